"""Column reactions of the mill girderway under crane trains, beside OpenSees.

    python3 -m venv venv && venv/bin/pip install -r fea/requirements.txt
    venv/bin/python tests/design/mill.py target/release/girderway [--step FT] [--keep FOLDER]

`girderway design` runs a ladle crane with eight wheels and a charging crane with four on the rail of
examples/mill_girderway, each alone, two of the latter, and one of each in either order, 1 ft or more apart. OpenSees solves the same building (by
fea/opensees_frame.py, which reads the spec on its own) under single loads along the rail. Its influence line of a
reaction is a cubic over the girder of a bay, and straight on each half of the gap over a column; both follow from a few
loads, and the misfit of the surplus loads is printed. The trains stand at every --step, 0.05 ft by default; two trains
by a running maximum over the positions of the one behind.

Samples may not exceed the exact extremes by more than the difference of both codes (1e-6 of the largest reaction: exit
status 1), and fall short of them by the step. Prints both, and time and memory of each case of the design.
"""

import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "fea"))
import frame_model  # noqa: E402
import opensees_frame  # noqa: E402

COLUMNS = [0.0, 40.0, 95.0, 170.0, 230.0, 275.0, 325.0]
GAP = 0.75
TRAINS = {
    "ladle": ([0, 5, 11, 16, 29, 34, 40, 45], 110e3, 4.0),
    "charging": ([0, 5, 13, 18], 120e3, 3.0),
}
CASES = {
    "ladle": ["ladle"],
    "charging": ["charging"],
    "two charging": ["charging", "charging"],
    "both": ["ladle", "charging"],
}
APART = 1.0
WITHIN = 1e-6


def design(case):
    """The design file of a case, vertical forces alone."""
    trains = [
        {"name": name, "ends": [end, end], "wheels": [{"x": x, "vertical": force} for x in places]}
        for name, (places, force, end) in TRAINS.items()
        if name in CASES[case]
    ]
    return {
        "format": "girderway-design/1", "name": "mill", "units": {"length": "ft", "force": "lbf", "time": "s"},
        "spec": "spec.json", "trains": trains, "cases": [{"name": case, "trains": CASES[case], "gap": APART}],
    }


def exact(program, case, folder):
    """Largest and smallest vertical reaction of each column; seconds of the processor."""
    (folder / "spec.json").write_text((ROOT / "examples/mill_girderway/spec.json").read_text())
    name = case.replace(" ", "-")
    (folder / f"{name}.json").write_text(json.dumps(design(case), indent=1))
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    begin = time.perf_counter()
    subprocess.run([program, "design", f"{name}.json", "-o", f"out-{name}", "--force", "--quiet"], cwd=folder, check=True)
    wall = time.perf_counter() - begin
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{case}: {wall:.2f} s, {used.ru_utime - before:.2f} s of the processor, "
          f"at most {used.ru_maxrss / 1024:.0f} MB so far")
    summary = json.loads((folder / f"out-{name}/summary.json").read_text())
    found = {}
    for extreme in summary["extremes"]:
        support = extreme.get("support", "")
        if support.startswith("column") and extreme.get("direction") == "uy":
            found[int(support[6:]) - 1, extreme["kind"]] = extreme["value"]
    return found


def stretches():
    """Parts of the rail with one polynomial each: from, to, degree, places of loads."""
    parts = []
    for k, (a, b) in enumerate(zip(COLUMNS, COLUMNS[1:])):
        if k > 0:
            parts.append((a, a + GAP, 1, a + GAP * np.array([0.3, 0.6, 0.9])))
        inner = np.array([0.03, 0.2, 0.4, 0.6, 0.8, 0.97])
        parts.append((a + GAP, b - GAP, 3, a + GAP + (b - a - 2 * GAP) * inner))
        if k + 2 < len(COLUMNS):
            parts.append((b - GAP, b, 1, b - GAP * np.array([0.9, 0.6, 0.3])))
    return parts


def reactions(frame, tie):
    """Vertical reactions of the columns under unit loads downwards: load x column."""
    ops = opensees_frame.load()
    model = opensees_frame.Model(ops, frame, tie)
    ops.constraints("Transformation" if model.plain else "Lagrange")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.integrator("LoadControl", 1.0)
    ops.algorithm("Linear", "-factorOnce")
    ops.timeSeries("Constant", 1)
    ops.analysis("Static")
    out = []
    for _, direction, node, force in frame.unit_loads():
        if direction != 1:
            continue
        ops.pattern("Plain", 1, 1)
        ops.load(node + 1, *(-float(f) for f in force), 0.0, 0.0, 0.0)
        if ops.analyze(1) != 0:
            raise SystemExit("OpenSees cannot solve the system")
        ops.reactions()
        out.append([ops.nodeReaction(6 * k + 1, 2) for k in range(len(COLUMNS))])
        ops.remove("loadPattern", 1)
    return np.array(out), bool(model.ties)


def influence():
    """Polynomials of the influence lines: part x (from, to, coefficients in x - from by column)."""
    parts = stretches()
    spec = json.loads((ROOT / "examples/mill_girderway/spec.json").read_text())
    spec["rails"]["north"]["stations"] = sorted(float(x) for part in parts for x in part[3])
    stiff = opensees_frame.TIES
    values, tied = reactions(frame_model.Frame(spec, "timoshenko"), stiff[0])
    if tied:
        stiffer, _ = reactions(frame_model.Frame(spec, "timoshenko"), stiff[1])
        values = (stiff[1] * stiffer - stiff[0] * values) / (stiff[1] - stiff[0])
    lines, misfit, first = [], 0.0, 0
    for a, b, degree, places in parts:
        rows = np.vander((places - a) / (b - a), degree + 1)
        own = values[first : first + len(places)]
        first += len(places)
        coefficients, *_ = np.linalg.lstsq(rows, own, rcond=None)
        misfit = max(misfit, np.abs(rows @ coefficients - own).max())
        lines.append((a, b, coefficients))
    print(f"influence lines of OpenSees: misfit {misfit:.1e} of a unit load")
    return lines


def evaluate(lines, x):
    """Influence ordinates at places x of the rail: column x place."""
    out = np.full((len(COLUMNS), len(x)), np.nan)
    for a, b, coefficients in lines:
        here = (x >= a) & (x <= b)
        out[:, here] = (np.vander((x[here] - a) / (b - a), len(coefficients)) @ coefficients).T
    return out


def sampled(lines, case, step):
    """Largest and smallest reactions of the columns over positions, those of several trains by running extremes."""
    low, high = COLUMNS[0] + GAP, COLUMNS[-1] - GAP
    responses = []
    for name in CASES[case]:
        places, force, end = TRAINS[name]
        ways = []
        for row in (places, [places[-1] - x for x in reversed(places)]):
            p = np.arange(low, high - row[-1] + 1e-9, step)
            ways.append(force * sum(evaluate(lines, np.minimum(p + x, high)) for x in row))
        responses.append((ways, places[-1], end))
    found = {}
    for sign, kind in ((1.0, "max"), (-1.0, "min")):
        best = [np.max([sign * way for way in ways], axis=0) for ways, _, _ in responses]
        if len(best) == 1:
            top = best[0].max(axis=1)
        else:
            top = np.full(len(COLUMNS), -np.inf)
            for behind, ahead in ((0, 1), (1, 0)):
                clear = responses[behind][1] + responses[behind][2] + responses[ahead][2] + APART
                shift = int(np.ceil(clear / step - 1e-9))
                running = np.maximum.accumulate(best[behind], axis=1)
                count = best[ahead].shape[1] - shift
                both = best[ahead][:, shift:] + running[:, :count]
                top = np.maximum(top, both.max(axis=1))
        for column, value in enumerate(top):
            found[column, kind] = sign * value
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--step", type=float, default=0.05)
    parser.add_argument("--keep", help="folder for the designs and their results")
    args = parser.parse_args()
    program = str(pathlib.Path(args.program).resolve())
    lines = influence()
    above = 0.0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(args.keep or temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for case in CASES:
            own = exact(program, case, folder)
            other = sampled(lines, case, args.step)
            largest = max(abs(value) for value in own.values())
            for column in range(len(COLUMNS)):
                cells = []
                for kind, sign in (("max", 1.0), ("min", -1.0)):
                    beyond = sign * (other[column, kind] - own[column, kind]) / largest
                    above = max(above, beyond)
                    cells.append(f"{kind} {own[column, kind]:12.1f}, sampled {other[column, kind]:12.1f} ({beyond:+.1e})")
                print(f"  column{column + 1} uy  " + "   ".join(cells), flush=True)
    print(f"no sample exceeds an exact extreme by more than {above:.1e} of the largest reaction")
    if above > WITHIN:
        sys.exit(1)


if __name__ == "__main__":
    main()
