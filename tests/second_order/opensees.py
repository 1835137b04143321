"""Compares what a run says of second order with OpenSees.

    apt-get install libblas3 liblapack3 libgfortran5 libgomp1
    python3 -m venv venv && venv/bin/pip install openseespy
    venv/bin/python tests/second_order/opensees.py target/release/girderway [--parts 8] [--places 24]

A wheel rolls slowly over cable-stayed decks with and without preload, pre-compressed girders, arches and flexible girders, each
under three loads. The note or warning of the run says by how much finite displacements would change deflections, forces and
moments, relative to the largest values of the run. OpenSees has the same frame with co-rotational `dispBeamColumn` and `corotTruss`
elements: standing loads first, then the wheel at many places. The true change is the largest difference at a node, or at the end
of a member, of the increment under the wheel from the linear answer, which is that of OpenSees without preload and that of the
tables of girderway about one; it is divided by the largest linear value.

Prints a line for each run: the change by OpenSees, by girderway, their ratio. The exit status is 1 if a ratio is outside 0.5 to 2
where the true change is above 0.01, if nothing is said there, or if girderway cannot tell in more than a tenth of the runs.
"""

import argparse
import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import openseespy.opensees as ops

DOFS = ["ux", "uy", "uz", "rx", "ry", "rz"]
PLANE = ["uz", "rx", "ry"]
STEEL = {"name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.85}
WEIGHTLESS = {"name": "weightless", "E": 2.1e8, "G": 8.1e7}
STRAND = {"name": "strand", "E": 1.65e8, "G": 6e7}
GRAVITY = 9.81


def spec(points, members, sections, supports, rail, preload=None):
    """A frame in the x-y plane; `members` are (first point, second point, section, kind)."""
    beams = [m for m in members if m[3] == "beam"]
    others = [m for m in members if m[3] != "beam"]
    groups = [group for group in (beams, others) if group]
    across = {tuple(m[:2]): i for i, m in enumerate(beams)}
    held = {}
    for point, fixed in supports:
        held.setdefault(point, set()).update(fixed)
    for point in range(len(points)):
        held.setdefault(point, set()).update(PLANE)
    out = {
        "format": "girderway-beam/1",
        "units": {"length": "m", "force": "kN", "time": "s"},
        "theory": "euler-bernoulli",
        "points": points,
        "cells": [{"type": "line", "data": [list(m[:2]) for m in group]} for group in groups],
        "cell_data": {
            "kind": [[m[3] for m in group] for group in groups],
            "section": [[m[2] for m in group] for group in groups],
            "orientation": [
                [[1, 0, 0] if points[m[0]][0] == points[m[1]][0] else [0, 1, 0] for m in group]
                for group in groups
            ],
        },
        "materials": [STEEL, WEIGHTLESS, STRAND],
        "sections": sections,
        "supports": [
            {"point": point, "fix": [dof for dof in DOFS if dof in fixed]}
            for point, fixed in sorted(held.items())
        ],
        "rails": {
            "rail": {
                "axis": [1, 0, 0],
                "segments": [{"cell": [0, across[pair]]} for pair in rail],
                "stations": [points[rail[0][0]][0], points[rail[-1][1]][0]],
            }
        },
    }
    if preload is not None:
        out["preload"] = preload
    return out


def section(name, material, area, second=None):
    own = {"name": name, "material": material, "A": area}
    if second is not None:
        own |= {"Iz": second, "Iy": second, "J": second}
    return own


def cable_stayed(height, preload):
    """A deck of 80 m on a pylon in its middle and four stays, with its own weight."""
    xs = [0, 15, 28, 40, 52, 65, 80]
    points = [[x, 0, 0] for x in xs] + [[40, -10, 0], [40, height, 0]]
    members = [(k, k + 1, "deck", "beam") for k in range(6)] + [(7, 8, "pylon", "beam")]
    members += [(k, 8, "stay", "truss") for k in (1, 2, 4, 5)]
    sections = [section("deck", "steel", 0.08, 8e-4), section("pylon", "weightless", 0.2, 0.05)]
    sections.append(section("stay", "strand", 0.002))
    supports = [(0, {"ux", "uy"}), (6, {"uy"}), (7, {"ux", "uy", "rz"})]
    rail = [(k, k + 1) for k in range(6)]
    weight = {"weight": True, "gravity": GRAVITY} if preload else None
    return spec(points, members, sections, supports, rail, weight)


def compressed(share, parts):
    """A girder of 24 m on two or three supports under a part of its Euler load."""
    step = 24 / parts
    second = 3e-4
    force = share * math.pi**2 * 2.1e8 * second / step**2
    points = [[k * step, 0, 0] for k in range(parts + 1)]
    members = [(k, k + 1, "girder", "beam") for k in range(parts)]
    supports = [(0, {"ux", "uy"})] + [(k, {"uy"}) for k in range(1, parts + 1)]
    preload = {"weight": False, "loads": [{"point": parts, "force": [-force, 0, 0]}]}
    return spec(points, members, [section("girder", "weightless", 0.02, second)], supports, [m[:2] for m in members], preload)


def arch(rise, is_fixed):
    """A parabolic arch of 30 m in twelve straight members, hinged or fixed; the rail lies on it."""
    count = 12
    xs = [30 * k / count for k in range(count + 1)]
    points = [[x, 4 * rise * 30 * (x / 30) * (1 - x / 30), 0] for x in xs]
    members = [(k, k + 1, "arch", "beam") for k in range(count)]
    foot = {"ux", "uy"} | ({"rz"} if is_fixed else set())
    sections = [section("arch", "weightless", 0.02, 2e-4)]
    return spec(points, members, sections, [(0, foot), (count, foot)], [m[:2] for m in members])


def flexible(kind):
    """A slender girder of 20 m: on a hinge and a roller, between hinges, or clamped at one end."""
    points = [[0, 0, 0], [10, 0, 0], [20, 0, 0]]
    members = [(0, 1, "girder", "beam"), (1, 2, "girder", "beam")]
    supports = {
        "roller": [(0, {"ux", "uy"}), (2, {"uy"})],
        "hinges": [(0, {"ux", "uy"}), (2, {"ux", "uy"})],
        "cantilever": [(0, {"ux", "uy", "rz"})],
    }[kind]
    sections = [section("girder", "weightless", 0.02, 1e-4)]
    return spec(points, members, sections, supports, [m[:2] for m in members])


def structures():
    for height in (8, 15, 25):
        for preload in (True, False):
            yield f"stays {height} m, {'about' if preload else 'without'} preload", cable_stayed(height, preload), (100, 300, 600)
    for share, parts in ((0.1, 1), (0.3, 2), (0.5, 1)):
        yield f"compressed {share}, {parts} spans", compressed(share, parts), (20, 60, 180)
    for rise, is_fixed, loads in ((0.05, True, (50, 200, 600)), (0.1, False, (50, 150, 300)), (0.2, True, (100, 300, 900))):
        yield f"arch {rise}, {'fixed' if is_fixed else 'hinged'}", arch(rise, is_fixed), loads
    for kind, loads in (("roller", (10, 50, 200)), ("hinges", (2, 10, 50)), ("cantilever", (0.5, 2, 8))):
        yield f"flexible, {kind}", flexible(kind), loads


class Frame:
    """A spec in OpenSees, its beams cut in parts and at the place of the wheel."""

    def __init__(self, given, parts, x):
        self.given, self.points = given, [list(point) for point in given["points"]]
        self.pieces, self.wheel = [], None
        axis = {tuple(segment["cell"]) for segment in given["rails"]["rail"]["segments"]}
        for group, block in enumerate(given["cells"]):
            for cell, (a, b) in enumerate(block["data"]):
                data = given["cell_data"]
                kind, name = data["kind"][group][cell], data["section"][group][cell]
                orientation = data["orientation"][group][cell]
                cuts = {0.0, 1.0}
                if kind == "beam":
                    cuts |= {k / parts for k in range(1, parts)}
                at = None
                ends = [self.points[a][0], self.points[b][0]]
                if (group, cell) in axis and ends[0] <= x <= ends[1]:
                    at = (x - ends[0]) / (ends[1] - ends[0])
                    at = min(cuts, key=lambda cut: abs(cut - at)) if min(abs(cut - at) for cut in cuts) < 1e-3 else at
                    cuts.add(at)
                last, node = a, {0.0: a}
                for cut in sorted(cuts)[1:]:
                    if cut == 1.0:
                        node[cut] = b
                    else:
                        node[cut] = len(self.points)
                        p, q = given["points"][a], given["points"][b]
                        self.points.append([p[k] + cut * (q[k] - p[k]) for k in range(3)])
                    self.pieces.append((last, node[cut], kind, name, orientation))
                    last = node[cut]
                if at is not None:
                    self.wheel = node[at]

    def build(self, is_finite):
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6)
        for k, point in enumerate(self.points, 1):
            ops.node(k, *map(float, point))
        held = {support["point"]: set(support["fix"]) for support in self.given["supports"]}
        for k in range(len(self.points)):
            fixed = held.get(k, set(PLANE))
            ops.fix(k + 1, *(int(dof in fixed) for dof in DOFS))
        materials = {own["name"]: own for own in self.given["materials"]}
        tags = {}
        for tag, own in enumerate(self.given["sections"], 1):
            tags[own["name"]] = tag
            material = materials[own["material"]]
            ops.uniaxialMaterial("Elastic", tag, material["E"])
            if "Iz" in own:
                ops.section("Elastic", tag, material["E"], own["A"], own["Iz"], own["Iy"], material["G"], own["J"])
                ops.beamIntegration("Lobatto", tag, tag, 4)
        sections = {own["name"]: own for own in self.given["sections"]}
        for tag, (a, b, kind, name, orientation) in enumerate(self.pieces, 1):
            if kind == "truss":
                ops.element("corotTruss" if is_finite else "Truss", tag, a + 1, b + 1, sections[name]["A"], tags[name])
                continue
            along = [self.points[b][k] - self.points[a][k] for k in range(3)]
            across = [along[(k + 1) % 3] * orientation[(k + 2) % 3] - along[(k + 2) % 3] * orientation[(k + 1) % 3] for k in range(3)]
            ops.geomTransf("Corotational" if is_finite else "Linear", tag, *across)
            ops.element("dispBeamColumn", tag, a + 1, b + 1, tag, tags[name])
        ops.constraints("Plain")
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.test("NormDispIncr", 1e-10, 40, 0)
        ops.algorithm("Newton")

    def standing(self):
        """Forces of the weight of what has mass, and of the preload, by node."""
        materials = {own["name"]: own for own in self.given["materials"]}
        sections = {own["name"]: own for own in self.given["sections"]}
        preload = self.given.get("preload")
        forces = {}

        def add(node, force):
            forces[node] = [a + b for a, b in zip(forces.get(node, [0.0] * 3), force)]

        if preload is None or preload["weight"]:
            for a, b, _, name, _ in self.pieces:
                mass = materials[sections[name]["material"]].get("density", 0.0) * sections[name]["A"]
                half = 0.5 * mass * GRAVITY * math.dist(self.points[a], self.points[b])
                add(a, [0, -half, 0])
                add(b, [0, -half, 0])
        for load in (preload or {}).get("loads", []):
            add(load["point"], load["force"])
        return forces

    def load(self, tag, forces, is_finite):
        ops.timeSeries("Linear", tag)
        ops.pattern("Plain", tag, tag)
        for node, force in forces.items():
            ops.load(node + 1, *map(float, force), 0.0, 0.0, 0.0)
        steps = 20 if is_finite else 1
        ops.integrator("LoadControl", 1 / steps)
        ops.analysis("Static")
        if ops.analyze(steps):
            return None
        ops.loadConst("-time", 0.0)
        return self.state()

    def state(self):
        """Displacements of nodes, forces and moments at the ends of the pieces in their own axes."""
        moved = [ops.nodeDisp(k + 1)[:2] for k in range(len(self.points))]
        forces, moments = [], []
        for tag, (a, b, kind, *_) in enumerate(self.pieces, 1):
            if kind == "truss":
                forces += [ops.eleResponse(tag, "axialForce")[0], 0.0]
                continue
            own = ops.eleResponse(tag, "basicForce")
            length = math.dist(self.points[a], self.points[b])
            forces += [own[0], (own[1] + own[2]) / length]
            moments += [own[1], own[2]]
        return moved, forces, moments


def difference(a, b):
    return [x - y for x, y in zip(a, b)]


def truth(given, force, places, parts):
    """Relative changes of deflections, forces and moments; None where OpenSees finds no equilibrium."""
    is_arch = any(point[1] != given["points"][0][1] for point in given["points"])
    first, last = given["rails"]["rail"]["stations"]
    on_rail = lambda frame, k: any(k in piece[:2] and piece[2] == "beam" for piece in frame.pieces)
    largest, change = [0.0] * 3, [0.0] * 3
    for place in range(places + 1):
        x = first + (last - first) * place / places
        frame = Frame(given, parts, x)
        live = {frame.wheel: [0, -force, 0]}
        frame.build(False)
        if "preload" in given:
            # linear about the state: the tangent there
            frame.build(True)
            before = frame.load(1, frame.standing(), True)
            if before is None:
                return None
            small = 1e-4
            after = frame.load(2, {frame.wheel: [0, -small * force, 0]}, True)
            if after is None:
                return None
            scale = 1 / small
            linear = [
                [[scale * v for v in difference(p, q)] for p, q in zip(after[0], before[0])],
                [scale * v for v in difference(after[1], before[1])],
                [scale * v for v in difference(after[2], before[2])],
            ]
        else:
            linear = frame.load(1, live, False)
        frame.build(True)
        standing = frame.load(1, frame.standing(), True)
        loaded = standing and frame.load(2, live, True)
        if loaded is None:
            return None
        for k, (moved, before, after) in enumerate(zip(linear[0], standing[0], loaded[0])):
            own = difference(after, before)
            for c in range(2):
                if c == 0 and on_rail(frame, k):
                    continue
                largest[0] = max(largest[0], abs(moved[c]))
                change[0] = max(change[0], abs(own[c] - moved[c]))
        for q in (1, 2):
            for own, before, after in zip(linear[q], standing[q], loaded[q]):
                largest[q] = max(largest[q], abs(own))
                change[q] = max(change[q], abs(after - before - own))
    return [c / m if m else 0.0 for c, m in zip(change, largest)]


def said(program, folder, given, force):
    """The three numbers of the note, "unknown" where it cannot tell, or None where nothing is said."""
    first, last = given["rails"]["rail"]["stations"]
    scene = {
        "format": "girderway-scene/1",
        "units": {"length": "m", "force": "kN", "time": "s"},
        "gravity": GRAVITY,
        "analysis": "quasi-static",
        "structures": {"s": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"body": {"weight": force, "dof": ["y"], "x0": first}},
        "wheels": {"wheel": {"radius": 0.5, "vertical": {"k": 1e8}}},
        "trucks": [{"name": "t", "body": "body", "rail": "s.rail", "wheel": "wheel"}],
        "motions": [{"body": "body", "dof": "x", "kind": "prescribed", "speed": [[0, 1.0]]}],
        "end": {"time": last - first},
        "output": {"dt": 1.0},
    }
    (folder / "spec.json").write_text(json.dumps(given))
    (folder / "scene.json").write_text(json.dumps(scene))
    run = subprocess.run([program, "run", "scene.json", "-o", "out", "--force"], cwd=folder, capture_output=True, text=True)
    text = run.stdout + run.stderr
    if run.returncode not in (0, 1):
        return f"refused: {text.strip().splitlines()[0]}"
    found = re.search(r"deflections by about (\S+), forces by (\S+) and moments by (\S+) of the largest", text)
    if found:
        return [float(value) for value in found.groups()]
    return "unknown" if "are not known" in text else None


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("--parts", type=int, default=8)
    arguments.add_argument("--places", type=int, default=24)
    given = arguments.parse_args()
    program = str(Path(given.program).resolve())
    wrong, unknown, count = 0, 0, 0
    names = ["deflections", "forces", "moments"]
    print(f"{'structure':34} {'kN':>5}  " + "   ".join(f"{name:>26}" for name in names))
    for name, structure, loads in structures():
        for force in loads:
            count += 1
            with tempfile.TemporaryDirectory() as folder:
                told = said(program, Path(folder), structure, force)
            true = truth(structure, force, given.places, given.parts)
            cells, is_wrong = [], isinstance(told, str) and told != "unknown"
            unknown += told == "unknown"
            for k in range(3):
                own = told[k] if isinstance(told, list) else told
                exact = None if true is None else true[k]
                if exact is None:
                    is_wrong |= isinstance(told, list)
                    cells.append(f"none {own}")
                    continue
                if isinstance(own, float):
                    ratio = own / exact if exact else math.inf
                    is_wrong |= exact > 0.01 and not 0.5 <= ratio <= 2
                    is_wrong |= exact <= 0.01 and own > 0.02
                    cells.append(f"{exact:.2e} {own:.1e} {ratio:5.2f}")
                else:
                    is_wrong |= own is None and exact > 0.01
                    is_wrong |= own == "unknown" and max(true) < 0.01
                    cells.append(f"{exact:.2e} {own}")
            wrong += is_wrong
            print(f"{name:34} {force:5}  " + "   ".join(f"{cell:>26}" for cell in cells) + ("  WRONG" if is_wrong else ""), flush=True)
    print(f"{count} runs: {wrong} wrong, {unknown} that cannot tell")
    return int(wrong > 0 or 10 * unknown > count)


if __name__ == "__main__":
    sys.exit(main())
