"""Compares extremes of `girderway design` with PyCBA, which samples positions of the vehicle.

    python3 -m venv venv && venv/bin/pip install PyCBA==1.0.2
    venv/bin/python tests/design/peers.py target/release/girderway [girders] [seed]

Continuous girders of random spans under random vehicles, both ways round, without shear deformation, as PyCBA has them.
PyCBA evaluates the girder at positions of the vehicle that are STEP apart and at 101 sections a span: it may not find
more than the exact extreme, and finds less by the steps of its positions and sections. Prints both, and the time of each.
"""

import json
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pycba as cba

STEP = 0.05


def peer(spans, stiffness, axles, weights):
    """Largest and smallest moment and shear of PyCBA, in kN m and kN, and the seconds it took."""
    begin = time.perf_counter()
    found = []
    for turned in (False, True):
        bridge = cba.BridgeAnalysis()
        supports = [-1, 0] * (len(spans) + 1)
        bridge.add_bridge(list(spans), [stiffness] * len(spans), supports)
        order = slice(None, None, -1) if turned else slice(None)
        bridge.add_vehicle(np.array(axles)[order], np.array(weights)[order])
        found.append(bridge.run_vehicle(STEP))
    seconds = time.perf_counter() - begin
    return {
        "moment max": max(e.Mmax.max() for e in found),
        "moment min": min(e.Mmin.min() for e in found),
        "shear max": max(e.Vmax.max() for e in found),
        "shear min": min(e.Vmin.min() for e in found),
    }, seconds


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
    found = {}
    for extreme in summary["extremes"]:
        if extreme.get("quantity") in ("moment", "shear") and extreme.get("plane") == "vertical":
            key = f"{extreme['quantity']} {extreme['kind']}"
            pick = max if extreme["kind"] == "max" else min
            found[key] = pick(found.get(key, extreme["value"]), extreme["value"])
    return found, seconds


def main():
    program = str(Path(sys.argv[1]).resolve())
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    dice = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    worst_above, worst_below = 0.0, 0.0
    for girder in range(count):
        spans = [round(dice.uniform(6, 25), 2) for _ in range(dice.randint(1, 6))]
        axles = [round(dice.uniform(0.8, 6), 2) for _ in range(dice.randint(1, 5))]
        weights = [round(dice.uniform(30, 250), 1) for _ in range(len(axles) + 1)]
        stiffness = dice.uniform(5e4, 5e5)
        theirs, their_time = peer(spans, stiffness, axles, weights)
        with tempfile.TemporaryDirectory() as folder:
            own, own_time = ours(program, spans, stiffness, axles, weights, Path(folder))
        for key in sorted(own):
            # Signs of shear differ: the larger of both sizes is compared.
            a, b = abs(own[key]), abs(theirs[key])
            if key.startswith("shear"):
                a = max(abs(own["shear max"]), abs(own["shear min"]))
                b = max(abs(theirs["shear max"]), abs(theirs["shear min"]))
            largest = max(abs(value) for name, value in own.items() if name[:5] == key[:5])
            worst_above = max(worst_above, (b - a) / largest)
            worst_below = max(worst_below, (a - b) / largest)
            print(f"{girder} spans {len(spans)} wheels {len(weights)} {key}: {own[key]:.4f}, PyCBA {theirs[key]:.4f}, "
                  f"{(a - b) / largest:+.2e}")
        print(f"{girder} time {own_time:.3f} s, PyCBA {their_time:.3f} s")
    print(f"PyCBA at most {worst_above:.1e} above and {worst_below:.1e} below the exact extremes")
    if worst_above > 1e-9:
        sys.exit(1)


main()
