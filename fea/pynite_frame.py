#!/usr/bin/env python3
"""Influence grids of a frame by PyNite. See frame_model.py for what goes in and out.

PyNite gives the members: axes, stiffness, releases, assembly, springs. It has no rigid parts; its assembled
stiffness K is reduced with their exact kinematics, u = T q, and T' K T q = T' p is solved for all unit loads.
It has no shear deformation: refused where the beams shear. Under a preload its geometric stiffness of beams cut into
parts is added, with axial forces found by iteration.
"""

import importlib.metadata
import math

import numpy as np
from Pynite import Analysis, FEModel3D
from scipy import sparse
from scipy.sparse.linalg import splu

import frame_model
from frame_model import Refused

# Most steps to the axial forces of a preload.
STEPS = 40
# Tolerance about a loaded state: cubic elements with their geometric stiffness, order 4.
LOADED = 1e-5


def rotation(model, name, axes):
    """Turns PyNite's member about its axis until its local y is ours."""
    own = model.members[name].T()[:3, :3]
    return math.degrees(math.atan2(axes[1] @ own[2], axes[1] @ own[1]))


def stiffness(frame):
    """PyNite's global stiffness matrix, six freedoms a node, and its members."""
    model = FEModel3D()
    for k, position in enumerate(frame.position):
        model.add_node(f"N{k}", *(float(x) for x in position))
    for k, member in enumerate(frame.members):
        s, name = member.section, f"M{k}"
        beam, held = member.kind == "beam", member.active()[0]
        e, g = s["E"], s["G"] or s["E"]
        model.add_material(name, e, g, 0.3, 0.0)
        area = s["A"] if beam or held[0] else 0.0
        bending = (s["Iy"], s["Iz"]) if beam else (0.0, 0.0)
        model.add_section(name, area, *bending, s["J"] if beam or held[3] else 0.0)
        model.add_member(name, *(f"N{node}" for node in member.nodes), name, name)
        model.members[name].rotation = rotation(model, name, member.axes)
        if member.releases.any() and beam:
            model.def_releases(name, *(bool(r) for r in member.releases.ravel()))
    for node, freedom, k in frame.springs:
        dof = ["DX", "DY", "DZ", "RX", "RY", "RZ"][freedom]
        held = getattr(model.nodes[f"N{node}"], f"spring_{dof}")[0] or 0.0
        model.def_support_spring(f"N{node}", dof, held + k)
    Analysis._prepare_model(model)
    turned = [m for p in model.members.values() for m in p.sub_members.values()]
    for member, ours in zip(turned, frame.members):
        if np.abs(member.T()[:3, :3] - ours.axes).max() > 1e-8:
            raise Refused("PyNite turns a member's axes in another way than asked")
    order = [model.nodes[f"N{k}"].ID for k in range(len(frame.position))]
    if order != list(range(len(order))):
        raise Refused("PyNite has numbered the nodes in another order")
    return model.Ke(check_stability=False, sparse=True).tocsc(), turned


def kinematics(frame):
    """T: motions of all nodes by the free motions of the bodies."""
    rows = {}
    for node, freedom in frame.fixed:
        rows.setdefault(frame.body[node], []).append(frame.arm(node)[freedom])
    for body, axis in frame.idle:
        rows.setdefault(body, []).append(np.concatenate([np.zeros(3), axis]))
    free, start = [], [0]
    for body in range(len(frame.root)):
        basis = np.eye(6)
        held = np.array(rows.get(body, np.zeros((0, 6))))
        if len(held):
            if np.all(np.count_nonzero(held, axis=1) == 1):
                basis = np.delete(basis, np.argmax(np.abs(held), axis=1), axis=1)
            else:
                scale = np.diag([1.0] * 3 + [1.0 / frame.reach(body)] * 3)
                _, _, vt = np.linalg.svd(held @ scale)
                basis = scale @ vt[len(held) :].T
        free.append(basis)
        start.append(start[-1] + basis.shape[1])
    entries = ([], [], [])
    for node, body in enumerate(frame.body):
        block = frame.arm(node) @ free[body]
        for i, j in zip(*np.nonzero(block)):
            for to, value in zip(entries, (block[i, j], 6 * node + i, start[body] + j)):
                to.append(value)
    shape = (6 * len(frame.position), start[-1])
    return sparse.coo_matrix((entries[0], (entries[1], entries[2])), shape=shape).tocsc()


def geometric(frame, k, turned, t):
    """PyNite's geometric stiffness by the axial forces of the preload, found by iteration."""
    if any(np.any(frame.reach_of(node) > 0.0) for m in frame.members for node in m.nodes):
        raise Refused("PyNite has no forces on rigid arms")
    force = np.zeros(t.shape[0])
    for node, own, moment in frame.preload_forces():
        force[6 * node : 6 * node + 6] += np.concatenate([own, moment])
    tension = np.full(len(turned), 1e-3 * np.abs(force).sum())
    for _ in range(STEPS):
        kg = sum_of(frame, turned, tension)
        reduced = (t.T @ (k + kg) @ t).tocsc()
        moved = t @ splu(reduced).solve(t.T @ force)
        found = np.array([axial(member, ours, moved) for member, ours in zip(turned, frame.members)])
        change, tension = np.abs(found - tension).max(), found
        if change <= 1e-11 * np.abs(tension).max():
            return sum_of(frame, turned, tension)
    raise Refused("the axial forces of the preload do not settle in PyNite")


def axial(member, ours, moved):
    """Tension of a member in a motion of the nodes."""
    a, b = (moved[6 * node : 6 * node + 3] for node in ours.nodes)
    return ours.section["E"] * ours.section["A"] / member.L() * (ours.axes[0] @ (b - a)) if ours.active()[0][0] else 0.0


def sum_of(frame, turned, tension):
    size = 6 * len(frame.position)
    entries = ([], [], [])
    for member, ours, n in zip(turned, frame.members, tension):
        local = np.array(member.kg(n), dtype=float)
        # A term along the axis, N/L beside EA/L, which our theory does not have.
        local[[0, 6], :] = local[:, [0, 6]] = 0.0
        own = member.T().T @ local @ member.T()
        if ours.kind != "beam":
            # A bar is a string, whatever PyNite's beam does.
            string = n / member.L() * (np.eye(3) - np.outer(ours.axes[0], ours.axes[0]))
            own = np.zeros((12, 12))
            own[:3, :3] = own[6:9, 6:9] = string
            own[:3, 6:9] = own[6:9, :3] = -string
        places = [6 * node + f for node in ours.nodes for f in range(6)]
        for i, a in enumerate(places):
            for j, b in enumerate(places):
                for to, value in zip(entries, (own[i, j], a, b)):
                    to.append(value)
    return sparse.coo_matrix((entries[0], (entries[1], entries[2])), shape=(size, size)).tocsc()


def solve(frame):
    if frame.sheared and any("Asy" in m.section or "Asz" in m.section for m in frame.members):
        raise Refused("PyNite has no shear deformation")
    (k, turned), t = stiffness(frame), kinematics(frame)
    if frame.preload:
        k = k + geometric(frame, k, turned, t)
    loads = np.zeros((t.shape[0], 3 * len(frame.heads)))
    for head, direction, node, force in frame.unit_loads():
        loads[6 * node : 6 * node + 3, 3 * head + direction] = force
    reduced = (t.T @ k @ t).tocsc()
    diagonal = np.sqrt(reduced.diagonal())
    if not np.all(diagonal > 0.0):
        raise Refused("PyNite finds a freedom without stiffness")
    scaling = sparse.diags(1.0 / diagonal)
    factor = splu((scaling @ reduced @ scaling).tocsc())
    found = t @ (scaling @ factor.solve(scaling @ (t.T @ loads)))
    at = np.array([[6 * node + k for k in range(3)] for _, node, _ in frame.heads])
    motion = found[at].transpose(2, 0, 1)
    versions = {"PyNite": importlib.metadata.version("PyNiteFEA"), "numpy": np.__version__}
    tolerance = LOADED if frame.preload else None
    return frame.answer(motion, versions, "Member3D, rigid parts by exact kinematics", (), tolerance)


if __name__ == "__main__":
    frame_model.serve(solve)
