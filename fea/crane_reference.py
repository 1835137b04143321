#!/usr/bin/env python3
"""A bridge crane of 11 freedoms, written out by hand, and what scipy's steppers make of it.

    python3 -m venv VENV && VENV/bin/pip install -r fea/requirements-scenes.txt
    VENV/bin/python fea/crane_reference.py -o fea/reference/crane.json

Freedoms: bridge X (along the runway), Y (up), Z (across), roll, pitch; trolley s along the bridge, y and pitch on its
girders; ladle x, y, z on an elastic rope. The crane runs at 5 ft/s over a runway of 45/45/60/45/45 ft and brakes, the
trolley starts, runs and brakes. Units pounds, feet and seconds.

Mechanics: bodies turn by small angles, their places are bilinear in angles and travel; forces follow from Lagrange's
equations. Runway girders are continuous on columns that give, upwards and sideways; the bridge girders are simply
supported. All are without mass and exact: cubic shapes between columns and the Green's function of the clamped cell.
Four equalised wheels a corner share its vertical force; each wheel is guided sideways by a spring. Wheels press with
k p + c v, v the speed of the wheel itself. A girder pushes wheels along itself where it slopes.

The reference is DOP853 at rtol 1e-12, started anew where a drive or brake switches, beside Radau at 1e-8. Every other
stepper runs the whole 22 s with its tolerance; its error is the largest of the northern wheels' force over 221 samples, of
its largest value. Absolute tolerances are a hundredth of relative ones. scipy does not count right-hand sides of its Jacobians by
differences; generalised-alpha (radius 0.8, steps of 10 to 2.5 ms) does here.
"""

import argparse
import json
import math
import pathlib

import numba
import numpy as np
import scipy
from scipy.integrate import solve_ivp
from scipy.optimize import root

G = 32.174
E = 4.176e9
BRIDGE, TROLLEY, LADLE = 750e3 / G, 450e3 / G, 1020e3 / G
SPAN, BASE, HEIGHT, RADIUS = 75.0, 15.0, 5.0, 1.25
# about the runway, about the bridge
ROLL, PITCH = BRIDGE * SPAN**2 / 12.0, BRIDGE * 40.0**2 / 12.0
TROLLEY_ROLL, TROLLEY_PITCH = TROLLEY * 20.0**2 / 12.0, TROLLEY * 12.0**2 / 12.0
AXLE = 6.0
OFFSETS = np.array([-7.5, -2.5, 2.5, 7.5])
WHEEL, DAMPER = 1e8, 1e5
COLUMNS = np.array([0.0, 45.0, 90.0, 150.0, 195.0, 240.0])
RUNWAY = {"vertical": (14.0 * E, 4e7), "lateral": (14.0 * E / 12.0, 5e6)}
GIRDERS = 2.0 * 20.0 * E
ROPE, LENGTH = 7e6, 40.0
ROPE_DAMPER = 2.0 * 0.02 * math.sqrt(ROPE * LADLE)
MU, CREEP = 0.2, 0.02
SPEED, START = 5.0, 65.0
BRIDGE_GAIN, BRIDGE_BRAKE = 2e5, 12.3457
TROLLEY_SPEED, TROLLEY_RAMP, TROLLEY_START = 10.0 / 3.0, 2.0, -12.0
TROLLEY_GAIN, TROLLEY_BRAKE = 1e5, 6.0137
END, SAMPLES = 22.0, 221
ABSOLUTE = 1e-2
BREAKS = [TROLLEY_RAMP, TROLLEY_BRAKE, BRIDGE_BRAKE]


def nodal(bending, column):
    """Compliance of deflection and slope at the columns, 2 x 2 blocks in turn."""
    size = 2 * len(COLUMNS)
    stiffness = np.zeros((size, size))
    for e, length in enumerate(np.diff(COLUMNS)):
        a, b, c = 6.0 * length, 4.0 * length**2, 2.0 * length**2
        cell = bending / length**3 * np.array([[12, a, -12, a], [a, b, -a, c], [-12, -a, 12, -a], [a, c, -a, b]])
        stiffness[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += cell
    stiffness[::2, ::2] += column * np.eye(len(COLUMNS))
    return np.linalg.inv(stiffness)


VERTICAL, LATERAL = (nodal(*RUNWAY[way]) for way in ("vertical", "lateral"))
BENDING, SIDEWAYS = RUNWAY["vertical"][0], RUNWAY["lateral"][0]


@numba.njit(cache=True)
def shapes(x, value, slope):
    """Row of cubic shapes at x and its slope; returns the cell."""
    e = 0
    while e < len(COLUMNS) - 2 and x > COLUMNS[e + 1]:
        e += 1
    h = COLUMNS[e + 1] - COLUMNS[e]
    s = (x - COLUMNS[e]) / h
    value[:] = 0.0
    slope[:] = 0.0
    value[2 * e] = 1 - 3 * s**2 + 2 * s**3
    value[2 * e + 1] = h * (s - 2 * s**2 + s**3)
    value[2 * e + 2] = 3 * s**2 - 2 * s**3
    value[2 * e + 3] = h * (s**3 - s**2)
    slope[2 * e] = (6 * s**2 - 6 * s) / h
    slope[2 * e + 1] = 1 - 4 * s + 3 * s**2
    slope[2 * e + 2] = (6 * s - 6 * s**2) / h
    slope[2 * e + 3] = 3 * s**2 - 2 * s
    return e


@numba.njit(cache=True)
def clamped(e, x, z, bending):
    """Deflection at x under 1 at z of the cell clamped at both ends, and its change as both move."""
    h = COLUMNS[e + 1] - COLUMNS[e]
    a, c = min(x, z) - COLUMNS[e], max(x, z) - COLUMNS[e]
    q = h - c
    core = 3 * c * h - a * (h + 2 * c)
    scale = 1.0 / (6 * bending * h**3)
    by_a = 2 * a * q**2 * core - a**2 * q**2 * (h + 2 * c)
    by_c = -2 * a**2 * q * core + a**2 * q**2 * (3 * h - 2 * a)
    return scale * a**2 * q**2 * core, scale * (by_a + by_c)


@numba.njit(cache=True)
def gives(x, compliance, bending, value, move):
    """Give of the rail at the places x, and its change as all of them move."""
    n = len(x)
    rows, slopes = np.zeros((n, compliance.shape[0])), np.zeros((n, compliance.shape[0]))
    cells = np.zeros(n, np.int64)
    for i in range(n):
        cells[i] = shapes(x[i], rows[i], slopes[i])
    half = compliance @ rows.T
    value[:] = rows @ half
    half = slopes @ half
    move[:] = half + half.T
    for i in range(n):
        for j in range(n):
            if cells[i] == cells[j]:
                own, by = clamped(cells[i], x[i], x[j], bending)
                value[i, j] += own
                move[i, j] += by


@numba.njit(cache=True)
def girders(x, value, move):
    """Give of both bridge girders together under the trolley's axles, and its change as they move."""
    for i in range(2):
        for j in range(2):
            a, c = min(x[i], x[j]) + SPAN / 2, max(x[i], x[j]) + SPAN / 2
            q = SPAN - c
            core = SPAN**2 - a**2 - q**2
            scale = 1.0 / (6 * GIRDERS * SPAN)
            value[i, j] = scale * a * q * core
            move[i, j] = scale * ((q - a) * core + a * q * (2 * q - 2 * a))


@numba.njit(cache=True)
def forces(q, v):
    """Corner forces (north front, north rear, south front, south rear), what rails do along X, and sideways forces."""
    X, Y, Z, roll, pitch = q[0], q[1], q[2], q[3], q[4]
    place = X - RADIUS * pitch
    offsets = np.array([BASE, -BASE])
    x = np.zeros(8)
    for c in range(2):
        for w in range(4):
            x[4 * c + w] = place + offsets[c] + OFFSETS[w]
    value, move = np.zeros((8, 8)), np.zeros((8, 8))
    gives(x, VERTICAL, BENDING, value, move)
    shared, shift = np.zeros((2, 2)), np.zeros((2, 2))
    for i in range(8):
        for j in range(8):
            shared[i // 4, j // 4] += value[i, j] / 16.0
            shift[i // 4, j // 4] += move[i, j] / 16.0
    gives(x, LATERAL, SIDEWAYS, value, move)
    for i in range(8):
        value[i, i] += 1.0 / WHEEL
    vertical, sideways = np.zeros((2, 2)), np.zeros((2, 8))
    along = 0.0
    for side in range(2):
        z = SPAN / 2 if side == 0 else -SPAN / 2
        down, rate = np.zeros(2), np.zeros(2)
        for c in range(2):
            down[c] = -(Y - z * roll + offsets[c] * pitch)
            rate[c] = -(v[1] - z * v[3] + offsets[c] * v[4])
        matrix = shared.copy()
        for c in range(2):
            matrix[c, c] += 0.25 / WHEEL
        own = np.linalg.solve(matrix, down + DAMPER / WHEEL * rate)
        vertical[side] = own
        along += 0.5 * own @ shift @ own
        apart = np.zeros(8)
        for i in range(8):
            pressed = (0.25 * own[i // 4] - DAMPER * rate[i // 4]) / WHEEL
            apart[i] = Z + roll * pressed
        guide = np.linalg.solve(value, apart)
        sideways[side] = guide
        along += 0.5 * guide @ move @ guide
    return vertical, sideways, along


@numba.njit(cache=True)
def axles(q, v):
    """Forces of the trolley's axles on both girders, and what the girders do along them."""
    place = q[5] - RADIUS * q[7]
    x = np.array([place + AXLE, place - AXLE])
    value, move = np.zeros((2, 2)), np.zeros((2, 2))
    girders(x, value, move)
    for i in range(2):
        value[i, i] += 0.5 / WHEEL
    down = np.array([-(q[6] + AXLE * q[7]), -(q[6] - AXLE * q[7])])
    rate = np.array([-(v[6] + AXLE * v[7]), -(v[6] - AXLE * v[7])])
    own = np.linalg.solve(value, down + DAMPER / WHEEL * rate)
    return own, 0.5 * own @ move @ own


@numba.njit(cache=True)
def balance(t, q, v, drives):
    """Mass matrix and forces at t; without drives and brakes where `drives` is 0, for the equilibrium."""
    X, Y, Z, roll, pitch, s, y = q[0], q[1], q[2], q[3], q[4], q[5], q[6]
    load = np.zeros(11)
    mass = np.zeros((11, 11))
    mass[0, 0] = mass[1, 1] = mass[2, 2] = BRIDGE
    mass[3, 3], mass[4, 4] = ROLL, PITCH
    load[1] -= BRIDGE * G
    for i in range(8, 11):
        mass[i, i] = LADLE
    load[9] -= LADLE * G
    # trolley: place by the freedoms, and what its acceleration has beside them
    rows = np.zeros((3, 11))
    rows[0, 0], rows[0, 4] = 1.0, -HEIGHT
    rows[1, 1], rows[1, 3], rows[1, 5], rows[1, 6] = 1.0, -s, -roll, 1.0
    rows[2, 2], rows[2, 3], rows[2, 5] = 1.0, HEIGHT, 1.0
    at = np.array([X - HEIGHT * pitch, Y - roll * s + y + HEIGHT, Z + roll * HEIGHT + s])
    mass += TROLLEY * rows.T @ rows
    load -= TROLLEY * rows[1] * (G - 2.0 * v[3] * v[5])
    mass[4, 4] += TROLLEY_ROLL
    for i, a in ((3, -1.0), (7, 1.0)):
        for j, b in ((3, -1.0), (7, 1.0)):
            mass[i, j] += a * b * TROLLEY_PITCH
    # runway
    vertical, sideways, along = forces(q, v)
    total = 0.0
    for side in range(2):
        z = SPAN / 2 if side == 0 else -SPAN / 2
        for c in range(2):
            arm = BASE if c == 0 else -BASE
            own = vertical[side, c]
            total += own
            load[1] += own
            load[3] -= z * own
            load[4] += arm * own
            rate = -(v[1] - z * v[3] + arm * v[4])
            pressed = (0.25 * own - DAMPER * rate) / WHEEL
            for w in range(4):
                load[2] -= sideways[side, 4 * c + w]
                load[3] -= pressed * sideways[side, 4 * c + w]
    load[0] += along
    load[4] -= RADIUS * along
    # girders
    own, push = axles(q, v)
    load[6] += own[0] + own[1]
    load[7] += AXLE * (own[0] - own[1])
    load[5] += push
    load[7] -= RADIUS * push
    # rope
    reach = q[8:11] - at
    length = math.sqrt(reach @ reach)
    reach = reach / length
    pull = ROPE * (length - LENGTH)
    pull += ROPE_DAMPER * (reach @ (v[8:11] - rows @ v))
    if length <= LENGTH or pull < 0.0:
        pull = 0.0
    load[8:11] -= pull * reach
    load += pull * (reach @ rows)
    if drives == 1:
        if t < BRIDGE_BRAKE:
            limit = MU * total
            load[0] += min(max(BRIDGE_GAIN * (SPEED - v[0]), -limit), limit)
        else:
            load[0] -= MU * total * math.tanh(v[0] / CREEP)
        grip = MU * (own[0] + own[1])
        if t < TROLLEY_BRAKE:
            wanted = TROLLEY_SPEED * min(t / TROLLEY_RAMP, 1.0)
            load[5] += min(max(TROLLEY_GAIN * (wanted - v[5]), -grip), grip)
        else:
            load[5] -= grip * math.tanh(v[5] / CREEP)
    return mass, load


@numba.njit(cache=True)
def acceleration(t, q, v):
    mass, load = balance(t, q, v, 1)
    return np.linalg.solve(mass, load)


@numba.njit(cache=True)
def rate(t, state):
    out = np.empty(22)
    out[:11] = state[11:]
    out[11:] = acceleration(t, state[:11].copy(), state[11:].copy())
    return out


def north(q, v):
    return float(forces(q, v)[0][0].sum())


def begin():
    """Equilibrium at the start, in motion along the runway."""
    q = np.zeros(11)
    q[0], q[5] = START, TROLLEY_START
    free = [1, 3, 4, 6, 7, 8, 9, 10]

    # what holds X, Z and s is let go at the start
    def residual(values):
        own = q.copy()
        own[free] = values
        return balance(0.0, own, np.zeros(11), 0)[1][free] / 1e3

    guess = q.copy()
    weight = (BRIDGE + TROLLEY + LADLE) * G
    guess[1] = -weight * (1 / 1.6e9 + 1e-8)
    guess[6] = -(TROLLEY + LADLE) * G * 4e-8
    guess[8], guess[10] = START, TROLLEY_START
    guess[9] = HEIGHT + guess[1] + guess[6] - LENGTH - LADLE * G / ROPE
    found = root(residual, guess[free], tol=1e-15)
    for _ in range(3):
        found = root(residual, found.x, tol=1e-15)
    q[free] = found.x
    state = np.zeros(22)
    state[:11] = q
    state[11] = state[19] = SPEED
    print("equilibrium", np.abs(residual(found.x)).max() * 1e3, "lb; north", north(q, np.zeros(11)))
    return state


def run(method, rtol, breaks=()):
    """Samples of the state, and right-hand sides asked for."""
    times = np.linspace(0.0, END, SAMPLES)
    ends = [0.0, *breaks, END]
    state, asked = begin.state, 0
    out = np.empty((SAMPLES, 22))
    out[0] = state
    for a, b in zip(ends[:-1], ends[1:]):
        inner = (times > a) & (times <= b)
        # one side of a switch
        own = solve_ivp(lambda t, y, b=b, a=a: rate(min(max(t, a), b - (1e-12 if b < END else 0.0)), y), (a, b), state,
                        method=method, rtol=rtol, atol=rtol * ABSOLUTE, t_eval=np.unique(np.append(times[inner], b)))
        asked += own.nfev
        state = own.y[:, -1]
        out[inner] = own.y.T[: inner.sum()]
    return out, asked


def alpha(h, rho=0.8):
    """Generalised-alpha with Newton's method; a Jacobian by differences every step would cost 22 right-hand sides, so it is
    kept while five corrections do."""
    m, f = (2 * rho - 1) / (1 + rho), rho / (1 + rho)
    gamma, beta = 0.5 - m + f, 0.25 * (1 - m + f) ** 2
    asked = 0

    def force(t, q, v):
        nonlocal asked
        asked += 1
        return acceleration(t, q, v)

    def slopes(t, q, v):
        base = force(t, q, v)
        by_q, by_v = np.zeros((11, 11)), np.zeros((11, 11))
        for j in range(11):
            step = np.zeros(11)
            step[j] = 1e-7
            by_q[:, j] = (force(t, q + step, v) - base) / 1e-7
            by_v[:, j] = (force(t, q, v + step) - base) / 1e-7
        return (1 - m) * np.eye(11) - (1 - f) * (beta * h * h * by_q + gamma * h * by_v)

    q, v = begin.state[:11].copy(), begin.state[11:].copy()
    a = force(0.0, q, v)
    jacobian, count = None, round(END / h)
    every = round(count / (SAMPLES - 1))
    out = [np.concatenate([q, v])]
    for i in range(count):
        t = (i + 1 - f) * h
        if jacobian is None:
            jacobian = slopes(t, q, v)
        ahead = a.copy()
        for k in range(40):
            end_q = q + h * v + h * h * ((0.5 - beta) * a + beta * ahead)
            end_v = v + h * ((1 - gamma) * a + gamma * ahead)
            mean = (1 - f) * end_q + f * q, (1 - f) * end_v + f * v
            if k > 5:
                jacobian = slopes(t, *mean)
            change = np.linalg.solve(jacobian, (1 - m) * ahead + m * a - force(t, *mean))
            ahead = ahead - change * (0.5 if k > 15 else 1.0)
            if np.abs(change).max() < 1e-6:
                break
        q = q + h * v + h * h * ((0.5 - beta) * a + beta * ahead)
        v = v + h * ((1 - gamma) * a + gamma * ahead)
        a = ahead
        if k > 4:
            jacobian = None
        if (i + 1) % every == 0:
            out.append(np.concatenate([q, v]))
    return np.array(out), asked


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("-o", "--out", type=pathlib.Path)
    parser.add_argument("--rtol", type=float, default=1e-12)
    args = parser.parse_args()
    begin.state = begin()
    exact, asked = run("DOP853", args.rtol, BREAKS)
    wanted = np.array([north(y[:11], y[11:]) for y in exact])
    peak = wanted.max()
    print("reference", asked, "north", wanted[0], wanted.min(), peak, wanted[-1], flush=True)

    def error(states):
        return float(max(abs(north(y[:11], y[11:]) - w) for y, w in zip(states, wanted)) / peak)

    other, asked = run("Radau", 1e-8, BREAKS)
    apart = error(other)
    print(f"Radau 1e-8: {apart:.1e} {asked}", flush=True)
    table = []
    for method, rtol in [("Radau", 1e-4), ("Radau", 1e-6), ("BDF", 1e-4), ("LSODA", 1e-6), ("RK45", 1e-5), ("DOP853", 1e-6)]:
        states, asked = run(method, rtol)
        table.append({"method": method, "rtol": rtol, "error": error(states), "rates": asked})
        print(table[-1], flush=True)
    for h in (1e-2, 5e-3, 2.5e-3):
        states, asked = alpha(h)
        table.append({"method": "generalised-alpha", "step": h, "error": error(states), "rates": asked})
        print(table[-1], flush=True)
    names = ["X", "Y", "Z", "roll", "pitch", "s", "y", "nod", "x_ladle", "y_ladle", "z_ladle"]
    if args.out:
        columns = {name: [float(f"{x:.12g}") for x in exact[:, i]] for i, name in enumerate(names)}
        columns["north"] = [float(f"{x:.12g}") for x in wanted]
        data = {"scipy": scipy.__version__, "numpy": np.__version__, "radau_apart": apart, "steppers": table,
                "time": [round(float(t), 3) for t in np.linspace(0.0, END, SAMPLES)], **columns}
        args.out.write_text("{\n" + ",\n".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in data.items()) + "\n}\n")


if __name__ == "__main__":
    main()
