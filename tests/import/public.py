"""Counts how many public NASTRAN decks with line elements `girderway import` takes, and why it refuses the others.

    python tests/import/public.py GIRDERWAY FOLDER [--skip-unused]

FOLDER has the repositories SteveDoyle2/pyNastran, smdogroup/tacs, vtpasquale/NASTRAN_CoFE, nasa/NASTRAN-95,
MYSTRANsolver/MYSTRAN and MYSTRANsolver/MYSTRAN_Benchmark, which are public on GitHub; those that are absent are not
counted. A deck is a file .bdf, .dat, .nas, .fem or .inp with a card CBAR, CBEAM, CROD, CONROD or CTUBE. Prints the
decks taken, the reasons that refuse decks by themselves, and all reasons, each with the number of decks.
"""

import collections
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ENDINGS = {".bdf", ".dat", ".nas", ".fem", ".inp"}
NUMBER = r"\b[0-9]+\b"
LINES = re.compile(rb"^(CBAR|CBEAM|CROD|CONROD|CTUBE)[ *,\t]", re.MULTILINE | re.IGNORECASE)


def decks(folder):
    """The decks below a folder, sorted."""
    files = (path for path in folder.rglob("*") if path.suffix.lower() in ENDINGS and path.is_file())
    return sorted(path for path in files if LINES.search(path.read_bytes()))


def reasons(stderr):
    """The kinds of errors of one deck, without numbers."""
    last = (stderr.strip().splitlines() or ["{}"])[-1]
    errors = json.loads(last).get("errors", [])
    kinds = set()
    for error in errors:
        about = re.sub(NUMBER, "N", error["path"] or "")
        expected = re.sub(r" \(.*alike.*\)$", "", error["expected"] or "")
        kinds.add(f"{about}: {re.sub(NUMBER, 'N', expected)}")
    return kinds


def main():
    program, folder, *flags = sys.argv[1:]
    found = decks(Path(folder))
    if not found:
        sys.exit(f"{folder}: no decks; fetch the repositories first")
    taken, alone, all_reasons = 0, collections.Counter(), collections.Counter()
    with tempfile.TemporaryDirectory() as scratch:
        for deck in found:
            units = ["--length", "m", "--force", "N", "--json", "-o", str(Path(scratch) / "spec.json")]
            run = subprocess.run([program, "import", str(deck), *units, *flags], capture_output=True, check=False)
            if run.returncode == 0:
                taken += 1
                continue
            kinds = reasons(run.stderr.decode(errors="replace"))
            all_reasons.update(kinds)
            if len(kinds) == 1:
                alone.update(kinds)
    print(f"{len(found)} decks, {taken} taken")
    for title, counts in [("refused by one reason alone", alone), ("all reasons", all_reasons)]:
        print(f"\n{title}:")
        for kind, count in counts.most_common():
            print(f"{count:5} {kind}")


if __name__ == "__main__":
    main()
