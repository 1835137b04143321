#!/usr/bin/env python3
"""Overheads of the package: an empty call, a grid, a run; beside the command line, Exudyn and PyCBA where they are.

    python3 crates/python/bench.py [path of the command line]

Every time is the best of several, in one sitting. Lines of programs that are not installed are left out.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
BOGIE = ROOT / "examples" / "bogie"


def best(work, repetitions, inner=1):
    times = []
    for _ in range(repetitions):
        begin = time.perf_counter()
        for _ in range(inner):
            work()
        times.append((time.perf_counter() - begin) / inner)
    return min(times)


def say(what, seconds):
    unit, factor = next((u, f) for u, f in (("s", 1), ("ms", 1e3), ("us", 1e6), ("ns", 1e9)) if seconds * f >= 1 or u == "ns")
    print(f"| {what} | {seconds * factor:.3g} {unit} |", flush=True)


print("| what | time |\n|---|---|")
say("`import girderway` beside numpy, new process", best(lambda: subprocess.run([sys.executable, "-c", "import girderway"]), 5)
    - best(lambda: subprocess.run([sys.executable, "-c", "import numpy"]), 5))
import girderway as gw

girder = gw.Structure(BOGIE / "spec.json")
native = girder._native
say("empty call (a name of a structure)", best(lambda: native.name, 7, 10_000))
x = np.linspace(-15, 75, 61)
girder.influence(x, x)
say("grid, 61 x 61, of a solved structure", best(lambda: girder.influence(x, x), 20, 50))
say("spec to grid, 61 x 61", best(lambda: gw.Structure(BOGIE / "spec.json").influence(x, x), 20))
for name in ("scene.json", "fast.json"):
    say(f"run of the bogie, `{name}`, without comparisons", best(lambda: gw.run(BOGIE / name, comparisons=False), 10))
say("run of the bogie, six cases", best(lambda: gw.run(BOGIE / "scene.json"), 5))
patches = [{"bodies": {"bogie": {"weight": 4e6 + 1e3 * k}}} for k in range(40)]
say("one of 40 runs by `map`, one thread",
    best(lambda: gw.map(BOGIE / "fast.json", patches, threads=1, each=lambda run: None), 3) / 40)
say("one of 40 runs by `map`, all threads",
    best(lambda: gw.map(BOGIE / "fast.json", patches, each=lambda run: None), 3) / 40)
if len(sys.argv) > 1:
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.argv[1], "run", str(BOGIE / "scene.json"), "-o", f"{folder}/out", "--quiet"]
        say("command line: six cases, with files", best(lambda: subprocess.run(command, check=True), 5))
        command = [sys.argv[1], "fea", str(BOGIE / "spec.json"), "-o", f"{folder}/grid.json", "--quiet"]
        say("command line: grid at 7 stations, with its file", best(lambda: subprocess.run(command, check=True), 5))

try:
    import pycba as cba
except ImportError:
    print("(no PyCBA)", file=sys.stderr)
else:
    # moments of a runway of three spans under two wheels, at PyCBA's steps of 0.1 m
    spans, ei = [6.0, 7.5, 6.0], 210e6 * 5.768e-4
    model = cba.BeamAnalysis(spans, [ei] * 3, [-1, 0, -1, 0, -1, 0, -1, 0])
    bridge = cba.BridgeAnalysis(model, cba.Vehicle(axle_spacings=np.array([3.6]), axle_weights=np.array([180.0, 180.0])))
    envelope = bridge.run_vehicle(0.1)
    runway = gw.Structure({"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
                           "theory": "euler-bernoulli",
                           "girder": {"spans": spans, "E": 210e6, "I_vertical": 5.768e-4}})
    train = {"name": "crane", "wheels": [{"x": 0, "vertical": 180}, {"x": 3.6, "vertical": 180}], "enters": True}
    ours = max(e["value"] for e in runway.design([train]).extremes if e["quantity"] == "moment")
    print(f"(largest moment: PyCBA {float(np.max(envelope.Mmax)):.4f}, girderway {ours:.4f} kN m)", file=sys.stderr)
    say("PyCBA: envelope of a runway under two wheels, steps of 0.1 m", best(lambda: bridge.run_vehicle(0.1), 3))
    say("girderway: the same, exact, with deflections and reactions", best(lambda: runway.design([train]).extremes, 5))

try:
    import exudyn as exu
    from exudyn import utilities as eu
except ImportError:
    print("(no Exudyn)", file=sys.stderr)
else:
    # a mass on a spring, 10 s at 1 ms by the generalised-alpha method: the smallest call with an answer
    def oscillator():
        container = exu.SystemContainer()
        system = container.AddSystem()
        point = system.AddNode(eu.Point(referenceCoordinates=[0, 0, 0], initialCoordinates=[0.01, 0, 0]))
        system.AddObject(eu.MassPoint(mass=1.0, nodeNumber=point))
        ground = system.AddNode(eu.NodePointGround(referenceCoordinates=[0, 0, 0]))
        a = system.AddMarker(eu.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
        b = system.AddMarker(eu.MarkerNodeCoordinate(nodeNumber=point, coordinate=0))
        system.AddObject(eu.CoordinateSpringDamper(markerNumbers=[a, b], stiffness=100.0, damping=0.0))
        system.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 10_000, 10.0
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        system.SolveDynamic(settings)
        return system.GetNodeOutput(point, exu.OutputVariableType.Displacement)[0]

    say("Exudyn: a mass on a spring, 10,000 steps", best(oscillator, 3))

try:
    sys.path.insert(0, str(ROOT / "fea"))
    import bench_scenes as scenes
except ImportError as error:
    print(f"(no comparison with Exudyn for the same answer: {error})", file=sys.stderr)
else:
    # the bogie at 100 ft/s on the girder without mass, a damper to ground in each wheel: scene S2 of bench_scenes.py
    crossing = scenes.Crossing("S2")
    samples = {"output": {"dt": crossing.end / (len(crossing.times) - 1)}}
    for asked in (1e-3, 1e-4):
        steps = next(n for n in (100, 200, 500, 1000, 2000, 5000, 10000)
                     if crossing.error(scenes.by_exudyn(crossing, n)) <= asked)
        error = crossing.error(scenes.by_exudyn(crossing, steps))
        say(f"Exudyn: the fast bogie in {steps} steps, error {error:.1g}",
            best(lambda: scenes.by_exudyn(crossing, steps), 3))
        for accuracy in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
            changes = samples | {"accuracy": accuracy}
            error = crossing.error(gw.run(BOGIE / "fast.json", changes)["bogie.deflection"])
            if error <= asked:
                break
        say(f"girderway: the same, accuracy {accuracy:g}, error {error:.1g}",
            best(lambda: gw.run(BOGIE / "fast.json", changes), 20))
