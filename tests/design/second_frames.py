#!/usr/bin/env python3
"""A second reading of the limits of deflections of frames: random halls and girders, checked by a program of its own.

Usage: second_frames.py GIRDERWAY [--designs 30] [--runs 10] [--seed 1]. Needs numpy.

Each structure has one or two girders: in a hall with columns (upright or inclined, fixed or hinged at their base), brackets as
rigid links, rafters, and rails at two heights; on inclined legs; with struts from the feet of the columns; with a surge truss;
with a hinge between supports. The structure is solved here by beam elements of 0.5 m in three dimensions, with releases, rigid
arms and links. One or two cranes stand at all positions of a fine grid, in both directions, with both signs of the lateral
forces. The ends of spans follow from the stiffness of the structure without its girders over an estimate of that of a girder
alone; structures in which this ratio is within a factor of two of the threshold of `docs/trains.md` are drawn again.

Every row that is found here must be in `limits` with its value (1.5 %; up to 4 % more under two cranes, whose pairs of
positions are sampled more coarsely here), its limit and its result. Further rows must have the right value and limit: on columns
alone they may lie between firm ones, which are not sought here. Limits of pairs of rails are sampled: none may exceed what is
found here, or be below 0.8 of it. In runs a bridge crosses two such girders, and its deflections are read in the same way.
"""

import argparse
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

E, G = 2.1e8, 8.1e7
# A, Iy (lateral), Iz (vertical), J in m and m4: tables of HE B sections (Euronorm 53-62)
SECTIONS = {
    "HEB 300": (149.1e-4, 8563e-8, 25166e-8, 185e-8),
    "HEB 500": (238.6e-4, 12624e-8, 107176e-8, 538e-8),
    "HEB 700": (306.4e-4, 14441e-8, 256888e-8, 831e-8),
}
BAR = ("bar", 20e-4)
# Joints are multiples of this apart; girders are divided by it, girders that stand alone by its half.
MESH = 0.5


class Structure:
    """Points, members, links, supports and girders, as a beam spec and as a stiffness matrix."""

    def __init__(self):
        self.points, self.members, self.links = [], [], []
        self.supports, self.girders = {}, []

    def point(self, *x):
        """Index of the point at x."""
        self.points.append([float(v) for v in x])
        return len(self.points) - 1

    def member(self, a, b, section, kind="beam", up=(0, 1, 0), free_a=(), free_b=(), girder=None):
        """A member; `free_a`, `free_b` are released rotations in local axes, `girder` the number of its girder."""
        self.members.append(dict(a=a, b=b, section=section, kind=kind, up=list(map(float, up)),
                                 free=[list(free_a), list(free_b)], girder=girder))
        return len(self.members) - 1

    def spec(self):
        """The beam spec."""
        names = sorted({m["section"] for m in self.members})
        sections = []
        for name in names:
            if name == BAR[0]:
                sections.append({"name": name, "material": "steel", "A": BAR[1]})
            else:
                area, i_y, i_z, j = SECTIONS[name]
                sections.append({"name": name, "material": "steel", "A": area, "Iy": i_y, "Iz": i_z, "J": j})
        blocks, data = [], {key: [] for key in ("kind", "section", "orientation", "release_a", "release_b")}
        order = {}
        for kind in ("beam", "truss"):
            own = [k for k, m in enumerate(self.members) if m["kind"] == kind]
            if not own:
                continue
            for place, k in enumerate(own):
                order[k] = [len(blocks), place]
            members = [self.members[k] for k in own]
            blocks.append({"type": "line", "data": [[m["a"], m["b"]] for m in members]})
            data["kind"].append([kind] * len(own))
            data["section"].append([m["section"] for m in members])
            data["orientation"].append([m["up"] for m in members])
            data["release_a"].append([m["free"][0] for m in members])
            data["release_b"].append([m["free"][1] for m in members])
        rails = {}
        for number, girder in enumerate(self.girders):
            own = [k for k, m in enumerate(self.members) if m["girder"] == number]
            start = self.points[self.members[own[0]]["a"]]
            rails[girder["name"]] = {
                "origin": [0, start[1] + girder["height"], start[2]], "axis": [1, 0, 0],
                "segments": [{"cell": order[k], "offset": [0, girder["height"], 0]} for k in own],
                "stations": girder["joints"],
            }
        return {
            "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
            "theory": "euler-bernoulli", "points": self.points, "cells": blocks, "cell_data": data,
            "materials": [{"name": "steel", "E": E, "G": G}], "sections": sections,
            "supports": [{"point": p, "fix": fix} for p, fix in self.supports.items()],
            "links": [{"from": a, "to": b} for a, b in self.links], "rails": rails,
        }


DOFS = ["ux", "uy", "uz", "rx", "ry", "rz"]


def beam(length, section):
    """Stiffness of a beam element in local axes."""
    area, i_y, i_z, j = SECTIONS[section]
    k = np.zeros((12, 12))
    axial = np.array([[1, -1], [-1, 1]])
    k[np.ix_([0, 6], [0, 6])] = E * area / length * axial
    k[np.ix_([3, 9], [3, 9])] = G * j / length * axial
    h = length
    bend = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                     [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]) / h**3
    k[np.ix_([1, 5, 7, 11], [1, 5, 7, 11])] = E * i_z * bend
    sign = np.diag([1.0, -1.0, 1.0, -1.0])
    k[np.ix_([2, 4, 8, 10], [2, 4, 8, 10])] = E * i_y * sign @ bend @ sign
    return k


def released(k, free):
    """Stiffness after the degrees of freedom `free` are condensed."""
    if not free:
        return k
    kept = [d for d in range(12) if d not in free]
    out = np.zeros_like(k)
    # A rotation that is free at both ends of a bar leaves a singular block: the least-norm solution has no force there.
    inner = np.linalg.pinv(k[np.ix_(free, free)])
    out[np.ix_(kept, kept)] = k[np.ix_(kept, kept)] - k[np.ix_(kept, free)] @ inner @ k[np.ix_(free, kept)]
    return out


def axes(a, b, up):
    """Rows: local x, y, z."""
    x = (b - a) / np.linalg.norm(b - a)
    y = np.array(up) - np.dot(up, x) * x
    y /= np.linalg.norm(y)
    return np.array([x, y, np.cross(x, y)])


def cross(r):
    """Matrix of theta -> theta x r."""
    return np.array([[0, r[2], -r[1]], [-r[2], 0, r[0]], [r[1], -r[0], 0]])


class Solution:
    """Compliance of a structure: displacements of the rails under forces on the rails."""

    def __init__(self, structure, without_girders=False):
        points = [np.array(p) for p in structure.points]
        elements = []
        self.lines = [[] for _ in structure.girders]
        self.mesh = MESH if len(structure.girders) > 1 else 0.5 * MESH
        for m in structure.members:
            if without_girders and m["girder"] is not None:
                continue
            a, b = points[m["a"]], points[m["b"]]
            count = 1 if m["girder"] is None else max(1, round(np.linalg.norm(b - a) / self.mesh))
            nodes = [m["a"]]
            for k in range(1, count):
                points.append(a + (b - a) * k / count)
                nodes.append(len(points) - 1)
            nodes.append(m["b"])
            for k in range(count):
                free = [DOFS.index(d) for d in m["free"][0]] if k == 0 else []
                free += [6 + DOFS.index(d) for d in m["free"][1]] if k == count - 1 else []
                elements.append((nodes[k], nodes[k + 1], m, free))
                if m["girder"] is not None:
                    self.lines[m["girder"]].append((nodes[k], nodes[k + 1], free))
        n = len(points)
        k = np.zeros((6 * n, 6 * n))
        for a, b, m, free in elements:
            length = np.linalg.norm(points[b] - points[a])
            if m["kind"] == "truss":
                local = np.zeros((12, 12))
                local[np.ix_([0, 6], [0, 6])] = E * BAR[1] / length * np.array([[1, -1], [-1, 1]])
            else:
                local = released(beam(length, m["section"]), free)
            turn = np.kron(np.eye(4), axes(points[a], points[b], m["up"]))
            at = np.r_[6 * a : 6 * a + 6, 6 * b : 6 * b + 6]
            k[np.ix_(at, at)] += turn.T @ local @ turn
        # Links: the point b follows the point a.
        whole = np.eye(6 * n)
        dropped = set()
        for a, b in structure.links:
            rows = np.zeros((6, 6 * n))
            rows[:3, 6 * a : 6 * a + 3] = np.eye(3)
            rows[:3, 6 * a + 3 : 6 * a + 6] = cross(points[b] - points[a])
            rows[3:, 6 * a + 3 : 6 * a + 6] = np.eye(3)
            whole[6 * b : 6 * b + 6] = rows
            dropped |= set(range(6 * b, 6 * b + 6))
        for p, fix in structure.supports.items():
            dropped |= {6 * p + DOFS.index(d) for d in fix}
        # What has no stiffness, as rotations of truss joints, is held.
        small = np.diag(whole.T @ k @ whole)
        dropped |= {d for d in range(6 * n) if small[d] <= 1e-9 * k.max()}
        kept = [d for d in range(6 * n) if d not in dropped]
        basis = whole[:, kept]
        self.basis, self.inverse = basis, np.linalg.inv(basis.T @ k @ basis)
        self.points, self.structure = points, structure

    def rows(self, rail, x):
        """The displacements (vertical, lateral) of a rail at the coordinates x: rows for the displacements of all nodes."""
        girder = self.structure.girders[rail]
        starts = np.array([self.points[a][0] for a, _, _ in self.lines[rail]])
        vertical = np.zeros((len(x), self.basis.shape[0]))
        lateral = np.zeros_like(vertical)
        for row, place in enumerate(x):
            e = int(np.clip(np.searchsorted(starts, place + 1e-9, side="right") - 1, 0, len(starts) - 1))
            a, b, free = self.lines[rail][e]
            h = self.points[b][0] - self.points[a][0]
            s = (place - self.points[a][0]) / h
            own, other = self.shapes(s, h, free, "rz"), self.shapes(s, h, free, "ry")
            # Vertical: uy and rz. Lateral: uz and -ry, and the twist at the height of the rail.
            for node, (w, r), (v, q), twist in ((a, own[0], other[0], 1 - s), (b, own[1], other[1], s)):
                vertical[row, 6 * node + 1] = w
                vertical[row, 6 * node + 5] = r
                lateral[row, 6 * node + 2] = v
                lateral[row, 6 * node + 4] = -q
                lateral[row, 6 * node + 3] = girder["height"] * twist
        return vertical, lateral

    @staticmethod
    def shapes(s, h, free, rotation):
        """Hermite shapes of both ends; of an element with a released rotation those of a beam hinged there."""
        at = DOFS.index(rotation)
        n = [[1 - 3 * s**2 + 2 * s**3, h * (s - 2 * s**2 + s**3)], [3 * s**2 - 2 * s**3, h * (s**3 - s**2)]]
        first, last = at in free, 6 + at in free
        if first and last:
            return [[1 - s, 0], [s, 0]]
        if first:
            t = 1 - s
            return [[1.5 * t**2 - 0.5 * t**3, 0], [1 - 1.5 * t**2 + 0.5 * t**3, -h * (t - 1.5 * t**2 + 0.5 * t**3)]]
        if last:
            return [[1 - 1.5 * s**2 + 0.5 * s**3, h * (s - 1.5 * s**2 + 0.5 * s**3)], [1.5 * s**2 - 0.5 * s**3, 0]]
        return n


    def compliance(self, to, by):
        """Displacements of the rows `to` under unit forces along the rows `by`."""
        return (to @ self.basis) @ self.inverse @ (by @ self.basis).T


# Ends of spans.

LEAST = 0.05


class NearThreshold(Exception):
    """The spans of a structure depend on digits of a threshold."""


def ends_of(structure, rail, plane):
    """Coordinates of the ends of spans of a rail in a plane (0: vertical, 1: lateral), and of those with supports of their own.

    Supports of the girder's own points are rigid. At other joints the ground has the stiffness of the structure without its
    girders."""
    girder = structure.girders[rail]
    joints, own = girder["joints"], girder["own"][plane]
    if plane == 0 and girder.get("struts"):
        return joints, own
    bare = Solution(structure, without_girders=True) if girder["connected"] else None
    ground = {}
    for x in joints:
        if x in own:
            ground[x] = np.inf
        elif bare is not None and x in girder["connected"]:
            p = girder["connected"][x]
            row = np.zeros((1, bare.basis.shape[0]))
            row[0, 6 * p + 1 + plane] = 1.0
            if plane == 1:
                row[0, 6 * p + 3] = girder["height"]
            # A point that nothing but the girder holds has no row of its own.
            kept = row @ bare.basis
            ground[x] = 1 / float((kept @ bare.inverse @ kept.T)[0, 0]) if np.abs(kept).max() > 0 else 0.0
        else:
            ground[x] = 0.0
    kept = list(joints)
    while True:
        ratios = ratio(girder, plane, kept, ground)
        if any(0.5 * LEAST < r < 2 * LEAST for r in ratios):
            raise NearThreshold
        if min(ratios) >= LEAST:
            break
        kept.pop(int(np.argmin(ratios)))
    firm = [x for x in kept if x in own]
    return kept, firm if len(firm) >= 2 else kept


def ratio(girder, plane, places, ground):
    """Stiffness of the ground over that of the girder at each place: of a beam that is clamped at the neighbouring places, 12
    EI/l^3 on each side (a hinged one has 3); none where it is hinged at its joints."""
    rigid = 0.0 if girder["simple"] else E * SECTIONS[girder["section"]][2 if plane == 0 else 1]
    out = []
    for k, x in enumerate(places):
        sides = [abs(places[j] - x) for j in (k - 1, k + 1) if 0 <= j < len(places)]
        own = sum(12 * rigid / length**3 for length in sides)
        out.append(0.0 if ground[x] == 0 else ground[x] / own if own else np.inf)
    return out


def spans_of(structure, rail, plane):
    """The spans of a rail in a plane: between all ends, and between those with supports of their own."""
    spans = []
    for ends in ends_of(structure, rail, plane):
        spans += [pair for pair in zip(ends, ends[1:]) if pair not in spans]
    return spans


# Trains.


def variations(train, loads):
    """Signed wheel forces of a train: direction, and forces (rail, x, vertical, lateral) by wheel."""
    out = []
    for turn in (1, -1):
        for sign in (1, -1):
            wheels = []
            for wheel in train["wheels"]:
                vertical, lateral = wheel["vertical"], 0.0
                if loads == "tenth":
                    vertical, lateral = 0.0, 0.1 * wheel["vertical"]
                elif loads == "thrust":
                    lateral = wheel.get("lateral", 0.0)
                elif loads == "skewing":
                    lateral = wheel.get("skewing", 0.0)
                wheels.append((wheel["rail"], turn * wheel["x"], vertical, sign * lateral))
            out.append(wheels)
            if loads == "vertical":
                break
    return out


class Responses:
    """Displacements of the rails of a structure under trains."""

    def __init__(self, structure, solution, step):
        self.structure, self.solution, self.step = structure, solution, step
        self.names = [g["name"] for g in structure.girders]
        self.nodes, self.out = [], []
        for rail, girder in enumerate(structure.girders):
            low, high = girder["joints"][0], girder["joints"][-1]
            self.nodes.append(np.linspace(low, high, round((high - low) / solution.mesh) + 1))
            vertical, lateral = solution.rows(rail, self.nodes[-1])
            self.out.append([vertical, lateral])

    def range(self, wheels):
        """First and last position of a train."""
        girders = self.structure.girders
        low = max(girders[self.names.index(r)]["joints"][0] - x for r, x, _, _ in wheels)
        return low, min(girders[self.names.index(r)]["joints"][-1] - x for r, x, _, _ in wheels)

    def of(self, wheels, at=None):
        """Positions, and displacements by rail and plane: arrays (position, node); positive down and along +z."""
        if at is None:
            low, high = self.range(wheels)
            at = np.append(np.arange(low, high, self.step), high)
            if self.step < MESH / 2:
                # Twist has a kink under a wheel: each wheel stands on each node once.
                rail = self.names.index(wheels[0][0])
                on_nodes = np.concatenate([self.nodes[rail] - x for _, x, _, _ in wheels])
                at = np.unique(np.append(at, on_nodes[(on_nodes >= low) & (on_nodes <= high)]))
        total = 0.0
        by_rail = {}
        for name, x, vertical, lateral in wheels:
            by_rail.setdefault(name, []).append((x, vertical, lateral))
        for name, own in by_rail.items():
            rail = self.names.index(name)
            for x, vertical, lateral in own:
                up, side = self.solution.rows(rail, at + x)
                total = total - vertical * up + lateral * side
        moved = [[self.solution.compliance(row, total).T * (-1 if plane == 0 else 1)
                  for plane, row in enumerate(rows)] for rows in self.out]
        return at, moved


def chords(nodes, moved, ends):
    """Displacements from the chord of a span: (position, node of the span)."""
    i, j = [int(np.argmin(np.abs(nodes - x))) for x in ends]
    part = moved[:, i : j + 1]
    s = (nodes[i : j + 1] - nodes[i]) / (nodes[j] - nodes[i])
    return part - (moved[:, [i]] * (1 - s) + moved[:, [j]] * s)


def largest(responses, trains, loads, value):
    """Largest size of `value(displacements)`, arrays (position, ...), over all states of one or two trains."""
    worst = 0.0
    of = [[(wheels, *responses.of(wheels)) for wheels in variations(train, loads)] for train in trains]
    if len(trains) == 1:
        for _, _, moved in of[0]:
            worst = max(worst, float(np.abs(value(moved)).max()))
        return worst
    extent = lambda wheels: (min(x for _, x, _, _ in wheels), max(x for _, x, _, _ in wheels))
    for (a, at_a, by_a), (b, at_b, by_b) in itertools.product(*of):
        (a0, a1), (b0, b1) = extent(a), extent(b)
        apart = (at_a[:, None] + a1 <= at_b[None, :] + b0 + 1e-9) | (at_b[None, :] + b1 <= at_a[:, None] + a0 + 1e-9)
        for u, v in zip(value(by_a).reshape(len(at_a), -1).T, value(by_b).reshape(len(at_b), -1).T):
            both = np.abs(u[:, None] + v[None, :])
            worst = max(worst, float(np.where(apart, both, 0.0).max(initial=0.0)))
        # The second train touches the first, before or behind it.
        low, high = responses.range(b)
        for gap in (a1 - b0, a0 - b1):
            fits = (at_a + gap >= low) & (at_a + gap <= high)
            if fits.any():
                _, touching = responses.of(b, at_a[fits] + gap)
                both = value(by_a).reshape(len(at_a), -1)[fits] + value(touching).reshape(fits.sum(), -1)
                worst = max(worst, float(np.abs(both).max()))
    return worst


# Structures.


def hall(rng):
    """Two crane girders on brackets of columns that rafters connect."""
    s = Structure()
    bays = int(rng.integers(2, 4))
    bay = float(rng.integers(10, 17)) * MESH
    width = float(rng.integers(10, 20))
    levels = [float(rng.integers(5, 8)) for _ in range(2)]
    levels = levels if rng.random() < 0.5 else [levels[0]] * 2
    top = max(levels) + float(rng.integers(1, 3))
    column = str(rng.choice(["HEB 300", "HEB 500", "HEB 700"]))
    girder = str(rng.choice(["HEB 300", "HEB 500"]))
    lean = float(rng.choice([0, 0, 0.5, 1.0]))
    bracket = float(rng.choice([0.0, 0.4, 0.8]))
    fixed, simple = rng.random() < 0.7, bool(rng.random() < 0.4)
    hinged_roof = fixed and rng.random() < 0.5
    frames = []
    for k in range(bays + 1):
        x = k * bay
        nodes = []
        for side in (0, 1):
            z, out = (0.0, -1.0) if side == 0 else (width, 1.0)
            foot = s.point(x, 0, z + out * lean)
            # the column is straight from its foot to its head
            level = levels[side]
            at = s.point(x, level, z + out * lean * (1 - level / top))
            head = s.point(x, top, z)
            s.supports[foot] = DOFS[:] if fixed else ["ux", "uy", "uz", "ry", "rz"]
            # The strong axis of the columns resists forces across the hall, that of bending along it is weaker.
            for a, b in ((foot, at), (at, head)):
                s.member(a, b, column, up=(0, 0, 1))
            nodes += [at, head]
        s.member(nodes[1], nodes[3], "HEB 300", free_a=["rz", "ry"] if hinged_roof else [],
                 free_b=["rz", "ry"] if hinged_roof else [])
        frames.append(nodes)
    for p, q in zip(frames, frames[1:]):
        for head in (1, 3):
            s.member(p[head], q[head], "HEB 300", free_a=["rz", "ry"], free_b=["rz", "ry"])
    for side in (0, 1):
        name = "ab"[side]
        seats, connected = [], {}
        inward = 1.0 if side == 0 else -1.0
        for k in range(bays + 1):
            at = frames[k][2 * side]
            if bracket or lean:
                # one line of girders: the seat is where the bracket ends
                seat = s.point(k * bay, levels[side], s.points[at][2] + inward * bracket)
                s.links.append((at, seat))
            else:
                seat = at
            seats.append(seat)
            connected[k * bay] = seat
        for k in range(bays):
            free_a = ["rz", "ry"] if simple else []
            s.member(seats[k], seats[k + 1], girder, free_a=free_a, free_b=free_a, girder=side)
        s.girders.append(dict(name=name, height=round(float(rng.uniform(0, 0.4)), 2), section=girder, simple=simple,
                              joints=[k * bay for k in range(bays + 1)], connected=connected, own=([], [])))
    return s


def surge(rng):
    """A girder whose surge truss meets it at panel points and hangs on it."""
    s = Structure()
    panels = int(rng.integers(4, 8))
    panel = float(rng.integers(3, 6)) * MESH
    depth = float(rng.choice([0.8, 1.0, 1.2]))
    near = [s.point(k * panel, 0, 0) for k in range(panels + 1)]
    far = [s.point(k * panel, 0, depth) for k in range(panels + 1)]
    section = str(rng.choice(list(SECTIONS)))
    for k in range(panels):
        s.member(near[k], near[k + 1], section, girder=0)
        s.member(far[k], far[k + 1], "bar", "truss")
        s.member(near[k], far[k + 1], "bar", "truss")
    for k in range(panels + 1):
        s.member(near[k], far[k], "bar", "truss")
        if 0 < k < panels:
            s.supports[far[k]] = ["uy"]
    s.supports[near[0]] = ["ux", "uy", "uz", "rx"]
    s.supports[near[-1]] = ["uy", "uz", "rx"]
    s.supports[far[0]] = ["ux", "uy", "uz"]
    s.supports[far[-1]] = ["uy", "uz"]
    ends = [0.0, panels * panel]
    s.girders.append(dict(name="a", height=round(float(rng.uniform(0, 0.3)), 2), section=section, simple=False,
                          joints=[k * panel for k in range(panels + 1)], connected={}, own=(ends, ends)))
    return s


def strutted(rng):
    """A girder with struts from its abutments to its third points, which carry it, and lateral supports at some joints."""
    s = Structure()
    third = float(rng.integers(6, 13)) * MESH
    depth = float(rng.integers(3, 6))
    section = str(rng.choice(list(SECTIONS)))
    nodes = [s.point(k * third, 0, 0) for k in range(4)]
    feet = [s.point(0, -depth, 0), s.point(3 * third, -depth, 0)]
    for k in range(3):
        s.member(nodes[k], nodes[k + 1], section, girder=0)
    for foot, node in zip(feet, (nodes[1], nodes[2])):
        s.member(foot, node, "bar", "truss")
        s.supports[foot] = ["ux", "uy", "uz"]
    lateral = [0.0, 3 * third] + [k * third for k in (1, 2) if rng.random() < 0.5]
    s.supports[nodes[0]] = ["ux", "uy", "uz", "rx"]
    s.supports[nodes[3]] = ["ux", "uy", "uz", "rx"]
    for k in (1, 2):
        if k * third in lateral:
            s.supports[nodes[k]] = ["uz", "rx"]
    joints = [k * third for k in range(4)]
    # The struts carry the inner joints, but only the ends have supports of their own.
    s.girders.append(dict(name="a", height=round(float(rng.uniform(0, 0.3)), 2), section=section, simple=False,
                          joints=joints, connected={}, own=([0.0, 3 * third], sorted(lateral)), struts=True))
    return s


def hinged(rng):
    """A girder over three supports with a hinge in its second span."""
    s = Structure()
    first, arm, last = [float(rng.integers(8, 15)) * MESH, float(rng.integers(2, 5)) * MESH,
                        float(rng.integers(8, 15)) * MESH]
    section = str(rng.choice(list(SECTIONS)))
    joints = [0.0, first, first + arm, first + arm + last]
    nodes = [s.point(x, 0, 0) for x in joints]
    for k in range(3):
        s.member(nodes[k], nodes[k + 1], section, free_b=["rz"] if k == 1 else [], girder=0)
    s.supports[nodes[0]] = ["ux", "uy", "uz", "rx"]
    for k in (1, 3):
        s.supports[nodes[k]] = ["uy", "uz", "rx"]
    ends = [joints[0], joints[1], joints[3]]
    s.girders.append(dict(name="a", height=round(float(rng.uniform(0, 0.3)), 2), section=section, simple=False,
                          joints=joints, connected={}, own=(ends, ends)))
    return s


def legs(rng):
    """A girder on pairs of inclined legs across it."""
    s = Structure()
    bays = int(rng.integers(2, 4))
    bay = float(rng.integers(10, 17)) * MESH
    depth = float(rng.integers(4, 8))
    spread = float(rng.choice([1.0, 1.5, 2.0]))
    section = str(rng.choice(["HEB 300", "HEB 500"]))
    nodes = [s.point(k * bay, depth, 0) for k in range(bays + 1)]
    for k in range(bays):
        s.member(nodes[k], nodes[k + 1], section, girder=0)
    connected = {}
    for k, node in enumerate(nodes):
        for z in (-spread, spread):
            foot = s.point(k * bay, 0, z)
            s.supports[foot] = DOFS[:]
            s.member(foot, node, "HEB 300", up=(1, 0, 0))
        connected[k * bay] = node
    s.girders.append(dict(name="a", height=round(float(rng.uniform(0, 0.3)), 2), section=section, simple=False,
                          joints=[k * bay for k in range(bays + 1)], connected=connected, own=([], [])))
    return s


KINDS = [hall, hall, surge, strutted, hinged, legs]

# Ratio and largest deflection, vertical and lateral, and the loads: texts that `docs/theory/practice.md` names.
CODES = {
    "EN 1993-6": ({}, (600, 0.025), (600, None), ["vertical", "thrust", "skewing"], False),
    "CMAA 70": ({}, (600, None), (400, None), ["tenth"], False),
    "AISC Design Guide 7": ({"class": "D"}, (800, None), (400, None), ["tenth"], False),
    "AIST TR-13": ({"building_class": "B"}, (1000, None), (400, None), ["vertical", "thrust"], True),
    "IS 800": ({"class": "electric"}, (750, None), (400, None), ["vertical", "thrust"], False),
}


def crane(rng, structure, name):
    """A crane on one rail, or on both rails of a hall."""
    both = len(structure.girders) == 2 and rng.random() < 0.5
    force = float(rng.integers(20, 120))
    base = round(float(rng.uniform(1, 3)), 1)
    thrust, skew = float(rng.integers(1, 15)), float(rng.choice([0, 0, 20]))
    own = str(rng.choice([g["name"] for g in structure.girders]))
    wheels = []
    for rail, share in (("a", 1.0), ("b", 0.6)) if both else ((own, 1.0),):
        for x in (0.0, base):
            wheels.append({"rail": rail, "x": x, "vertical": share * force, "lateral": thrust})
        if skew:
            wheels[-2]["skewing"] = share * skew
    return {"name": name, "wheels": wheels}


QUANTITIES = ["vertical deflection", "lateral deflection"]


def allowed(rule, length):
    """The limit of a span by a ratio and a largest deflection."""
    return min(length / rule[0], rule[1] or np.inf)


def deflection(responses, sets, loads, rail, plane, span):
    """Largest deflection of a span from its chord, over sets of trains and kinds of loads."""
    of = lambda moved: chords(responses.nodes[rail], moved[rail][plane], span)
    return max(largest(responses, own, load, of) for own in sets for load in loads)


class Reading:
    """The limits of a code on the deflections of a structure under trains."""

    def __init__(self, structure, solution, trains, code):
        _, vertical, lateral, horizontal, alone = CODES[code]
        self.rules, self.loads = (vertical, lateral), (["vertical"], horizontal)
        self.sets = [[t] for t in trains] if alone else [trains]
        self.responses = Responses(structure, solution, 0.1 if len(trains) == 1 else 0.25)
        self.structure = structure

    def row(self, rail, plane, span):
        """Value and limit of a span."""
        value = deflection(self.responses, self.sets, self.loads[plane], rail, plane, span)
        return value, allowed(self.rules[plane], span[1] - span[0])

    def rows(self):
        """All rows: quantity, rail, from, to, value, limit."""
        return [(QUANTITIES[plane], girder["name"], *span, *self.row(rail, plane, span))
                for rail, girder in enumerate(self.structure.girders) for plane in (0, 1)
                for span in spans_of(self.structure, rail, plane)]


def pair_rows(structure, responses, trains, code):
    """Largest change of gauge and difference in height that limits of a code bear on."""
    if len(structure.girders) < 2:
        return {}
    if not any({w["rail"] for w in t["wheels"]} == {"a", "b"} for t in trains):
        return {}
    n = min(len(nodes) for nodes in responses.nodes)
    gauge = lambda moved: moved[1][1][:, :n] - moved[0][1][:, :n]
    height = lambda moved: moved[1][0][:, :n] - moved[0][0][:, :n]
    each = lambda of, sets: max(largest(responses, trains, loads, of) for loads in sets)
    if code == "EN 1993-6":
        return {"change of gauge": each(gauge, ["vertical", "thrust", "skewing"]),
                "difference in height": each(height, ["vertical"])}
    if code == "IS 800":
        return {"change of gauge": each(gauge, ["vertical", "thrust"])}
    return {}


def doubled(structure, width):
    """Two girders of the same kind side by side, the rails a and b."""
    out = Structure()
    for copy, name in enumerate("ab"):
        first, number = len(out.points), len(out.members)
        for x, y, z in structure.points:
            out.point(x, y, z + copy * width)
        for m in structure.members:
            girder = None if m["girder"] is None else copy
            out.members.append({**m, "a": m["a"] + first, "b": m["b"] + first, "girder": girder})
        out.links += [(a + first, b + first) for a, b in structure.links]
        out.supports.update({p + first: fix for p, fix in structure.supports.items()})
        girder = structure.girders[0]
        connected = {x: p + first for x, p in girder["connected"].items()}
        out.girders.append({**girder, "name": name, "connected": connected})
    return out


def run_program(program, command, spec, document):
    """Summary of a design or a run."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "spec.json").write_text(json.dumps(spec))
        (folder / "main.json").write_text(json.dumps(document))
        done = subprocess.run([program, command, "main.json", "-o", "out", "--quiet"], cwd=folder,
                              capture_output=True, text=True)
        if done.returncode:
            return done.stderr.strip()
        return json.loads((folder / "out/summary.json").read_text())


def draw(rng):
    """A structure whose spans are not near a threshold, with its solution."""
    while True:
        kind = KINDS[rng.integers(0, len(KINDS))]
        structure = kind(rng)
        solution = Solution(structure)
        try:
            for rail in range(len(structure.girders)):
                for plane in (0, 1):
                    ends_of(structure, rail, plane)
        except NearThreshold:
            continue
        return kind.__name__, structure, solution


def compare_design(program, seed):
    """Errors of one design, in words, and the number of its rows."""
    rng = np.random.default_rng(seed)
    kind, structure, solution = draw(rng)
    trains = [crane(rng, structure, f"c{k}") for k in range(int(rng.integers(1, 3)))]
    code = str(rng.choice(list(CODES)))
    design = {"format": "girderway-design/1", "units": {"length": "m", "force": "kN", "time": "s"}, "spec": "spec.json",
              "trains": trains, "practice": {"code": code, **CODES[code][0]},
              "cases": [{"name": "all", "trains": [t["name"] for t in trains]}]}
    if rng.random() < 0.5:
        design["cases"][0]["factors"] = {"vertical": 1.5, "lateral": float(rng.choice([0, 1.5]))}
    where = f"seed {seed} ({kind}, {code}, {len(trains)} trains)"
    summary = run_program(program, "design", structure.spec(), design)
    if isinstance(summary, str):
        return [f"{where}: {summary}"], 0
    found, pairs = {}, {}
    for row in summary["limits"]:
        if "from" not in row:
            pairs[row["quantity"]] = max(pairs.get(row["quantity"], 0.0), row["value"])
            continue
        key = (row["quantity"], row["rail"], round(row["from"], 6), round(row["to"], 6))
        if key not in found or row["value"] > found[key]["value"]:
            found[key] = row
    errors = []
    reading = Reading(structure, solution, trains, code)
    rows = reading.rows()
    most = max(value for *_, value, _ in rows)
    more = 1.015 if len(trains) == 1 else 1.04
    count = 0
    for quantity, rail, a, b, value, limit in rows:
        row = found.pop((quantity, rail, round(a, 6), round(b, 6)), None)
        if value < 1e-6 * most:
            continue
        count += 1
        if row is None:
            errors.append(f"{where}: no row for {quantity} of {rail} from {a} to {b}, {value} of {limit}")
        elif not 0.985 <= row["value"] / value <= more or abs(row["limit"] / limit - 1) > 1e-9:
            errors.append(f"{where}: {quantity} of {rail} from {a} to {b}: {row['value']} of {row['limit']}, "
                          f"here {value} of {limit}")
        elif row["within"] != (row["value"] <= row["limit"]):
            errors.append(f"{where}: {quantity} of {rail} from {a} to {b}: within is {row['within']}")
    for (quantity, rail, a, b), row in found.items():
        if row["value"] <= 1e-6 * most:
            continue
        number = reading.responses.names.index(rail)
        value, limit = reading.row(number, QUANTITIES.index(quantity), (a, b))
        # A row more must be right. On columns alone it may be between firm ones, which are not sought here; otherwise it is
        # between joints within a span, and may not govern.
        inside = [v / l for q, r, c, d, v, l in rows if (q, r) == (quantity, rail) and c <= a and b <= d]
        if not 0.985 <= row["value"] / value <= (1.015 if len(trains) == 1 else 1.25) or abs(row["limit"] / limit - 1) > 1e-9:
            errors.append(f"{where}: {quantity} of {rail} from {a} to {b}: {row['value']}, here {value}")
        if not structure.girders[number]["connected"] and (not inside or value / limit > max(inside)):
            errors.append(f"{where}: a row that is not expected: {quantity} of {rail} from {a} to {b}, {value} of {limit}")
    known = pair_rows(structure, reading.responses, trains, code)
    for quantity, value in known.items():
        count += 1
        if quantity not in pairs:
            errors.append(f"{where}: no row for {quantity}, {value}")
        elif not 0.8 * value <= pairs.pop(quantity) <= 1.015 * value:
            errors.append(f"{where}: {quantity}: {[r['value'] for r in summary['limits'] if r['quantity'] == quantity]}, "
                          f"here {value}")
    errors += [f"{where}: a row that is not expected: {key}, {value}" for key, value in pairs.items() if key not in known]
    return errors, count


def compare_run(program, seed):
    """Errors of one run: a bridge on two girders, two wheels on each, judged by codes and a limit of one's own."""
    rng = np.random.default_rng(seed)
    while True:
        kind, structure, solution = draw(rng)
        if len(structure.girders) == 1:
            break
    girder, width = structure.girders[0], 12.0
    base = round(float(rng.uniform(1, 3)), 1)
    weight = float(rng.integers(40, 300))
    low, high = girder["joints"][0] + base / 2, girder["joints"][-1] - base / 2
    truck = lambda rail, z: {"name": rail, "body": "bridge", "tree": [-base / 2, base / 2], "rail": f"s.{rail}", "wheel": "w",
                             "at": [0, 0, z]}
    scene = {
        "format": "girderway-scene/1", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.81,
        "analysis": "quasi-static", "structures": {"s": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"bridge": {"weight": 2 * weight, "inertia": [500, 500, 50], "dof": ["y", "roll", "pitch"],
                              "track": ["s.a", "s.b"]}},
        "wheels": {"w": {"radius": 0.2, "vertical": {"k": 1e6}}},
        "trucks": [truck("a", -width / 2), truck("b", width / 2)],
        "motions": [{"body": "bridge", "dof": "x", "kind": "prescribed", "position": [[0, low], [20, high]]}],
        "end": {"time": 20}, "output": {"dt": 0.05},
        "practice": {"class": "D", "code": ["CMAA 70", "EN 1993-6"], "limits": {"vertical": "L/450"}},
    }
    where = f"run {seed} ({kind})"
    summary = run_program(program, "run", doubled(structure, width).spec(), scene)
    if isinstance(summary, str):
        return [f"{where}: {summary}"], 0
    responses = Responses(structure, solution, 0.1)
    train = {"wheels": [{"rail": "a", "x": x, "vertical": weight / 2} for x in (-base / 2, base / 2)]}
    own = {"CMAA 70": (600, None), "EN 1993-6:2007": (600, 0.025), "own": (450, None)}
    worst = {}
    for plane, rules, loads in ((0, own, "vertical"), (1, {"CMAA 70": (400, None)}, "tenth")):
        for a, b in spans_of(structure, 0, plane):
            value = deflection(responses, [[train]], [loads], 0, plane, (a, b))
            for code, rule in rules.items():
                key = (QUANTITIES[plane], code)
                worst[key] = max(worst.get(key, 0.0), value / allowed(rule, b - a))
    errors = []
    for (quantity, code), known in worst.items():
        own = [c for c in summary["verdict"]["checks"] if (c["check"], c.get("code", "own")) == (quantity, code)]
        if not own:
            errors.append(f"{where}: no check of {quantity} by {code}, here {known}")
            continue
        found = max(c["utilisation"] for c in own)
        # A run evaluates its limits at some of its output times.
        if not 0.95 * known <= found <= 1.005 * known:
            errors.append(f"{where}: {quantity} by {code}: {found}, here {known}")
        if own[0].get("sampled"):
            errors.append(f"{where}: {quantity} by {code}: said to be sampled")
    fails = max(worst.values()) > 1.0
    near = abs(max(worst.values()) - 1) < 0.03
    if not near and (summary["verdict"]["result"] == "not ok") != fails:
        errors.append(f"{where}: verdict {summary['verdict']['result']}")
    return errors, len(worst)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--designs", type=int, default=30)
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    program = str(pathlib.Path(given.program).resolve())
    errors, rows = [], 0
    for count, compare in ((given.designs, compare_design), (given.runs, compare_run)):
        for seed in range(given.seed, given.seed + count):
            own, number = compare(program, seed)
            errors += own
            rows += number
    print("\n".join(errors))
    print(f"{given.designs} designs, {given.runs} runs, {rows} rows, {len(errors)} errors")
    return bool(errors)


if __name__ == "__main__":
    sys.exit(main())
