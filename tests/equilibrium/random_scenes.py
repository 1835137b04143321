#!/usr/bin/env python3
"""Static equilibrium of bodies on one-sided wheels: random scenes beside their conditions and beside Lemke's method.

    python3 tests/equilibrium/random_scenes.py PROGRAM [--scenes 2000] [--seed 1] [--jobs 2]

A rigid body stands on 1 to 12 wheels on 1 to 3 simply supported girders, whose stiffnesses differ by factors from 1e-3 to 1e3. The
wheels have linear or power laws from 1e2 to 1e9 kN/m, rails may have steps, and the centre of mass is anywhere. Nothing of the
reference is taken from the program:

- influence coefficients of the girders are the closed form of a simply supported beam;
- an answer must satisfy balance of forces and moments, the laws, the positions and complementarity, each within 1e-9;
- under linear laws the forces must be those of Lemke's method in rational numbers;
- a refusal must be right: by Caratheodory's theorem the load is a sum of pushing forces exactly if it is one of at most as many
  as there are equations, and all such sets are tried in rational numbers.

Exit status: 0 all scenes are right, 1 some are not, 2 usage.
"""

import argparse
import csv
import json
import random
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from itertools import combinations
from pathlib import Path

SPAN = 10.0
E = 210e6
NEAR = 1e-9


def power(draw, low, high):
    return 10.0 ** draw.uniform(low, high)


def scene_of(seed):
    """A scene, its spec, and what its reference is computed from."""
    draw = random.Random(seed)
    rails = draw.choice([1, 1, 2, 2, 2, 3])
    base = power(draw, -5, -2)
    inertia = [base * power(draw, -3, 3) for _ in range(rails)]
    z = [0.0] if rails == 1 else [-4.0, 4.0] if rails == 2 else [-4.0, 0.0, 4.0]
    points, cells, section, supports, sections, lines = [], [], [], [], [], {}
    for r in range(rails):
        points += [[0, 0, z[r]], [SPAN, 0, z[r]]]
        cells.append([2 * r, 2 * r + 1])
        section.append(r)
        sections.append({"name": f"s{r}", "material": "steel", "A": 0.01, "Iy": inertia[r], "Iz": inertia[r], "J": 1e-5})
        supports += [{"point": 2 * r, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 2 * r + 1, "fix": ["uy", "uz", "rx"]}]
        lines[f"r{r}"] = {"origin": [0, 0, z[r]], "axis": [1, 0, 0], "segments": [{"cell": [0, r]}], "stations": [0, SPAN / 2, SPAN]}
    spec = {"format": "girderway-beam/1", "name": "rails", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
            "up": [0, 1, 0], "points": points, "cells": [{"type": "line", "data": cells}], "cell_data": {"section": [section]},
            "materials": [{"name": "steel", "E": E, "G": 81e6}], "sections": sections, "supports": supports, "rails": lines}
    x0 = draw.uniform(4, 6)
    dof = draw.choice([["y"], ["y", "pitch"], ["y", "pitch"], ["y", "roll"], ["y", "roll", "pitch"], ["y", "roll", "pitch"]])
    exponent = draw.choice([1, 1, 1, 1.5, 2.2])
    k = power(draw, 2, 9)
    kinds, trucks, wheels = {}, [], []
    for w in range(draw.randint(1, 12)):
        own = k if draw.random() < 0.6 else power(draw, 2, 9)
        r, x = draw.randrange(rails), round(draw.uniform(-3.5, 3.5), draw.choice([0, 1, 9]))
        kinds[f"k{w}"] = {"radius": 0.3, "vertical": {"k": own} if exponent == 1 else {"law": "impact", "k": own, "exponent": exponent}}
        trucks.append({"name": f"t{w}", "body": "b", "rail": f"s.r{r}", "at": [x, 0, z[r]], "tree": [0.0], "wheel": f"k{w}"})
        wheels.append((r, x, z[r], own))
    steps = []
    for r in range(rails):
        if draw.random() < 0.3:
            steps.append({"kind": "step", "rail": f"r{r}", "x": draw.uniform(2, 8), "height": draw.choice([-1, 1]) * power(draw, -4, -2)})
    reach = draw.choice([0.5, 1.0, 3.0])
    cg = [draw.uniform(-reach, reach), draw.uniform(0, 2), draw.uniform(-reach, reach) if "roll" in dof else 0.0]
    weight = power(draw, 0, 3)
    scene = {"format": "girderway-scene/1", "name": "n", "units": spec["units"], "gravity": 9.81, "analysis": "quasi-static",
             "structures": {"s": {"spec": "spec.json", "foundation": "influence", "irregularities": steps}},
             "bodies": {"b": {"weight": weight, "inertia": [1, 1, 1], "cg": cg, "dof": dof, "x0": x0}}, "wheels": kinds, "trucks": trucks,
             "motions": [{"body": "b", "dof": "x", "kind": "prescribed", "position": [[0, x0]]}], "end": {"time": 0.01},
             "output": {"dt": 0.01}, "accuracy": 1e-4}
    if draw.random() < 0.2:
        scene["bodies"]["b"]["dof"] = dof = [d for d in dof if d != "roll"] or ["y"]
    height = {s["rail"]: s for s in steps}
    rise = [height[f"r{r}"]["height"] if f"r{r}" in height and x0 + x > height[f"r{r}"]["x"] else 0.0 for r, x, _, _ in wheels]
    return {"scene": scene, "spec": spec, "wheels": wheels, "inertia": inertia, "x0": x0, "dof": dof, "cg": cg, "weight": weight,
            "rise": rise, "exponent": exponent}


def compliance(case):
    """Deflection at wheel i under a unit force at wheel j: simply supported Euler-Bernoulli beam."""
    def own(a, b, inertia):
        x, a = min(a, b), max(a, b)
        b = SPAN - a
        return b * x * (SPAN**2 - b**2 - x**2) / (6 * SPAN * E * inertia)
    places = [(r, case["x0"] + x) for r, x, _, _ in case["wheels"]]
    return [[own(xi, xj, case["inertia"][ri]) if ri == rj else 0.0 for rj, xj in places] for ri, xi in places]


def equations(case):
    """Rows of the balance over the wheels, and the load: forces, moments by pitch, moments by roll, as far as they are free."""
    wheels, weight, cg = case["wheels"], case["weight"], case["cg"]
    rows, load = [[1.0 for _ in wheels]], [weight]
    if "pitch" in case["dof"] and any(x for _, x, _, _ in wheels):
        rows.append([x for _, x, _, _ in wheels])
        load.append(weight * cg[0])
    # a motion that moves no wheel is not one of the equilibrium
    if "roll" in case["dof"] and any(z for _, _, z, _ in wheels):
        rows.append([z for _, _, z, _ in wheels])
        load.append(weight * cg[2])
    return rows, load


def eliminated(matrix, load):
    """The solution of equations in rational numbers, with 0 for what they leave free; None without one."""
    rows = [[*row, value] for row, value in zip(matrix, load)]
    columns, pivots = len(matrix[0]), []
    for j in range(columns):
        k = next((k for k in range(len(pivots), len(rows)) if rows[k][j] != 0), None)
        if k is None:
            continue
        rows[len(pivots)], rows[k] = rows[k], rows[len(pivots)]
        head = rows[len(pivots)]
        head[:] = [entry / head[j] for entry in head]
        for other in rows:
            if other is not head and other[j] != 0:
                factor = other[j]
                other[:] = [a - factor * b for a, b in zip(other, head)]
        pivots.append(j)
    if any(row[-1] != 0 for row in rows[len(pivots):]):
        return None
    out = [Fraction(0)] * columns
    for row, j in zip(rows, pivots):
        out[j] = row[-1]
    return out


def exists(case):
    """Whether pushing forces balance the load, in rational numbers."""
    rows, load = equations(case)
    rows, load = [[Fraction(v) for v in row] for row in rows], [Fraction(v) for v in load]
    for size in range(1, len(rows) + 1):
        for chosen in combinations(range(len(case["wheels"])), size):
            found = eliminated([[row[i] for i in chosen] for row in rows], load)
            if found is not None and all(value >= 0 for value in found):
                return True
    return False


def lemke(case):
    """Forces under linear laws by Lemke's method in rational numbers, lexicographic against ties.

    F >= 0, s = (A + 1/k) F - R q - c >= 0, F . s = 0, R^T F = w; the degrees of freedom q are differences of two unknowns >= 0, and
    the balance is two inequalities.
    """
    rows, load = equations(case)
    n, m = len(case["wheels"]), len(rows)
    a = compliance(case)
    size = n + 2 * m
    matrix = [[Fraction(0)] * size for _ in range(size)]
    for i in range(n):
        for j in range(n):
            matrix[i][j] = Fraction(a[i][j]) + (1 / Fraction(case["wheels"][i][3]) if i == j else 0)
        for k in range(m):
            r = Fraction(rows[k][i])
            matrix[i][n + k], matrix[i][n + m + k] = -r, r
            matrix[n + k][i], matrix[n + m + k][i] = r, -r
    right = [-Fraction(v) for v in case["rise"]] + [-Fraction(v) for v in load] + [Fraction(v) for v in load]
    # columns: w, z, z0, right side
    tableau = [[Fraction(int(i == j)) for j in range(size)] + [-v for v in matrix[i]] + [Fraction(-1), right[i]] for i in range(size)]
    basis = list(range(size))
    row = min(range(size), key=lambda i: (right[i], i))
    if right[row] >= 0:
        return [0.0] * n
    entering = 2 * size
    while True:
        leaving = basis[row]
        head = tableau[row]
        factor = head[entering]
        head[:] = [v / factor for v in head]
        for other in tableau:
            if other is not head and other[entering] != 0:
                own = other[entering]
                other[:] = [x - own * y for x, y in zip(other, head)]
        basis[row] = entering
        if leaving == 2 * size:
            out = [Fraction(0)] * n
            for i, variable in enumerate(basis):
                if size <= variable < size + n:
                    out[variable - size] = tableau[i][-1]
            return [float(v) for v in out]
        entering = leaving + size if leaving < size else leaving - size
        able = [i for i in range(size) if tableau[i][entering] > 0]
        if not able:
            return None
        def ratio(i):
            own = tableau[i][entering]
            return [tableau[i][-1] / own] + [tableau[i][j] / own for j in range(size)]
        out = [i for i in able if basis[i] == 2 * size]
        row = min(able, key=ratio)
        if out and tableau[out[0]][-1] / tableau[out[0]][entering] == tableau[row][-1] / tableau[row][entering]:
            row = out[0]


def wrong(case, row):
    """What is wrong with the first row of a history."""
    wheels = case["wheels"]
    force = [row[f"t{w}.wheel1.vertical"] for w in range(len(wheels))]
    depth = [row[f"t{w}.wheel1.penetration"] for w in range(len(wheels))]
    size = max(force)
    said = []
    rows, load = equations(case)
    for own, value in zip(rows, load):
        lever = max(abs(v) for v in own)
        if abs(sum(f * r for f, r in zip(force, own)) - value) > NEAR * case["weight"] * max(lever, 1e-9):
            said.append(f"balance {sum(f * r for f, r in zip(force, own))} of {value}")
    a = compliance(case)
    bent = [sum(g * f for g, f in zip(line, force)) for line in a]
    # the position of the body: positive down
    at = row["b.deflection"]
    for w, (_, x, z, k) in enumerate(wheels):
        moved = at - row.get("b.pitch", 0.0) * x + row.get("b.roll", 0.0) * z
        reached = case["rise"][w] + moved - bent[w]
        scale = max(abs(case["rise"][w]), abs(at), abs(moved), bent[w], abs(depth[w]))
        if abs(reached - depth[w]) > NEAR * scale:
            said.append(f"wheel {w}: position {reached}, penetration {depth[w]}")
        wanted = k * max(depth[w], 0.0) ** case["exponent"]
        # a force from a penetration that is small beside the deflection has its rounding
        noise = k * (abs(depth[w]) + 1e-15 * scale) ** case["exponent"] - k * abs(depth[w]) ** case["exponent"]
        if force[w] < 0 or abs(force[w] - wanted) > NEAR * size + noise:
            said.append(f"wheel {w}: force {force[w]}, by its law {wanted}")
    if case["exponent"] == 1:
        for w, exact in enumerate(lemke(case) or []):
            if abs(force[w] - exact) > NEAR * size:
                said.append(f"wheel {w}: force {force[w]}, by Lemke's method {exact}")
    return said


def run(program, seed):
    """The outcome of a scene: stands, falls, wrong; with text."""
    case = scene_of(seed)
    with tempfile.TemporaryDirectory(prefix="girderway-") as folder:
        for name in ("scene", "spec"):
            (Path(folder) / f"{name}.json").write_text(json.dumps(case[name]))
        begun = time.perf_counter()
        done = subprocess.run([program, "run", "scene.json", "-o", "out", "--quiet"], cwd=folder, capture_output=True, text=True)
        spent = time.perf_counter() - begun
        if done.returncode == 0:
            with open(Path(folder) / "out" / "history.csv", newline="") as file:
                first = next(csv.DictReader(file))
            said = wrong(case, {name: float(value) for name, value in first.items() if value})
            return ("wrong" if said else "stands", "; ".join(said), spent)
    if "no static equilibrium" not in done.stderr:
        return ("wrong", done.stderr.strip()[:300], spent)
    if exists(case):
        return ("wrong", "refused although it stands: " + done.stderr.strip()[:200], spent)
    if not any(word in done.stderr for word in ("tips", "sinks", "rises")):
        return ("wrong", "refused without a fall: " + done.stderr.strip()[:200], spent)
    return ("falls", "", spent)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--scenes", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    seeds = range(1_000_000 * options.seed, 1_000_000 * options.seed + options.scenes)
    counts, spent = {}, 0.0
    with ThreadPoolExecutor(options.jobs) as pool:
        for seed, (kind, text, own) in zip(seeds, pool.map(lambda seed: run(options.program.resolve(), seed), seeds)):
            counts[kind] = counts.get(kind, 0) + 1
            spent += own
            if text:
                print(f"{seed}: {text}", flush=True)
    print(f"{options.scenes} scenes: {counts}, {spent:.1f} s in the program")
    return 1 if counts.get("wrong") else 0


if __name__ == "__main__":
    sys.exit(main())
