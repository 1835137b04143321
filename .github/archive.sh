#!/usr/bin/env bash
# Packs the release build of the command line with its completions, manual pages and the licences of all it contains.
# Usage: .github/archive.sh NAME, from the root of the repository; writes NAME.tar.gz, or NAME.zip on Windows.
set -euo pipefail
name=$1
program=target/release/girderway
if [ -f "$program.exe" ]; then program=$program.exe; fi
mkdir -p "$name/completions" "$name/man"
cp "$program" README.md CHANGELOG.md LICENSE-MIT LICENSE-APACHE THIRD-PARTY.html "$name/"
for shell in bash zsh fish powershell; do
    "$program" completions "$shell" > "$name/completions/girderway.$shell"
done
"$program" man "$name/man"
case $program in
    *.exe) 7z a -bso0 "$name.zip" "$name" ;;
    *) tar -czf "$name.tar.gz" "$name" ;;
esac
