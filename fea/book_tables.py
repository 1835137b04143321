#!/usr/bin/env python3
"""Tables of docs/performance.md and docs/study.md from the files that the measurements write.

    python fea/book_tables.py peers docs/peers.json          # written by fea/bench_peers.py -o docs
    python fea/book_tables.py frames frames.csv              # written by fea/bench_frames.py --csv frames.csv
    python fea/book_tables.py wheels wheels.csv              # written by the example `crossings` of the crate sim
    python fea/book_tables.py study OUT [OUT ...]            # folders of `girderway study`
    python fea/book_tables.py stability OUT/stability.json   # of `girderway study --stability`

Prints Markdown; nothing but the standard library is needed.
"""

import csv
import json
import pathlib
import sys

LOADS = "61 loads on the girder"
# error of grids that are exact but for rounding
EXACT = 1e-9
CROSSINGS = {
    "S1": "S1, bogie at 5 ft/s",
    "S2": "S2, bogie at 100 ft/s",
    "S3": "S3, eight wheels at 10 ft/s",
    "S1 beam": "S1, girder with mass",
    "S2 beam": "S2, girder with mass",
    "S4 beam": "S4, bridge of Yang and Yau",
}
SOLVERS = ("CHOLMOD", "SuperLU", "OpenSees", "PyNite")
QUANTITIES = ("deflection", "wheel_force", "lateral_force", "reaction", "moment")
VERDICTS = ("right", "silently wrong", "diverges", "wrong, with a warning", "refused")
# a reference whose own error of the deflection is larger decides nothing
UNRESOLVED = 0.1


def thousands(text):
    """A comma before every three digits of the integer part, from five digits on."""
    whole, point, part = text.partition(".")
    return (f"{int(whole):,}" if len(whole) > 4 else whole) + point + part


def number(value, digits):
    """`value` with significant digits: plain between 1e-3 and 1e7, otherwise with a power of ten."""
    if value is None:
        return ""
    mantissa, power = f"{value:.{digits - 1}e}".split("e")
    power = int(power)
    if value != 0.0 and not -3 <= power < 7:
        return f"{mantissa}e{power}"
    return thousands(f"{float(f'{value:.{digits - 1}e}'):.{max(digits - 1 - power, 0)}f}")


def scientific(value, digits):
    mantissa, power = f"{value:.{digits}e}".split("e")
    return f"{mantissa}e{int(power)}"


def seconds(value):
    """Seconds with three digits in ns, us, ms or s."""
    for unit, factor, end in (("ns", 1e9, 0.9995e-6), ("us", 1e6, 0.9995e-3), ("ms", 1e3, 0.9995)):
        if value < end:
            return f"{number(factor * value, 3)} {unit}"
    return f"{number(value, 3)} s"


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    print("\n".join(lines) + "\n")


def peers(path):
    """The rows of docs/performance.md that come from fea/bench_peers.py, with the heads of its table."""
    runs = json.loads(pathlib.Path(path).read_text())
    rows = [compared(runs, LOADS, "grid of the paper's girder", "61 unit loads", "error", EXACT)]
    for scene, task in CROSSINGS.items():
        for quantity, text in (("error", "deflection"), ("force_error", "wheel forces")):
            rows.append(compared(runs, scene, task, f"{text} within 1e-3", quantity, 1e-3))
    table(("task", "size or accuracy", "girderway", "other programs (times as long)", "command"), rows)


def compared(runs, scene, task, size, quantity, error):
    """A row: for every code the shortest median of the settings that reach the error, and its ratio to girderway's."""
    least = {}
    for run in runs:
        # an error that is no number is one without bound
        if run["scene"] == scene and run[quantity] is not None and run[quantity] <= error:
            least[run["code"]] = min(run["median_ms"], least.get(run["code"], float("inf")))
    ours = least.pop("girderway")
    others = [f"{code} {seconds(1e-3 * ms)} ({number(ms / ours, 2)})" for code, ms in least.items()]
    return task, size, seconds(1e-3 * ours), ", ".join(others), "`fea/bench_peers.py`"


def frames(path):
    with open(path, newline="") as file:
        cases = {}
        for row in csv.DictReader(file):
            key = (row["frame"], int(row["freedoms"]), row["loads"])
            cases.setdefault(key, {})[row["code"]] = float(row["ms"])
    rows = []
    for (frame, dofs, loads), ms in cases.items():
        ratio = ms["girderway"] / ms["CHOLMOD"] if "CHOLMOD" in ms else None
        own = [number(ms.get(code), 3) for code in ("girderway", *SOLVERS)]
        rows.append((f"{frame} {thousands(str(dofs))}", loads, *own, number(ratio, 2)))
    table(("frame, degrees of freedom", "loads", "girderway, ms", *SOLVERS, "ours / CHOLMOD"), rows)


def wheels(path):
    with open(path, newline="") as file:
        rows = [(row["n"], row["steps"], number(float(row["stages"]) / float(row["steps"]), 1),
                 seconds(1e-6 * float(row["us a step"])), scientific(float(row["residual"]), 0))
                for row in csv.DictReader(file)]
    table(("wheels", "steps", "contact solutions a step", "time of a step", "energy residual"), rows)


def read_study(folder):
    """study.json with the times of timing.json at its settings."""
    folder = pathlib.Path(folder)
    study, timing = (json.loads((folder / name).read_text()) for name in ("study.json", "timing.json"))
    # timing.json has the settings that were timed, in the same order
    times = iter(timing["settings"])
    for setting in study["settings"]:
        knob, value = list(setting.items())[1]
        if value < 1.0:
            mantissa, power = f"{value:e}".split("e")
            value = f"{float(mantissa):g}e{int(power)}"
        else:
            value = f"{value:g}"
        setting["label"] = f"{setting['family']}, {knob} {value}"
        if setting["status"] == "done":
            setting |= next(times, {})
            setting["errors"] = {name: own["largest"] for name, own in setting["errors"].items()}
    study["cost_ratio_by_time"] = timing["cost_ratio"]
    until = study.get("until")
    study["title"] = study["name"] if until is None else f"{study['name']}, until {number(until, 3)} s"
    return study


def reference(study):
    """The reference that resolves deflections, and the error from which it does."""
    found = ("own", 0.0)
    for own in study["references"]:
        found = (own["against"], own["resolution"].get("deflection", 0.0))
        if own["against"] != "massless" and found[1] < UNRESOLVED:
            return found
    return found


def studies(folders):
    all_studies = [read_study(folder) for folder in folders]
    rows = []
    for study in all_studies:
        against, least = reference(study)
        done = [own for own in study["settings"]
                if own["against"] == against and "deflection" in own.get("errors", {}) and own.get("median")]
        best = float("inf")
        for own in sorted(done, key=lambda own: own["median"]):
            error = own["errors"]["deflection"]
            if max(error, least) >= best:
                continue
            best = max(error, least)
            text = f"below {scientific(least, 0)}" if error <= least else scientific(error, 1)
            force = own["errors"].get("wheel_force")
            force = "" if force is None else "that of the reference" if force == 0.0 else scientific(force, 1)
            rows.append((study["title"], own["label"], text, force,
                         number(1e3 * own["median"], 3),
                         f"{number(1e3 * own['least'], 2)} to {number(1e3 * own['most'], 2)}", own["stages"]))
    table(("scene", "setting", "error of deflection", "wheel force", "median, ms", "least to most",
           "contact solutions"), rows)
    rows = []
    for study in all_studies:
        def held(own):
            memory = own.get("memory") or {}
            return (memory.get("run") or 0) + (memory.get("foundations") or 0)
        chosen = [next((own for own in study["settings"] if own["family"] == family), None)
                  for family in ("as written", "auto")]
        chosen.append(max(study["settings"], key=held))
        for own in chosen:
            if own is None or not held(own):
                continue
            # a reference of the scene's own foundations knows nothing of their error
            is_known = reference(study)[0] == "whole" or own["against"] != "whole"
            error = own["errors"].get("deflection") if is_known else None
            text = "that of the reference" if error == 0.0 else "" if error is None else scientific(error, 1)
            rows.append((study["title"], own["label"], number(1e-3 * (own["memory"].get("foundations") or 0), 3),
                         number(1e-3 * own["memory"]["run"], 3), text))
    table(("scene", "setting", "foundations, kB", "run, kB", "error of deflection"), rows)
    rows = []
    for study in all_studies:
        for setting, word in (("as written", "as written"), ("auto", "auto"), ("stepping", "as written, among methods")):
            if setting == "stepping" and study["cost_ratio_by_stages"]["as written"].get("deflection") is not None:
                continue
            for by, key in (("contact solutions", "cost_ratio_by_stages"), ("time", "cost_ratio_by_time")):
                cells = [number(study[key][setting].get(name), 3) for name in QUANTITIES]
                if any(cells):
                    rows.append((study["title"], word, by, *cells))
    table(("scene", "setting", "by", "deflection", "wheel force", "lateral", "reaction", "moment"), rows)


def stability(path):
    maps = json.loads(pathlib.Path(path).read_text())["maps"]

    def points(own, verdict):
        return own["counts"].get(verdict, 0)

    def cell(count):
        return thousands(str(count)) if count else ""

    rows = []
    for one in maps:
        for own in one["methods"]:
            bold = "**" if own["is_girderway"] else ""
            counts = [points(own, verdict) for verdict in VERDICTS]
            rows.append((f"`{one['name']}`", f"{bold}{own['method']}{bold}", cell(sum(counts)), *map(cell, counts)))
    table(("map", "method", "points", "right", "silently wrong", "diverges", "warned", "refused"), rows)

    def sums(some, ours):
        return [sum(points(own, verdict) for one in some for own in one["methods"] if own["is_girderway"] is ours)
                for verdict in VERDICTS]

    rows = []
    for name, some in [*((f"`{one['name']}`", [one]) for one in maps), ("all", maps)]:
        ours, others = sums(some, True), sums(some, False)
        rows.append((name, cell(sum(ours)), cell(ours[0]), cell(ours[3]), cell(ours[4]), ours[1] + ours[2],
                     cell(sum(others)), cell(others[1]), cell(others[2])))
    table(("map", "girderway: points", "right", "warned", "refused", "silently wrong", "others: points",
           "silently wrong", "diverge"), rows)
    for one in maps:
        for own in one["measured"]:
            print(f"{one['name']}: {own['what']}: {own['value']:.5g}")


def main():
    kinds = {"peers": peers, "frames": frames, "wheels": wheels, "stability": stability}
    if len(sys.argv) < 3 or sys.argv[1] not in (*kinds, "study"):
        sys.exit(__doc__)
    if sys.argv[1] == "study":
        studies(sys.argv[2:])
    else:
        kinds[sys.argv[1]](sys.argv[2])


if __name__ == "__main__":
    main()
