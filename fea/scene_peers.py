"""S3 and the crossings over girders with mass, by hand (numba), by scipy and by Exudyn: see bench_scenes.py.

S3: a carriage on two equalisers on four bogies, eight wheels; girder without mass, dampers on the wheels' own velocity.
Beams: Hermite elements; the gap of wheel i is p = z + a_i pitch - N(x_i) u, its force k p + c dp/dt with the convective
part v N'(x_i) u.
"""

import numba
import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

import bogie_reference as bogie

SAMPLES = bogie.SAMPLES
SIGNS = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)], dtype=float)
# Deflection of wheel i by z, pitch of the carriage, two equalisers, four bogies.
LEVERS = np.zeros((8, 8))
for _i, (_a, _b, _c) in enumerate(SIGNS):
    LEVERS[_i, 0], LEVERS[_i, 1] = 1.0, 6.0 * _a
    LEVERS[_i, 2 + _i // 4] = 3.0 * _b
    LEVERS[_i, 4 + _i // 2] = 4.0 / 3.0 * _c
AT = SIGNS @ np.array([6.0, 3.0, 4.0 / 3.0])


def train_mass():
    """8 x 8: carriage, equalisers at their pins, bogies at theirs."""
    mass = np.zeros((8, 8))
    carriage = bogie.WEIGHT / bogie.GRAVITY - 1800.0
    mass[0, 0], mass[1, 1] = carriage, 64.0 * carriage
    for e in range(2):
        row = np.zeros(8)
        row[0], row[1] = 1.0, -6.0 + 12.0 * e
        mass += 300.0 * np.outer(row, row)
        mass[2 + e, 2 + e] += 2700.0
        for b in range(2):
            pin = row.copy()
            pin[2 + e] = -3.0 + 6.0 * b
            mass += 300.0 * np.outer(pin, pin)
            mass[4 + 2 * e + b, 4 + 2 * e + b] += 300.0
    return mass


MASS = train_mass()
INVERSE = np.linalg.inv(MASS)
PULL = MASS @ np.eye(8)[0] * bogie.GRAVITY


def train_compliance(x):
    at = x + AT
    return bogie.influence(at[:, None], at[None, :]) + np.eye(8) / bogie.STIFFNESS


def train_start():
    # Statically determinate: every wheel's force follows from the weights alone.
    force = np.linalg.solve(LEVERS.T, PULL)
    return np.concatenate([np.linalg.solve(LEVERS, train_compliance(0.0) @ force), np.zeros(8)])


def train_forces(x, s):
    drop = LEVERS @ (s[:8] + bogie.DAMPING / bogie.STIFFNESS * s[8:])
    return np.linalg.solve(train_compliance(x), drop)


def train_rate(x, s):
    return np.concatenate([s[8:], INVERSE @ (PULL - LEVERS.T @ train_forces(x, s))])


@numba.njit(cache=False)
def train_rate_fast(x, s, levers, inverse, pull, at, give):
    a = np.empty((8, 8))
    for i in range(8):
        for j in range(i + 1):
            a[i, j] = give(x + at[i], x + at[j])
        a[i, i] += 1e-8
    f = levers @ (s[:8] + 1e-3 * s[8:])
    for i in range(8):  # Cholesky and both substitutions in place
        for j in range(i + 1):
            t = a[i, j]
            for k in range(j):
                t -= a[i, k] * a[j, k]
            a[i, j] = np.sqrt(t) if i == j else t / a[j, j]
    for i in range(8):
        for k in range(i):
            f[i] -= a[i, k] * f[k]
        f[i] /= a[i, i]
    for i in range(7, -1, -1):
        for k in range(i + 1, 8):
            f[i] -= a[k, i] * f[k]
        f[i] /= a[i, i]
    out = np.empty(16)
    out[:8] = s[8:]
    out[8:] = inverse @ (pull - levers.T @ f)
    return out, f


@numba.njit(cache=False)
def train_rk4(speed, end, steps, s, levers, inverse, pull, at, give):
    h, every = end / steps, steps // 100
    z, forces = np.empty(101), np.empty((101, 8))
    for n in range(steps):
        x = speed * n * h
        a, f = train_rate_fast(x, s, levers, inverse, pull, at, give)
        if n % every == 0:
            z[n // every], forces[n // every] = s[0], f
        b, _ = train_rate_fast(x + 0.5 * speed * h, s + 0.5 * h * a, levers, inverse, pull, at, give)
        c, _ = train_rate_fast(x + 0.5 * speed * h, s + 0.5 * h * b, levers, inverse, pull, at, give)
        d, _ = train_rate_fast(x + speed * h, s + h * c, levers, inverse, pull, at, give)
        s = s + h / 6.0 * (a + 2.0 * (b + c) + d)
    z[100] = s[0]
    forces[100] = train_rate_fast(speed * end, s, levers, inverse, pull, at, give)[1]
    return z, forces


class Beam:
    """A girder with mass, and the body that crosses it."""

    def __init__(self, name):
        paper = name != "S4 beam"
        self.span, self.overhang = (60.0, 15.0) if paper else (25.0, 0.0)
        self.bending, self.line = (bogie.EI, 15.2) if paper else (2.87e9 * 2.90, 2303.0)
        self.speed, self.end = {"S1": (5.0, 12.0), "S2": (100.0, 0.55), "S4": (25.0 / 0.9, 0.9)}[name[:2]]
        self.mass, self.gravity = (bogie.MASS, bogie.GRAVITY) if paper else (5750.0, 9.81)
        self.inertia = bogie.INERTIA if paper else 1.0
        self.arms = bogie.ARMS if paper else np.zeros(1)
        self.k, self.c = (bogie.STIFFNESS, bogie.DAMPING) if paper else (1595e3, 0.0)
        # cells a span; an overhang is a quarter of a span
        self.coarse, self.fine = (12, 48) if paper else (12, 48)

    def mesh(self, cells):
        h = self.span / cells
        count = cells + 2 * round(self.overhang / h)
        size = 2 * (count + 1)
        k, m = np.zeros((size, size)), np.zeros((size, size))
        ke = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h], [-12, -6 * h, 12, -6 * h],
                       [6 * h, 2 * h * h, -6 * h, 4 * h * h]]) * self.bending / h**3  # fmt: skip
        me = np.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                       [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]) * self.line * h / 420  # fmt: skip
        for e in range(count):
            part = slice(2 * e, 2 * e + 4)
            k[part, part] += ke
            m[part, part] += me
        held = [2 * round(x / h) for x in (self.overhang, self.overhang + self.span)]
        # held freedoms stay, stiff beyond doubt and without coupling
        for i in held:
            k[i, :] = k[:, i] = m[i, :] = m[:, i] = 0.0
            k[i, i], m[i, i] = ke[0, 0], me[0, 0]
        return h, held, k, m

    def row(self, x, h, size, held):
        e = min(max(int((x + self.overhang) / h), 0), size // 2 - 2)
        s = (x + self.overhang) / h - e
        n, d = np.zeros(size), np.zeros(size)
        n[2 * e : 2 * e + 4] = cubics(s, h)
        d[2 * e : 2 * e + 4] = slopes(s, h)
        n[held], d[held] = 0.0, 0.0
        return n, d

    def at_rest(self, k, h, held):
        force = np.full(len(self.arms), self.mass * self.gravity / len(self.arms))
        rows = [self.row(a, h, len(k), held)[0] for a in self.arms]
        u = np.linalg.solve(k, sum(n * f for n, f in zip(rows, force)))
        d = np.array([n @ u for n in rows]) + force / self.k
        pitch = (d[-1] - d[0]) / (self.arms[-1] - self.arms[0]) if len(d) > 1 else 0.0
        return d.mean(), pitch, u


@numba.njit(cache=False)
def cubics(s, h):
    return np.array([1 - s * s * (3 - 2 * s), h * s * (1 - s) ** 2, s * s * (3 - 2 * s), -h * s * s * (1 - s)])


@numba.njit(cache=False)
def slopes(s, h):
    return np.array([-6 * s * (1 - s) / h, (1 - s) * (1 - 3 * s), 6 * s * (1 - s) / h, -s * (2 - 3 * s)])


@numba.njit(cache=False)
def newmark(steps, end, speed, overhang, h, held, k, m, arms, spring, damper, mass, inertia, gravity, z, pitch, u):
    """Average acceleration; wheel forces by the give of everything over one step."""
    size, wheels = len(u), len(arms)
    dt = end / steps
    b = 0.25 * dt * dt
    give = np.linalg.inv(k + m / b)
    ahead = give @ m / b
    v, acc = np.zeros(size), np.zeros(size)
    body, body_v = np.array([z, pitch]), np.zeros(2)
    n, d = np.zeros((wheels, 4)), np.zeros((wheels, 4))
    first = np.zeros(wheels, dtype=np.int64)
    f = np.zeros(wheels)
    body_a = np.zeros(2)
    out, forces = np.empty(101), np.empty((101, wheels))
    out[0] = z
    every = steps // 100
    a_matrix, right = np.empty((wheels, wheels)), np.empty(wheels)
    for step in range(-1, steps):
        start = step < 0
        for i in range(wheels):
            along = (speed * dt * (step + 1) + arms[i] + overhang) / h
            e = min(max(int(along), 0), size // 2 - 2)
            first[i] = 2 * e
            n[i], d[i] = cubics(along - e, h), slopes(along - e, h)
            for j in held:
                if 2 * e <= j < 2 * e + 4:
                    n[i, j - 2 * e] = d[i, j - 2 * e] = 0.0
        if start:  # accelerations of the first instant
            load = -k @ u
            for i in range(wheels):
                part = u[first[i] : first[i] + 4]
                f[i] = spring * (body[0] + arms[i] * body[1] - n[i] @ part) - damper * speed * (d[i] @ part)
                load[first[i] : first[i] + 4] += n[i] * f[i]
            acc = np.linalg.solve(m, load)
            body_a[0], body_a[1] = gravity - f.sum() / mass, -(arms * f).sum() / inertia
            forces[0] = f
            continue
        guess = u + dt * v + b * acc
        rate = v + 0.5 * dt * acc
        new = ahead @ guess
        body_guess = body + dt * body_v + b * body_a
        body_rate = body_v + 0.5 * dt * body_a
        fall = np.array([body_guess[0] + b * gravity, body_guess[1]])
        new_v = rate + 2.0 / dt * (new - guess)
        fall_v = body_rate + 2.0 / dt * (fall - body_guess)
        for i in range(wheels):
            at = first[i]
            gap = fall[0] + arms[i] * fall[1] - n[i] @ new[at : at + 4]
            gap_v = fall_v[0] + arms[i] * fall_v[1] - n[i] @ new_v[at : at + 4] - speed * (d[i] @ new[at : at + 4])
            right[i] = spring * gap + damper * gap_v
            for j in range(wheels):
                square = give[at : at + 4, first[j] : first[j] + 4] @ n[j]
                together = b / mass + b * arms[i] * arms[j] / inertia + n[i] @ square
                a_matrix[i, j] = spring * together + damper * (2.0 / dt * together + speed * (d[i] @ square))
            a_matrix[i, i] += 1.0
        f = np.linalg.solve(a_matrix, right)
        for i in range(wheels):
            new += give[:, first[i] : first[i] + 4] @ n[i] * f[i]
        fall[0] -= b / mass * f.sum()
        fall[1] -= b / inertia * (arms * f).sum()
        acc, body_a = (new - guess) / b, (fall - body_guess) / b
        v, body_v = rate + 0.5 * dt * acc, body_rate + 0.5 * dt * body_a
        u, body = new, fall
        if (step + 1) % every == 0:
            out[(step + 1) // every], forces[(step + 1) // every] = body[0], f
    return out, forces


def beam_by_hand(beam, setting):
    cells, steps = setting
    h, held, k, m = beam.mesh(cells)
    z, pitch, u = beam.at_rest(k, h, held)
    return newmark(steps, beam.end, beam.speed, beam.overhang, h, np.array(held), k, m, beam.arms, beam.k, beam.c,
                   beam.mass, beam.inertia, beam.gravity, z, pitch, u)  # fmt: skip


def beam_by_scipy(beam, setting):
    """The lowest modes of a mesh, by solve_ivp."""
    method, rtol, count = setting
    h, held, k, m = beam.mesh(beam.coarse)
    squares, shapes = eigh(k, m)
    free = np.flatnonzero(np.abs(shapes[held]).max(axis=0) < 1e-9 * np.abs(shapes).max())[:count]
    squares, shapes = squares[free], shapes[:, free]
    z, pitch, u = beam.at_rest(k, h, held)
    start = np.concatenate([[z, pitch], shapes.T @ m @ u, np.zeros(2 + len(free))])

    def rate(t, s):
        q, v = s[: len(s) // 2], s[len(s) // 2 :]
        push = -squares * q[2:]
        fall, turn = beam.gravity, 0.0
        for a in beam.arms:
            n, d = (row @ shapes for row in beam.row(beam.speed * t + a, h, len(k), held))
            gap = q[0] + a * q[1] - n @ q[2:]
            gap_v = v[0] + a * v[1] - n @ v[2:] - beam.speed * (d @ q[2:])
            force = beam.k * gap + beam.c * gap_v
            push = push + n * force
            fall, turn = fall - force / beam.mass, turn - a * force / beam.inertia
        return np.concatenate([v, [fall, turn], push])

    times = np.linspace(0.0, beam.end, SAMPLES)
    run = solve_ivp(rate, (0.0, beam.end), start, method=method, rtol=rtol, atol=1e-4 * rtol, t_eval=times)
    return run.y[0] if run.success else np.full(SAMPLES, np.nan)


def exudyn(start, mass, load, matrices, steps, end):
    """GenericODE2 with stiffness and damping set before each step: matrices(t) -> (K, C)."""
    import exudyn as exu
    import exudyn.itemInterface as item

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    size = len(start)
    node = mbs.AddNode(
        item.NodeGenericODE2(
            referenceCoordinates=[0.0] * size,
            initialCoordinates=list(start),
            initialCoordinates_t=[0.0] * size,
            numberOfODE2Coordinates=size,
        )
    )
    k, c = matrices(0.0)
    body = mbs.AddObject(
        item.ObjectGenericODE2(
            nodeNumbers=[node], massMatrix=mass, stiffnessMatrix=k, dampingMatrix=c, forceVector=list(load)
        )
    )
    out = np.full(SAMPLES, np.nan)
    out[0] = start[0]
    every, h = steps // 100, end / steps

    def before(system, t):
        k, c = matrices(t)
        system.SetObjectParameter(body, "stiffnessMatrix", k)
        system.SetObjectParameter(body, "dampingMatrix", c)
        return True

    def after(system, t):
        n = round(t / h)
        if n % every == 0 and n // every < SAMPLES:
            out[n // every] = system.GetNodeOutput(node, exu.OutputVariableType.Coordinates)[0]
        return True

    mbs.SetPreStepUserFunction(before)
    mbs.SetPostStepUserFunction(after)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = end
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = False
    settings.solutionSettings.writeSolutionToFile = False
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
    return out


def train_by_exudyn(case, steps):
    def matrices(t):
        k = LEVERS.T @ np.linalg.solve(train_compliance(case.speed * t), LEVERS)
        return k, bogie.DAMPING / bogie.STIFFNESS * k

    return exudyn(train_start()[:8], MASS, PULL, matrices, steps, case.end)


def beam_by_exudyn(beam, setting):
    cells, steps = setting
    h, held, k, m = beam.mesh(cells)
    z, pitch, u = beam.at_rest(k, h, held)
    size = len(u) + 2
    mass, base = np.zeros((size, size)), np.zeros((size, size))
    mass[0, 0], mass[1, 1], mass[2:, 2:] = beam.mass, beam.inertia, m
    base[2:, 2:] = k

    def matrices(t):
        stiff, damp = base.copy(), np.zeros((size, size))
        for a in beam.arms:
            n, d = beam.row(beam.speed * t + a, h, len(u), held)
            gap = np.concatenate([[1.0, a], -n])
            stiff += np.outer(gap, beam.k * gap - np.concatenate([[0.0, 0.0], beam.c * beam.speed * d]))
            damp += beam.c * np.outer(gap, gap)
        return stiff, damp

    load = np.zeros(size)
    load[0] = beam.mass * beam.gravity
    return exudyn(np.concatenate([[z, pitch], u]), mass, load, matrices, steps, beam.end)
