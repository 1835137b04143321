#!/usr/bin/env python3
"""Compares two builds of girderway: the same random scenes and specs, the same files?

    python3 tests/equivalence/compare.py OLD NEW [--scenes 500] [--seed 1] [--jobs 2]

Exit status: 0 all cases are equal, 1 some differ, 2 usage. README.md beside this file says what is compared.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))

import draws  # noqa: E402
import equal  # noqa: E402
import fixed  # noqa: E402

NOT_COMPARED = "not compared"


def prepare(case, folder):
    """Writes the files of a case."""
    if case.folder:
        shutil.copytree(case.folder, folder, dirs_exist_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in case.files.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def call(binary, command, folder, limit):
    """Exit status, standard output and standard error of one call; the status is None where it took too long."""
    try:
        done = subprocess.run([str(binary), *command], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None, "", ""
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def compared(case, binaries, rules, keep=None):
    """Runs a case with both programs; returns its differences and the exit statuses of the old one."""
    with tempfile.TemporaryDirectory(prefix="girderway-") as temporary:
        roots = [Path(temporary) / side / "case" for side in ("old", "new")]
        for root in roots:
            prepare(case, root)
        found, statuses = [], []
        for command in case.commands:
            old, new = (call(binary, command, root, case.timeout) for binary, root in zip(binaries, roots))
            if old[0] is None and new[0] is None:
                found.append(equal.Difference(NOT_COMPARED, " ".join(command), f"both took more than {case.timeout:.0f} s"))
                break
            statuses.append(old[0])
            if old[0] != new[0]:
                found.append(equal.Difference("exit status", " ".join(command), f"{old[0]} became {new[0]} {equal.clip(new[2].strip(), 200)}"))
            for kind, a, b in (("standard output", old[1], new[1]), ("messages", old[2], new[2])):
                if text := equal.messages(a, b, rules):
                    found.append(equal.Difference(kind, " ".join(command), text))
        found += equal.folders(*roots, rules)
        if keep and found:
            shutil.copytree(temporary, Path(keep) / case.name.replace("/", "_").replace(" ", "_"), dirs_exist_ok=True)
    return found, statuses


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("old", type=Path, help="program as it was")
    parser.add_argument("new", type=Path, help="program as it is")
    parser.add_argument("--scenes", type=int, default=500, metavar="N", help="random cases [500]")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of the random cases [1]")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="cases at the same time [2]")
    parser.add_argument("--only", metavar="TEXT", help="cases alone whose name has this text")
    parser.add_argument("--random-only", action="store_true", help="without malformed inputs, examples and calls")
    parser.add_argument("--slow", action="store_true", help="the long examples too")
    parser.add_argument("--tolerance", type=float, metavar="T", help="histories within T of the largest value of a column until a flange strikes")
    parser.add_argument("--messages-may-differ", action="store_true", help="wording of messages may differ, not their places and numbers")
    parser.add_argument("--renamed", type=Path, metavar="FILE", help="lines old<TAB>new: renamed keys of our own output")
    parser.add_argument("--pictures", action="store_true", help="compare pictures and reports too")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="copy the folders of cases that differ to DIR")
    parser.add_argument("--tags", action="store_true", help="print how often each feature occurs, and how often it ran to the end")
    return parser.parse_args()


def main():
    options = arguments()
    binaries = [options.old.resolve(), options.new.resolve()]
    for binary in binaries:
        if not binary.is_file():
            print(f"{binary} is no file", file=sys.stderr)
            return 2
    renamed = equal.read_renames(options.renamed.read_text()) if options.renamed else {}
    rules = equal.Rules(renamed, options.messages_may_differ, options.tolerance, options.pictures)
    cases = [draws.random_case(options.seed, number) for number in range(options.scenes)]
    if not options.random_only:
        cases += fixed.cases(options.slow)
    if options.only:
        cases = [case for case in cases if options.only in case.name]
    begin = time.monotonic()
    differing, kinds, tags, ran, ended = [], Counter(), Counter(), Counter(), Counter()
    with ThreadPoolExecutor(options.jobs) as pool:
        results = pool.map(lambda case: compared(case, binaries, rules, options.keep), cases)
        for number, (case, (found, statuses)) in enumerate(zip(cases, results), 1):
            if found:
                differing.append((case, found))
                kinds.update({difference.kind for difference in found})
            good = bool(statuses) and statuses[0] == 0
            ended["ran to the end" if all(s == 0 for s in statuses) and statuses else "ran in part" if good else "refused"] += 1
            tags.update(case.tags)
            ran.update(case.tags if good else ())
            if sys.stderr.isatty() or number % 100 == 0:
                print(f"{number} of {len(cases)} cases, {len(differing)} differ", end="\r" if sys.stderr.isatty() else "\n", file=sys.stderr)
    for case, found in differing:
        print(f"{case.name}: {found[0].kind}: {found[0].place}: {found[0].text}")
        if len(found) > 1:
            print(f"    and {len(found) - 1} more: {', '.join(sorted({d.kind for d in found}))}")
    if options.tags:
        print(f"{'feature':36} {'cases':>6} {'ran':>6}")
        for tag in sorted(tags):
            print(f"{tag:36} {tags[tag]:6} {ran[tag]:6}")
    if kinds:
        print(f"{'kind of difference':24} cases")
        for kind, number in kinds.most_common():
            print(f"{kind:24} {number:5}")
    without = sum(any(d.kind == NOT_COMPARED for d in found) for _, found in differing)
    summary = ", ".join(f"{count} {word}" for word, count in sorted(ended.items()))
    print(f"{len(cases)} cases in {time.monotonic() - begin:.0f} s ({summary}): {len(cases) - len(differing)} equal, "
          f"{len(differing) - without} differ, {without} not compared")
    return 1 if differing or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
