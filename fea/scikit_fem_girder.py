#!/usr/bin/env python3
"""Influence grids of a straight girder over its supports, by scikit-fem.

Reads one JSON object on standard input, writes one on standard output.

Input: spans, overhangs [left, right], stations (0 at the first support), rail_height, and the stiffnesses
EA, EI_vertical, EI_lateral, GJ, kGA_vertical, kGA_lateral; null where unknown. A shear stiffness of null is a
beam that is rigid in shear. Every support holds the deflections and the twist, the first also the length.

Output: versions, elements, notes, the indices of the stations compared, and influence: six n x n grids between those
(row: deflection, column: load), null where a stiffness that they need is unknown.

    Euler-Bernoulli bending   integral EI v'' q''                                     ElementLineHermite
    Timoshenko bending        integral EI t' s' + kGA (v' - t)(q' - s)                ElementLinePp(3), ElementLineP2
    torsion, length           integral GJ p' q',  integral EA u' q'                   ElementLineP1

Loads act at nodes, and between nodes the exact solution lies in the finite element space: cubic v, quadratic
rotation t, linear twist p and length u. So the finite element solution is the exact one, up to rounding, at
every point. Nodes lie at ends, supports and a few loaded stations at a time, since many short elements would
cost digits; results are read at all stations by evaluating the elements.

The rail is rigidly connected at rail_height h above the axis, y up and z = x cross y:

    vertical rail deflection v,  lateral w + h p,  longitudinal u - h v'
    and a longitudinal rail load P is a force P with a moment -h P, a lateral one a force P with a torque h P.
"""

import json
import sys

import numpy as np
import scipy
import skfem
from scipy.linalg import solve
from skfem.helpers import dd, ddot, grad

# Loaded stations a mesh.
GROUP = 12
# Least distance of a station from ends and supports, by the length of the girder: shorter elements cost digits.
NEAREST = 1.0 / 200.0


class Layout:
    """Supports, ends and stations along the girder; stations at a support up to rounding are put on it."""

    def __init__(self, data):
        self.supports = np.concatenate([[0.0], np.cumsum(data["spans"])])
        left, right = data["overhangs"]
        self.ends = np.array([-left, self.supports[-1] + right])
        self.stations = np.array(data["stations"], dtype=float)
        close = 1e-12 * (self.ends[1] - self.ends[0])
        for fixed in np.concatenate([self.ends, self.supports]):
            self.stations[np.abs(self.stations - fixed) <= close] = fixed
        apart = np.abs(self.stations[:, None] - np.concatenate([self.ends, self.supports])).min(axis=1)
        self.chosen = np.flatnonzero((apart == 0.0) | (apart >= NEAREST * (self.ends[1] - self.ends[0])))
        self.notes = []
        if len(self.chosen) < len(self.stations):
            self.notes.append(f"compared at {len(self.chosen)} of {len(self.stations)} stations")
        self.stations = self.stations[self.chosen]

    def groups(self):
        """Index arrays of stations; those of a group lie far apart."""
        count = -(-len(self.stations) // GROUP)
        return [np.arange(len(self.stations))[start::count] for start in range(count)]

    def mesh(self, group):
        """Mesh with nodes at ends, supports and the stations of a group."""
        nodes = np.concatenate([self.ends, self.supports, self.stations[group]])
        return skfem.MeshLine(np.unique(nodes))


def node(mesh, x):
    """Index of the node at x."""
    return int(np.flatnonzero(mesh.p[0] == x)[0])


def reading(basis, points):
    """Two matrices, points x degrees of freedom: values and first derivatives at the points."""
    cells = basis.mesh.element_finder(mapping=basis.mapping)(points)
    local = basis.mapping.invF(points[None, :, None], tind=cells)
    value = np.zeros((len(points), basis.N))
    slope = np.zeros((len(points), basis.N))
    for k in range(basis.Nbfun):
        phi = basis.elem.gbasis(basis.mapping, local, k, tind=cells)[0]
        dofs = basis.element_dofs[k, cells]
        value[np.arange(len(points)), dofs] += np.asarray(phi)[:, 0]
        slope[np.arange(len(points)), dofs] += np.asarray(phi.grad)[0, :, 0]
    return value, slope


def solution(stiffness, held, loads):
    """Columns of the solution with the held degrees of freedom at zero."""
    free = np.setdiff1d(np.arange(stiffness.shape[0]), held)
    result = np.zeros_like(loads)
    result[free] = solve(stiffness.toarray()[np.ix_(free, free)], loads[free], assume_a="pos")
    return result


@skfem.BilinearForm
def curvature(v, q, _):
    return ddot(dd(v), dd(q))


@skfem.BilinearForm
def gradient(u, q, _):
    return grad(u)[0] * grad(q)[0]


@skfem.BilinearForm
def product(t, s, _):
    return t * s


@skfem.BilinearForm
def slope_times(v, s, _):
    return grad(v)[0] * s


def bernoulli(layout, group, ei):
    """Stiffness, held freedoms, load columns and readings of the Hermite beam."""
    basis = skfem.Basis(layout.mesh(group), skfem.ElementLineHermite(), intorder=4)
    deflection, slope = basis.nodal_dofs
    held = deflection[[node(basis.mesh, x) for x in layout.supports]]
    at = [node(basis.mesh, x) for x in layout.stations[group]]
    value, rotation = reading(basis, layout.stations)
    return ei * curvature.assemble(basis), held, deflection[at], slope[at], value, rotation


def timoshenko(layout, group, ei, kga):
    """The same of the beam that shears."""
    mesh = layout.mesh(group)
    v = skfem.Basis(mesh, skfem.ElementLinePp(3), intorder=6)
    t = v.with_element(skfem.ElementLineP2())
    mixed = kga * slope_times.assemble(v, t)
    stiffness = scipy.sparse.bmat(
        [
            [kga * gradient.assemble(v), -mixed.T],
            [-mixed, ei * gradient.assemble(t) + kga * product.assemble(t)],
        ],
        format="csr",
    )
    held = v.nodal_dofs[0][[node(mesh, x) for x in layout.supports]]
    at = [node(mesh, x) for x in layout.stations[group]]
    count = len(layout.stations)
    value = np.hstack([reading(v, layout.stations)[0], np.zeros((count, t.N))])
    rotation = np.hstack([np.zeros((count, v.N)), reading(t, layout.stations)[0]])
    return stiffness, held, v.nodal_dofs[0][at], v.N + t.nodal_dofs[0][at], value, rotation


def bending(layout, ei, kga):
    """Deflections from forces, deflections from moments, rotations from moments; n x n each."""
    count = len(layout.stations)
    result = np.zeros((3, count, count))
    for group in layout.groups():
        parts = bernoulli(layout, group, ei) if kga is None else timoshenko(layout, group, ei, kga)
        stiffness, held, forces, moments, value, rotation = parts
        loads = np.zeros((stiffness.shape[0], 2 * len(group)))
        loads[forces, np.arange(len(group))] = 1.0
        loads[moments, len(group) + np.arange(len(group))] = 1.0
        found = solution(stiffness, held, loads)
        by_force, by_moment = found[:, : len(group)], found[:, len(group) :]
        result[0][:, group] = value @ by_force
        result[1][:, group] = value @ by_moment
        result[2][:, group] = rotation @ by_moment
    return result


def linear(layout, rigidity, supports):
    """Twists from torques, or lengthwise displacements from forces: n x n."""
    result = np.zeros((len(layout.stations), len(layout.stations)))
    for group in layout.groups():
        basis = skfem.Basis(layout.mesh(group), skfem.ElementLineP1())
        dofs = basis.nodal_dofs[0]
        held = dofs[[node(basis.mesh, x) for x in supports]]
        loads = np.zeros((basis.N, len(group)))
        loads[dofs[[node(basis.mesh, x) for x in layout.stations[group]]], np.arange(len(group))] = 1.0
        stiffness = rigidity * gradient.assemble(basis)
        result[:, group] = reading(basis, layout.stations)[0] @ solution(stiffness, held, loads)
    return result


def grids(layout, data):
    """The six grids that the known stiffnesses allow."""
    h = data["rail_height"]
    known = data.get
    found = dict.fromkeys(
        ["vertical", "lateral", "longitudinal", "vertical_lateral", "vertical_longitudinal", "lateral_longitudinal"]
    )
    zero = np.zeros((len(layout.stations),) * 2)
    if known("EI_vertical") is not None:
        force, moment, rotation = bending(layout, data["EI_vertical"], known("kGA_vertical"))
        found["vertical"] = force
        found["vertical_longitudinal"] = -h * moment
        if known("EA") is not None:
            length = linear(layout, data["EA"], layout.supports[:1])
            found["longitudinal"] = length + h * h * rotation
    if known("EI_lateral") is not None and (h == 0.0 or known("GJ") is not None):
        force, _, _ = bending(layout, data["EI_lateral"], known("kGA_lateral"))
        twist = linear(layout, data["GJ"], layout.supports) if h != 0.0 else zero
        found["lateral"] = force + h * h * twist
    # One straight girder with its rail above the axis: both bendings stand alone.
    if found["vertical"] is not None and found["lateral"] is not None:
        found["vertical_lateral"] = zero
        found["lateral_longitudinal"] = zero
    return found


def main():
    data = json.load(sys.stdin)
    layout = Layout(data)
    sheared = any(data.get(k) is not None for k in ("kGA_vertical", "kGA_lateral"))
    answer = {
        "versions": {"scikit-fem": skfem.__version__, "numpy": np.__version__, "scipy": scipy.__version__},
        "elements": "ElementLinePp(3) with ElementLineP2" if sheared else "ElementLineHermite",
        "influence": {name: None if grid is None else grid.tolist() for name, grid in grids(layout, data).items()},
        "stations": layout.chosen.tolist(),
        "notes": layout.notes,
    }
    json.dump(answer, sys.stdout, allow_nan=False)


if __name__ == "__main__":
    main()
