#!/usr/bin/env python3
"""A second reading of the limits of deflections: random designs of girders, checked by a program of its own.

Usage: second_reading.py GIRDERWAY [--designs 40] [--seed 1]. Needs numpy.

Each design is a girder on random supports (full, vertical only, lateral only, stiff and very soft springs, overhangs), with a
random train, a random code or limits of one's own, and cases with and without factors. The girder is solved here by Hermite
elements in the vertical plane, and in the lateral plane with St. Venant torsion between forks. Trains stand at positions
0.05 m apart, in both directions, with both signs of the lateral forces; deflections are taken at all nodes, from the chord
between the supports of the plane. Every row of `limits` must be found here with its value (1 %, as positions are sampled), its
limit and its result, and every row found here must be in `limits`.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

E, G = 2.1e8, 8.1e7
SECTIONS = {  # I_vertical, I_lateral, J in m4: tables of HE B sections (Euronorm 53-62)
    "HEB 300": (25166e-8, 8563e-8, 185e-8),
    "HEB 500": (107176e-8, 12624e-8, 538e-8),
    "HEB 700": (256888e-8, 14441e-8, 831e-8),
}
STEP = 0.25


def hermite(s, h):
    """Shape functions of a beam element of length h at the fraction s."""
    return np.array(
        [1 - 3 * s**2 + 2 * s**3, h * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3, h * (s**3 - s**2)]
    )


def beam(nodes, rigidity, held, springs):
    """Compliance (deflection at every node under a unit force at any x, by a function) of a beam."""
    n = len(nodes)
    k = np.zeros((2 * n, 2 * n))
    for e in range(n - 1):
        h = nodes[e + 1] - nodes[e]
        own = rigidity / h**3 * np.array(
            [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
             [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
        )
        at = slice(2 * e, 2 * e + 4)
        k[at, at] += own
    for x, stiffness in springs:
        k[2 * index(nodes, x), 2 * index(nodes, x)] += stiffness
    free = [d for d in range(2 * n) if d not in {2 * index(nodes, x) for x in held}]
    inverse = np.zeros_like(k)
    inverse[np.ix_(free, free)] = np.linalg.inv(k[np.ix_(free, free)])

    def at(x):
        e = min(max(np.searchsorted(nodes, x, side="right") - 1, 0), n - 2)
        h = nodes[e + 1] - nodes[e]
        row = np.zeros(2 * n)
        row[2 * e : 2 * e + 4] = hermite((x - nodes[e]) / h, h)
        return inverse[0::2] @ row

    return at


def torsion(nodes, rigidity, held):
    """Rotation at every node under a unit torque at any x of a bar that is held against twist at some nodes."""
    n = len(nodes)
    k = np.zeros((n, n))
    for e in range(n - 1):
        own = rigidity / (nodes[e + 1] - nodes[e])
        k[e : e + 2, e : e + 2] += own * np.array([[1, -1], [-1, 1]])
    free = [d for d in range(n) if d not in {index(nodes, x) for x in held}]
    inverse = np.zeros_like(k)
    inverse[np.ix_(free, free)] = np.linalg.inv(k[np.ix_(free, free)])

    def at(x):
        e = min(max(np.searchsorted(nodes, x, side="right") - 1, 0), n - 2)
        s = (x - nodes[e]) / (nodes[e + 1] - nodes[e])
        return inverse[:, e] * (1 - s) + inverse[:, e + 1] * s

    return at


def index(nodes, x):
    return int(np.argmin(np.abs(nodes - x)))


def chord_maxima(nodes, ends, response, wheels, forces):
    """Largest deflection of each span from its chord, over all positions of a train and both directions."""
    out = np.zeros(len(ends) - 1)
    low, high = nodes[0], nodes[-1]
    for turn in (1, -1):
        offsets = [turn * x for x in wheels]
        first, last = low - min(offsets), high - max(offsets)
        for p in np.append(np.arange(first, last, 0.05), last):
            u = sum(f * response(p + x) for x, f in zip(offsets, forces))
            for s, (a, b) in enumerate(zip(ends, ends[1:])):
                i, j = index(nodes, a), index(nodes, b)
                part = u[i : j + 1]
                chord = u[i] + (u[j] - u[i]) * (nodes[i : j + 1] - a) / (b - a)
                out[s] = max(out[s], np.max(np.abs(part - chord)))
    return out


def overhang_maximum(nodes, x, response, wheels, forces):
    """Largest absolute deflection of the tip at x."""
    worst = 0.0
    for turn in (1, -1):
        offsets = [turn * o for o in wheels]
        first, last = nodes[0] - min(offsets), nodes[-1] - max(offsets)
        for p in np.append(np.arange(first, last, 0.05), last):
            u = sum(f * response(p + o) for o, f in zip(offsets, forces))
            worst = max(worst, abs(u[index(nodes, x)]))
    return worst


def design_of(rng):
    """A random design: spec, design, and what this program needs to know of it."""
    section = rng.choice(list(SECTIONS))
    i_v, i_l, _ = SECTIONS[section]
    height = round(float(rng.uniform(0, 0.4)), 2)
    lengths = [float(rng.integers(12, 40)) * STEP for _ in range(rng.integers(2, 5))]
    joints = np.concatenate([[0.0], np.cumsum(lengths)])
    over = float(rng.integers(0, 9)) * STEP if rng.random() < 0.4 else 0.0
    points = list(joints) + ([joints[-1] + over] if over else [])
    vertical, lateral, springs, supports, spring_list = [], [], [], [], []
    for k, x in enumerate(joints):
        outer = k in (0, len(joints) - 1)
        kind = "full" if outer else rng.choice(["full", "vertical", "lateral", "stiff", "soft", "none"])
        fix = {"full": ["uy", "uz", "rx"], "vertical": ["uy"], "lateral": ["uz", "rx"]}.get(str(kind), [])
        if k == 0:
            fix = ["ux", *fix]
        if kind in ("full", "vertical"):
            vertical.append(float(x))
        if kind in ("full", "lateral"):
            lateral.append(float(x))
        if kind in ("stiff", "soft"):
            # far stiffer than the girder between the next joints, or far softer than over all of it
            a, b = lengths[k - 1], lengths[k]
            near = 12 * E * i_v * (1 / a**3 + 1 / b**3)
            far = 3 * E * i_v / joints[-1] ** 3
            stiffness = 50 * near if kind == "stiff" else 0.002 * far
            springs.append((float(x), float(stiffness)))
            spring_list.append({"point": k, "dof": "uy", "k": float(stiffness)})
            if kind == "stiff":
                vertical.append(float(x))
        if fix:
            supports.append({"point": k, "fix": fix})
    spec = {
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "theory": "euler-bernoulli", "points": [[float(x), 0, 0] for x in points],
        "cells": [{"type": "line", "data": [[k, k + 1] for k in range(len(points) - 1)]}],
        "materials": [{"name": "steel", "E": E, "G": G}],
        "sections": [{"name": "g", "material": "steel", "A": 0.02, "Iy": SECTIONS[section][1],
                      "Iz": SECTIONS[section][0], "J": SECTIONS[section][2]}],
        "supports": supports, "springs": spring_list,
        "rails": {"rail": {"origin": [0, 0, 0], "axis": [1, 0, 0],
                           "segments": [{"cell": [0, k], "offset": [0, height, 0]} for k in range(len(points) - 1)],
                           "stations": [float(x) for x in points]}},
    }
    base = round(float(rng.uniform(1, min(4, points[-1] / 3))), 2)
    force = float(rng.integers(20, 200))
    thrust, skew = [float(rng.integers(0, 20)) for _ in range(2)]
    wheels = [{"x": 0, "vertical": force}, {"x": base, "vertical": force}]
    if skew:
        wheels[0]["skewing"] = skew
    train = {"name": "c", "wheels": wheels, "lateral": thrust}
    practice = [
        {"code": "EN 1993-6"}, {"code": "EN 1991-3:2006"}, {"code": "CMAA 70"},
        {"code": "AISC Design Guide 7", "class": "D"}, {"code": "AIST TR-13", "building_class": "B"},
        {"code": "IS 800", "class": "electric"},
        {"limits": {"vertical": ["L/500", 0.015], "lateral": "L/450", "overhang": "L/200"}},
    ][rng.integers(0, 7)]
    design = {"format": "girderway-design/1", "units": spec["units"], "spec": "spec.json", "trains": [train],
              "practice": practice}
    if rng.random() < 0.5:
        factors = {"vertical": 1.6, "lateral": 0} if rng.random() < 0.5 else {"vertical": 1.2, "lateral": 1.2}
        design["cases"] = [{"name": "factored", "trains": ["c"], "factors": factors}]
    known = {"section": section, "height": height, "points": points, "over": over, "vertical": vertical,
             "lateral": lateral, "springs": springs, "wheels": [0, base], "force": force, "thrust": thrust,
             "skew": skew, "practice": practice, "joints": joints}
    return spec, design, known


# Ratio and largest deflection: vertical, lateral, by the texts that `docs/theory/practice.md` names.
RULES = {
    "EN": ((600, 0.025), (600, None), "horizontal"),
    "CMAA": ((600, None), (400, None), "tenth"),
    "AISC": ((800, None), (400, None), "tenth"),
    "AIST": ((1000, None), (400, None), "thrust"),
    "IS": ((750, None), (400, None), "thrust"),
    "own": ((500, 0.015), (450, None), "horizontal"),
}


def expected(known):
    """Rows of limits: quantity, from, to, value, limit; of each place the largest value."""
    i_v, i_l, j = SECTIONS[known["section"]]
    nodes = np.arange(0, known["points"][-1] + 1e-9, 0.5 * STEP)
    code = known["practice"].get("code", "own")
    vertical_rule, lateral_rule, loads = RULES[code.split()[0]]
    allowed = lambda rule, length: min(length / rule[0], rule[1] or np.inf)
    rows = []
    up = beam(nodes, E * i_v, [x for x in known["vertical"] if x not in dict(known["springs"])], known["springs"])
    forces = [known["force"]] * 2
    ends = sorted(known["vertical"])
    for (a, b), value in zip(zip(ends, ends[1:]), chord_maxima(nodes, ends, up, known["wheels"], forces)):
        rows.append(("vertical deflection", a, b, value, allowed(vertical_rule, b - a)))
    if code == "own" and known["over"]:
        value = overhang_maximum(nodes, nodes[-1], up, known["wheels"], forces)
        rows.append(("deflection of the overhang", ends[-1], nodes[-1], value, known["over"] / 200))
    bend = beam(nodes, E * i_l, known["lateral"], [])
    twist = torsion(nodes, G * j, known["lateral"])
    side = lambda x: bend(x) + known["height"] ** 2 * twist(x)
    sets = {"tenth": [[0.1 * f for f in forces]], "thrust": [[known["thrust"]] * 2]}
    sets["horizontal"] = sets["thrust"] + [[known["skew"], 0.0]]
    ends = sorted(known["lateral"])
    best = np.zeros(len(ends) - 1)
    for lateral in sets[loads]:
        best = np.maximum(best, chord_maxima(nodes, ends, side, known["wheels"], lateral))
    for (a, b), value in zip(zip(ends, ends[1:]), best):
        if value > 0:
            rows.append(("lateral deflection", a, b, value, allowed(lateral_rule, b - a)))
    return rows


def compare(program, seed):
    """Errors of one design, in words."""
    spec, design, known = design_of(np.random.default_rng(seed))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "spec.json").write_text(json.dumps(spec))
        (folder / "design.json").write_text(json.dumps(design))
        done = subprocess.run([program, "design", "design.json", "-o", "out", "--quiet"], cwd=folder,
                              capture_output=True, text=True)
        if done.returncode:
            return [f"seed {seed}: {done.stderr.strip()}"], 0
        summary = json.loads((folder / "out/summary.json").read_text())
    found = {}
    for row in summary["limits"]:
        key = (row["quantity"], round(row["from"], 6), round(row["to"], 6))
        if key not in found or row["value"] > found[key]["value"]:
            found[key] = row
    errors, rows = [], expected(known)
    for quantity, a, b, value, limit in rows:
        row = found.pop((quantity, round(a, 6), round(b, 6)), None)
        if row is None:
            errors.append(f"seed {seed}: no row for {quantity} from {a} to {b}")
        elif abs(row["value"] / value - 1) > 0.01 or abs(row["limit"] / limit - 1) > 1e-9:
            errors.append(f"seed {seed}: {quantity} from {a} to {b}: {row['value']} of {row['limit']}, "
                          f"here {value} of {limit}")
        elif row["within"] != (row["value"] <= row["limit"]):
            errors.append(f"seed {seed}: {quantity} from {a} to {b}: within is {row['within']}")
    for key, row in found.items():
        if row["value"] > 1e-9:
            errors.append(f"seed {seed}: a row that is not expected: {key}, {row['value']}")
    fails = any(value > limit for _, _, _, value, limit in rows)
    near = any(abs(value / limit - 1) < 0.01 for _, _, _, value, limit in rows)
    if not near and (summary["verdict"]["result"] == "not ok") != fails:
        errors.append(f"seed {seed}: verdict {summary['verdict']['result']}")
    return errors, len(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--designs", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    program = str(pathlib.Path(given.program).resolve())
    errors, rows = [], 0
    for seed in range(given.seed, given.seed + given.designs):
        own, count = compare(program, seed)
        errors += own
        rows += count
    print("\n".join(errors))
    print(f"{given.designs} designs, {rows} rows, {len(errors)} errors")
    return bool(errors)


if __name__ == "__main__":
    sys.exit(main())
