#!/usr/bin/env python3
"""Influence grids of a straight girder as a solid: meshed by gmsh, solved by scikit-fem.

Reads {"spec": ..., "theory": ...} on standard input, writes one JSON object on standard output. The short form of a
spec alone, and only where its section can be a solid rectangle b x h: h = sqrt(12 I_vertical / A), b = A / h, and
I_lateral, where given, is b^3 h / 12 within RECTANGLE.

Linear elasticity with E and nu = E / (2 G) - 1, triquadratic hexahedra, sections at supports and stations on planes
of the mesh. A beam has one deflection a section, a solid has many, and a point load on it measures its own dent. So
all three, load, support and measurement, are the same average of the section, weighted like the shear stress of a
beam:

    vertical   integral of (3/2A) (1 - (2y/h)^2) u_y dA        lateral   integral of (3/2A) (1 - (2z/b)^2) u_z dA

A support holds these two and the twist, integral of (y u_z - z u_y) dA; the first also the mean of u_x. Slopes are
free. The stiffness is factored with three points held against rigid motion; reactions and rigid motion follow from
the supports and from equilibrium, under which the three points carry nothing.

Compared are the vertical grid and, with the rail on the axis, the lateral one. Longitudinal loads at a rail above the
axis and torsion are matters of how the rail is fastened to the solid: they are left out.
"""

import json
import sys

import numpy as np
import scipy
import scipy.sparse
from scipy.sparse.linalg import splu

import frame_model
from frame_model import Refused

# Relative difference of I_lateral from that of the rectangle.
RECTANGLE = 1e-3
# Most stations: each makes a plane of the mesh.
MOST = 17
# Agreement with Timoshenko beams, and its growth for short spans: by (depth / span)^2.
TOLERANCE, SHORT = 1e-3, 0.05
# Further growth where a flat section bends about its flat axis: by nu^2 (1 - depth / width) (width / span)^2. Near loads
# and supports the width resists the transverse curvature, over a length of about the width, as in a plate.
# Measured with nu = 0.3: (width / span)^2 times 0.125 at depth / width = 0.06 and 0.12, 0.077 at 0.25, 0.036 at 1.
FLAT = 1.2
# Elements across height and width, the longest one by the smaller of height and width, and most along the bar.
ACROSS = (4, 4)
LONGEST, ALONG = 0.5, 240


def load():
    """gmsh and scikit-fem; gmsh needs libraries of the system's that its wheel does not carry."""
    try:
        import gmsh
    except OSError as error:
        hint = "apt-get install libglu1-mesa libgl1 libopengl0 libxrender1 libxcursor1 libxft2 libxinerama1 libxfixes3"
        raise Refused(f"gmsh cannot be loaded: {error} (on Debian: {hint})") from error
    import skfem

    return gmsh, skfem


class Bar:
    """The girder as a rectangle along x, with the planes of its mesh."""

    def __init__(self, spec, theory):
        if "girder" not in spec:
            raise Refused("a solid is made of straight girders, the short form of a spec")
        girder = spec["girder"]
        for key in ("A", "G"):
            if key not in girder:
                raise Refused(f"a solid needs `{key}`")
        area, moment = girder["A"], girder["I_vertical"]
        self.h = (12.0 * moment / area) ** 0.5
        self.b = area / self.h
        lateral = self.b**3 * self.h / 12.0
        given = girder.get("I_lateral", lateral)
        if abs(given - lateral) > RECTANGLE * lateral:
            raise Refused(
                f"the section is no solid rectangle: A and I_vertical make one of {self.b:.4g} x {self.h:.4g}, whose "
                f"I_lateral is {lateral:.4g}, not {given:.4g}"
            )
        self.e = girder["E"]
        self.nu = self.e / (2.0 * girder["G"]) - 1.0
        if not -0.9 < self.nu < 0.49:
            raise Refused(f"E and G make Poisson's ratio {self.nu:.3g}: no solid has it")
        self.sheared = theory == "timoshenko"
        self.lateral = "I_lateral" in girder and girder.get("rail_height", 0.0) == 0.0
        left, right = girder.get("overhangs", [0.0, 0.0])
        self.supports = np.concatenate([[0.0], np.cumsum(girder["spans"])])
        ends = np.array([-left, self.supports[-1] + right])
        self.slender = min(girder["spans"]) / max(self.h, self.b)
        fixed = np.unique(np.concatenate([ends, self.supports]))
        stations = np.array(spec["stations"], dtype=float)
        chosen = range(len(stations))
        if len(stations) > MOST:
            chosen = sorted({round(k * (len(stations) - 1) / (MOST - 1)) for k in range(MOST)})
        self.chosen, self.stations, planes = [], [], list(fixed)
        for index in chosen:
            nearest = planes[int(np.argmin(np.abs(np.array(planes) - stations[index])))]
            gap = abs(nearest - stations[index])
            if gap <= 1e-9 * self.h:
                self.stations.append(nearest)
            elif gap >= 0.05 * self.h:
                planes.append(stations[index])
                self.stations.append(stations[index])
            else:
                continue
            self.chosen.append(index)
        self.total = len(stations)
        self.planes = np.sort(planes)


def mesh(gmsh, skfem, bar):
    """Hexahedra of the bar: a rectangle extruded from plane to plane."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    geo, count = gmsh.model.geo, ACROSS
    x = bar.planes[0]
    corners = [
        geo.addPoint(x, y, z)
        for y, z in ((-bar.h / 2, -bar.b / 2), (bar.h / 2, -bar.b / 2), (bar.h / 2, bar.b / 2), (-bar.h / 2, bar.b / 2))
    ]
    lines = [geo.addLine(corners[k], corners[(k + 1) % 4]) for k in range(4)]
    for k, line in enumerate(lines):
        geo.mesh.setTransfiniteCurve(line, count[k % 2] + 1)
    surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    geo.mesh.setTransfiniteSurface(surface)
    geo.mesh.setRecombine(2, surface)
    longest = max(LONGEST * min(bar.h, bar.b), (bar.planes[-1] - bar.planes[0]) / ALONG)
    for near, far in zip(bar.planes, bar.planes[1:]):
        layers = max(1, int(np.ceil((far - near) / longest)))
        made = geo.extrude([(2, surface)], far - near, 0, 0, numElements=[layers], recombine=True)
        surface = made[0][1]
    geo.synchronize()
    gmsh.model.mesh.generate(3)
    tags, points, _ = gmsh.model.mesh.getNodes()
    _, nodes = gmsh.model.mesh.getElementsByType(5)
    version = gmsh.option.getString("General.Version")
    gmsh.finalize()
    number = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    number[tags.astype(np.int64)] = np.arange(len(tags))
    points = points.reshape(-1, 3).T
    # Layers may come a rounding away from their planes.
    for plane in bar.planes:
        points[0][np.abs(points[0] - plane) <= 1e-9 * bar.h] = plane
    cells = number[nodes.astype(np.int64)].reshape(-1, 8).T
    # The reference corners of both codes, to match the order of an element's nodes.
    theirs = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    ours = skfem.MeshHex().p.T.round().astype(int)
    order = [int(np.flatnonzero((theirs == corner).all(axis=1))[0]) for corner in ours]
    return skfem.MeshHex(np.ascontiguousarray(points), np.ascontiguousarray(cells[order])), version


def patterns(skfem, bar, basis):
    """Averages of sections as load columns: those that supports hold, and those of the stations."""
    m, area, none = basis.mesh, bar.b * bar.h, np.zeros(basis.N)
    sections = {}

    def column(x, weight):
        if x not in sections:
            facets = m.facets_satisfying(lambda p: np.abs(p[0] - x) <= 1e-9 * bar.h)
            sections[x] = skfem.FacetBasis(m, basis.elem, facets=facets, intorder=4)
        return skfem.LinearForm(lambda v, w: weight(w.x) * v).assemble(sections[x])

    def vertical(x):
        return [none, column(x, lambda p: 1.5 / area * (1.0 - (2.0 * p[1] / bar.h) ** 2)), none]

    def lateral(x):
        return [none, none, column(x, lambda p: 1.5 / area * (1.0 - (2.0 * p[2] / bar.b) ** 2))]

    def twist(x):
        polar = area * (bar.h**2 + bar.b**2) / 12.0
        return [none, -column(x, lambda p: p[2] / polar), column(x, lambda p: p[1] / polar)]

    def length(x):
        return [column(x, lambda p: 1.0 / area + 0.0 * p[0]), none, none]

    held = [kind(x) for x in bar.supports for kind in (vertical, lateral, twist)]
    held.append(length(bar.supports[0]))
    loads = [kind(x) for kind in (vertical, lateral)[: 1 + bar.lateral] for x in bar.stations]
    return np.array([np.concatenate(c) for c in held]).T, np.array([np.concatenate(c) for c in loads]).T


def rigid(bar, places):
    """Six rigid motions as columns; rotations by the bar's half length."""
    half = 0.5 * (bar.planes[-1] - bar.planes[0])
    r = (places - places.mean(axis=1)[:, None]) / half
    columns = [np.kron(np.eye(3)[k], np.ones(r.shape[1])) for k in range(3)]
    columns += [np.cross(np.eye(3)[k], r.T).T.ravel() for k in range(3)]
    return np.array(columns).T


def elasticity(skfem, bar, basis):
    """Stiffness of the solid, all u_x first, then all u_y and u_z."""
    lame = bar.e * bar.nu / ((1.0 + bar.nu) * (1.0 - 2.0 * bar.nu))
    shear = bar.e / (2.0 * (1.0 + bar.nu))

    def product(i, j):
        return skfem.BilinearForm(lambda u, v, _: u.grad[j] * v.grad[i]).assemble(basis)

    slopes = [[product(i, j) for j in range(3)] for i in range(3)]
    laplace = shear * (slopes[0][0] + slopes[1][1] + slopes[2][2])
    blocks = [
        [lame * slopes[i][j] + shear * slopes[j][i] + (laplace if i == j else 0.0 * laplace) for j in range(3)]
        for i in range(3)
    ]
    return scipy.sparse.bmat(blocks, format="csc")


def solve(question):
    gmsh, skfem = load()
    bar = Bar(question["spec"], question["theory"])
    m, version = mesh(gmsh, skfem, bar)
    basis = skfem.Basis(m, skfem.ElementHex2(), intorder=4)
    stiffness = elasticity(skfem, bar, basis)
    held, loads = patterns(skfem, bar, basis)
    modes = rigid(bar, basis.doflocs)
    # Three corners of the first section leave no rigid motion.
    low = np.array([bar.planes[0], -bar.h / 2, -bar.b / 2])

    def corner(*step):
        apart = np.abs(basis.doflocs.T - low - step).max(axis=1)
        return int(np.flatnonzero(apart <= 1e-9 * bar.h)[0])

    a, b, c = corner(0, 0, 0), corner(0, bar.h, 0), corner(0, 0, bar.b)
    points = [a, a + basis.N, a + 2 * basis.N, b, b + 2 * basis.N, c]
    free = np.setdiff1d(np.arange(3 * basis.N), points)
    inner = stiffness[free][:, free].tocsc()
    factor = splu(inner, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}, diag_pivot_thresh=0.0)
    columns = np.hstack([held, loads])
    found = np.zeros_like(columns)
    found[free] = factor.solve(columns[free])
    flexible, moved = columns.T @ found, columns.T @ modes
    s = held.shape[1]
    size = 1.0 / np.abs(flexible).max()
    system = np.block([[size * flexible[:s, :s], moved[:s]], [moved[:s].T, np.zeros((6, 6))]])
    right = -np.vstack([size * flexible[:s, s:], moved[s:].T])
    unknown = np.linalg.solve(system, right)
    grid = flexible[s:, s:] + flexible[s:, :s] @ unknown[:s] + moved[s:] @ unknown[s:] / size
    count = len(bar.stations)
    influence = {"vertical": grid[:count, :count].tolist()}
    if bar.lateral:
        influence["lateral"] = grid[count:, count:].tolist()
        influence["vertical_lateral"] = grid[:count, count:].tolist()
    shape = f"rectangle {bar.b:.4g} x {bar.h:.4g}, shortest span {bar.slender:.3g} depths"
    notes = [f"{shape}, {m.t.shape[1]} hexahedra, {3 * basis.N} freedoms"]
    if count < bar.total:
        notes.append(f"compared at {count} of {bar.total} stations")
    across, along = sorted([bar.b, bar.h])
    flat = "lateral" if bar.b < bar.h else "vertical"
    wide = SHORT + FLAT * bar.nu**2 * (1.0 - across / along)
    tolerances = {flat: max(TOLERANCE, wide / bar.slender**2)} if across < along else {}
    if flat in influence and tolerances.get(flat, 0.0) > TOLERANCE:
        notes.append(f"flat section: near loads and supports the solid bends as a plate, so that the {flat} grid may differ "
                     f"by {tolerances[flat]:.1e}; what a beam is, the other codes tell")
    return {
        "versions": {"gmsh": version, "scikit-fem": skfem.__version__, "scipy": scipy.__version__},
        "elements": "ElementHex2",
        "stations": bar.chosen,
        "influence": influence,
        "notes": notes,
        # What beam theory leaves out grows with the square of depth by span.
        "tolerance": max(TOLERANCE, SHORT / bar.slender**2),
        "tolerances": tolerances,
    }


if __name__ == "__main__":
    frame_model.reply(solve, json.load(sys.stdin))
