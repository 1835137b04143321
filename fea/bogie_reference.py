#!/usr/bin/env python3
"""Reference crossings of a two-wheel bogie over a massless girder, by scipy.

The girder rests on two supports at x = 0 and x = L and runs past both. Its influence function is

    G(x, z) = g(x, z) - sum_i l_i(x) g(s_i, z) - sum_j l_j(z) g(x, s_j) + sum_ij l_i(x) l_j(z) g(s_i, s_j)
    g(x, z) = |x - z|^3 / (12 EI),   s = (0, L),   l_0(x) = 1 - x/L,   l_1(x) = x/L

which satisfies EI G'''' = delta(x - z), vanishes at both supports and is free of moment and shear beyond
the load and the supports, so it is exact on the overhangs too.

The bogie is a rigid body (mass M, inertia I about its centre) that travels at constant speed. Its states
are z, the deflection of its centre, positive down, and the pitch, positive when the front goes down. Wheel
i sits at the arm a_i, so d_i = z + a_i pitch. Each wheel is a spring k over the girder and a damper c on its
own vertical velocity, both two-sided; with the girder's deflection w = G F,

    F = k (d - w) + c d_dot      <=>      (G + 1/k) F = d + (c/k) d_dot
    M z'' = M g - sum F,         I pitch'' = - sum a_i F

No code is shared with the simulator. Two integrators of different families (explicit DOP853, implicit
Radau) run with the same tolerance; the difference of the two is written with the results. The integration
is restarted where a wheel passes a support, where the third derivative of G jumps.

    python bogie_reference.py            check, then write reference/bogie_s1.json and bogie_s2.json
    python bogie_reference.py --check    check alone

Units: ft, lbf, s. Needs numpy and scipy (requirements.txt).
"""

import json
import pathlib
import sys

import numpy as np
import scipy
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

SPAN = 60.0
EI = 9.528 * 4.32e9
WEIGHT = 4.8e6
GRAVITY = 32.174
MASS = WEIGHT / GRAVITY
INERTIA = MASS * 1.5**2
ARMS = np.array([-4.0 / 3.0, 4.0 / 3.0])
STIFFNESS = 1e8
DAMPING = 1e5
SAMPLES = 101
RTOL = 1e-12
ATOL = 1e-15

SCENES = {
    "s1": {"speed": 5.0, "travel": 60.0, "peak_expected": 0.54709},
    "s2": {"speed": 100.0, "travel": 55.0, "peak_expected": 0.90868},
}

# Two wheels at rest, half of 4.8e6 lbf each: trunnion position, deflection of the left and of the right wheel's
# rail, of the trunnion. From the force method on the simply supported beam.
STATIC = [
    (15.0, 0.2754962199348336, 0.31038868617972704, 0.3169424530572803),
    (22.5, 0.44748994534483016, 0.46930925431390436, 0.48239959982936725),
    (30.0, 0.5217514992991561, 0.5217514992991561, 0.5457514992991561),
]

# Influence coefficients between stations -15, 0, 15, 30, 45, 60, 75 ft, for example G(-15, 75) = [0][6].
TABLE = {
    (-15.0, -15.0): 1.3665862020710885e-07,
    (-15.0, 15.0): -7.174577560873216e-08,
    (-15.0, 30.0): -8.199517212426532e-08,
    (-15.0, 75.0): 5.466344808284355e-08,
    (15.0, 15.0): 6.149637909319899e-08,
    (15.0, 45.0): 4.783051707248811e-08,
    (30.0, 30.0): 1.0932689616568709e-07,
    (30.0, 75.0): -8.199517212426532e-08,
    (75.0, 75.0): 1.3665862020710885e-07,
}


def influence(x, z):
    """Deflection at x per unit load at z; x and z broadcast."""
    supports = (0.0, SPAN)

    def kernel(a, b):
        return np.abs(a - b) ** 3 / (12.0 * EI)

    def weights(a):
        return (1.0 - a / SPAN, a / SPAN)

    total = kernel(x, z)
    for si, li in zip(supports, weights(x)):
        total = total - li * kernel(si, z)
        for sj, lj in zip(supports, weights(z)):
            total = total + li * lj * kernel(si, sj)
    for sj, lj in zip(supports, weights(z)):
        total = total - lj * kernel(x, sj)
    return total


def compliance(trunnion):
    """2 x 2: girder and wheel springs in series, wheels at trunnion + ARMS."""
    at = trunnion + ARMS
    return influence(at[:, None], at[None, :]) + np.eye(2) / STIFFNESS


def forces(trunnion, state):
    """Wheel forces of a state (z, pitch, their rates)."""
    z, pitch, z_rate, pitch_rate = state
    d = z + ARMS * pitch
    rate = z_rate + ARMS * pitch_rate
    return np.linalg.solve(compliance(trunnion), d + DAMPING / STIFFNESS * rate)


def at_rest(trunnion):
    """State in static equilibrium, half of the weight on each wheel."""
    d = compliance(trunnion) @ np.full(2, WEIGHT / 2.0)
    return np.array([d.mean(), (d[1] - d[0]) / (ARMS[1] - ARMS[0]), 0.0, 0.0])


def cross(speed, travel, method):
    """One crossing from trunnion x = 0: times, states at the sample times and pieces of dense output."""

    def rate(t, state):
        force = forces(speed * t, state)
        return [state[2], state[3], GRAVITY - force.sum() / MASS, -(ARMS @ force) / INERTIA]

    end = travel / speed
    breaks = sorted({0.0, end} | {t for s in (0.0, SPAN) for t in (s - ARMS) / speed if 0.0 < t < end})
    times = np.linspace(0.0, end, SAMPLES)
    states = np.empty((SAMPLES, 4))
    pieces = []
    state = at_rest(0.0)
    for start, stop in zip(breaks, breaks[1:]):
        run = solve_ivp(rate, (start, stop), state, method=method, rtol=RTOL, atol=ATOL, dense_output=True)
        if not run.success:
            raise RuntimeError(run.message)
        # Exact step ends at the sample times: the dense output is of lower order than the steps.
        inside = np.flatnonzero((times >= start) & (times <= stop))
        here, value = start, state
        for i in inside:
            if times[i] > here:
                leg = solve_ivp(rate, (here, times[i]), value, method=method, rtol=RTOL, atol=ATOL)
                here, value = times[i], leg.y[:, -1]
            states[i] = value
        if stop > here:
            value = solve_ivp(rate, (here, stop), value, method=method, rtol=RTOL, atol=ATOL).y[:, -1]
        pieces.append((start, stop, run.sol))
        state = value
    return times, states, pieces


def peak(pieces):
    """Largest z over all pieces and when: (time, z)."""
    best = (0.0, -np.inf)
    for start, stop, sol in pieces:
        grid = np.linspace(start, stop, 4001)
        i = int(np.argmax(sol(grid)[0]))
        low, high = grid[max(i - 1, 0)], grid[min(i + 1, len(grid) - 1)]
        top = minimize_scalar(lambda t: -sol(t)[0], bounds=(low, high), method="bounded", options={"xatol": 1e-12})
        for t in (top.x, grid[i]):
            if sol(t)[0] > best[1]:
                best = (float(t), float(sol(t)[0]))
    return best


def check():
    """The influence function and the static cases against known values; raises where one is missed."""
    for (x, z), value in TABLE.items():
        if abs(influence(x, z) - value) > 1e-14 * 1.4e-7 or abs(influence(z, x) - value) > 1e-14 * 1.4e-7:
            raise AssertionError(f"G({x}, {z}) = {influence(x, z)!r}, expected {value!r}")
    for x, left, right, trunnion in STATIC:
        half = np.full(2, WEIGHT / 2.0)
        rail = (compliance(x) - np.eye(2) / STIFFNESS) @ half
        seen = (rail[0], rail[1], at_rest(x)[0])
        if np.abs(np.array(seen) - (left, right, trunnion)).max() > 1e-14:
            raise AssertionError(f"static case at {x} ft: {seen!r}")


def digits(values):
    """Rounded to 15 significant digits."""
    return [float(f"{v:.14e}") for v in values]


def scene(name):
    """One scene by both integrators, as the data of its file."""
    setting = SCENES[name]
    speed, travel = setting["speed"], setting["travel"]
    times, states, pieces = cross(speed, travel, "DOP853")
    _, other, _ = cross(speed, travel, "Radau")
    when, top = peak(pieces)
    if abs(top - setting["peak_expected"]) > 6e-6:
        raise AssertionError(f"{name}: peak of z {top!r}, expected {setting['peak_expected']}")
    wheel = np.array([forces(speed * t, s) for t, s in zip(times, states)])
    wheel_other = np.array([forces(speed * t, s) for t, s in zip(times, other)])
    return {
        "description": "two-wheel bogie on a massless simply supported girder with overhangs, fea/bogie_reference.py",
        "units": {"length": "ft", "force": "lbf", "time": "s", "angle": "rad"},
        "settings": {
            "span": SPAN,
            "EI": EI,
            "weight": WEIGHT,
            "gravity": GRAVITY,
            "mass": MASS,
            "inertia": INERTIA,
            "arms": ARMS.tolist(),
            "k": STIFFNESS,
            "c": DAMPING,
            "damper": "wheel's own velocity, to ground",
            "contact": "two-sided",
            "speed": speed,
            "travel": travel,
            "start": "static equilibrium, trunnion at x = 0",
            "integrator": "DOP853, restarted where a wheel passes a support",
            "rtol": RTOL,
            "atol": ATOL,
            "scipy": scipy.__version__,
        },
        "signs": "z and forces positive down; pitch positive when the front (larger x) goes down; F1 rear, F2 front",
        "difference_to_radau": {
            "z": float(f"{np.abs(states - other)[:, 0].max():.1e}"),
            "pitch": float(f"{np.abs(states - other)[:, 1].max():.1e}"),
            "force": float(f"{np.abs(wheel - wheel_other).max():.1e}"),
        },
        "peak": {"z": float(f"{top:.11f}"), "time": float(f"{when:.6f}"), "x": float(f"{speed * when:.5f}")},
        "time": digits(times),
        "z": digits(states[:, 0]),
        "pitch": digits(states[:, 1]),
        "F1": digits(wheel[:, 0]),
        "F2": digits(wheel[:, 1]),
    }


def main():
    check()
    if "--check" in sys.argv[1:]:
        return
    folder = pathlib.Path(__file__).resolve().parent / "reference"
    folder.mkdir(exist_ok=True)
    for name in SCENES:
        data = scene(name)
        (folder / f"bogie_{name}.json").write_text(json.dumps(data, indent=1) + "\n", encoding="ascii")
        print(name, data["peak"], data["difference_to_radau"], "smallest wheel force", min(data["F1"] + data["F2"]))


if __name__ == "__main__":
    main()
