#!/usr/bin/env python3
"""Shows that compare.py finds every kind of difference: proof.py PROGRAM.

A few inputs are run by PROGRAM and by PROGRAM with one file altered after each command; each alteration must be found,
those that the rules allow must not.
"""

import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))

import compare  # noqa: E402
import equal  # noqa: E402
import fixed  # noqa: E402
from case import Case  # noqa: E402

BOGIE = str(fixed.ROOT / "examples/bogie")
RUN = ["run", "fast.json", "-o", "out"]
GRID = ["fea", "spec.json", "-o", "grid.json"]
TABLES = [GRID, ["splines", "grid.json", "-o", "t.adm"], ["splines", "grid.json", "-o", "t.npz"]]
DECK = [["deck", "fast.json", "-o", "d.adm"]]
BAD = [["run", "expected.json"]]

SUBSTITUTE = (
    "import re,sys,pathlib; p=pathlib.Path(sys.argv[1]); t=p.read_text(); "
    "n=re.sub(sys.argv[2],sys.argv[3],t,count=1,flags=re.S); assert n!=t; p.write_text(n)"
)


def altered(program, folder, file, pattern, replacement):
    """A program that runs PROGRAM and then replaces a pattern in a file, once."""
    script = folder / "altered"
    script.write_text(
        f"#!/bin/sh\n{program} \"$@\"\nstatus=$?\n"
        f"if [ -f '{file}' ]; then {sys.executable} -c '{SUBSTITUTE}' '{file}' '{pattern}' '{replacement}'; fi\nexit $status\n"
    )
    script.chmod(0o755)
    return script


def printed(program, folder, words):
    """A program whose messages are altered by sed."""
    script = folder / "altered"
    script.write_text(f"#!/bin/sh\n{{ {program} \"$@\" 2>&1 1>&3 | sed '{words}' 1>&2; }} 3>&1\n"
                      f"{program} \"$@\" >/dev/null 2>&1\n")
    script.chmod(0o755)
    return script


PLAIN = equal.Rules()
# what, commands, file, pattern, replacement, rules, kind of the difference or None
FILES = [
    ("a digit of a history", [RUN], "out/history.csv", r"(\n0\.5,[^,]*,[^,]*)([0-9]),", r"\g<1>\g<2>1,", PLAIN, "history"),
    ("the same within the tolerance", [RUN], "out/history.csv", r"(\n0\.5,[^,]*,0\.[0-9]{15}[0-9]*),", r"\g<1>1,", equal.Rules(tolerance=1e-10), None),
    ("a value beyond the tolerance", [RUN], "out/history.csv", r"(\n0\.5,[^,]*,0\.[0-9]{3})[0-9]*,", r"\g<1>,", equal.Rules(tolerance=1e-10), "history"),
    ("a row less", [RUN], "out/history.csv", r"\n[^\n]*\n$", r"\n", equal.Rules(tolerance=1e-10), "history"),
    ("a grid", [GRID], "grid.json", r"(e-8),", r"\g<1>1,", PLAIN, "grid"),
    ("a table", TABLES, "t.adm", r"(E-8),", r"\g<1>1,", PLAIN, "table"),
    ("a deck", DECK, "d.adm", r"(GFORCE)", r"\g<1> ", PLAIN, "deck"),
    ("a status", [RUN], "out/summary.json", r'"done"', r'"ended"', PLAIN, "summary"),
    ("a number of a summary", [RUN], "out/summary.json", r'("residual": )', r"\g<1>1", PLAIN, "summary"),
    ("a renamed key", [RUN], "out/summary.json", r'"put_in"', r'"supplied"', PLAIN, "summary"),
    ("a renamed key that is listed", [RUN], "out/summary.json", r'"put_in"', r'"supplied"', equal.Rules(renamed={"energy/put_in": "supplied"}), None),
    ("a count of steps beyond 1 %", [RUN], "out/summary.json", r'("accepted": )([0-9])', r"\g<1>9\2", equal.Rules(tolerance=1e-10), "summary"),
    ("an output in the manifest", [RUN], "out/manifest.json", r'"history.csv"', r'"story.csv"', PLAIN, "manifest"),
    ("a hash in the manifest", [RUN], "out/manifest.json", r'("sha256": ")..', r"\g<1>00", PLAIN, None),
    ("a stage of the times", [RUN], "out/timing.json", r'"plots"', r'"pictures"', PLAIN, "timing"),
    ("a line of a picture", [RUN], "out/plots/wheel-forces.svg", r'(data-series="0".*?d="M[0-9]+ )[0-9]+l', r"\g<1>100l", equal.Rules(pictures=True), "picture"),
    ("a word of a picture", [RUN], "out/plots/wheel-forces.svg", r"vertical", r"upright", equal.Rules(pictures=True), "picture"),
    ("the paint of a picture", [RUN], "out/plots/wheel-forces.svg", r"#DDDDDD", r"#EEEEEE", equal.Rules(pictures=True), None),
    ("a picture that nobody compares", [RUN], "out/plots/wheel-forces.svg", r"vertical", r"upright", PLAIN, None),
    ("a number of a report", [RUN], "out/report.html", r'(<td class="number">[0-9.]*)<', r"\g<1>9<", equal.Rules(pictures=True), "report"),
    ("a chart of a report", [RUN], "out/report.html", r'("n":551,"v":\[)', r"\g<1>1", equal.Rules(pictures=True), "report"),
    ("the style of a report", [RUN], "out/report.html", r"font-size: 1\.9rem", r"font-size: 2rem", equal.Rules(pictures=True), None),
]
MESSAGES = [
    ("the wording of a message", "s/unknown key/strange key/", PLAIN, "messages"),
    ("the wording of a message, which may differ", "s/unknown key/strange key/", equal.Rules(messages_may_differ=True), None),
    ("the place of a message", "s/:1:/:2:/", equal.Rules(messages_may_differ=True), "messages"),
]


def main():
    program = Path(sys.argv[1]).resolve()
    failures = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        trials = [(what, commands, altered(program, sub(folder), file, pattern, new), rules, kind)
                  for what, commands, file, pattern, new, rules, kind in FILES]
        trials += [(what, BAD, printed(program, sub(folder), words), rules, kind) for what, words, rules, kind in MESSAGES]
        for what, commands, other, rules, kind in trials:
            case = Case(what, {}, commands, set(), BOGIE)
            kinds = {difference.kind for difference in compared_once(case, program, other, rules)}
            good = kinds - {"exit status"} == ({kind} if kind else set())
            failures += not good
            print(f"{'found' if kind else 'let pass'}: {what}" if good else f"WRONG: {what}: {kinds or 'nothing'} in place of {kind}")
    print(f"{len(FILES) + len(MESSAGES)} alterations, {failures} judged wrongly")
    return 1 if failures else 0


def compared_once(case, program, other, rules):
    return compare.compared(case, (program, other), rules)[0]


def sub(folder, count=[0]):
    count[0] += 1
    path = folder / str(count[0])
    path.mkdir()
    return path


if __name__ == "__main__":
    sys.exit(main())
