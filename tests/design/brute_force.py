#!/usr/bin/env python3
"""Designs of random structures beside brute force: no state of the trains may exceed what the program lists as extremes.

Usage: brute_force.py GIRDERWAY [--designs 40] [--seed 1] [--file DESIGN.json] [--keep FOLDER]. Needs numpy.

Structures are girders in the short form, and frames with columns, brackets on rigid links, springs, hinges, tapers, rigid
arms, sloping members, one or two rails (also two on one girder), and overhanging ends. Each case has one to three trains of one
to eight wheels, with ends, gaps, orders, factors and forces in three directions beside the rail.

The frame is solved here by a program of its own, which reads the spec: the stiffness of a member is the inverse of the
flexibility of a cantilever, and a load on a member acts through the forces of its clamped ends. Four things are checked:

- attained: at the positions, signs, place and side that the program states, the response is its value, and the positions are
  admissible (wheels on their rails, distances between the ends of trains);
- optimal: no arrangement that is found here exceeds its value. Positions are those of a grid and those at which a wheel stands
  at an end of a member or at the section, in all orders, directions and signs; several trains are combined by running maxima
  over their grids, so that every value belongs to an admissible arrangement. The best state and the state of the program are
  then improved: positions on ever finer grids with trains that touch, places along the span, and places that follow a wheel;
- envelope: the envelope at the place of an extreme has its value;
- direct: one state of each moment and deflection is solved again here, with a point of the frame under each wheel.

Values are compared by the largest of their quantity. The exit status is 1 where a check fails.
"""

import argparse
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

DOFS = ["ux", "uy", "uz", "rx", "ry", "rz"]
QUANTITIES = [("normal", "vertical"), ("torsion", "vertical"), ("shear", "vertical"), ("shear", "lateral"),
              ("moment", "vertical"), ("moment", "lateral"), ("deflection", "vertical"), ("deflection", "lateral")]
# Gauss-Legendre nodes and weights on 0..1: a cubic is known by its values there, and its integral by their weighted sum.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
NODES, WEIGHTS = 0.5 * (1 + _NODES), 0.5 * _WEIGHTS
TO_POWERS = np.linalg.inv(np.vander(NODES, 4, increasing=True))
# A wheel this far beside a place counts as before or behind it, relative to the length of the rails.
BESIDE = 1e-11
# Seconds after which a design is given up.
LONGEST = 40


class Singular(Exception):
    """The structure can move without strain."""


def cross(r):
    """Matrix of theta -> theta x r."""
    return np.array([[0, r[2], -r[1]], [-r[2], 0, r[0]], [r[1], -r[0], 0]])


def moved(d):
    """Displacements of a rigid bar at distances d along local x from those at its start; array (..., 6, 6)."""
    d = np.asarray(d, float)
    out = np.zeros(d.shape + (6, 6))
    out[..., range(6), range(6)] = 1
    out[..., 1, 5], out[..., 2, 4] = d, -d
    return out


class Member:
    """A uniform member between the tips of its arms."""

    def __init__(self, nodes, points, offsets, up, stiff, free, truss=False):
        self.nodes, self.free, self.truss = nodes, free, truss
        self.tips = [points[n] + o for n, o in zip(nodes, offsets)]
        along = self.tips[1] - self.tips[0]
        self.length = np.linalg.norm(along)
        x = along / self.length
        y = up - x * (up @ x)
        y = y / np.linalg.norm(y) if np.linalg.norm(y) > 1e-9 else cross(x)[:, int(np.argmin(np.abs(x)))]
        y = y / np.linalg.norm(y)
        self.axes = np.array([x, y, np.cross(x, y)])
        self.stiff = stiff
        arm = np.zeros((12, 12))
        for k, o in enumerate(offsets):
            arm[6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = np.eye(6)
            arm[6 * k : 6 * k + 3, 6 * k + 3 : 6 * k + 6] = cross(o)
        self.motion = np.kron(np.eye(4), self.axes) @ arm
        if truss:
            k = np.zeros((12, 12))
            k[np.ix_([0, 6], [0, 6])] = stiff["axial"] / self.length * np.array([[1, -1], [-1, 1]])
            self.whole = k
        else:
            end = np.linalg.inv(self.flexibility(self.length))
            turn = moved(self.length)
            self.end = end
            self.whole = np.block([[turn.T @ end @ turn, -turn.T @ end], [-end @ turn, end]])
        kept = [d for d in range(12) if d not in free]
        self.kept = kept
        self.stiffness = np.zeros((12, 12))
        # recovery of the displacements of the flexible ends from those of the tips, and from end forces on what is released
        self.recovery = np.eye(12)
        self.released = np.zeros((12, 12))
        k = self.whole
        self.stiffness[np.ix_(kept, kept)] = k[np.ix_(kept, kept)]
        if free:
            inner = np.linalg.inv(k[np.ix_(free, free)])
            self.released[np.ix_(free, free)] = -inner
            self.recovery[free] = 0
            self.recovery[np.ix_(free, kept)] = -inner @ k[np.ix_(free, kept)]
            self.stiffness[np.ix_(kept, kept)] -= k[np.ix_(kept, free)] @ inner @ k[np.ix_(free, kept)]

    def flexibility(self, s):
        """Displacements of the end of a cantilever of length s under forces and moments there; array (..., 6, 6)."""
        s, c = np.asarray(s, float), self.stiff
        f = np.zeros(s.shape + (6, 6))
        f[..., 0, 0], f[..., 3, 3] = s / c["axial"], s / c["torsion"]
        f[..., 1, 1] = s**3 / 3 / c["bend_z"] + s * c["shear_y"]
        f[..., 2, 2] = s**3 / 3 / c["bend_y"] + s * c["shear_z"]
        f[..., 1, 5] = f[..., 5, 1] = s**2 / 2 / c["bend_z"]
        f[..., 2, 4] = f[..., 4, 2] = -(s**2) / 2 / c["bend_y"]
        f[..., 5, 5], f[..., 4, 4] = s / c["bend_z"], s / c["bend_y"]
        return f

    def clamped(self, s, w):
        """End forces on the member, and displacements of released ends, under loads w (..., 6) at places s (...)."""
        s = np.asarray(s, float)
        at_b = np.einsum("...ij,...jk,...k->...i", moved(self.length - s), self.flexibility(s), w)
        b = -at_b @ self.end
        a = -np.einsum("...ji,...j->...i", moved(s), w) - b @ moved(self.length)
        p = np.concatenate([a, b], axis=-1)
        loose = p @ self.released.T
        out = p + loose @ self.whole.T
        out[..., self.free] = 0
        return out, loose

    def section_rows(self, s):
        """Rows for the twelve displacements of the tips: internal force and moment (local, of the part beyond on the part
        before), then displacement and rotation of the axis."""
        force = -np.swapaxes(moved(-s), -1, -2) @ self.stiffness[:6]
        return np.concatenate([force, moved(s) @ self.recovery[:6] + self.flexibility(s) @ force], axis=-2)

    def section_local(self, s, at, w, forces, loose):
        """The same due to loads w (n, 6) at places `at` (n) with clamped tips; s a number, loads at s not counted as passed."""
        passed = (at < s)[:, None]
        force = -forces[:, :6] @ moved(-s) - np.where(passed, np.einsum("nji,nj->ni", moved(at - s), w), 0)
        # what is loaded before the section bends the part before it
        own = np.einsum("nij,njk,nk->ni", moved(s - at), self.flexibility(np.minimum(at, s)), w)
        place = loose[:, :6] @ moved(s).T + force @ self.flexibility(s) + np.where(passed, own, 0)
        return np.concatenate([force, place], axis=1)


def log_mean(p, q):
    """Reciprocal of the mean reciprocal of a property that varies linearly."""
    return p if abs(p - q) < 1e-13 * abs(p) else (q - p) / np.log(q / p)


class Frame:
    """A beam spec with its stiffness, and the places at which its rails are loaded."""

    def __init__(self, spec):
        self.spec = spec = general(spec)
        up = np.array(spec.get("up", [0, 1, 0]), float)
        self.up = up / np.linalg.norm(up)
        self.points = [np.array(p, float) for p in spec["points"]]
        materials = {m["name"]: m for m in spec["materials"]}
        sections = spec["sections"]
        shear = spec.get("theory", "timoshenko") == "timoshenko"
        names = {s["name"]: k for k, s in enumerate(sections) if "name" in s}
        sets = spec.get("point_sets", {})
        point = lambda p: p if isinstance(p, int) else sets[p][0]
        self.members, self.cells = [], {}
        self.weights = []
        for block, cells in enumerate(spec["cells"]):
            data = {k: v[block] for k, v in spec.get("cell_data", {}).items() if v[block] is not None}
            for index, (a, b) in enumerate(cells["data"]):
                get = lambda key, default: next((v for v in [data[key][index] if isinstance(data.get(key), list)
                                                             else data.get(key)] if v is not None), default)
                section = get("section", 0)
                section = sections[names[section] if isinstance(section, str) else section]
                other = get("section_b", None)
                other = section if other is None else sections[names[other] if isinstance(other, str) else other]
                material = materials[section["material"]]
                truss = get("kind", "beam") == "truss"
                offsets = [np.array(get(f"offset_{e}", [0, 0, 0]), float) for e in "ab"]
                free = [DOFS.index(d) for d in get("release_a", [])] + [6 + DOFS.index(d) for d in get("release_b", [])]
                up_of = np.array(get("orientation", list(self.up)), float)
                count = get("parts", 1) if other is not section else 1
                tips = [self.points[a] + offsets[0], self.points[b] + offsets[1]]
                chain = [a]
                for k in range(1, count):
                    self.points.append(tips[0] + (tips[1] - tips[0]) * k / count)
                    chain.append(len(self.points) - 1)
                chain.append(b)
                self.cells[block, index] = list(range(len(self.members), len(self.members) + count))
                for k in range(count):
                    def value(key, default=None):
                        if key not in section:
                            return default
                        p, q = section[key], other[key]
                        return log_mean(p + (q - p) * k / count, p + (q - p) * (k + 1) / count)
                    e, g = material["E"], material.get("G", 0.0)
                    stiff = {"axial": e * value("A")}
                    if not truss:
                        stiff |= {"torsion": g * value("J"), "bend_y": e * value("Iy"), "bend_z": e * value("Iz"),
                                  "shear_y": 1 / (g * value("Asy")) if shear and value("Asy") else 0.0,
                                  "shear_z": 1 / (g * value("Asz")) if shear and value("Asz") else 0.0}
                    own = [offsets[0] if k == 0 else np.zeros(3), offsets[1] if k == count - 1 else np.zeros(3)]
                    own_free = [d for d in free if (d < 6 and k == 0) or (d >= 6 and k == count - 1)]
                    self.members.append(Member(chain[k : k + 2], self.points, own, up_of, stiff, own_free, truss))
                    self.weights.append(material.get("density", 0.0) * value("A"))
        n = 6 * len(self.points)
        k = np.zeros((n, n))
        for m in self.members:
            at = self.dofs(m)
            k[np.ix_(at, at)] += m.motion.T @ m.stiffness @ m.motion
        follow = np.eye(n)
        for link in spec.get("links", []):
            a, b = point(link["from"]), point(link["to"])
            rows = np.eye(6)
            rows[:3, 3:] = cross(self.points[b] - self.points[a])
            follow[6 * b : 6 * b + 6] = 0
            follow[6 * b : 6 * b + 6, 6 * a : 6 * a + 6] = rows
        self.follow = follow
        k = follow.T @ k @ follow
        label = lambda p: next((name for name, own in sets.items() if own == [p]), f"point{p}")
        self.reactions = {}
        fixed = []
        for support in spec.get("supports", []):
            own = support["point"]
            for p in [own] if isinstance(own, int) else sets[own]:
                for d in support["fix"]:
                    fixed.append(6 * p + DOFS.index(d))
                    self.reactions[label(p), d] = ("support", 6 * p + DOFS.index(d))
        for spring in spec.get("springs", []):
            d = 6 * point(spring["point"]) + DOFS.index(spring["dof"])
            k[d, d] += spring["k"]
            self.reactions[label(point(spring["point"])), spring["dof"]] = ("spring", d, spring["k"])
        if spec.get("names"):
            self.reactions = {(spec["names"][a], spec["words"].get(d, d)): v for (a, d), v in self.reactions.items()}
        size = np.abs(k).max()
        free = [d for d in range(n) if d not in fixed and k[d, d] > 1e-13 * size * 1e-3]
        self.k, self.open = k, free
        inner = k[np.ix_(free, free)]
        scale = 1 / np.sqrt(np.diag(inner))
        scaled = inner * scale[:, None] * scale
        if free and np.linalg.eigvalsh(scaled)[0] < 1e-11:
            raise Singular
        self.inverse = scale[:, None] * np.linalg.inv(scaled) * scale
        self.make_rails()

    def dofs(self, m):
        """Degrees of freedom of both points of a member."""
        return np.r_[6 * m.nodes[0] : 6 * m.nodes[0] + 6, 6 * m.nodes[1] : 6 * m.nodes[1] + 6]

    def make_rails(self):
        """The places of each rail: stretches on members, and gaps that follow the nearer tip."""
        self.rails, self.rail_axes, self.origins = {}, {}, {}
        for name, rail in self.spec["rails"].items():
            axis = np.array(rail["axis"], float)
            axis = axis / np.linalg.norm(axis)
            y = self.up - axis * (axis @ self.up)
            y = y / np.linalg.norm(y)
            self.rail_axes[name] = np.array([axis, y, np.cross(axis, y)])
            origin = self.origins[name] = np.array(rail.get("origin", [0, 0, 0]), float)
            found = []
            for segment in rail["segments"]:
                for m in self.cells[tuple(segment["cell"])]:
                    ends = [axis @ (tip - origin) for tip in self.members[m].tips]
                    found.append(dict(member=m, x=sorted(ends), back=ends[0] > ends[1],
                                      offset=np.array(segment.get("offset", [0, 0, 0]), float)))
            found.sort(key=lambda c: c["x"][0])
            out = []
            for c in found:
                if out and c["x"][0] > out[-1]["x"][1] + 1e-9:
                    before, middle = out[-1], 0.5 * (out[-1]["x"][1] + c["x"][0])
                    out.append(self.gap(before, before["x"][1], [before["x"][1], middle], 0 if before["back"] else 1))
                    out.append(self.gap(c, c["x"][0], [middle, c["x"][0]], 1 if c["back"] else 0))
                out.append(c)
            for c in out:
                c["rail"], c["axes"] = name, self.rail_axes[name]
            self.rails[name] = out
        # members as rails of their own, for their weight
        self.own = [dict(member=m, x=[0.0, member.length], back=False, offset=np.zeros(3),
                         axes=np.array([self.up, self.up, self.up]), rail=None)
                    for m, member in enumerate(self.members) if not member.truss]
        self.own_stack = self.stack(self.own)
        self.stacks = {name: self.stack(cells) for name, cells in self.rails.items()}

    def stack(self, cells):
        """First coordinates, lengths, degrees of freedom and forces on them (cell, node, load, 12) of stretches."""
        at, forces = np.zeros((len(cells), 12), int), np.zeros((len(cells), 4, 5, 12))
        for k, cell in enumerate(cells):
            x = cell["x"]
            dofs, own = self.on_points(cell, x[0] + (x[1] - x[0]) * NODES)
            at[k, : len(dofs)], forces[k, ..., : len(dofs)] = dofs, own
        x = np.array([c["x"] for c in cells])
        return x[:, 0], x[:, 1] - x[:, 0], at, forces, [c["member"] for c in cells]

    def gap(self, cell, x, ends, end):
        member = self.members[cell["member"]]
        node = member.nodes[end]
        return dict(member=None, node=node, x=ends, at=x, arm=member.tips[end] + cell["offset"] - self.points[node],
                    follows=cell)

    def range(self, rail):
        """First and last coordinate of a rail."""
        return self.rails[rail][0]["x"][0], self.rails[rail][-1]["x"][1]

    def place(self, cell, x):
        """Places on the member of a stretch."""
        m = self.members[cell["member"]]
        s = (np.asarray(x) - cell["x"][0]) / (cell["x"][1] - cell["x"][0]) * m.length
        return np.clip(m.length - s if cell["back"] else s, 0, m.length)

    def loads(self, cell, x):
        """Unit loads at coordinates x (n): member or node, places (n), loads (n, 5, 6): along x, up, along z; couples of
        forces along x and up at one unit of length along z."""
        axes = cell["axes"]
        x = np.asarray(x, float)

        def at(arm):
            w = np.zeros((5, 6))
            w[:3, :3], w[:3, 3:] = axes, axes @ cross(arm)
            w[3, 3:], w[4, 3:] = np.cross(axes[2], axes[0]), np.cross(axes[2], axes[1])
            return w
        if cell["member"] is None:
            return None, np.array([at(cell["arm"] + (v - cell["at"]) * axes[0]) for v in x])
        if "unit" not in cell:
            m = self.members[cell["member"]]
            w = at(cell["offset"])
            cell["unit"] = np.concatenate([w[:, :3] @ m.axes.T, w[:, 3:] @ m.axes.T], axis=1)
        return self.place(cell, x), np.broadcast_to(cell["unit"], (len(x), 5, 6))

    def on_points(self, cell, x):
        """The forces on points (n, 5, 6 or 12) of unit loads at coordinates x, with their degrees of freedom."""
        s, w = self.loads(cell, x)
        if s is None:
            return np.arange(6 * cell["node"], 6 * cell["node"] + 6), w
        m = self.members[cell["member"]]
        forces, _ = m.clamped(np.repeat(s[:, None], 5, 1), w)
        return self.dofs(m), -forces @ m.motion

    def words(self, cell):
        """Rows (8, 12) for the quantities of a section of a stretch by the internal force and the motion of its axis."""
        if "words" not in cell:
            cell["words"] = self.words_of(cell)
        return cell["words"]

    def words_of(self, cell):
        m, axes = self.members[cell["member"]], self.rail_axes[cell["rail"]]
        t = m.axes[0] * (-1 if cell["back"] else 1)
        sign = -1 if cell["back"] else 1
        u = self.up - t * (t @ self.up)
        u = u / np.linalg.norm(u)
        z = np.cross(t, u)
        out = np.zeros((8, 12))
        for row, (part, direction) in enumerate([(0, t), (3, t), (0, -u), (0, z), (3, z), (3, u)]):
            out[row, part : part + 3] = sign * (m.axes @ direction)
        for row, direction in ((6, -axes[1]), (7, axes[2])):
            out[row, 6:9] = m.axes @ direction
            out[row, 9:12] = m.axes @ np.cross(cell["offset"], direction)
        return out


def general(spec):
    """A spec in the general form."""
    if "girder" not in spec:
        return spec
    g = spec["girder"]
    spans, over = g["spans"], g.get("overhangs", [0, 0])
    supports = np.concatenate([[0.0], np.cumsum(spans)])
    xs = list(supports)
    if over[0]:
        xs = [-over[0]] + xs
    if over[1]:
        xs = xs + [xs[-1] + over[1]]
    first = 1 if over[0] else 0
    section = {"material": "own", "A": g["A"], "Iy": g["I_lateral"], "Iz": g["I_vertical"], "J": g["J"]}
    if "kA_vertical" in g:
        section["Asy"] = g["kA_vertical"]
    if "kA_lateral" in g:
        section["Asz"] = g["kA_lateral"]
    own = {"name": "own", "E": g["E"], "G": g["G"], "density": g.get("mass_per_length", 0.0) / g["A"]}
    h = g.get("rail_height", 0.0)
    fixes = [{"point": first + k, "fix": ["uy", "uz", "rx"] + (["ux"] if k == 0 else [])} for k in range(len(supports))]
    return {"theory": spec.get("theory", "timoshenko"), "points": [[float(x), 0, 0] for x in xs],
            "cells": [{"type": "line", "data": [[k, k + 1] for k in range(len(xs) - 1)]}], "cell_data": {},
            "materials": [own], "sections": [section], "supports": fixes,
            "names": {f"point{first + k}": f"support{k + 1}" for k in range(len(supports))}, "words": {},
            "rails": {"rail": {"axis": [1, 0, 0], "origin": [0, h, 0],
                               "segments": [{"cell": [0, k], "offset": [0, h, 0]} for k in range(len(xs) - 1)]}}}


class Influence:
    """Influence lines of responses: for each rail pieces with cubics (piece, load, power, response)."""

    def __init__(self, frame, rows, direct=None, section=None, words=None):
        """`rows` (response, all degrees of freedom); `direct` a degree of freedom whose load is subtracted; `section` = (cell,
        x) where the loads on its member act directly, by `words`."""
        self.frame = frame
        n = len(frame.follow)
        free = frame.open
        virtual = np.zeros((n, len(rows)))
        virtual[free] = frame.inverse @ (rows @ frame.follow)[:, free].T
        self.virtual = frame.follow @ virtual
        self.direct, self.section, self.words = direct, section, words
        self.make_lines()

    def make_lines(self):
        """The cubics of all rails."""
        self.lines, self.starts, self.lengths = {}, {}, {}
        for name, cells in self.frame.rails.items():
            self.starts[name], self.lengths[name], self.lines[name] = self.pieces(cells, self.frame.stacks[name])

    def pieces(self, cells, stack):
        """First coordinates, lengths and cubics (piece, load, power, response) of stretches."""
        starts, lengths, at, forces, members = stack
        values = self.on_all(at, forces)
        if self.section is not None and self.section[0]["member"] in members:
            parts = []
            for k, cell in enumerate(cells):
                if cell["member"] != self.section[0]["member"]:
                    parts.append(([starts[k]], [lengths[k]], values[k : k + 1]))
                    continue
                split = self.split(cell)
                own = [self.values(cell, a + (b - a) * NODES) for a, b in split]
                parts.append(([a for a, _ in split], [b - a for a, b in split], np.array(own)))
            starts, lengths, values = [np.concatenate(v) for v in zip(*parts)]
        cubic = np.einsum("pk,nkcr->ncpr", TO_POWERS, values)
        return starts, lengths, cubic / (lengths[:, None] ** np.arange(4))[:, None, :, None]

    def on_all(self, at, forces):
        """Responses (cell, node, load, response) to forces on points."""
        virtual = self.virtual
        if self.direct is not None:
            virtual = virtual - self.frame.follow[:, [self.direct]]
        n, r = len(at), virtual.shape[1]
        return (forces.reshape(n, 20, 12) @ virtual[at]).reshape(n, 4, 5, r)

    def split(self, cell):
        if self.section is None or cell["member"] is None or cell["member"] != self.section[0]["member"]:
            return [cell["x"]]
        own, s = self.section
        m = self.frame.members[cell["member"]]
        f = (m.length - s if cell["back"] else s) / m.length
        x = cell["x"][0] + f * (cell["x"][1] - cell["x"][0])
        return [p for p in ([cell["x"][0], x], [x, cell["x"][1]]) if p[1] - p[0] > 1e-14 * (1 + abs(x))]

    def values(self, cell, x):
        """Responses (n, 5, response) to unit loads at coordinates inside a piece."""
        at, forces = self.frame.on_points(cell, x)
        out = forces @ self.virtual[at]
        if self.direct is not None:
            out[..., 0] -= forces @ self.frame.follow[at][:, self.direct]
        if self.section is not None and cell["member"] is not None and cell["member"] == self.section[0]["member"]:
            m = self.frame.members[cell["member"]]
            s, w = self.frame.loads(cell, x)
            places = np.repeat(s, 5)
            loads = w.reshape(-1, 6)
            own = m.section_local(self.section[1], places, loads, *m.clamped(places, loads))
            out = out + (own @ self.words.T).reshape(len(x), 5, -1)
        return out

    def parts(self, train, turned, positions):
        """Responses (5, n, response) to the vertical, lateral, longitudinal forces, and to the couples of the vertical and the
        longitudinal forces, of a train at positions (n)."""
        out = np.zeros((5, len(positions), self.virtual.shape[1]))
        for name, own in train.by_rail(turned).items():
            starts, lines = self.starts[name], self.lines[name]
            low, high = self.frame.range(name)
            slack = 1e-12 * max(abs(low), abs(high))
            x = positions[:, None] + own["offset"]
            on = (x >= low - slack) & (x <= high + slack)
            piece = np.clip(np.searchsorted(starts, x, side="right") - 1, 0, len(starts) - 1)
            t = x - starts[piece]
            powers = np.stack([np.ones_like(t), t, t * t, t**3], axis=-1) * on[..., None]
            for part, component, force in ((0, 1, -own["vertical"]), (1, 2, own["lateral"]), (2, 0, own["longitudinal"]),
                                           (3, 4, -own["vertical"] * own["lever"]),
                                           (4, 3, own["longitudinal"] * own["lever"])):
                if force.any():
                    out[part] += np.einsum("nwp,nwpr->nr", powers * force[:, None], lines[piece, component])
        return out

    def bounds(self, train, turned, positions):
        """The largest and the smallest response (n, response) over the signs."""
        v, q, l, ev, el = self.parts(train, turned, positions)
        if not train.reverses:
            return (v + q + l + ev + el,) * 2
        # the couple of the longitudinal forces changes with both signs
        both = np.array([l + ev + el, l - ev - el, -l + ev - el, -l - ev + el])
        return v + np.abs(q) + both.max(axis=0), v - np.abs(q) + both.min(axis=0)

    def dead(self, line, gravity):
        """Response to line loads downwards on the rails and to the weight of members."""
        total = np.zeros(self.virtual.shape[1])
        frame = self.frame
        power = 1 / np.arange(1, 5)

        def mean(lengths, lines):
            return np.einsum("n,np,npr->nr", lengths, lengths[:, None] ** np.arange(4) * power, lines[:, 1])
        for name, load in line.items():
            total -= load * mean(self.lengths[name], self.lines[name]).sum(axis=0)
        if gravity:
            starts, lengths, lines = self.pieces(frame.own, frame.own_stack)
            owners = np.repeat(np.arange(len(frame.own)), [len(self.split(c)) for c in frame.own])
            weights = np.array([frame.weights[c["member"]] for c in frame.own])
            total -= gravity * (weights[owners][:, None] * mean(lengths, lines)).sum(axis=0)
            for m, member in enumerate(frame.members):
                for node in member.nodes if member.truss else []:
                    half = 0.5 * gravity * frame.weights[m] * member.length
                    total -= half * (frame.up @ self.virtual[6 * node : 6 * node + 3])
                    if self.direct is not None:
                        total[0] += half * (frame.up @ frame.follow[6 * node : 6 * node + 3, self.direct])
        return total


def section_lines(frame, cell, s):
    """Influence lines of the eight quantities of a section."""
    m, words = frame.members[cell["member"]], frame.words(cell)
    rows = np.zeros((8, len(frame.follow)))
    rows[:, frame.dofs(m)] = words @ m.section_rows(np.float64(s)) @ m.motion
    return Influence(frame, rows, section=(cell, s), words=words)


def named_lines(frame, section, spec):
    """Influence lines of a named section of a design."""
    if "x" in section:
        cells = [c for c in frame.rails["rail"] if c["x"][0] - 1e-12 <= section["x"] < c["x"][1]]
        cell = (cells or [frame.rails["rail"][-1]])[0]
        m, s = cell["member"], section["x"] - cell["x"][0]
    else:
        parts = frame.cells[tuple(section["cell"])]
        total = sum(frame.members[m].length for m in parts)
        at = section["place"] * total
        for m in parts:
            if at < frame.members[m].length * (1 - 1e-12) or m == parts[-1]:
                s = at
                break
            at -= frame.members[m].length
    member = frame.members[m]
    # at an end the section is just inside
    s = min(max(s, 1e-13 * member.length), member.length * (1 - 1e-13))
    words = np.zeros((1, 12))
    words[0, ["N", "Vy", "Vz", "Mx", "My", "Mz"].index(section["component"])] = 1
    rows = np.zeros((1, len(frame.follow)))
    rows[:, frame.dofs(member)] = words @ member.section_rows(np.float64(s)) @ member.motion
    return Influence(frame, rows, section=(dict(member=m, back=False), s), words=words)


def reaction_lines(frame, key):
    """Influence line of a reaction."""
    found = frame.reactions[key]
    if found[0] == "support":
        # the stiffness of bodies acts on their leading points
        lines = Influence.__new__(Influence)
        lines.frame, lines.direct, lines.section, lines.words = frame, found[1], None, None
        n = len(frame.follow)
        virtual = np.zeros((n, 1))
        virtual[frame.open, 0] = frame.inverse @ frame.k[found[1], frame.open]
        lines.virtual = frame.follow @ virtual
        lines.make_lines()
        return lines
    row = np.zeros((1, len(frame.follow)))
    row[0, found[1]] = -found[2]
    return Influence(frame, row)


class Train:
    """A train with the forces of a case."""

    def __init__(self, given, factors, frame):
        self.name = given["name"]
        rails = list(frame.rails)
        default = given.get("rail", rails[0])
        wheels = given["wheels"]
        f = lambda key: factors.get(key, 1.0)
        self.reverses = given.get("signs", "both") == "both"
        self.enters, self.ends = given.get("enters", False), given.get("ends", [0, 0])
        self.ways = [False, True] if given.get("turned", True) else [False]
        self.wheels = []
        first = wheels[0].get("rail", default)
        for w in wheels:
            v = w["vertical"]
            v = sum(p * factors.get(k, f("vertical")) for k, p in v.items()) if isinstance(v, dict) else v * f("vertical")
            rail = w.get("rail", default)
            shift = (frame.origins[first] - frame.origins[rail]) @ frame.rail_axes[first][0]
            self.wheels.append(dict(
                rail=rail, x=w["x"], shift=shift, vertical=v,
                lateral=w.get("lateral", given.get("lateral", 0.0)) * f("lateral"),
                longitudinal=w.get("longitudinal", given.get("longitudinal", 0.0) / len(wheels)) * f("longitudinal"),
                lever=w.get("eccentricity", given.get("eccentricity", 0.0))))
        self.kept, self.frame = {}, frame

    def by_rail(self, turned):
        """Arrays of the wheels on each rail."""
        if turned not in self.kept:
            out = {}
            for name in {w["rail"]: 0 for w in self.wheels}:
                own = [w for w in self.wheels if w["rail"] == name]
                out[name] = {k: np.array([w[k] for w in own]) for k in ("vertical", "lateral", "longitudinal", "lever")}
                out[name]["offset"] = np.array([(-w["x"] if turned else w["x"]) + w["shift"] for w in own])
            self.kept[turned] = out
        return self.kept[turned]

    def extent(self, turned, rail):
        """What it covers of a rail, less its position, or nothing."""
        own = self.by_rail(turned).get(rail)
        if own is None:
            return None
        before, behind = self.ends[::-1] if turned else self.ends
        return own["offset"].min() - before, own["offset"].max() + behind

    def range(self, turned):
        """First and last position; of a train that enters those beyond which nothing is loaded."""
        ends = [(self.frame.range(r)[0] - o["offset"].min(), self.frame.range(r)[1] - o["offset"].max())
                for r, o in self.by_rail(turned).items()]
        if self.enters:
            wide = [(self.frame.range(r)[0] - o["offset"].max(), self.frame.range(r)[1] - o["offset"].min())
                    for r, o in self.by_rail(turned).items()]
            return min(a for a, _ in wide), max(b for _, b in wide)
        return max(a for a, _ in ends), min(b for _, b in ends)


class Case:
    """Trains at once. At the ends of its range a train stands just inside, as the program has it at joints of rails and at named
    sections; a wheel that stands at a joint or a section there may count on either side with `from_inside` false."""

    from_inside = True

    def __init__(self, given, design, frame):
        given = given if isinstance(given, dict) else {"trains": given}
        self.factors = given.get("factors", {})
        by_name = {t["name"]: t for t in design["trains"]}
        self.trains = [Train(by_name[n], self.factors, frame) for n in given["trains"]]
        names = given["trains"]
        self.names = [n if names.count(n) == 1 else f"{n}{names[: k + 1].count(n)}" for k, n in enumerate(names)]
        self.gap, self.ordered = given.get("gap", 0.0), given.get("order", "any") == "given"
        self.dead = self.factors.get("dead", 1.0)
        dead = design.get("dead_load", False)
        weight = dead is True or isinstance(dead, dict) and dead.get("weight", False)
        self.gravity = design.get("gravity", 9.80665) if weight else 0.0
        self.line = dead.get("line", {}) if isinstance(dead, dict) else {}
        self.frame = frame
        self.length = max(b - a for a, b in map(frame.range, frame.rails))

    def distance(self, i, way, j, other):
        """Least distance from the position of train i to that of train j behind it."""
        found = -np.inf
        for rail in self.frame.rails:
            a, b = self.trains[i].extent(way, rail), self.trains[j].extent(other, rail)
            if a and b:
                found = max(found, a[1] - b[0] + self.gap)
        return found

    def orders(self):
        """Orders of the trains."""
        count = range(len(self.trains))
        return [tuple(count)] if self.ordered else list(itertools.permutations(count))

    def span(self, j, way):
        """Range of positions of a train; one that enters may stand far beyond."""
        low, high = self.trains[j].range(way)
        if self.trains[j].enters:
            return low - 50 * self.length, high + 50 * self.length
        return self.inner(low, high)

    def inner(self, low, high):
        """The ends of a range of positions, from inside where the limits from inside are meant."""
        eps = BESIDE * self.length
        return (low + eps, high - eps) if self.from_inside and high - low > 4 * eps else (low, high)

    def is_admissible(self, ways, positions, slack):
        """Whether trains stand on their rails and clear of each other in one of the orders."""
        for j, (way, p) in enumerate(zip(ways, positions)):
            low, high = self.trains[j].range(way)
            if not self.trains[j].enters and not low - slack <= p <= high + slack:
                return False
        return any(all(positions[b] - positions[a] >= self.distance(a, ways[a], b, ways[b]) - slack
                       for a, b in itertools.combinations(order, 2)) for order in self.orders())

    def hub(self, order, ways):
        """A train from which the places of the others follow, or nothing."""
        if len(order) < 3:
            return 0
        c = lambda a, b: self.distance(order[a], ways[order[a]], order[b], ways[order[b]])
        for h in (1, 0, 2):
            a, b = [k for k in range(3) if k != h]
            if c(a, b) == -np.inf or h == 1 and c(a, b) <= c(a, 1) + c(1, b) + 1e-12:
                return h
        return None

    def best(self, grids, values):
        """The best arrangement on grids: `grids[j][way]` positions, `values[j][way]` (n, column). Values by column, and
        functions that give order, ways and positions of the best of a column."""
        count = len(self.trains)
        columns = values[0][self.trains[0].ways[0]].shape[1]
        best = np.full(columns, -np.inf)
        state = [None] * columns
        for ways in itertools.product(*[t.ways for t in self.trains]):
            for order in self.orders():
                h = self.hub(order, ways)
                if h is None:
                    continue
                hub = order[h]
                q = grids[hub][ways[hub]]
                total = values[hub][ways[hub]].copy()
                chosen = {}
                for k, j in enumerate(order):
                    if k == h:
                        continue
                    p, f = grids[j][ways[j]], values[j][ways[j]]
                    if k < h:
                        run = np.maximum.accumulate(f, axis=0)
                        limit = q - self.distance(j, ways[j], hub, ways[hub])
                        at = np.searchsorted(p, limit, side="right") - 1
                        part = np.where((at >= 0)[:, None], run[np.maximum(at, 0)], -np.inf)
                        chosen[j] = (True, at, f)
                    else:
                        run = np.maximum.accumulate(f[::-1], axis=0)[::-1]
                        limit = q + self.distance(hub, ways[hub], j, ways[j])
                        at = np.searchsorted(p, limit, side="left")
                        part = np.where((at < len(p))[:, None], run[np.minimum(at, len(p) - 1)], -np.inf)
                        chosen[j] = (False, at, f)
                    total += part
                top = total.argmax(axis=0)
                value = total[top, np.arange(columns)]
                for column in np.nonzero(value > best)[0]:
                    best[column] = value[column]
                    positions = [0.0] * count
                    positions[hub] = q[top[column]]
                    for j, (before, at, f) in chosen.items():
                        a = at[top[column]]
                        k = f[: a + 1, column].argmax() if before else a + f[a:, column].argmax()
                        positions[j] = grids[j][ways[j]][k]
                    state[column] = (ways, positions)
        return best, state

    def ways_only(self, ways):
        """The same case with its trains in given ways."""
        out = Case.__new__(Case)
        out.__dict__.update(self.__dict__)
        out.trains = []
        for train, way in zip(self.trains, ways):
            own = Train.__new__(Train)
            own.__dict__.update(train.__dict__)
            own.ways = [way]
            out.trains.append(own)
        return out

    def grid(self, j, way, count, marks=()):
        """Positions of a train: equal distances, and those with a wheel at an end of a stretch or at one of the marks (rail,
        x), on both sides."""
        train = self.trains[j]
        low, high = self.inner(*train.range(way))
        eps = BESIDE * self.length
        at = [np.linspace(low, high, count)]
        for rail, own in train.by_rail(way).items():
            ends = [x for c in self.frame.rails[rail] for x in c["x"]] + [x for r, x in marks if r == rail]
            at.append((np.array(ends)[:, None] - own["offset"]).ravel())
        at = np.concatenate(at)
        at = np.unique(np.clip(np.concatenate([at, at - eps, at + eps]), low, high))
        if train.enters:
            far = 10 * self.length * np.arange(1, 4)
            at = np.concatenate([(low - far)[::-1], [low - 3 * eps], at, [high + 3 * eps], high + far])
        return at


class Field:
    """The response of all members to loads that stand."""

    def __init__(self, case, ways, positions, signs):
        frame = self.frame = case.frame
        force = np.zeros(len(frame.follow))
        self.on = {}
        for train, way, position, (sq, sl, se) in zip(case.trains, ways, positions, signs):
            for rail, own in train.by_rail(way).items():
                for k, offset in enumerate(own["offset"]):
                    x = position + offset
                    low, high = frame.range(rail)
                    slack = 1e-12 * max(abs(low), abs(high))
                    if not low - slack <= x <= high + slack:
                        continue
                    x = min(max(x, low), high)
                    cells = frame.rails[rail]
                    cell = cells[max(0, int(np.searchsorted([c["x"][0] for c in cells], x, side="right")) - 1)]
                    along, lever = sl * own["longitudinal"][k], se * own["lever"][k]
                    parts = np.array([along, -own["vertical"][k], sq * own["lateral"][k], lever * along,
                                      -lever * own["vertical"][k]])
                    at, forces = frame.on_points(cell, [x])
                    force[at] += parts @ forces[0]
                    if cell["member"] is not None:
                        s, w = frame.loads(cell, [x])
                        self.on.setdefault(cell["member"], []).append((s[0], parts @ w[0]))
        self.force = frame.follow.T @ force
        self.u = np.zeros(len(force))
        self.u[frame.open] = frame.inverse @ self.force[frame.open]
        self.all = frame.follow @ self.u

    def at(self, cell, places):
        """Quantities (n, 8) at places of the member of a stretch."""
        frame = self.frame
        m = frame.members[cell["member"]]
        words = frame.words(cell)
        tips = m.motion @ self.all[frame.dofs(m)]
        out = m.section_rows(np.asarray(places)) @ tips
        loads = self.on.get(cell["member"], [])
        if loads:
            at, w = np.array([l[0] for l in loads]), np.array([l[1] for l in loads])
            forces = m.clamped(at, w)
            for k, s in enumerate(places):
                out[k] += m.section_local(s, at, w, *forces).sum(axis=0)
        return out @ words.T


class Checker:
    """One design of the program beside brute force."""

    def __init__(self, spec, design, summary):
        self.frame = Frame(spec)
        self.spec, self.design, self.summary = spec, design, summary
        given = design.get("cases") or [[t["name"]] for t in design["trains"]]
        self.cases = [Case(c, design, self.frame) for c in given]
        # influence lines, and dead loads, by their places
        self.kept = {}
        self.sizes = {}
        for e in summary["extremes"]:
            self.sizes[self.kind(e)] = max(self.sizes.get(self.kind(e), 0.0), abs(e["value"]))
        # what would be zero without rounding is judged by the largest force and moment
        largest = max([v for k, v in self.sizes.items() if k[0] != "deflection"], default=1.0)
        for k in self.sizes:
            if k[0] != "deflection":
                self.sizes[k] = max(self.sizes[k], 1e-4 * largest)
        bend = max([v for k, v in self.sizes.items() if k[0] == "deflection"], default=1.0)
        for k in self.sizes:
            if k[0] == "deflection":
                self.sizes[k] = max(self.sizes[k], 1e-3 * bend)
        self.compared, self.excess, self.apart, self.short, self.direct = 0, -np.inf, 0.0, [], 0.0
        self.faults, self.tried = [], set()
        self.dead_faults, self.dead_apart = [], 0.0

    @staticmethod
    def kind(e):
        if e["quantity"] == "reaction":
            return ("reaction", e["direction"][0])
        if "section" in e:
            return ("section", "N" if e["quantity"] in ("N", "Vy", "Vz") else "M")
        return (e["quantity"], e["plane"])

    def lines(self, key, make):
        if key not in self.kept:
            self.kept[key] = make()
        return self.kept[key]

    def dead(self, case, cell, s):
        """The quantities (n, 8) of a section of a stretch under the dead load of a case: polynomials of degree four."""
        if not case.line and not case.gravity or not case.dead:
            return np.zeros((np.size(s), 8))
        key = ("dead", cell["rail"], cell["x"][0])
        length = self.frame.members[cell["member"]].length
        nodes = 0.5 - 0.5 * np.cos(np.pi * (np.arange(5) + 0.5) / 5)
        if key not in self.kept:
            values = [section_lines(self.frame, cell, f * length).dead(case.line, case.gravity) for f in nodes]
            self.kept[key] = np.linalg.solve(np.vander(nodes, increasing=True), np.array(values))
        return case.dead * np.vander(np.atleast_1d(s) / length, 5, increasing=True) @ self.kept[key]

    def span_of(self, rail, x):
        """Number of the span of a place strictly between its ends."""
        ends = self.design.get("spans", {}).get(rail)
        if ends is None:
            ends = list(np.concatenate([[0.0], np.cumsum(self.spec["girder"]["spans"])]))
        return int(np.searchsorted(ends, x))

    def state_of(self, case, e):
        """Ways, positions and signs of an entry."""
        found = [e["positions"][n] for n in case.names]
        signs = [[e["signs"][n][k] for k in ("lateral", "longitudinal", "eccentricity")] for n in case.names]
        return [f["turned"] for f in found], [f["position"] for f in found], signs

    def sections(self, rail, span, count=13):
        """Stretches and places of a span, just inside the ends of members too."""
        out = []
        ends = self.design.get("spans", {}).get(rail)
        if ends is None:
            ends = list(np.concatenate([[0.0], np.cumsum(self.spec["girder"]["spans"])]))
        low = ends[span - 1] if span else -np.inf
        high = ends[span] if span < len(ends) else np.inf
        for cell in self.frame.rails[rail]:
            a, b = max(cell["x"][0], low), min(cell["x"][1], high)
            if cell["member"] is None or b - a < 1e-9:
                continue
            eps = 1e-12 * (b - a) * 10
            xs = np.linspace(a, b, count)
            xs[0], xs[-1] = a + eps, b - eps
            out.append((cell, xs))
        return out

    def run(self, refined=40):
        by_span = {}
        rng = np.random.default_rng(1)
        chosen = rng.permutation(len(self.summary["extremes"]))[:refined]
        self.chosen = {id(self.summary["extremes"][k]) for k in chosen}
        for e in self.summary["extremes"]:
            key = (e["case"], e.get("rail"), e.get("span"), e.get("support"), e.get("direction"), e.get("section"))
            by_span.setdefault(key, []).append(e)
        for (number, rail, span, support, direction, section), entries in by_span.items():
            case = self.cases[number - 1]
            if rail is not None:
                self.check_span(case, rail, span, entries)
            elif support is not None:
                lines = self.lines((support, direction), lambda: reaction_lines(self.frame, (support, direction)))
                self.check_effect(case, lines, entries)
            elif section is not None:
                given = next(s for s in self.design["sections"] if s["name"] == section)
                lines = self.lines(("section", section), lambda: named_lines(self.frame, given, self.spec))
                self.check_effect(case, lines, entries)
        return self

    def value_of(self, case, lines, ways, positions, signs):
        """Response to trains in a state, without dead load."""
        total = 0
        for train, way, p, (sq, sl, se) in zip(case.trains, ways, positions, signs):
            v, q, l, ev, el = lines.parts(train, way, np.array([p]))[:, 0]
            total = total + v + sq * q + sl * l + se * ev + se * sl * el
        return total

    def beside(self, case, ways, positions):
        """The positions, and those a little beside them that are admissible: also by so little that a wheel which the program
        states just beyond a joint stays there."""
        eps = BESIDE * case.length
        for shifts in itertools.product((0, -eps, eps, -0.05 * eps, 0.05 * eps), repeat=len(positions)):
            moved_by = [p + s for p, s in zip(positions, shifts)]
            if case.is_admissible(ways, moved_by, 1.5 * eps):
                yield moved_by

    def judge(self, e, case, attained, found, where, dead=None):
        size = self.sizes[self.kind(e)] or 1.0
        if dead is not None and abs(dead - e["dead"]) > 1e-10 * size:
            # the other differences of this value follow from that of the dead load
            self.dead_apart = max(self.dead_apart, abs(dead - e["dead"]) / size)
            self.dead_faults.append(f"dead load: {e['case']} {e['rail']} {e['span']} {e['quantity']} {e['plane']} {e['kind']} at "
                                    f"{e['x']}: {e['dead']}, here {dead}")
            return
        sign = 1 if e["kind"] == "max" else -1
        self.compared += 1
        apart = abs(attained - e["value"]) / size
        excess = sign * (found - e["value"]) / size
        self.apart, self.excess = max(self.apart, apart), max(self.excess, excess)
        self.short.append((id(e) in self.chosen, max(0.0, -excess)))
        name = " ".join(str(e[k]) for k in ("case", "rail", "span", "support", "direction", "section", "quantity", "plane",
                                            "kind") if k in e)
        if apart > 1e-7:
            self.faults.append(f"not attained: {name}: {e['value']}, here {attained} ({apart:.1e})")
        if excess > 1e-9:
            self.faults.append(f"exceeded: {name}: {e['value']}, here {found} ({excess:.1e}) in {where}")
        if "bound" in e and sign * (found - e["bound"]) / size > 1e-9:
            self.faults.append(f"above the bound: {name}: {e['bound']}, here {found} in {where}")

    def check_effect(self, case, lines, entries):
        grids = {j: {w: case.grid(j, w, 241) for w in t.ways} for j, t in enumerate(case.trains)}
        dead = case.dead * lines.dead(case.line, case.gravity)[0]
        both = [{w: lines.bounds(t, w, grids[j][w]) for w in t.ways} for j, t in enumerate(case.trains)]
        for e in entries:
            sign = 1 if e["kind"] == "max" else -1
            side = 0 if sign > 0 else 1
            ways, positions, signs = self.state_of(case, e)
            self.admissible(case, e, ways, positions)
            size = self.sizes[self.kind(e)] or 1.0
            attained = np.inf
            for p in self.beside(case, ways, positions):
                value = self.value_of(case, lines, ways, p, signs)[0] + dead
                if abs(value - e["value"]) < abs(attained - e["value"]):
                    attained = value
                if abs(attained - e["value"]) < 1e-10 * size:
                    break
            best, state = case.best(grids, [{w: sign * both[j][w][side] for w in t.ways} for j, t in enumerate(case.trains)])
            if state[0] is None:
                self.faults.append(f"no arrangement on the grid: {e}")
                continue
            start = [(best[0], *state[0])]
            start.append((sign * (attained - dead), ways, positions))
            value, where = best[0], state[0]
            if id(e) in self.chosen or best[0] + sign * dead > sign * e["value"] + 1e-9 * size:
                value, where = max((self.improve(case, lines, 0, sign, w, p) for _, w, p in start), key=lambda r: r[0])
            self.judge(e, case, attained, sign * max(value, best[0]) + dead, where)

    def admissible(self, case, e, ways, positions):
        if not case.is_admissible(ways, positions, 1e-9 * case.length):
            self.faults.append(f"not admissible: {e}")

    def improve(self, case, lines, column, sign, ways, positions, steps=9):
        """Improves positions on finer and finer grids about them; the section stays."""
        ways, positions = list(ways), list(positions)
        h = case.length / 120
        best = -np.inf
        side = 0 if sign > 0 else 1
        eps = BESIDE * case.length
        for _ in range(steps):
            grids, values = [], []
            for j, train in enumerate(case.trains):
                low, high = case.span(j, ways[j])
                at = positions[j] + np.linspace(-h, h, 13)
                for k in range(len(case.trains)):
                    if k != j:
                        local = positions[k] + np.linspace(-h, h, 7)
                        for c in (-case.distance(j, ways[j], k, ways[k]), case.distance(k, ways[k], j, ways[j])):
                            if np.isfinite(c):
                                at = np.concatenate([at, local + c])
                near = []
                for rail, own in train.by_rail(ways[j]).items():
                    ends = np.append(lines.starts[rail], case.frame.range(rail)[1])
                    p = (ends[:, None] - own["offset"]).ravel()
                    near.append(p[np.abs(p - positions[j]) <= h])
                near = np.concatenate(near)
                at = np.unique(np.clip(np.concatenate([at, near, near - eps, near + eps, [positions[j]]]), low, high))
                grids.append({ways[j]: at})
                values.append({ways[j]: sign * lines.bounds(train, ways[j], at)[side][:, [column]]})
            own = case.ways_only(ways)
            value, state = own.best(grids, values)
            if state[0] is not None and value[0] >= best:
                best = value[0]
                positions = list(state[0][1])
            h *= 0.3
        return best, (ways, positions)

    def check_span(self, case, rail, span, entries):
        coarse = {}
        for cell, xs in self.sections(rail, span):
            for x in xs:
                s = float(self.frame.place(cell, x))
                lines = self.lines((cell["member"], rail, s), lambda: section_lines(self.frame, cell, s))
                marks = [(rail, x)]
                grids = {j: {w: case.grid(j, w, 101, marks) for w in t.ways} for j, t in enumerate(case.trains)}
                both = [{w: lines.bounds(t, w, grids[j][w]) for w in t.ways} for j, t in enumerate(case.trains)]
                dead = self.dead(case, cell, s)[0]
                for sign, side in ((1, 0), (-1, 1)):
                    best, state = case.best(grids, [{w: sign * both[j][w][side] for w in t.ways}
                                                    for j, t in enumerate(case.trains)])
                    for k in range(8):
                        if state[k] is not None and best[k] + sign * dead[k] > coarse.get((k, sign), (-np.inf,))[0]:
                            coarse[k, sign] = (best[k] + sign * dead[k], cell, s, *state[k])
        for e in entries:
            k = QUANTITIES.index((e["quantity"], e["plane"]))
            sign = 1 if e["kind"] == "max" else -1
            ways, positions, signs = self.state_of(case, e)
            self.admissible(case, e, ways, positions)
            attained, cell, s = self.at_stated(case, e, rail, k, ways, positions, signs)
            size = self.sizes[self.kind(e)] or 1.0
            starts = []
            if cell is not None:
                starts.append((sign * attained, cell, s, ways, positions))
            top = coarse.get((k, sign))
            if top is not None:
                if not starts or top[0] > sign * e["value"] - 0.03 * size:
                    starts.append(top)
            found, where = -np.inf, None
            for start in starts:
                refine = id(e) in self.chosen or start[0] > sign * e["value"] + 1e-9 * size
                value, state = self.improve_place(case, rail, span, k, sign, start) if refine else (start[0], start[2:])
                if value > found:
                    found, where = value, state
            if not starts:
                self.faults.append(f"nothing to compare: {e}")
                continue
            if top is not None and top[0] > found:
                found, where = top[0], top[2:]
            dead = None if cell is None else self.dead(case, cell, float(self.frame.place(cell, e["x"])))[0, k]
            self.judge(e, case, attained, sign * found, where, dead)
            own = e["coincident"].get(e["quantity"])
            if own is not None and sign * (e["value"] - own) > 1e-9 * size:
                self.faults.append(f"envelope.csv at the place of an extreme: {own} of {e['value']}: {e}")
            if k >= 4 and cell is not None and self.kind(e) not in self.tried:
                self.tried.add(self.kind(e))
                self.solve_again(case, e, k, section_lines(self.frame, cell, s), ways, positions, signs)

    def solve_again(self, case, e, k, lines, ways, positions, signs):
        """Compares a response with that of a frame that has a point under each wheel and at the section."""
        places = {e["rail"]: [e["x"]]}
        for train, way, p in zip(case.trains, ways, positions):
            for rail, own in train.by_rail(way).items():
                places.setdefault(rail, []).extend(p + own["offset"])
        frame = Frame(subdivided(self.spec, places)[0])
        given = (self.design.get("cases") or [[t["name"]] for t in self.design["trains"]])[e["case"] - 1]
        field = Field(Case(given, self.design, frame), ways, positions, signs)
        near = [c for c in frame.rails[e["rail"]] if c["member"] is not None
                and c["x"][0] - 1e-7 <= e["x"] <= c["x"][1] + 1e-7]
        found = []
        for c in near:
            length, s = frame.members[c["member"]].length, float(frame.place(c, e["x"]))
            found += list(field.at(c, np.clip([s, s - 1e-10 * length, s + 1e-10 * length], 0, length))[:, k])
        known = [self.value_of(case, lines, ways, p, signs)[k] for p in self.beside(case, ways, positions)]
        apart = min(abs(v - w) for v in found for w in known) / (self.sizes[self.kind(e)] or 1.0)
        self.direct = max(self.direct, apart)
        if apart > 1e-6:
            self.faults.append(f"solved again: {e}: {known[0]} by influence lines, {found} ({apart:.1e})")

    def at_stated(self, case, e, rail, k, ways, positions, signs):
        """The value at the stated place and side, the nearest to that of the program; with its stretch and place."""
        x, size = e["x"], self.sizes[self.kind(e)] or 1.0
        best = (np.inf, None, None)
        for cell, (low, *_, high) in self.sections(rail, e["span"]):
            slack = 1e-9 * case.length
            if not low - slack <= x <= high + slack:
                continue
            m = self.frame.members[cell["member"]]
            s = float(self.frame.place(cell, x))
            ends = sorted(self.frame.place(cell, np.array([low, high])))
            near = [s] + [v for v in (s - 1e-9 * m.length, s + 1e-9 * m.length) if ends[0] < v < ends[1]]
            for s in near:
                lines = section_lines(self.frame, cell, s)
                dead = self.dead(case, cell, s)[0, k]
                for p in self.beside(case, ways, positions):
                    value = self.value_of(case, lines, ways, p, signs)[k] + dead
                    if abs(value - e["value"]) < abs(best[0] - e["value"]):
                        best = (value, cell, s)
                    if abs(value - e["value"]) < 1e-10 * size:
                        return best
        return best

    def improve_place(self, case, rail, span, k, sign, start):
        """Improves positions and place by turns."""
        value, cell, s, ways, positions = start
        best, where = value, (cell["x"], s, ways, positions)
        for turn in range(4):
            lines = section_lines(self.frame, cell, s)
            dead = self.dead(case, cell, s)[0, k]
            found, (ways, positions) = self.improve(case, lines, k, sign, ways, positions, 6 if turn else 9)
            found += sign * dead
            gain = found - best
            if found > best:
                best, where = found, (cell["x"], s, ways, positions)
            if turn and gain <= 1e-12 * abs(best):
                break
            cell, s = self.best_place(case, rail, span, k, sign, ways, positions, cell, s)
            if k in (4, 5):
                tied = self.follow(case, cell, s, rail, span, k, sign, ways, positions)
                if tied is not None and tied[0] > best:
                    best, cell, s, positions = tied
                    where = (cell["x"], s, ways, positions)
        return best, where

    def signs_at(self, case, lines, k, sign, ways, positions):
        """The best signs of a state."""
        out = []
        for train, way, p in zip(case.trains, ways, positions):
            v, q, l, ev, el = lines.parts(train, way, np.array([p]))[:, 0, k]
            options = itertools.product((1, -1), repeat=3) if train.reverses else [(1, 1, 1)]
            out.append(max(options, key=lambda o: sign * (o[0] * q + o[1] * l + o[2] * ev + o[1] * o[2] * el)))
        return out

    def best_place(self, case, rail, span, k, sign, ways, positions, cell, s):
        """The best place of the stretch for a state: near the place, and beside the wheels."""
        lines = section_lines(self.frame, cell, s)
        signs = self.signs_at(case, lines, k, sign, ways, positions)
        field = Field(case, ways, positions, signs)
        m = self.frame.members[cell["member"]]
        ends = next((xs for c, xs in self.sections(rail, span) if c is cell), None)
        if ends is None:
            return cell, s
        low, high = sorted(self.frame.place(cell, ends[[0, -1]]))
        h = 0.1 * (high - low)
        eps = 1e-11 * m.length
        for _ in range(6):
            places = s + np.linspace(-h, h, 9)
            for at, _ in field.on.get(cell["member"], []):
                if abs(at - s) <= h:
                    places = np.concatenate([places, [at - eps, at + eps, at]])
            places = np.unique(np.clip(places, low, high))
            values = sign * field.at(cell, places)[:, k]
            values += sign * self.dead(case, cell, places)[:, k]
            s = float(places[values.argmax()])
            h *= 0.3
        return cell, s

    def follow(self, case, cell, s, rail, span, k, sign, ways, positions):
        """Moves a wheel near the section together with it; the others stand, or move along where that is admissible."""
        best = None
        m = self.frame.members[cell["member"]]
        for j, train in enumerate(case.trains):
            own = train.by_rail(ways[j]).get(rail)
            if own is None:
                continue
            for offset in own["offset"]:
                x = positions[j] + offset
                if not cell["x"][0] <= x <= cell["x"][1] or abs(float(self.frame.place(cell, x)) - s) > 0.02 * m.length:
                    continue
                for others in ((0, 1) if len(positions) > 1 else (0,)):
                    center, h = 0.0, 0.02 * case.length
                    for _ in range(6):
                        tried = []
                        for d in center + np.linspace(-h, h, 7):
                            p = [q + d if n == j or others else q for n, q in enumerate(positions)]
                            at = p[j] + offset
                            if not case.is_admissible(ways, p, 0) or not cell["x"][0] < at < cell["x"][1] \
                                    or self.span_of(rail, at) != span:
                                continue
                            place = float(self.frame.place(cell, at))
                            lines = section_lines(self.frame, cell, place)
                            dead = self.dead(case, cell, place)[0, k]
                            for eps in (-BESIDE * case.length, BESIDE * case.length):
                                near = [q + eps if n == j else q for n, q in enumerate(p)]
                                if not case.is_admissible(ways, near, 0):
                                    continue
                                side = 0 if sign > 0 else 1
                                value = sum(lines.bounds(t, w, np.array([q]))[side][0, k]
                                            for t, w, q in zip(case.trains, ways, near))
                                tried.append((sign * (value + dead), d, place, near))
                        if not tried:
                            break
                        top = max(tried, key=lambda r: r[0])
                        center = top[1]
                        if best is None or top[0] > best[0]:
                            best = (top[0], cell, top[2], top[3])
                        h *= 0.35
        return best


def subdivided(spec, places):
    """A spec in the general form with further points under the rails at the coordinates `places` (by rail), for uniform cells
    only and without points close to each other, which would take digits, and the place of each old cell among the new ones."""
    spec = json.loads(json.dumps(general(spec)))
    frame = Frame(spec)
    cuts = {}
    for rail, xs in places.items():
        for cell in frame.rails[rail]:
            if cell["member"] is None:
                continue
            length = frame.members[cell["member"]].length
            for x in xs:
                s = float(frame.place(cell, x))
                if cell["x"][0] < x < cell["x"][1] and 1e-2 < s / length < 1 - 1e-2:
                    cuts.setdefault(cell["member"], set()).add(round(s / length, 15))
    owner = {own[0]: key for key, own in frame.cells.items() if len(own) == 1}
    keys = list(spec.get("cell_data", {}))
    new_of, blocks = {}, []
    for block, cells in enumerate(spec["cells"]):
        data, columns = [], {k: [] for k in keys if isinstance(spec["cell_data"][k][block], list)}
        for index, ends in enumerate(cells["data"]):
            m = frame.cells[block, index][0]
            at = sorted(cuts.get(m, ())) if (block, index) in owner.values() else []
            at = [f for k, f in enumerate(at) if k == 0 or f - at[k - 1] > 1e-2]
            tips = frame.members[m].tips
            chain = [ends[0]]
            for f in at:
                spec["points"].append(list(map(float, tips[0] + f * (tips[1] - tips[0]))))
                chain.append(len(spec["points"]) - 1)
            chain.append(ends[1])
            new_of[block, index] = (list(range(len(data), len(data) + len(at) + 1)), [0.0, *at, 1.0])
            for k, pair in enumerate(zip(chain, chain[1:])):
                data.append(list(pair))
                for key, column in columns.items():
                    value = spec["cell_data"][key][block][index]
                    if key in ("offset_a", "release_a") and k > 0 or key in ("offset_b", "release_b") and k < len(at):
                        value = [0, 0, 0] if key.startswith("offset") else []
                    column.append(value)
        cells["data"] = data
        blocks.append(columns)
    for block, columns in enumerate(blocks):
        for key, column in columns.items():
            spec["cell_data"][key][block] = column
    for rail in spec["rails"].values():
        rail["segments"] = [dict(segment, cell=[segment["cell"][0], k]) for segment in rail["segments"]
                            for k in new_of[tuple(segment["cell"])][0]]
    return spec, new_of


# Random structures.


class Draft:
    """Points, members and supports of a random structure."""

    def __init__(self, rng):
        self.rng = rng
        self.points, self.beams, self.trusses = [], [], []
        self.supports, self.springs, self.links = {}, [], []
        self.rails = {}

    def point(self, x, y, z):
        self.points.append([round(float(v), 4) for v in (x, y, z)])
        return len(self.points) - 1

    def beam(self, a, b, section, **data):
        self.beams.append(dict(ends=[a, b], section=section, **data))
        return len(self.beams) - 1

    def spec(self):
        """The beam spec."""
        rng = self.rng
        sections = [{"name": f"s{k}", "material": "steel", "A": round(rng.uniform(0.01, 0.03), 4),
                     "Iy": float(f"{rng.uniform(4e-5, 3e-4):.3g}"), "Iz": float(f"{rng.uniform(2e-4, 1.5e-3):.3g}"),
                     "J": float(f"{rng.uniform(2e-6, 1e-4):.3g}")} for k in range(4)]
        for s in sections:
            if rng.random() < 0.6:
                s["Asy"] = round(0.4 * s["A"], 5)
            if rng.random() < 0.4:
                s["Asz"] = round(0.5 * s["A"], 5)
        sections.append({"name": "bar", "material": "steel", "A": 0.004})
        cells = [{"type": "line", "data": [m["ends"] for m in self.beams]}]
        keys = ("section", "orientation", "offset_a", "offset_b", "release_a", "release_b", "section_b", "parts")
        data = {}
        for key in keys:
            if any(key in m for m in self.beams):
                default = {"orientation": [0, 1, 0], "parts": 1, "section_b": None, "release_a": [], "release_b": []}
                data[key] = [[m[key] if m.get(key) is not None else default.get(key, [0, 0, 0]) for m in self.beams]]
        if self.trusses:
            cells.append({"type": "line", "data": self.trusses})
            for key in data:
                data[key].append(None)
            data["section"][-1] = 4
            data["kind"] = [None, "truss"]
        return {"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
                "theory": str(rng.choice(["timoshenko", "euler-bernoulli"])), "points": self.points, "cells": cells,
                "cell_data": data, "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.85}],
                "sections": sections, "supports": [{"point": p, "fix": fix} for p, fix in self.supports.items()],
                "springs": self.springs, "links": self.links, "rails": self.rails}


def short_spec(rng):
    """A girder in the short form."""
    spans = [round(rng.uniform(4, 10), 2) for _ in range(rng.integers(1, 5))]
    over = [round(rng.uniform(0.5, 2), 2) if rng.random() < 0.4 else 0 for _ in range(2)]
    g = {"spans": spans, "overhangs": over, "E": 2.1e8, "G": 8.1e7, "A": 0.02, "I_vertical": 5.8e-4, "I_lateral": 1.1e-4,
         "J": 4e-6, "rail_height": float(rng.choice([0, 0.25, 0.6])), "mass_per_length": 0.2}
    if rng.random() < 0.6:
        g["kA_vertical"] = 0.007
    if rng.random() < 0.5:
        g["kA_lateral"] = 0.012
    return {"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
            "theory": str(rng.choice(["timoshenko", "euler-bernoulli"])), "girder": g, "stations": [0, 0.5 * spans[0], spans[0]]}


def frame_spec(rng, level=False):
    """A frame, with the ends of the spans of its rails; `level`: no member under a rail slopes."""
    d = Draft(rng)
    lines = int(rng.integers(1, 3))
    bays = int(rng.integers(1, 4))
    xs = np.concatenate([[0.0], np.cumsum(np.round(rng.uniform(4, 9, bays), 1))])
    x0 = float(rng.choice([0.0, 0.0, 3.7]))
    over = [float(np.round(rng.uniform(0.6, 2.0), 1)) if rng.random() < 0.35 else 0.0 for _ in range(2)]
    width = float(np.round(rng.uniform(3, 12), 1))
    spans = {}
    joints = []
    for line in range(lines):
        z, y = line * width, float(np.round(rng.uniform(4, 7), 1))
        style = rng.choice(["supports", "columns", "mixed", "springs"])
        slope = float(rng.choice([0, 0, 0, 0.03])) * (not level)
        has_arms = rng.random() < 0.4
        row = [d.point(x, y + slope * x, z) for x in xs]
        joints.append(row)
        for k, p in enumerate(row):
            kind = str(rng.choice(["support", "column", "spring"])) if style == "mixed" else \
                {"supports": "support", "columns": "column", "springs": "spring"}[style]
            if kind == "spring" and k in (0,):
                kind = "support"
            if kind == "support":
                d.supports[p] = ["uy", "uz", "rx"] + (["ux"] if k == 0 else []) + (["rz"] if rng.random() < 0.1 else [])
            elif kind == "spring":
                for dof, k_of in (("uy", 8e3), ("uz", 5e3), ("rx", 4e4)):
                    d.springs.append({"point": p, "dof": dof, "k": float(f"{k_of * rng.uniform(0.5, 3):.3g}")})
                if rng.random() < 0.3:
                    d.springs.append({"point": p, "dof": "rz", "k": 1e4})
            else:
                top = p
                if rng.random() < 0.4:
                    # a bracket: the column stands beside the girder
                    top = d.point(xs[k], y + slope * xs[k] - 0.4, z + float(rng.choice([-0.6, 0.6])))
                    d.links.append({"from": top, "to": p})
                foot = d.point(xs[k], 0, d.points[top][2] + float(rng.choice([0, 0, 0.5])))
                d.supports[foot] = ["ux", "uy", "uz", "rx", "ry", "rz"] if rng.random() < 0.6 or style != "columns" \
                    else ["ux", "uy", "uz", "ry"] + (["rx"] if rng.random() < 0.5 else [])
                data = {"orientation": [1, 0, 0]}
                if rng.random() < 0.3:
                    data["offset_b"] = [0, -0.3, 0]
                d.beam(foot, top, int(rng.integers(0, 4)), **data)
                if rng.random() < 0.15:
                    brace = d.point(xs[k] + 2, 0, z)
                    d.supports[brace] = ["ux", "uy", "uz"]
                    d.trusses.append([brace, p])
        # the girder: stretches between joints, some of them in two pieces, and overhangs
        pieces = []
        hinges = 0
        chain = list(row)
        nodes = []
        if over[0]:
            nodes.append(d.point(xs[0] - over[0], y + slope * (xs[0] - over[0]), z))
        for k in range(bays):
            nodes.append(chain[k])
            if rng.random() < 0.45:
                f = float(rng.choice([0.25, 0.5, 0.7]))
                x = xs[k] + f * (xs[k + 1] - xs[k])
                nodes.append(d.point(x, y + slope * x, z))
        nodes.append(chain[-1])
        if over[1]:
            nodes.append(d.point(xs[-1] + over[1], y + slope * (xs[-1] + over[1]), z))
        own = []
        simple = bays > 1 and rng.random() < 0.25
        section = int(rng.integers(0, 4))
        for a, b in zip(nodes, nodes[1:]):
            data = {}
            if rng.random() < 0.3:
                section = int(rng.integers(0, 4))
            inner_a, inner_b = a in row, b in row
            if has_arms:
                drop = float(rng.choice([0, 0, 0.2])) * (not level)
                if inner_a:
                    data["offset_a"] = [0.15, drop, 0]
                if inner_b:
                    data["offset_b"] = [-0.15, drop if "offset_a" in data or not inner_a else 0, 0]
            if simple and inner_a and a != row[0] and inner_b:
                data["release_a"] = ["rz", "ry"]
            elif b not in row and a in row and a != row[0] and rng.random() < 0.3 and hinges == 0:
                data["release_b"] = ["rz"] if rng.random() < 0.5 else ["rz", "ry"]
                hinges += 1
            if rng.random() < 0.15:
                data["orientation"] = [0, 1, float(rng.choice([-0.2, 0.3]))]
            ends = (a, b)
            if rng.random() < 0.25 and not data.get("offset_a") and not data.get("offset_b"):
                ends = (b, a)
                if "release_a" in data or "release_b" in data:
                    data["release_a"], data["release_b"] = data.get("release_b"), data.get("release_a")
            if rng.random() < 0.12:
                data["section_b"] = (section + 1) % 4
                data["parts"] = int(rng.integers(2, 5))
            own.append(d.beam(*ends, section, **data))
        h = float(rng.choice([0.0, 0.3, 0.55]))
        names = ["north", "south"]
        rails = [(names[line], 0.0 if rng.random() < 0.7 else 0.08)]
        if lines == 1 and rng.random() < 0.3:
            rails.append((names[1], 0.9))
        for name, e in rails:
            d.rails[name] = {"origin": [x0, y + h, z], "axis": [1, 0, 0], "stations": [],
                             "segments": [{"cell": [0, m], "offset": [0, h, e]} for m in own]}
            spans[name] = [float(x) - x0 for x in xs]
    if lines == 2:
        for a, b in zip(*joints):
            if rng.random() < 0.5:
                d.beam(a, b, int(rng.integers(0, 4)))
    # shear areas at both ends of a taper, or at neither; a section may be in several tapers
    spec = d.spec()
    for m in d.beams * len(d.beams):
        if "section_b" in m:
            p, q = spec["sections"][m["section"]], spec["sections"][m["section_b"]]
            for key in ("Asy", "Asz"):
                if (key in p) != (key in q):
                    p.pop(key, None)
                    q.pop(key, None)
    frame = Frame(spec)
    for name in spec["rails"]:
        low, high = frame.range(name)
        spec["rails"][name]["stations"] = [low + (high - low) * f for f in (0.31, 0.62)]
        spans[name] = [min(max(x, low), high) for x in spans[name]]
    return spec, spans


def random_design(rng, spec, spans):
    """Trains and cases on a structure."""
    frame = Frame(spec)
    rails = list(frame.rails)
    length = min(b - a for a, b in map(frame.range, rails))
    trains = []
    for name in "abc"[: rng.integers(1, 4)]:
        count = int(rng.choice([1, 2, 2, 2, 3, 4, 4, 6, 8]))
        both = len(rails) == 2 and rng.random() < 0.4
        most = length * rng.uniform(0.1, 0.4)
        wheels = []
        home = str(rng.choice(rails))
        for rail in rails if both else [home]:
            places = np.sort(np.round(rng.uniform(0, most, max(1, count // 2) if both else count), 2))
            places[0] = 0.0 if rail == rails[0] or not both else places[0]
            for x in np.unique(places):
                wheel = {"x": float(x), "vertical": float(np.round(rng.uniform(20, 200), 1))}
                if rng.random() < 0.15:
                    wheel["lateral"] = float(np.round(rng.uniform(-20, 20), 1))
                if rng.random() < 0.1:
                    wheel["eccentricity"] = 0.04
                if len(rails) > 1:
                    wheel["rail"] = rail
                wheels.append(wheel)
        train = {"name": name, "wheels": wheels}
        if rng.random() < 0.2:
            for w in wheels:
                w["vertical"] = {"crane": w["vertical"], "hoist": float(np.round(rng.uniform(-10, 90), 1))}
        if rng.random() < 0.6:
            train["ends"] = [float(np.round(v, 2)) for v in rng.uniform(0, 1, 2)]
        for key, size, chance in (("lateral", 15, 0.5), ("longitudinal", 30, 0.4), ("eccentricity", 0.06, 0.25)):
            if rng.random() < chance:
                train[key] = float(np.round(rng.uniform(-size, size), 3))
        if rng.random() < 0.3:
            train["turned"] = False
        if rng.random() < 0.3:
            train["signs"] = "given"
        if rng.random() < 0.3:
            train["enters"] = True
        trains.append(train)
    names = [t["name"] for t in trains]
    cases = [[names[0]]]
    for _ in range(int(rng.integers(1, 3))):
        own = [str(n) for n in rng.choice(names, rng.choice([1, 2, 3], p=[0.2, 0.65, 0.15]))]
        # trains of a case give their loads in one way where its factors name parts
        case = {"name": f"case {len(cases) + 1}", "trains": own, "gap": float(rng.choice([0, 0, 0.5, 1.3]))}
        if rng.random() < 0.3:
            case["order"] = "given"
        factors = {}
        for key in ("dead", "vertical", "lateral", "longitudinal"):
            if rng.random() < 0.25:
                factors[key] = float(rng.choice([0, 0.5, 1.1, 1.35, -1] if key != "dead" else [0, 0.9, 1.35]))
        if all(isinstance(w["vertical"], dict) for t in trains if t["name"] in own for w in t["wheels"]):
            factors["hoist"] = 1.5
        if factors:
            case["factors"] = factors
        cases.append(case)
    design = {"format": "girderway-design/1", "name": "random", "units": {"length": "m", "force": "kN", "time": "s"},
              "spec": "spec.json", "gravity": 9.81, "trains": trains, "cases": cases}
    if spans:
        design["spans"] = spans
    tapered = bool(spec.get("cell_data", {}).get("section_b"))
    dead = rng.random()
    if dead < 0.3 and not tapered:
        design["dead_load"] = True
    elif dead < 0.55:
        design["dead_load"] = {"weight": not tapered, "line": {rails[0]: 1.5}}
    if "cells" in spec and rng.random() < 0.5:
        count = len(spec["cells"][0]["data"])
        design["sections"] = [{"name": f"n{k}", "cell": [0, int(rng.integers(0, count))],
                               "place": float(rng.choice([0, 0.3, 0.5, 1])), "component": c}
                              for k, c in enumerate(rng.choice(["N", "Vy", "Vz", "Mx", "My", "Mz"], 2))]
        for s in design["sections"]:
            s["component"] = str(s["component"])
    elif "girder" in spec and rng.random() < 0.5:
        design["sections"] = [{"name": "m", "x": 0.4 * spec["girder"]["spans"][0], "component": "Mz"}]
    return design


def draw(rng, level=False):
    """A random structure with its design."""
    while True:
        try:
            if rng.random() < 0.3:
                spec = short_spec(rng)
                return spec, random_design(rng, spec, None)
            spec, spans = frame_spec(rng, level)
            return spec, random_design(rng, spec, spans)
        except Singular:
            continue


def solve(program, spec, design, folder, longest=LONGEST, name="design"):
    """Runs the program: exit status, what it said, the summary, and seconds."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "spec.json").write_text(json.dumps(spec))
    (folder / f"{name}.json").write_text(json.dumps(design))
    start = time.time()
    try:
        done = subprocess.run([program, "--quiet", "design", f"{name}.json", "-o", "out", "--force"], cwd=folder,
                              capture_output=True, text=True, timeout=longest)
    except subprocess.TimeoutExpired:
        return None, f"takes more than {longest} s", None, time.time() - start
    seconds = time.time() - start
    summary = json.loads((folder / "out/summary.json").read_text()) if done.returncode == 0 else None
    return done.returncode, done.stderr.strip(), summary, seconds


def has_room(spec, design):
    """Whether the trains of every case fit somewhere."""
    frame = Frame(spec)
    for given in design["cases"]:
        case = Case(given, design, frame)
        try:
            grids = {j: {w: case.grid(j, w, 41) for w in t.ways} for j, t in enumerate(case.trains)}
        except ValueError:
            return False
        ok = all(t.enters or t.range(w)[0] <= t.range(w)[1] for t in case.trains for w in t.ways)
        best, state = case.best(grids, [{w: np.zeros((len(g), 1)) for w, g in own.items()} for own in grids.values()])
        if not ok or state[0] is None:
            return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--designs", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first design")
    parser.add_argument("--refined", type=int, default=40, help="extremes of a design that are sought on finer grids")
    parser.add_argument("--ends", action="store_true", help="both sides of joints count at the ends of ranges of positions")
    parser.add_argument("--level", action="store_true", help="no member under a rail slopes")
    parser.add_argument("--file", help="a design file instead of random designs")
    parser.add_argument("--keep", help="folder for the designs with faults")
    args = parser.parse_args()
    Case.from_inside = not args.ends
    total = dict(designs=0, refused=0, compared=0, excess=-np.inf, apart=0.0, direct=0.0, dead=0.0, dead_faults=0, faults=0)
    shorts, slow = [], []
    with tempfile.TemporaryDirectory() as scratch:
        jobs = range(args.first, args.first + args.designs)
        if args.file:
            path = pathlib.Path(args.file)
            design = json.loads(path.read_text())
            given = [(path.stem, json.loads((path.parent / design["spec"]).read_text()), design | {"spec": "spec.json"})]
        else:
            given = ((n, *draw(np.random.default_rng([args.seed, n]), args.level)) for n in jobs)
        for number, spec, design in given:
            code, said, summary, seconds = solve(args.program, spec, design, scratch)
            start = time.time()
            faults = []
            if code != 0:
                total["refused"] += 1
                if code is not None and "cases" in design and has_room(spec, design):
                    faults.append(f"refused with status {code}: {said}")
                note = f"refused: {said[:150]}"
            else:
                checker = Checker(spec, design, summary).run(args.refined)
                faults = checker.faults
                total["designs"] += 1
                total["compared"] += checker.compared
                total["excess"] = max(total["excess"], checker.excess)
                total["apart"] = max(total["apart"], checker.apart)
                shorts += [v for refined, v in checker.short if refined]
                total["dead"] = max(total["dead"], checker.dead_apart)
                total["dead_faults"] += len(checker.dead_faults)
                faults = faults + checker.dead_faults[:1]
                total["direct"] = max(total["direct"], checker.direct)
                note = (f"{checker.compared} values, excess {checker.excess:.1e}, stated positions {checker.apart:.1e}, "
                        f"error bound {summary['error_bound']:.0e}")
            if seconds > 10:
                slow.append((number, seconds))
            print(f"{number}: {note}; {seconds:.1f} s, check {time.time() - start:.0f} s", flush=True)
            for fault in faults:
                print(f"  {fault[:600]}", flush=True)
            total["faults"] += len(faults)
            if faults and args.keep:
                folder = pathlib.Path(args.keep) / f"{args.seed}-{number}"
                folder.mkdir(parents=True, exist_ok=True)
                (folder / "spec.json").write_text(json.dumps(spec))
                (folder / "design.json").write_text(json.dumps(design))
    print(f"{total['designs']} designs, {total['refused']} refused; {total['compared']} values; largest excess of brute force "
          f"{total['excess']:.1e}; largest difference at stated positions {total['apart']:.1e}; points under "
          f"wheels {total['direct']:.1e}; refined values fall short by "
          f"{np.percentile(shorts, 50) if shorts else 0:.0e} (half), {np.percentile(shorts, 95) if shorts else 0:.0e} (95 %), "
          f"{max(shorts, default=0):.0e} (all); dead load differs in {total['dead_faults']} values by {total['dead']:.1e}; faults {total['faults']}")
    for number, seconds in slow:
        print(f"slow: design {number} takes {seconds:.0f} s")
    return 1 if total["faults"] else 0


if __name__ == "__main__":
    sys.exit(main())
