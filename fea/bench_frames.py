#!/usr/bin/env python3
"""Unit loads on frames: girderway beside CHOLMOD, SuperLU, OpenSees and PyNite, in one run.

    apt-get install libsuitesparse-dev libopenblas0-serial
    python3 -m venv VENV && VENV/bin/pip install -r fea/requirements-bench.txt
    VENV/bin/python fea/bench_frames.py [--dir DIR] [--cargo ARGS] [--only NAME ...] [--quick] [--csv FILE]

Runs the example `frames` of the crate fea, which times girderway and writes its frames to DIR, and then the other
codes on the same frames and unit loads. Times are the least of three, in milliseconds, on one thread:

    girderway   from model to factor; grid of the factored frame, G = (L^-1 P)' (L^-1 P) with the loads inside members
    CHOLMOD     analyse and factor the assembled stiffness; solve for all loads, and G = P' X
    SuperLU     factor (MMD of A + A', symmetric mode); solve, and G = P' X
    OpenSees    first analysis, with numbering and factorisation (SparseSYM; UmfPack factors anew for each); the other load cases
    PyNite      one analysis of all load cases

Assembly is part of girderway's time, and stands apart for CHOLMOD and SuperLU, which get a matrix. OpenSees and
PyNite get their models built. Each code's grid is compared with girderway's; loads on one member have a local part
that the nodes do not show, so pairs on different members are compared.
"""

import os

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

import argparse
import csv
import pathlib
import subprocess
import time

import numpy as np
import scipy.sparse
from scipy.sparse.linalg import splu

CASES = ["runway-11", "runway-112", "runway-1122", "building-12", "building-26"]
LOADS = [41, 400]
# Most freedoms: PyNite and OpenSees take minutes beyond, SuperLU the memory of a large machine.
PYNITE, OPENSEES, SUPERLU = 1e4, 1e5, 9.9e4
# No third repetition after so many seconds.
PATIENCE = 20.0


def table(path):
    return np.atleast_2d(np.loadtxt(path, delimiter=","))


class Frame:
    """A frame as written by the example, its matrix and its loads."""

    def __init__(self, folder):
        self.points = table(folder / "points.csv")
        members = table(folder / "members.csv")
        self.ends = members[:, :2].astype(int)
        self.section = members[:, 2].astype(int)
        self.sections = table(folder / "sections.csv")
        self.held = table(folder / "supports.csv").astype(int).ravel()
        along = self.points[self.ends[:, 1]] - self.points[self.ends[:, 0]]
        self.length = np.linalg.norm(along, axis=1)
        x = along / self.length[:, None]
        y = members[:, 3:] - x * np.einsum("ij,ij->i", x, members[:, 3:])[:, None]
        y /= np.linalg.norm(y, axis=1)[:, None]
        self.axes = np.stack([x, y, np.cross(x, y)], axis=1)
        free = np.ones(6 * len(self.points), dtype=bool)
        free[(6 * self.held[:, None] + np.arange(6)).ravel()] = False
        self.free = np.flatnonzero(free)

    def turn(self, members):
        """12 x 12 rotations to local axes."""
        t = np.zeros((len(members), 12, 12))
        for k in range(4):
            t[:, 3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = self.axes[members]
        return t

    def freedoms(self, members):
        return (6 * self.ends[members][:, :, None] + np.arange(6)).reshape(len(members), 12)

    def stiffness(self):
        """Assembled stiffness of the free motions."""
        e, g, a, iy, iz, j = self.sections[self.section].T
        length, k = self.length, np.zeros((len(self.length), 12, 12))
        for at, value in ((0, e * a / length), (3, g * j / length)):
            k[:, at, at] = k[:, at + 6, at + 6] = value
            k[:, at, at + 6] = k[:, at + 6, at] = -value
        for across, turn, sign, i in ((1, 5, 1.0, iz), (2, 4, -1.0, iy)):
            r = e * i / length**3
            p, q, s, half = 12.0 * r, sign * 6.0 * length * r, 4.0 * length**2 * r, 2.0 * length**2 * r
            at = [across, turn, across + 6, turn + 6]
            block = [[p, q, -p, q], [q, s, -q, half], [-p, -q, p, -q], [q, half, -q, s]]
            for u in range(4):
                for v in range(4):
                    k[:, at[u], at[v]] = block[u][v]
        everyone = np.arange(len(length))
        t = self.turn(everyone)
        k = np.einsum("mji,mjk,mkl->mil", t, k, t, optimize=True)
        dofs = self.freedoms(everyone)
        rows, columns = np.repeat(dofs, 12, axis=1).ravel(), np.tile(dofs, (1, 12)).ravel()
        n = 6 * len(self.points)
        whole = scipy.sparse.coo_matrix((k.ravel(), (rows, columns)), shape=(n, n)).tocsc()
        return whole[self.free][:, self.free].tocsc()

    def loads(self, path):
        """Unit loads at their members' ends: members, and 12 global forces each."""
        data = table(path)
        members, s = data[:, 0].astype(int), data[:, 1]
        length, axes = self.length[members], self.axes[members]
        force = np.einsum("mij,mj->mi", axes, data[:, 5:])
        moment = np.einsum("mij,mj->mi", axes, np.cross(data[:, 2:5], data[:, 5:]))
        p = np.zeros((len(members), 12))
        for k, value in ((0, force[:, 0]), (3, moment[:, 0])):
            p[:, k], p[:, k + 6] = (1.0 - s) * value, s * value
        shapes = [1 - 3 * s**2 + 2 * s**3, length * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3, length * (s**3 - s**2)]
        slopes = [(6 * s**2 - 6 * s) / length, 1 - 4 * s + 3 * s**2, (6 * s - 6 * s**2) / length, 3 * s**2 - 2 * s]
        for across, turn, sign in ((1, 5, 1.0), (2, 4, -1.0)):
            for at, shape, slope in zip([across, turn, across + 6, turn + 6], shapes, slopes):
                # In x-z a rotation about y is minus the slope.
                own = sign if at % 6 == turn else 1.0
                p[:, at] += own * (shape * force[:, across] + sign * slope * moment[:, turn - 3])
        return members, np.einsum("mji,mj->mi", self.turn(members), p)

    def columns(self, members, forces):
        """The loads as sparse columns over the free motions."""
        n = 6 * len(self.points)
        dofs = self.freedoms(members)
        at = (dofs.ravel(), np.repeat(np.arange(len(members)), 12))
        return scipy.sparse.coo_matrix((forces.ravel(), at), shape=(n, len(members))).tocsc()[self.free].tocsc()


def least(job):
    """Least time of up to three runs of a job that gives its stages' seconds and a result."""
    best, spent = None, 0.0
    for _ in range(3):
        start = time.perf_counter()
        times, result = job()
        spent += time.perf_counter() - start
        best = times if best is None else [min(a, b) for a, b in zip(best, times)]
        if spent > PATIENCE:
            break
    return [1e3 * t for t in best], result


def cholmod(k, p):
    from sksparse.cholmod import analyze

    def job():
        start = time.perf_counter()
        factor = analyze(k)
        factor.cholesky_inplace(k)
        middle = time.perf_counter()
        grid = p.T @ factor(p.toarray())
        return [middle - start, time.perf_counter() - middle], grid

    return least(job)


def superlu(k, p):
    def job():
        start = time.perf_counter()
        factor = splu(k, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}, diag_pivot_thresh=0.0)
        middle = time.perf_counter()
        grid = p.T @ factor.solve(p.toarray())
        return [middle - start, time.perf_counter() - middle], grid

    return least(job)


def opensees(frame, members, forces):
    from opensees_frame import load

    ops = load()
    parts = forces.reshape(-1, 2, 6)
    ends = frame.ends[members]
    nodes = np.unique(ends)
    column = {int(node): k for k, node in enumerate(nodes)}
    at = np.array([[column[int(n)] for n in pair] for pair in ends])

    def job():
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6)
        for k, point in enumerate(frame.points):
            ops.node(k + 1, *map(float, point))
        for k in frame.held:
            ops.fix(int(k) + 1, *[1] * 6)
        for k, (a, b) in enumerate(frame.ends):
            e, g, area, iy, iz, j = map(float, frame.sections[frame.section[k]])
            ops.geomTransf("Linear", k + 1, *map(float, frame.axes[k][2]))
            ops.element("elasticBeamColumn", k + 1, int(a) + 1, int(b) + 1, area, e, g, j, iy, iz, k + 1)
        ops.constraints("Plain")
        ops.numberer("RCM")
        ops.system("SparseSYM")
        ops.integrator("LoadControl", 1.0)
        ops.algorithm("Linear", "-factorOnce")
        # A load case is what acts at its step: patterns that come and go would factor anew.
        for k, (pair, part) in enumerate(zip(ends, parts)):
            ops.timeSeries("Rectangular", k + 1, k + 0.5, k + 1.5)
            ops.pattern("Plain", k + 1, k + 1)
            for node, force in zip(pair, part):
                ops.load(int(node) + 1, *map(float, force))
        ops.analysis("Static")
        times, grid = [0.0, 0.0], np.zeros((len(members), len(members)))
        for k in range(len(members)):
            start = time.perf_counter()
            if ops.analyze(1) != 0:
                raise RuntimeError("OpenSees cannot solve the system")
            u = np.array([ops.nodeDisp(int(node) + 1) for node in nodes])
            times[k > 0] += time.perf_counter() - start
            grid[:, k] = np.einsum("lij,lij->l", parts, u[at])
        return times, grid

    return least(job)


def pynite(frame, members, forces):
    from Pynite import FEModel3D

    directions = ["FX", "FY", "FZ", "MX", "MY", "MZ"]
    parts = forces.reshape(-1, 2, 6)
    ends = frame.ends[members]

    def job():
        model = FEModel3D()
        for k, point in enumerate(frame.points):
            model.add_node(f"N{k}", *map(float, point))
        for k in frame.held:
            model.def_support(f"N{k}", *[True] * 6)
        for k, (e, g, area, iy, iz, j) in enumerate(frame.sections):
            model.add_material(f"S{k}", e, g, 0.3, 0.0)
            model.add_section(f"S{k}", area, iy, iz, j)
        for k, (a, b) in enumerate(frame.ends):
            name = f"S{frame.section[k]}"
            model.add_member(f"M{k}", f"N{a}", f"N{b}", name, name)
            own = model.members[f"M{k}"].T()[:3, :3]
            angle = np.degrees(np.arctan2(frame.axes[k][1] @ own[2], frame.axes[k][1] @ own[1]))
            model.members[f"M{k}"].rotation = float(angle)
        for case, (pair, part) in enumerate(zip(ends, parts)):
            for node, force in zip(pair, part):
                for direction, value in zip(directions, force):
                    if value != 0.0:
                        model.add_node_load(f"N{node}", direction, float(value), f"C{case}")
            model.add_load_combo(f"C{case}", {f"C{case}": 1.0})
        start = time.perf_counter()
        model.analyze_linear(check_stability=False, sparse=True)
        spent = time.perf_counter() - start
        grid = np.zeros((len(members), len(members)))
        for case in range(len(members)):
            for k, pair in enumerate(ends):
                nodes = [model.nodes[f"N{node}"] for node in pair]
                u = [[getattr(n, d)[f"C{case}"] for d in ("DX", "DY", "DZ", "RX", "RY", "RZ")] for n in nodes]
                grid[k, case] = np.sum(parts[k] * np.array(u))
        return [spent], grid

    return least(job)


def compare(frame, folder, count, limits):
    """One line a code: its name, stages in milliseconds, total by girderway's, difference of grids."""
    ours = table(folder / f"times-{count}.csv")[0]
    yield "girderway", ours, None
    start = time.perf_counter()
    k = frame.stiffness()
    assembly = 1e3 * (time.perf_counter() - start)
    members, forces = frame.loads(folder / f"loads-{count}.csv")
    p = frame.columns(members, forces)
    size = k.shape[0]
    jobs = [("CHOLMOD", lambda: cholmod(k, p), 1e9), ("SuperLU", lambda: superlu(k, p), limits[2])]
    if count == LOADS[0]:
        jobs.append(("OpenSees", lambda: opensees(frame, members, forces), limits[1]))
        jobs.append(("PyNite", lambda: pynite(frame, members, forces), limits[0]))
    check = folder / f"grid-{count}.csv"
    known = table(check) if check.exists() else None
    for name, job, most in jobs:
        if size > most:
            yield name, f"left out beyond {most:.0f} freedoms", None
            continue
        try:
            times, grid = job()
        except (ImportError, RuntimeError, MemoryError) as error:
            yield name, f"not run: {error}", None
            continue
        apart = None
        if known is not None:
            i, j = known[:, 0].astype(int), known[:, 1].astype(int)
            scale = np.sqrt(np.abs(grid[i, i] * grid[j, j]))
            apart = float(np.max(np.abs(grid[i, j] - known[:, 2]) / scale))
        yield name, times, apart
    yield "assembly for CHOLMOD, SuperLU", [assembly], None


def blas():
    """The libraries that CHOLMOD has loaded for dense work."""
    try:
        import sksparse.cholmod  # noqa: F401

        maps = pathlib.Path("/proc/self/maps").read_text()
    except (ImportError, OSError):
        return "unknown"
    names = {line.split()[-1] for line in maps.splitlines() if "/" in line}
    found = sorted(n for n in names if "blas" in n.lower() and "site-packages" not in n)
    return ", ".join(found) or "unknown"


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--dir", type=pathlib.Path, default=pathlib.Path("target/frames"))
    options.add_argument("--cargo", default="run --release --quiet -p girderway-fea --example frames --")
    options.add_argument("--only", nargs="+", default=CASES, choices=CASES)
    options.add_argument("--quick", action="store_true", help="CHOLMOD and SuperLU alone")
    options.add_argument("--csv", type=pathlib.Path, help="also write all totals there, as docs/frames.csv has them")
    args = options.parse_args()
    rows = []
    limits = (0.0, 0.0, SUPERLU) if args.quick else (PYNITE, OPENSEES, SUPERLU)
    print(f"one thread, least of three, ms; CHOLMOD's BLAS: {blas()}")
    for name in args.only:
        subprocess.run(["cargo", *args.cargo.split(), str(args.dir), name], check=True)
        folder = args.dir / name
        frame = Frame(folder)
        for count in LOADS:
            print(f"\n{name}: {len(frame.free)} freedoms, {count} unit loads")
            print(f"{'':30}{'factor':>12}{'solve':>12}{'total':>12}{'girderway is':>14}{'grids differ':>14}")
            for code, times, apart in compare(frame, folder, count, limits):
                if isinstance(times, str):
                    print(f"{code:30}{times}")
                    continue
                total = sum(times)
                if not code.startswith("assembly"):
                    rows.append((name.split("-")[0], len(frame.free), count, code, f"{total:.3g}"))
                stages = "".join(f"{t:12.2f}" for t in times) if len(times) == 2 else " " * 24
                if code == "girderway":
                    own = total
                ratio = "" if code == "girderway" or code.startswith("assembly") else f"{own / total:14.3f}"
                difference = "" if apart is None else f"{apart:14.1e}"
                print(f"{code:30}{stages}{total:12.2f}{ratio}{difference}", flush=True)
    if args.csv:
        with args.csv.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([("frame", "freedoms", "loads", "code", "ms"), *rows])


if __name__ == "__main__":
    main()
