#!/usr/bin/env python3
"""girderway beside the tools that do a part of its work, on the same cases in one sitting, on one chart.

    python3 -m venv VENV && VENV/bin/pip install -r fea/requirements-peers.txt
    VENV/bin/python fea/bench_peers.py -o DIR [--quick]

The girder: 61 unit loads on the paper's girder, -15 to 75 ft; error against the principle of virtual work integrated
exactly, by the largest coefficient.

    girderway      from numbers to the grid and its certificate (example `girder` of the crate fea)
    scikit-fem     Hermite elements, loads and readings inside them; mesh, assembly, Cholesky, 61 solutions
    PyNite         nodes at the stations; one analysis of 61 load cases, the model built
    OpenSees       nodes at the stations; the first analysis factors, the others follow, the model built

The crossings: those of bench_scenes.py, beside scipy, RK4 and Newmark by hand (numba) and Exudyn.

Times are milliseconds that the thread worked, the least, the median and the most of interleaved repetitions; girderway's are
repeated by itself, before the others. Writes peers.json and peers.svg.
"""

import os

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

import argparse
import pathlib
import subprocess
import time

import numpy as np

import bench_scenes as scenes

HERE = pathlib.Path(__file__).resolve().parent
SPAN, OVERHANG, EI = 60.0, 15.0, 4.32e9 * 9.528
STATIONS = np.linspace(-OVERHANG, SPAN + OVERHANG, 61)
GRID = "61 loads on the girder"


def moment(x, z):
    """Bending moment at x, sagging positive, of a unit load down at z; supports at 0 and SPAN."""
    share = np.clip(x / SPAN, 0.0, 1.0)
    if z < 0.0:
        return np.where(x < 0.0, -np.maximum(x - z, 0.0), z * (1.0 - share))
    if z > SPAN:
        return np.where(x > SPAN, -np.maximum(z - x, 0.0), (SPAN - z) * share)
    return SPAN * np.minimum(share * (1.0 - z / SPAN), (1.0 - share) * z / SPAN)


def reference():
    """G(x, z) = integral M_x M_z / EI, exact by two Gauss points between the places where a moment has a kink."""
    cuts = np.unique(np.concatenate([STATIONS, [0.0, SPAN]]))
    middle, half = 0.5 * (cuts[1:] + cuts[:-1]), 0.5 * np.diff(cuts)
    points = np.concatenate([middle - half / np.sqrt(3.0), middle + half / np.sqrt(3.0)])
    moments = np.array([moment(points, z) for z in STATIONS])
    return (moments * np.concatenate([half, half])) @ moments.T / EI


def by_scikit_fem(count):
    """`count` Hermite elements over the girder; the supports are nodes."""
    import skfem
    from scipy.linalg import solve

    from scikit_fem_girder import curvature, node, reading

    mesh = skfem.MeshLine(np.linspace(-OVERHANG, SPAN + OVERHANG, count + 1))
    basis = skfem.Basis(mesh, skfem.ElementLineHermite(), intorder=4)
    stiffness = (EI * curvature.assemble(basis)).toarray()
    held = [basis.nodal_dofs[0][node(mesh, x)] for x in (0.0, SPAN)]
    free = np.setdiff1d(np.arange(basis.N), held)
    value = reading(basis, STATIONS)[0][:, free]
    return value @ solve(stiffness[np.ix_(free, free)], value.T, assume_a="pos")


def by_pynite(_):
    from Pynite import FEModel3D

    model = FEModel3D()
    model.add_material("steel", 4.32e9, 1.66e9, 0.3, 0.0)
    model.add_section("girder", 1.0, 1.0, 9.528, 1.0)
    for k, x in enumerate(STATIONS):
        model.add_node(f"N{k}", float(x), 0.0, 0.0)
        if x in (0.0, SPAN):
            model.def_support(f"N{k}", x == 0.0, True, True, True, False, False)
        if k > 0:
            model.add_member(f"M{k}", f"N{k - 1}", f"N{k}", "steel", "girder")
        model.add_node_load(f"N{k}", "FY", 1.0, f"C{k}")
        model.add_load_combo(f"C{k}", {f"C{k}": 1.0})
    model.analyze_linear(check_stability=False, sparse=True)
    nodes = [model.nodes[f"N{k}"] for k in range(len(STATIONS))]
    return np.array([[at.DY[f"C{load}"] for load in range(len(STATIONS))] for at in nodes])


def by_opensees(_):
    from opensees_frame import load

    ops = load()
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Linear", 1)
    for k, x in enumerate(STATIONS):
        ops.node(k + 1, float(x), 0.0)
        if x in (0.0, SPAN):
            ops.fix(k + 1, int(x == 0.0), 1, 0)
        if k > 0:
            ops.element("elasticBeamColumn", k, k, k + 1, 1.0, 4.32e9, 9.528, 1)
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandSPD")
    ops.integrator("LoadControl", 1.0)
    ops.algorithm("Linear", "-factorOnce")
    count = len(STATIONS)
    for k in range(count):
        ops.timeSeries("Rectangular", k + 1, k + 0.5, k + 1.5)
        ops.pattern("Plain", k + 1, k + 1)
        ops.load(k + 1, 0.0, 1.0, 0.0)
    ops.analysis("Static")
    grid = np.zeros((count, count))
    for k in range(count):
        if ops.analyze(1) != 0:
            raise RuntimeError("OpenSees cannot solve the girder")
        grid[:, k] = [ops.nodeDisp(node + 1, 2) for node in range(count)]
    return grid


def error(grid, wanted):
    off = np.abs(grid - wanted).max() / np.abs(wanted).max()
    return float(off) if np.isfinite(off) else float("inf")


def grids(profile, quick):
    """Rows of all codes: case, code, setting, error, None for forces, least, median and most ms."""
    wanted = reference()
    command = ["cargo", "run", "-q", "--profile", profile, "-p", "girderway-fea", "--example", "girder"]
    text = subprocess.run(command, cwd=HERE.parent, check=True, capture_output=True, text=True).stdout
    times, *lines = ([float(value) for value in line.split(",")] for line in text.splitlines())
    yield GRID, "girderway", "4 states", error(np.array(lines), wanted), None, *times
    jobs = [("scikit-fem", by_scikit_fem, count) for count in (6, 12, 24, 48, 60, 120, 240)]
    jobs += [("PyNite", by_pynite, 60), ("OpenSees", by_opensees, 60)]
    found = {}
    for _ in range(3 if quick else 7):
        for code, job, setting in jobs:
            began = time.thread_time()
            grid = job(setting)
            passed = 1e3 * (time.thread_time() - began)
            found.setdefault((code, f"{setting} elements"), (error(grid, wanted), []))[1].append(passed)
    for (code, setting), (off, times) in found.items():
        yield GRID, code, setting, off, None, min(times), float(np.median(times)), max(times)


def chart(rows, path):
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    cases = list(dict.fromkeys(row[0] for row in rows))
    codes = list(dict.fromkeys(row[1] for row in rows))
    figure, axes = plt.subplots(2, 4, figsize=(15, 7.5))
    for axis, case in zip(axes.flat, cases):
        for code, marker in zip(codes, "oX^sDvP*"):
            at = codes.index(code)
            for error, face in ((3, f"C{at}"), (4, "none")):
                own = [row for row in rows if row[:2] == (case, code) and row[error] is not None and 0 < row[error] < 1]
                middle = [row[6] for row in own]
                spread = [[row[6] - row[5] for row in own], [row[7] - row[6] for row in own]]
                style = {"color": f"C{at}", "markerfacecolor": face, "markersize": 5, "elinewidth": 0.7}
                if own:
                    axis.errorbar(middle, [row[error] for row in own], xerr=spread, fmt=marker, **style)
        axis.set(xscale="log", yscale="log", title=case, xlabel="time, ms: median, least to most")
        axis.set_ylabel("error by the largest coefficient" if case == GRID else "error of deflection, hollow: forces")
        axis.grid(True, which="major", alpha=0.3)
    for axis in list(axes.flat)[len(cases) :]:
        axis.axis("off")
    handles = [
        plt.Line2D([], [], color=f"C{at}", marker=marker, linestyle="", label=code)
        for (at, code), marker in zip(enumerate(codes), "oX^sDvP*")
    ]
    list(axes.flat)[-1].legend(handles=handles, loc="center")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", type=pathlib.Path, required=True, help="folder for peers.json and peers.svg")
    parser.add_argument("--quick", action="store_true", help="fewer settings and repetitions")
    parser.add_argument("--scenes", nargs="*", default=list(scenes.GOALS), help="crossings to run")
    parser.add_argument("--profile", default="release", help="profile of cargo in which ours is built")
    options = parser.parse_args()
    cases = [scenes.case(name) for name in options.scenes]
    rows = list(grids(options.profile, options.quick))
    rows += list(scenes.ours(options.profile, cases)) + list(scenes.measure(cases, [], options.quick))
    print(f"{'case':24s}{'code':12s}{'setting':24s}   error  of force     least    median      most, ms")
    for case, code, setting, off, of_force, *times in sorted(rows, key=lambda row: (row[0], row[1], row[6])):
        forces = "       -" if of_force is None else f"{of_force:8.1e}"
        print(f"{case:24s}{code:12s}{setting:24s}{off:8.1e}  {forces}", *(f"{t:9.4f}" for t in times))
    scenes.write(rows, options.o / "peers.json")
    chart(rows, options.o / "peers.svg")


if __name__ == "__main__":
    main()
