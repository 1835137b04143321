#!/usr/bin/env python3
"""Influence grids of a frame by OpenSees. See frame_model.py for what goes in and out.

    beams       elasticBeamColumn; ElasticTimoshenkoBeam where they shear
    trusses     Truss with an elastic material
    preload     PDelta transformation of beams cut into parts, corotTruss; unit loads are small steps from its state
    rods        twoNodeLink with E A / L and G J / L; springs about axes of rotation that nothing else resists
    rigid       rigidLink beam from the root of a body to each of its other nodes
    supports    fix;  springs  zeroLength to a fixed node
    constraints by transformation, exact; as Lagrange multipliers, exact too, where a body is supported at a node
                that is not its root, or in part while other nodes follow it
    releases    a node of its own at the member's end, tied to the body in what is not released: by equalDOF, exact,
                where the end is the body's root and the axes allow it; otherwise by zeroLength springs of a number
                of TIES times the member's own stiffness. They err by the inverse of that number, and stiffer ones by
                rounding; so the frame is solved with both, and the error is extrapolated away

All 3 n unit loads act on nodes at the rail heads and are solved with one factorisation.
"""

import ctypes
import importlib.util
import pathlib

import numpy as np

import frame_model
from frame_model import Refused

# Stiffness of ties by that of their member.
TIES = 1e4, 1e5
# Size of the unit loads about a loaded state, by the largest force of the preload.
STEP = 1e-6
# Stress of bars before the preload, by its largest force.
HINT = 1e-6
# Tolerance about a loaded state: axial forces at the chord of each part, order 2, at critical factors above two.
LOADED = 5e-3
# Shear area, by area, of a beam that is rigid in shear in one direction alone.
RIGID = 1e20
LIBRARIES = ["libquadmath.so.0", "libgfortran.so.4", "libgomp.so.1", "libblas.so.3", "liblapack.so.3"]


def load():
    """OpenSees; its Linux wheel carries libraries that the loader does not look for beside it."""
    found = importlib.util.find_spec("openseespylinux")
    for folder in found.submodule_search_locations if found else []:
        for name in LIBRARIES:
            path = pathlib.Path(folder) / "lib" / name
            if path.exists():
                try:
                    ctypes.CDLL(str(path), mode=ctypes.RTLD_GLOBAL)
                except OSError:
                    pass  # The import below says what is missing.
    try:
        import openseespy.opensees as ops
    except ModuleNotFoundError as error:
        raise Refused(f"OpenSees is not installed: {error}") from error
    except (ImportError, RuntimeError) as error:
        reason = error.__cause__ or error.__context__ or error
        hint = "on Debian: apt-get install libblas3 liblapack3 libgfortran5 libgomp1"
        raise Refused(f"OpenSees cannot be loaded: {reason} ({hint})") from error
    return ops


class Model:
    """The frame in OpenSees; tags count from 1."""

    def __init__(self, ops, frame, tie):
        self.ops, self.frame, self.tie, self.ties = ops, frame, tie, []
        self.move_roots()
        self.plain = self.transforms()
        self.nodes = self.elements = self.materials = 0
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6)
        for position in frame.position:
            self.node(position)
        for node, body in enumerate(frame.body):
            root = frame.root[body]
            if node != root:
                ops.rigidLink("beam", root + 1, node + 1)
        for member in frame.members:
            self.member(member)
        for node, freedom, k in frame.springs:
            ground = self.node(frame.position[node])
            ops.fix(ground, *[1] * 6)
            self.spring(ground, node + 1, {freedom: k})
        held = {}
        for node, freedom in frame.fixed:
            held.setdefault(node, [0] * 6)[freedom] = 1
        for node, fix in held.items():
            ops.fix(node + 1, *fix)
        for body, axis in frame.idle:
            # No load turns the body about this axis: any stiffness will do.
            root = frame.root[body]
            ground = self.node(frame.position[root])
            ops.fix(ground, *[1] * 6)
            across = np.eye(3)[np.argmin(np.abs(axis))]
            self.spring(ground, root + 1, {3: self.turning()}, frame_model.triad(axis, across))

    def node(self, position):
        self.nodes += 1
        self.ops.node(self.nodes, *(float(x) for x in position))
        return self.nodes

    def spring(self, a, b, stiffness, axes=np.eye(3)):
        """zeroLength springs, stiffness by freedom, along axes."""
        tags = []
        for k in stiffness.values():
            self.materials += 1
            self.ops.uniaxialMaterial("Elastic", self.materials, float(k))
            tags.append(self.materials)
        self.elements += 1
        directions = [freedom + 1 for freedom in stiffness]
        orient = [float(v) for v in [*axes[0], *axes[1]]]
        self.ops.element("zeroLength", self.elements, a, b, "-mat", *tags, "-dir", *directions, "-orient", *orient)

    def end(self, member, end):
        """The node at an end of a member: the body's, or one that its releases let go."""
        node = member.nodes[end]
        released = member.releases[end]
        if not released.any():
            return node + 1
        own = self.node(self.frame.position[node])
        stiff = member_stiffness(member)
        aligned = np.all(np.count_nonzero(np.abs(member.axes) > 1e-12, axis=1) == 1)
        at_root = self.plain and node == self.frame.root[self.frame.body[node]]
        exact, springs = [], {}
        for group in ([0, 1, 2], [3, 4, 5]):
            tied = [k for k in group if not released[k]]
            if at_root and len(tied) == 3:
                exact += group
            elif at_root and aligned:
                exact += [group[0] + int(np.argmax(np.abs(member.axes[k % 3]))) for k in tied]
            else:
                springs.update({k: self.tie * stiff[k] for k in tied})
        if exact:
            # One call: a second one for the same node would not be seen.
            self.ops.equalDOF(node + 1, own, *(k + 1 for k in exact))
        if springs:
            self.spring(node + 1, own, springs, member.axes)
            self.ties.append(springs)
        return own

    def transforms(self):
        """Transformation takes supports at roots alone, and errs where a root with followers is held in part."""
        frame, held = self.frame, {}
        for node, freedom in frame.fixed:
            held.setdefault(node, set()).add(freedom)
        followed = {body for node, body in enumerate(frame.body) if node != frame.root[body]}
        return all(
            node == frame.root[frame.body[node]] and (len(fix) == 6 or frame.body[node] not in followed)
            for node, fix in held.items()
        )

    def turning(self):
        """A stiffness of rotation of the size that members have."""
        rods = [m for m in self.frame.members if m.kind == "rod"]
        return max((m.section["G"] * m.section["J"] / m.whole for m in rods), default=1.0)

    def move_roots(self):
        """Roots at released ends, where nothing else needs them: ties there are exact."""
        frame = self.frame
        held = {frame.body[node] for node, _ in frame.fixed}
        for member in frame.members:
            for node, released in zip(member.nodes, member.releases):
                body = frame.body[node]
                if released.any() and body not in held:
                    frame.root[body] = node
                    held.add(body)

    def member(self, member):
        ops, s = self.ops, member.section
        if member.kind == "rod":
            self.rod(member)
            return
        a, b = self.end(member, 0), self.end(member, 1)
        self.elements += 1
        tag = self.elements
        if member.kind in ("truss", "cable"):
            self.materials += 1
            ops.uniaxialMaterial("Elastic", self.materials, float(s["E"]))
            kind, material = "Truss", self.materials
            if self.frame.preload:
                # Without any tension the first step of a hanger would be that of a mechanism.
                largest = max(np.linalg.norm(force) for _, force, _ in self.frame.preload_forces())
                self.materials += 1
                ops.uniaxialMaterial("InitStressMaterial", self.materials, material, float(HINT * largest / s["A"]))
                kind, material = "corotTruss", self.materials
            ops.element(kind, tag, a, b, float(s["A"]), material)
            return
        ops.geomTransf("PDelta" if self.frame.preload else "Linear", tag, *(float(v) for v in member.axes[2]))
        numbers = [float(s[k]) for k in ("A", "E", "G", "J", "Iy", "Iz")]
        if "Asy" in s or "Asz" in s:
            area, e, g, j, iy, iz = numbers
            shear = [float(s.get(key, RIGID * area)) for key in ("Asy", "Asz")]
            ops.element("ElasticTimoshenkoBeam", tag, a, b, e, g, area, j, iy, iz, *shear, tag)
        else:
            ops.element("elasticBeamColumn", tag, a, b, *numbers, tag)

    def rod(self, member):
        """Springs along and about the axis between its nodes."""
        s = member.section
        stiffness = {0: s["E"] * s["A"] / member.whole, 3: s["G"] * s["J"] / member.whole}
        tags, directions = [], []
        for freedom in np.flatnonzero(member.active()[0]):
            self.materials += 1
            self.ops.uniaxialMaterial("Elastic", self.materials, float(stiffness[freedom]))
            tags.append(self.materials)
            directions.append(int(freedom) + 1)
        if tags:
            self.elements += 1
            a, b = (node + 1 for node in member.nodes)
            orient = [float(v) for v in member.axes[:2].ravel()]
            self.ops.element("twoNodeLink", self.elements, a, b, "-mat", *tags, "-dir", *directions, "-orient", *orient)

    def solve(self):
        """Displacements of the heads: unit load (3 head + direction) x head x 3."""
        ops, frame = self.ops, self.frame
        ops.constraints("Transformation" if self.plain else "Lagrange")
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.timeSeries("Constant", 1)
        base, size = self.load_first(), 1.0
        if frame.preload:
            # So small that the state does not change.
            size = STEP * max(np.linalg.norm(force) for _, force, _ in frame.preload_forces())
        ops.integrator("LoadControl", 1.0)
        if frame.preload:
            # The tangent of PDelta is not exact.
            ops.test("FixedNumIter", 4)
            ops.algorithm("Newton")
        else:
            ops.algorithm("Linear", "-factorOnce")
        ops.analysis("Static")
        motion = np.zeros((3 * len(frame.heads), len(frame.heads), 3))
        for head, direction, node, force in frame.unit_loads():
            ops.pattern("Plain", 1, 1)
            ops.load(node + 1, *(float(size * f) for f in force), 0.0, 0.0, 0.0)
            if ops.analyze(1) != 0:
                raise Refused("OpenSees cannot solve the system")
            for k, (_, other, _) in enumerate(frame.heads):
                moved = np.array([ops.nodeDisp(other + 1, d) for d in (1, 2, 3)])
                motion[3 * head + direction, k] = (moved - base[k]) / size
            ops.remove("loadPattern", 1)
        return motion

    def load_first(self):
        """Displacements of the heads under the preload, which stays; zeros without one."""
        ops, frame = self.ops, self.frame
        if not frame.preload:
            return np.zeros((len(frame.heads), 3))
        ops.timeSeries("Linear", 2)
        ops.pattern("Plain", 2, 2)
        for node, force, moment in frame.preload_forces():
            ops.load(node + 1, *(float(f) for f in [*force, *moment]))
        ops.test("NormDispIncr", 1e-13, 50)
        ops.algorithm("Newton")
        ops.integrator("LoadControl", 1.0)
        ops.analysis("Static")
        if ops.analyze(1) != 0:
            raise Refused("OpenSees finds no state under the preload")
        ops.loadConst("-time", 0.0)
        ops.wipeAnalysis()
        ops.constraints("Transformation" if self.plain else "Lagrange")
        ops.numberer("RCM")
        ops.system("UmfPack")
        return np.array([[ops.nodeDisp(node + 1, d) for d in (1, 2, 3)] for _, node, _ in frame.heads])


def member_stiffness(member):
    """Size of a cell's stiffness in each local freedom of an end; its pieces are stiffer, and ties need not be."""
    s, length = member.section, member.whole
    bending = [12.0 * s["E"] * s[key] / length**3 for key in ("Iz", "Iy")]
    turning = [4.0 * s["E"] * s[key] / length for key in ("Iy", "Iz")]
    return [s["E"] * s["A"] / length, *bending, s["G"] * s["J"] / length, *turning]


def solve(frame):
    ops = load()
    if frame.preload and any(m.kind == "rod" for m in frame.members):
        raise Refused("OpenSees has no rods under axial force")
    model = Model(ops, frame, TIES[0])
    motion, notes = model.solve(), []
    if model.ties:
        stiffer = Model(ops, frame, TIES[1]).solve()
        motion = (TIES[1] * stiffer - TIES[0] * motion) / (TIES[1] - TIES[0])
        count = sum(len(ties) for ties in model.ties)
        notes = [f"{count} directions at {len(model.ties)} released ends are tied by springs, extrapolated to rigid"]
    sheared = any("Asy" in m.section or "Asz" in m.section for m in frame.members)
    beams = "ElasticTimoshenkoBeam" if sheared else "elasticBeamColumn"
    versions = {"OpenSees": ops.version(), "numpy": np.__version__}
    about = ", PDelta about the preload" if frame.preload else ""
    tolerance = LOADED if frame.preload else None
    if frame.preload:
        notes.append("no couplings with the longitudinal direction: there it adds what a load's axial force does on the deflected shape")
    answer = frame.answer(motion, versions, f"{beams}, rigidLink{about}", notes, tolerance)
    if frame.preload:
        answer["influence"] = {name: grid for name, grid in answer["influence"].items() if "_longitudinal" not in name}
    return answer


if __name__ == "__main__":
    frame_model.serve(solve)
