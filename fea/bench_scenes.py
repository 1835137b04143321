#!/usr/bin/env python3
"""Crossings of the paper's girder: girderway beside scipy, compiled code by hand and Exudyn, in one run.

    python3 -m venv VENV && VENV/bin/pip install -r fea/requirements-scenes.txt
    VENV/bin/python fea/bench_scenes.py [-o DIR] [--quick] [--skip NAME ...]

Scenes S1 (5 ft/s over 60 ft) and S2 (100 ft/s to 55 ft), girder without mass, exact influence function, dampers on
the wheels' own velocity: those of bogie_reference.py, which also makes the reference (DOP853 and Radau at 1e-12).
S3 is a carriage with eight wheels at 10 ft/s over the same girder; "S1 beam", "S2 beam" and "S4 beam" (Yang and Yau's
bridge) have the mass of the girder: scene_peers.py. Their references are its own, in fine steps: DOP853 at 1e-11 for S3,
Newmark on 48 cells a span for the others.

Every code runs over a range of steps or tolerances. Two errors are measured over 101 samples: that of the deflection, by its
peak, and that of the vertical forces of all wheels, by the largest force (of girderway and numba alone). Times are
milliseconds that the thread worked, the least, the median and the most of interleaved repetitions, without compilation:

    girderway   the public `run` with history, audit and events (example `crossings` of the crate sim)
    numba       RK4 with fixed steps in force form, two wheels solved by Cramer's rule
    scipy       solve_ivp with RK45, DOP853, LSODA, Radau
    Exudyn      GenericODE2, stiffness and damping set before each step, implicit trapezoidal rule

Prints all of them, and by each error the cheapest setting of every code that reaches 1e-3, 1e-4, 1e-5 and 1e-6; -o writes
scenes.json, with a chart scenes.svg.
"""

import os

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

import argparse
import json
import pathlib
import subprocess
import time

import numba
import numpy as np
from scipy.integrate import solve_ivp

import bogie_reference as bogie
import scene_peers as peers

HERE = pathlib.Path(__file__).resolve().parent
SAMPLES = bogie.SAMPLES
# Errors at which codes are compared.
ERRORS = (1e-3, 1e-4, 1e-5, 1e-6)
# Scenes; ratio of the time of code by hand, and of Exudyn, to ours that is aimed at.
GOALS = {
    "S1": {"numba": 15, "Exudyn": 1000},
    "S2": {"numba": 15, "Exudyn": 1000},
    "S3": {"numba": 5, "Exudyn": 20},
    "S1 beam": {},
    "S2 beam": {},
    "S4 beam": {"numba": 5, "Exudyn": 150},
}


class Crossing:
    """A scene and its reference."""

    def __init__(self, name):
        setting = bogie.SCENES[name.lower()]
        self.name, self.speed, self.travel = name, setting["speed"], setting["travel"]
        self.end = self.travel / self.speed
        self.start = bogie.at_rest(0.0)
        self.times = np.linspace(0.0, self.end, SAMPLES)
        data = json.loads((HERE / "reference" / f"bogie_{name.lower()}.json").read_text())
        self.z = np.array(data["z"])
        self.forces = np.array([data["F1"], data["F2"]]).T

    def errors(self, z, forces=None):
        """Errors of the deflection and of wheel forces, one row for each sample; the second None without forces."""

        def error(found, wanted):
            found = np.asarray(found)
            off = np.abs(found - wanted[:: (SAMPLES - 1) // (len(found) - 1)]).max() / np.abs(wanted).max()
            return float(off) if np.isfinite(off) else float("inf")

        return error(z, self.z), None if forces is None else error(forces, self.forces)


class Train(Crossing):
    """S3."""

    def __init__(self):
        self.name, self.speed, self.end = "S3", 10.0, 6.0
        self.times = np.linspace(0.0, self.end, SAMPLES)
        rate = lambda t, s: peers.train_rate(self.speed * t, s)  # noqa: E731
        run = solve_ivp(rate, (0.0, self.end), peers.train_start(), "DOP853", self.times, rtol=1e-11, atol=1e-13)
        self.z = run.y[0]
        self.forces = np.array([peers.train_forces(self.speed * t, s) for t, s in zip(self.times, run.y.T)])


class Heavy(Crossing):
    """A girder with mass."""

    def __init__(self, name, steps):
        self.name, self.beam = name, peers.Beam(name)
        self.z, self.forces = peers.beam_by_hand(self.beam, (self.beam.fine, steps))


@numba.njit(cache=False)
def give(x, z):
    """Deflection of a simply supported beam with overhangs, by Macaulay's brackets."""
    span, ei = 60.0, 9.528 * 4.32e9

    def cube(a):
        return a * a * a if a > 0.0 else 0.0

    r0, rl = (span - z) / span, z / span
    w = cube(x - z) - r0 * cube(x) - rl * cube(x - span)
    w0 = cube(-z)
    wl = cube(span - z) - r0 * cube(span)
    return (w - w0 - (wl - w0) * x / span) / (6.0 * ei)


@numba.njit(cache=False)
def rates(x, s0, s1, s2, s3):
    k, c, arm = 1e8, 1e5, 4.0 / 3.0
    mass = 4.8e6 / 32.174
    a, b = x - arm, x + arm
    g11, g22, g12 = give(a, a) + 1.0 / k, give(b, b) + 1.0 / k, give(a, b)
    e1 = s0 - arm * s1 + c / k * (s2 - arm * s3)
    e2 = s0 + arm * s1 + c / k * (s2 + arm * s3)
    det = g11 * g22 - g12 * g12
    f1, f2 = (g22 * e1 - g12 * e2) / det, (g11 * e2 - g12 * e1) / det
    return s2, s3, 32.174 - (f1 + f2) / mass, -arm * (f2 - f1) / (mass * 2.25), f1, f2


@numba.njit(cache=False)
def rk4(speed, end, steps, start):
    samples = min(steps, 100)
    out, forces = np.empty(samples + 1), np.empty((samples + 1, 2))
    h = end / steps
    every = max(steps // 100, 1)
    a, b, c, d = start[0], start[1], start[2], start[3]
    for n in range(steps):
        x = speed * n * h
        xm, xe = x + 0.5 * speed * h, x + speed * h
        p1, p2, p3, p4, f1, f2 = rates(x, a, b, c, d)
        if n % every == 0:
            out[n // every], forces[n // every, 0], forces[n // every, 1] = a, f1, f2
        q1, q2, q3, q4, _, _ = rates(xm, a + 0.5 * h * p1, b + 0.5 * h * p2, c + 0.5 * h * p3, d + 0.5 * h * p4)
        r1, r2, r3, r4, _, _ = rates(xm, a + 0.5 * h * q1, b + 0.5 * h * q2, c + 0.5 * h * q3, d + 0.5 * h * q4)
        s1, s2, s3, s4, _, _ = rates(xe, a + h * r1, b + h * r2, c + h * r3, d + h * r4)
        a += h / 6.0 * (p1 + 2.0 * (q1 + r1) + s1)
        b += h / 6.0 * (p2 + 2.0 * (q2 + r2) + s2)
        c += h / 6.0 * (p3 + 2.0 * (q3 + r3) + s3)
        d += h / 6.0 * (p4 + 2.0 * (q4 + r4) + s4)
    _, _, _, _, f1, f2 = rates(speed * end, a, b, c, d)
    out[samples], forces[samples, 0], forces[samples, 1] = a, f1, f2
    return out, forces


def by_hand(case, steps):
    return rk4(case.speed, case.end, steps, case.start)


def by_scipy(case, setting):
    method, rtol = setting

    def rate(t, s):
        return plain(case.speed * t, s)

    run = solve_ivp(rate, (0.0, case.end), case.start, method=method, rtol=rtol, atol=1e-3 * rtol, t_eval=case.times)
    return run.y[0] if run.success else np.full(SAMPLES, np.nan)


def plain(x, s):
    force = bogie.forces(x, s)
    return [s[2], s[3], bogie.GRAVITY - force.sum() / bogie.MASS, -(bogie.ARMS @ force) / bogie.INERTIA]


def by_exudyn(case, steps):
    arms = np.array([[1.0, a] for a in bogie.ARMS])

    # Matrices at the start fix the first acceleration; before a step, t is the step's end.
    def matrices(t):
        k = arms.T @ np.linalg.solve(bogie.compliance(case.speed * t), arms)
        return k, bogie.DAMPING / bogie.STIFFNESS * k

    mass, load = np.diag([bogie.MASS, bogie.INERTIA]), [bogie.MASS * bogie.GRAVITY, 0.0]
    return peers.exudyn(case.start[:2], mass, load, matrices, steps, case.end)


def train_by_hand(case, steps):
    start, p = peers.train_start(), peers
    return p.train_rk4(case.speed, case.end, steps, start, p.LEVERS, p.INVERSE, p.PULL, p.AT, give)


def train_by_scipy(case, setting):
    method, rtol = setting
    rate = lambda t, s: peers.train_rate(case.speed * t, s)  # noqa: E731
    run = solve_ivp(rate, (0.0, case.end), peers.train_start(), method, case.times, rtol=rtol, atol=1e-3 * rtol)
    return run.y[0] if run.success else np.full(SAMPLES, np.nan)


def settings(case, quick):
    """Code, function, its settings."""
    methods = ["RK45", "LSODA"] if quick else ["RK45", "DOP853", "LSODA", "Radau"]
    pairs = [(m, r) for m in methods for r in ([1e-3, 1e-5] if quick else [1e-3, 1e-4, 1e-5, 1e-6, 1e-7])]
    coarse = [100, 200, 500, 1000, 2000] if quick else [100, 200, 500, 1000, 2000, 5000, 10000]
    if isinstance(case, Heavy):
        counts = (100, 200, 400, 800, 1600, 3200) if quick else (100, 200, 400, 800, 1600, 3200, 6400, 12800)
        meshes = [(cells, steps) for cells in (8, 12, 24, 36) for steps in counts]
        modal = [("LSODA", rtol, count) for rtol in (1e-4, 1e-6) for count in (3, 6)]
        hand, by_scipy_, exu = peers.beam_by_hand, peers.beam_by_scipy, peers.beam_by_exudyn
        return [
            ("numba", lambda c, v: hand(c.beam, v), meshes),
            ("scipy", lambda c, v: by_scipy_(c.beam, v), modal),
            ("Exudyn", lambda c, v: exu(c.beam, v), [(12, n) for n in coarse]),
        ]
    if isinstance(case, Train):
        many = [200, 300, 400, 600, 1000, 2000, 4000, 8000]
        return [
            ("numba", train_by_hand, many),
            ("scipy", train_by_scipy, pairs),
            ("Exudyn", peers.train_by_exudyn, coarse),
        ]
    many = [20, 25, 50, 100, 200, 300, 400, 500, 700, 1000, 1500, 2000, 3000, 5000, 10000, 20000]
    return [("numba", by_hand, many), ("scipy", by_scipy, pairs), ("Exudyn", by_exudyn, coarse)]


def case(name):
    """A scene of GOALS with its reference."""
    fine = {"S1 beam": 12000, "S2 beam": 4000, "S4 beam": 4000}
    if name == "S3":
        return Train()
    return Heavy(name, fine[name]) if name in fine else Crossing(name)


def ours(profile, cases):
    """Rows of the example of the crate sim."""
    command = ["cargo", "run", "-q", "--profile", profile, "-p", "girderway-sim", "--example", "crossings"]
    text = subprocess.run(command, cwd=HERE.parent, check=True, capture_output=True, text=True).stdout
    known = {case.name: case for case in cases}
    for line in text.splitlines()[1:]:
        name, setting, _, least, median, most, *z = line.split(",")
        if name in known:
            columns = np.array([float(value) for value in z]).reshape(-1, SAMPLES)
            errors = known[name].errors(columns[0], columns[1:].T)
            yield name, "girderway", setting, *errors, float(least), float(median), float(most)


def measure(cases, skip, quick):
    found = {}
    jobs = [
        (case, code, function, value)
        for case in cases
        for code, function, values in settings(case, quick)
        if code not in skip
        for value in values
    ]
    for repetition in range(3 if quick else 5):
        for case, code, function, value in jobs:
            if repetition == 0 and code == "numba":
                function(case, value)
            began = time.thread_time()
            result = function(case, value)
            passed = 1e3 * (time.thread_time() - began)
            results = result if isinstance(result, tuple) else (result,)
            errors, times = found.setdefault((case.name, code, str(value)), (case.errors(*results), []))
            times.append(passed)
    for key, (errors, times) in found.items():
        yield (*key, *errors, min(times), float(np.median(times)), max(times))


def cheapest(rows):
    """Quantity, scene, error asked, code -> setting and times."""
    best = {}
    for scene, code, setting, of_deflection, of_force, *times in rows:
        for quantity, error in (("deflection", of_deflection), ("force", of_force)):
            for asked in ERRORS:
                key = (quantity, scene, asked, code)
                if error is not None and error <= asked and (key not in best or times[1] < best[key][2]):
                    best[key] = (setting, *times)
    return best


def write(rows, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    keys = ("scene", "code", "setting", "error", "force_error", "least_ms", "median_ms", "most_ms")
    # an error without bound is no number of JSON
    lasting = [[None if isinstance(own, float) and not np.isfinite(own) else own for own in row] for row in rows]
    text = json.dumps([dict(zip(keys, row)) for row in lasting], indent=1, allow_nan=False)
    path.write_text(text + "\n", encoding="ascii")


def chart(rows, path):
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, 3, figsize=(12, 7), sharey=True)
    for axis, scene in zip(axes.flat, GOALS):
        for at, code in enumerate(dict.fromkeys(row[1] for row in rows)):
            for error, face in ((3, f"C{at}"), (4, "none")):
                own = [row for row in rows if row[:2] == (scene, code) and row[error] is not None and 0 < row[error] < 1]
                style = {"color": f"C{at}", "markerfacecolor": face, "markersize": 4}
                label = {"label": code} if error == 3 else {}
                axis.loglog([row[6] for row in own], [row[error] for row in own], "o", **style, **label)
        axis.set(title=scene, xlabel="median time, ms")
        axis.grid(True, which="major", alpha=0.3)
    for axis in axes[:, 0]:
        axis.set_ylabel("error of the deflection (filled), of wheel forces (hollow)")
    axes[0, 0].legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", type=pathlib.Path, help="folder for scenes.json and scenes.svg")
    parser.add_argument("--quick", action="store_true", help="fewer settings and repetitions")
    parser.add_argument("--skip", nargs="*", default=[], help="codes to leave out")
    parser.add_argument("--scenes", nargs="*", default=list(GOALS), help="scenes to run")
    parser.add_argument("--profile", default="release", help="profile of cargo in which ours is built")
    options = parser.parse_args()
    cases = [case(name) for name in options.scenes]
    rows = list(ours(options.profile, cases)) + list(measure(cases, options.skip, options.quick))
    print("scene    code       setting                  error  of force     least    median      most, ms")
    for scene, code, setting, error, of_force, *times in sorted(rows, key=lambda row: (row[0], row[1], row[6])):
        forces = "       -" if of_force is None else f"{of_force:8.1e}"
        print(f"{scene:7s}  {code:9s}  {setting:22s}  {error:8.1e}  {forces}", *(f"{t:9.4f}" for t in times))
    best = cheapest(rows)
    print("\ncheapest: error of, scene, error, code, setting, least, median, most ms, least and median by ours (goal)")
    for (quantity, scene, asked, code), (setting, *times) in sorted(best.items()):
        own = best.get((quantity, scene, asked, "girderway"))
        ratio = f"{times[0] / own[1]:.2f} {times[1] / own[2]:.2f}" if own else "-"
        told = " ".join(f"{t:9.4f}" for t in times)
        goal = GOALS[scene].get(code, "-")
        print(f"{quantity:10s}  {scene:7s}  {asked:.0e}  {code:9s}  {setting:22s}  {told}  {ratio} ({goal})")
    if options.o:
        write(rows, options.o / "scenes.json")
        chart(rows, options.o / "scenes.svg")


if __name__ == "__main__":
    main()
