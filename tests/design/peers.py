"""Compares extremes of `girderway design` with two programs that sample positions of the vehicle.

    python3 -m venv venv && venv/bin/pip install PyCBA==1.0.2 ospgrillage==0.6.0
    venv/bin/python tests/design/peers.py target/release/girderway [girders] [seed] [--osp-step M]

Continuous girders of random spans under random vehicles, both ways round, without shear deformation.

PyCBA evaluates the girder at positions of the vehicle that are CBA_STEP apart and at 101 sections a span. Its model of
the girder is exact, so that it may not find more than the exact extreme; it finds less by its steps. Signs of shear
differ: the larger of both sizes is compared.

ospgrillage (OpenSees) has grillages. The girder is one of two equal beams, joined by cross members without torsional
stiffness, under a vehicle half-way between both: each carries half of it. It replaces a wheel between two lines of
nodes by forces at these lines, which is another load: its moments may be too large or too small by a few parts of wheel
load times spacing of the lines, and its shear beside a support lacks what stands within the first spacing. Lines and
positions of the vehicle are the same distance apart, --osp-step, by default 0.5 m, adjusted to the spans. Its own model
of continuous spans does not join the beams over inner supports (version 0.6.0), so the supports are set in OpenSees.
On Debian, OpenSees needs `apt-get install libblas3 liblapack3 libgfortran5 libgomp1`.

A program that is not installed is left out, and the output says so. Prints every figure and the time of each program;
the exit status is 1 if PyCBA exceeds an exact extreme by more than 1e-9 of the largest of its kind.
"""

import argparse
import contextlib
import importlib
import json
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

CBA_STEP = 0.05
KINDS = ["moment max", "moment min", "shear"]


def load(name):
    """A module, or None with a sentence on standard output that says why it is absent."""
    try:
        return importlib.import_module(name)
    except (ImportError, RuntimeError) as error:
        print(f"{name} is left out: {error}")
        return None


def by_pycba(cba, spans, stiffness, axles, weights, _step):
    """Largest and smallest moment and largest shear of PyCBA, in kN m and kN."""
    found = []
    for turned in (False, True):
        bridge = cba.BridgeAnalysis()
        supports = [-1, 0] * (len(spans) + 1)
        bridge.add_bridge(list(spans), [stiffness] * len(spans), supports)
        order = slice(None, None, -1) if turned else slice(None)
        bridge.add_vehicle(np.array(axles)[order], np.array(weights)[order])
        found.append(bridge.run_vehicle(CBA_STEP))
    return {
        "moment max": max(e.Mmax.max() for e in found),
        "moment min": min(e.Mmin.min() for e in found),
        "shear": max(max(abs(e.Vmax).max(), abs(e.Vmin).max()) for e in found),
    }


def grillage(og, ops, spans, stiffness, step):
    """Two beams 2 m apart, each with half of the stiffness, and their supports."""
    e = 2.1e8
    steel = og.create_material(material="steel", E=e, G=8e7, v=0.3, rho=1e-9)
    beam = og.create_section(A=0.1, J=1e-12, Iz=0.5 * stiffness / e, Iy=1e-3, Az=1, Ay=1)
    cross = og.create_section(A=0.1, J=1e-12, Iz=1e-3, Iy=1e-3, Az=1, Ay=1)
    counts = [max(2, round(span / step)) for span in spans]
    lines = np.concatenate([np.full(n, span / n) for span, n in zip(spans, counts)])
    # Added up as ospgrillage does it: a line beyond the length by rounding has no span.
    length = sum(float(x) for x in lines)
    model = og.create_grillage(
        bridge_name="girder", long_dim=length, width=2.0, skew=0, num_long_grid=2, num_trans_grid=2,
        edge_beam_dist=1.0, mesh_type="Oblique", beam_x_spacing=list(lines))
    model.set_member(og.create_member(section=beam, material=steel), member="edge_beam")
    for member in ("start_edge", "end_edge", "transverse_slab"):
        model.set_member(og.create_member(section=cross, material=steel), member=member)
    model.create_osp_model(pyfile=False)
    for x in np.concatenate([[0.0], np.cumsum(spans)]):
        for tag, node in model.Mesh_obj.node_spec.items():
            if abs(node["coordinate"][0] - x) < 1e-6:
                ops.fix(tag, int(x == 0.0), 1, 1, 0, 0, 0)
    return model


def by_ospgrillage(og, spans, stiffness, axles, weights, step):
    """The same of ospgrillage; forces at the ends of elements, sums of both beams."""
    ops = importlib.import_module("openseespy.opensees")
    model = grillage(og, ops, spans, stiffness, step)
    places = np.concatenate([[0.0], np.cumsum(axles)])
    total = float(sum(spans))
    for name, at in (("forward", places), ("turned", places[-1] - places)):
        vehicle = og.create_compound_load(name="vehicle")
        for x, weight in zip(at, weights):
            point = og.create_load_vertex(x=float(x), y=0, z=0, p=-float(weight))
            vehicle.add_load(og.create_load(loadtype="point", name="wheel", point1=point))
        path = og.create_moving_path(
            start_point=og.create_point(x=-places[-1], y=0, z=1.0), end_point=og.create_point(x=total, y=0, z=1.0),
            increments=int(np.ceil((total + places[-1]) / step)) + 1)
        moving = og.create_moving_load(name=name)
        moving.set_path(path)
        moving.add_load(vehicle)
        model.add_load_case(moving)
    model.analyze()
    forces = model.get_results().forces
    along = []
    for tag in ops.getEleTags():
        first, last = (ops.nodeCoord(node) for node in ops.eleNodes(tag))
        if abs(first[2] - last[2]) < 1e-9:
            along.append((round(first[0], 6), first[2], tag))
    tags = [tag for _, _, tag in sorted(along)]

    def both(component):
        values = forces.sel(Element=tags, Component=component).values.astype(float)
        return values.reshape(len(values), -1, 2).sum(axis=2)

    # OpenSees gives forces on the ends: a sagging moment is positive at the end j and negative at the end i.
    moments = np.concatenate([-both("Mz_i"), both("Mz_j")])
    return {
        "moment max": float(moments.max()),
        "moment min": float(moments.min()),
        "shear": float(max(abs(both("Vy_i")).max(), abs(both("Vy_j")).max())),
    }


def ours(program, spans, stiffness, axles, weights, folder):
    """The same of `girderway design`; vehicles enter and leave the girder."""
    e = 2.1e8
    units = {"length": "m", "force": "kN", "time": "s"}
    spec = {"format": "girderway-beam/1", "units": units, "theory": "euler-bernoulli",
            "girder": {"spans": list(spans), "E": e, "I_vertical": stiffness / e}, "stations": [0.0, sum(spans)]}
    x = np.concatenate([[0.0], np.cumsum(axles)])
    wheels = [{"x": float(a), "vertical": float(w)} for a, w in zip(x, weights)]
    design = {"format": "girderway-design/1", "name": "peer", "units": units, "spec": "spec.json",
              "trains": [{"name": "vehicle", "wheels": wheels, "enters": True}]}
    (folder / "spec.json").write_text(json.dumps(spec))
    (folder / "design.json").write_text(json.dumps(design))
    begin = time.perf_counter()
    subprocess.run([program, "design", "design.json", "-o", "out", "--force"], cwd=folder, check=True,
                   capture_output=True)
    seconds = time.perf_counter() - begin
    summary = json.loads((folder / "out/summary.json").read_text())
    own = [e for e in summary["extremes"] if e.get("plane") == "vertical" and "span" in e]
    values = {name: [e["value"] for e in own if e["quantity"] == name] for name in ("moment", "shear")}
    return {
        "moment max": max(values["moment"]),
        "moment min": min(0.0, min(values["moment"])),
        "shear": max(abs(value) for value in values["shear"]),
    }, seconds


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("girders", nargs="?", type=int, default=10)
    parser.add_argument("seed", nargs="?", type=int, default=1)
    parser.add_argument("--osp-step", type=float, default=0.5)
    args = parser.parse_args()
    program = str(Path(args.program).resolve())
    peers = [(name, load(module), run) for name, module, run in
             (("PyCBA", "pycba", by_pycba), ("ospgrillage", "ospgrillage", by_ospgrillage))]
    peers = [(name, module, run) for name, module, run in peers if module]
    dice = random.Random(args.seed)
    gaps = {name: [] for name, _, _ in peers}
    seconds = {name: 0.0 for name in ["girderway", *gaps]}
    for girder in range(args.girders):
        spans = [round(dice.uniform(6, 25), 2) for _ in range(dice.randint(1, 6))]
        axles = [round(dice.uniform(0.8, 6), 2) for _ in range(dice.randint(1, 5))]
        weights = [round(dice.uniform(30, 250), 1) for _ in range(len(axles) + 1)]
        stiffness = dice.uniform(5e4, 5e5)
        with tempfile.TemporaryDirectory() as folder:
            own, taken = ours(program, spans, stiffness, axles, weights, Path(folder))
        print(f"girder {girder}: {len(spans)} spans, {sum(spans):.2f} m, {len(weights)} wheels")
        print(f"  girderway    {taken:8.3f} s  " + "  ".join(f"{kind} {own[kind]:.4f}" for kind in KINDS))
        seconds["girderway"] += taken
        sizes = {"moment max": max(own["moment max"], -own["moment min"]), "shear": own["shear"]}
        sizes["moment min"] = sizes["moment max"]
        for name, module, run in peers:
            begin = time.perf_counter()
            # ospgrillage writes its library of materials into the working folder
            with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
                found = run(module, spans, stiffness, axles, weights, args.osp_step)
            taken = time.perf_counter() - begin
            seconds[name] += taken
            signs = {"moment max": 1, "moment min": -1, "shear": 1}
            gap = {kind: signs[kind] * (found[kind] - own[kind]) / sizes[kind] for kind in KINDS}
            gaps[name].append(gap)
            print(f"  {name:<12} {taken:8.3f} s  "
                  + "  ".join(f"{kind} {found[kind]:.4f} ({gap[kind]:+.1e})" for kind in KINDS), flush=True)
    for name in gaps:
        spread = "; ".join(f"{kind} {min(g[kind] for g in gaps[name]):+.1e} to {max(g[kind] for g in gaps[name]):+.1e}"
                           for kind in KINDS)
        print(f"{name} beside the exact extremes, of the largest of a girder: {spread}")
    print("total time: " + ", ".join(f"{name} {taken:.2f} s" for name, taken in seconds.items()))
    if "PyCBA" in gaps and max(max(gap.values()) for gap in gaps["PyCBA"]) > 1e-9:
        sys.exit(1)


if __name__ == "__main__":
    main()
