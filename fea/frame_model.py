"""A beam spec as nodes, rigid bodies and straight members: what a frame code needs, and no stiffness.

Reads the contract of specs ("girderway-beam/1") on its own. Shared by pynite_frame.py and opensees_frame.py.

Everything rigid becomes a body: linked points, the arms from points to the flexible ends of members, and the arm
from a section to the rail head. The nodes of a body move as u + theta x r about its root. Members are cut where a
station lies inside them, so that loads act at nodes.
"""

import json
import math
import sys

import numpy as np

FREEDOMS = ["ux", "uy", "uz", "rx", "ry", "rz"]
QUANTITIES = {
    "vertical": (1, 1),
    "lateral": (2, 2),
    "longitudinal": (0, 0),
    "vertical_lateral": (1, 2),
    "vertical_longitudinal": (1, 0),
    "lateral_longitudinal": (2, 0),
}
# Members without bending, and the local freedoms that they resist.
BARS = {"truss": [0], "rod": [0, 3], "cable": [0]}
# Parts of a beam under a preload: other codes have cubic elements, whose error falls with the fourth power.
PARTS = 16
# Standard gravity, m/s2, and lengths in metres.
GRAVITY = 9.80665
METRES = {"m": 1.0, "mm": 1e-3, "ft": 0.3048, "in": 0.0254}
# Size of a rotation's part in every member, relative to its largest, at which nothing resists the rotation.
IDLE = 1e-9
# Most stations: a member cut into many short ones costs digits and time.
MOST = 96
# Least distance of a station from its neighbours, by the length of its member.
NEAREST = 4e-3


class Refused(Exception):
    """Why a code is not compared; a sentence for the user."""


def unit(v):
    return v / np.linalg.norm(v)


def triad(x, y):
    """Rows: x, the part of y normal to it, their cross product."""
    x = unit(np.asarray(x, dtype=float))
    y = np.asarray(y, dtype=float)
    y = unit(y - x * (x @ y))
    return np.array([x, y, np.cross(x, y)])


def general(spec):
    """The short form written out as a general one, and the directions whose stiffness is known."""
    girder = spec["girder"]
    left, right = girder.get("overhangs", [0.0, 0.0])
    supports = np.concatenate([[0.0], np.cumsum(girder["spans"])])
    ends = [-left] * (left > 0.0) + list(supports) + [supports[-1] + right] * (right > 0.0)
    first = int(left > 0.0)
    height = girder.get("rail_height", 0.0)
    known = {1}
    if "A" in girder:
        known.add(0)
    torsion = "J" in girder and "G" in girder
    if "I_lateral" in girder and (torsion or height == 0.0):
        known.add(2)
    # What is not known is not read either: a straight girder does not couple it with what is.
    area = girder.get("A", 1.0)
    section = {
        "name": "girder",
        "material": "girder",
        "A": area,
        "Iz": girder["I_vertical"],
        "Iy": girder.get("I_lateral", girder["I_vertical"]),
        "J": girder["J"] if torsion else girder["I_vertical"],
        "mass": girder.get("mass_per_length", 0.0),
    }
    for here, there in [("kA_vertical", "Asy"), ("kA_lateral", "Asz")]:
        if here in girder:
            section[there] = girder[here]
    cells = [[k, k + 1] for k in range(len(ends) - 1)]
    return {
        **{key: spec[key] for key in ("format", "name", "units", "theory") if key in spec},
        **at_points(spec, ends),
        "up": [0.0, 1.0, 0.0],
        "points": [[x, 0.0, 0.0] for x in ends],
        "cells": [{"type": "line", "data": cells}],
        "cell_data": {},
        "materials": [{"name": "girder", "E": girder["E"], "G": girder.get("G", girder["E"])}],
        "sections": [section],
        "supports": [
            {"point": first + k, "fix": (["ux"] if k == 0 else []) + ["uy", "uz", "rx"]} for k in range(len(supports))
        ],
        "rails": {
            "rail": {
                "axis": [1.0, 0.0, 0.0],
                "segments": [{"cell": [0, k], "offset": [0.0, height, 0.0]} for k in range(len(cells))],
                "stations": spec["stations"],
            }
        },
    }, known


def at_points(spec, ends):
    """The preload of a short form with its loads on points."""
    if "preload" not in spec:
        return {}
    nearest = lambda x: min(range(len(ends)), key=lambda k: abs(ends[k] - x))  # noqa: E731
    loads = [{"point": nearest(load["x"]), "force": load["force"]} for load in spec["preload"].get("loads", [])]
    return {"preload": {**spec["preload"], "loads": loads}}


def between(a, b, start, stop):
    """The section of a stretch of a cell whose properties run linearly from a to b: means of the reciprocals."""
    section = dict(a)
    for key in ("A", "Iy", "Iz", "J", "Asy", "Asz"):
        if key in a and key in b:
            p, q = (a[key] + (b[key] - a[key]) * s for s in (start, stop))
            section[key] = p if abs(q - p) <= 1e-12 * p else (q - p) / math.log(q / p)
    return section


class Member:
    """A straight piece between two nodes, local axes in rows; `whole` is the length of its cell."""

    def __init__(self, nodes, axes, kind, section, releases, whole):
        self.nodes, self.axes, self.kind = nodes, axes, kind
        self.section, self.releases, self.whole = section, releases, whole

    def active(self):
        """Local freedoms with stiffness, at both ends: 2 x 6."""
        if self.kind in BARS:
            held = np.zeros((2, 6), dtype=bool)
            for freedom in BARS[self.kind]:
                held[:, freedom] = not np.any(self.releases[:, freedom])
            return held
        held = ~self.releases
        for axial in (0, 3):
            held[:, axial] = np.all(held[:, axial])
        for across, turn in ((1, 5), (2, 4)):
            free = self.releases[:, [across, turn]]
            if free.sum() >= 2:
                held[:, [across, turn]] = False
            elif free[:, 0].any():
                held[:, across] = False
        return held


class Frame:
    """Nodes, bodies, members, what holds them, and rail heads.

    position, body    of each node; body = index of the body
    root              node of each body about which it turns
    members           Member
    fixed             (node, freedom): motions held at zero, none of them following from others
    idle              (body, axis): rotations about axes that are not global and that nothing resists
    springs           (node, freedom, stiffness)
    heads             (number of the station, node, axes of the rail): where loads act and deflections are read
    known             directions of the rail that may be compared
    preload           whether the grids are those about the state of a preload
    """

    def __init__(self, spec, theory):
        self.known = {0, 1, 2}
        if "girder" in spec:
            spec, self.known = general(spec)
        self.spec = spec
        self.sheared = theory == "timoshenko"
        self.position, self.body, self.root, self.members, self.notes = [], [], [], [], []
        self.place = {}
        self.preload = "preload" in spec
        self.read_points()
        self.read_members()
        self.read_rails()
        self.read_supports()

    def read_points(self):
        """Points, joined to bodies by links."""
        points = [np.array(p, dtype=float) for p in self.spec["points"]]
        leader = list(range(len(points)))

        def find(k):
            while leader[k] != k:
                k = leader[k]
            return k

        for link in self.spec.get("links", []):
            a, b = find(link["from"]), find(link["to"])
            leader[max(a, b)] = min(a, b)
        held = [0] * len(points)
        for support in self.spec.get("supports", []):
            held[support["point"]] += len(support["fix"])
        number = {}
        for k, position in enumerate(points):
            first = find(k)
            if first not in number:
                number[first] = len(self.root)
                self.root.append(max((held[j], -j) for j in range(len(points)) if find(j) == first)[1] * -1)
            self.position.append(position)
            self.body.append(number[first])
            self.place[(number[first], tuple(position))] = k

    def node(self, body, position):
        """The node of a body at a place; made where there is none."""
        key = (body, tuple(position))
        if key not in self.place:
            self.place[key] = len(self.position)
            self.position.append(np.array(position))
            self.body.append(body)
        return self.place[key]

    def new_body(self, position):
        self.root.append(len(self.position))
        return self.node(len(self.root) - 1, position)

    def read_members(self):
        materials = {m["name"]: m for m in self.spec["materials"]}
        data = self.spec.get("cell_data", {})
        up = np.array(self.spec.get("up", [0.0, 1.0, 0.0]), dtype=float)
        self.cells = {}
        for block, cells in enumerate(self.spec["cells"]):
            for index, points in enumerate(cells["data"]):

                def get(key, default, block=block, index=index):
                    return data[key][block][index] if key in data else default

                section = dict(self.spec["sections"][get("section", 0)])
                section.update({k: materials[section["material"]].get(k, 0.0) for k in ("E", "G")})
                section.setdefault("mass", section.get("A", 0.0) * materials[section["material"]].get("density", 0.0))
                if not self.sheared:
                    section.pop("Asy", None)
                    section.pop("Asz", None)
                kind = get("kind", "beam")
                ends, nodes = [], []
                for end in (0, 1):
                    offset = np.array(get(("offset_a", "offset_b")[end], [0.0, 0.0, 0.0]), dtype=float)
                    ends.append(self.position[points[end]] + offset)
                    nodes.append(self.node(self.body[points[end]], ends[end]))
                x = unit(ends[1] - ends[0])
                y = get("orientation", None)
                y = up if y is None else np.array(y, dtype=float)
                if kind in BARS and np.linalg.norm(np.cross(x, y)) <= 1e-6 * np.linalg.norm(y):
                    y = np.eye(3)[np.argmin(np.abs(x))]
                releases = np.zeros((2, 6), dtype=bool)
                for end in (0, 1):
                    for word in get(("release_a", "release_b")[end], []):
                        releases[end, FREEDOMS.index(word)] = True
                whole = np.linalg.norm(ends[1] - ends[0])
                axes, other = triad(x, y), get("section_b", None)
                parts = get("parts", None) or self.spec.get("parts", 1)
                if other is None:
                    parts = parts if get("parts", None) else 1
                if self.preload and kind not in BARS:
                    parts = max(parts, PARTS)
                if kind in BARS:
                    parts = 1
                end = section if other is None else self.spec["sections"][other]
                self.cells[block, index] = range(len(self.members), len(self.members) + parts)
                for part in range(parts):
                    piece = between(section, end, part / parts, (part + 1) / parts)
                    last = nodes[1] if part + 1 == parts else None
                    if last is None:
                        last = self.new_body(ends[0] + (ends[1] - ends[0]) * (part + 1) / parts)
                    own = releases.copy()
                    own[0] &= part == 0
                    own[1] &= part + 1 == parts
                    self.members.append(Member([nodes[0], last], axes, kind, piece, own, whole))
                    nodes[0] = last

    def read_rails(self):
        """Heads of all stations; cuts members where stations lie inside."""
        up = np.array(self.spec.get("up", [0.0, 1.0, 0.0]), dtype=float)
        wanted, count = [], 0
        for rail in self.spec["rails"].values():
            axes = triad(rail["axis"], up)
            origin = np.array(rail.get("origin", [0.0, 0.0, 0.0]), dtype=float)
            segments = []
            for segment in rail["segments"]:
                offset = np.array(segment.get("offset", [0.0] * 3), dtype=float)
                for member in self.cells[tuple(segment["cell"])]:
                    ends = [self.position[node] for node in self.members[member].nodes]
                    segments.append((member, [axes[0] @ (end - origin) for end in ends], offset))
            for x in rail["stations"]:
                wanted.append((count, x, axes, segments))
                count += 1
        self.total = count
        if count > MOST:
            kept = {round(k * (count - 1) / (MOST - 1)) for k in range(MOST)}
            wanted = [w for w in wanted if w[0] in kept]
        self.heads, cuts = [], {}
        for number, x, axes, segments in wanted:
            self.station(number, x, axes, segments, cuts)
        for member, places in cuts.items():
            self.cut(member, places)
        self.heads.sort(key=lambda head: head[0])
        if len(self.heads) < self.total:
            self.notes.append(f"compared at {len(self.heads)} of {self.total} stations")

    def station(self, number, x, axes, segments, cuts):
        """Puts a head at x: on a section, on a flexible end, or rigidly with an end beside a gap."""
        for member, along, offset in segments:
            t = (x - along[0]) / (along[1] - along[0])
            if not -1e-9 <= t <= 1.0 + 1e-9:
                continue
            nodes, releases = self.members[member].nodes, self.members[member].releases
            if min(t, 1.0 - t) <= 1e-9:
                end = int(t > 0.5)
                if not releases[end].any():
                    self.head(number, nodes[end], self.position[nodes[end]] + offset, axes)
            else:
                cuts.setdefault(member, []).append((t, number, offset, axes))
            return
        # Only a gap is left: the nearer end of the segments on both sides.
        _, end, edge, offset = min(
            (
                (abs(x - edge), self.members[member].nodes[k], edge, offset)
                for member, along, offset in segments
                for k, edge in enumerate(along)
            ),
            key=lambda item: item[0],
        )
        self.head(number, end, self.position[end] + offset + (x - edge) * axes[0], axes)

    def head(self, number, node, position, axes):
        self.heads.append((number, self.node(self.body[node], position), axes))

    def cut(self, member, places):
        whole = self.members[member]
        first, last = whole.nodes
        start, along = self.position[first], self.position[last] - self.position[first]
        before, nodes = 0.0, [first]
        for t, number, offset, axes in sorted(places, key=lambda place: place[0]):
            again = len(nodes) > 1 and t - before <= 1e-12
            if not again and (t - before < NEAREST or 1.0 - t < NEAREST):
                continue
            if not again:
                before = t
                nodes.append(self.new_body(start + t * along))
            self.head(number, nodes[-1], start + t * along + offset, axes)
        nodes.append(last)
        for k, pair in enumerate(zip(nodes, nodes[1:])):
            releases = np.zeros((2, 6), dtype=bool)
            if k == 0:
                releases[0] = whole.releases[0]
            if k == len(nodes) - 2:
                releases[1] = whole.releases[1]
            piece = Member(list(pair), whole.axes, whole.kind, whole.section, releases, whole.whole)
            if k == 0:
                self.members[member] = piece
            else:
                self.members.append(piece)

    def arm(self, node):
        """Motion of a node by that of its body: 6 x 6."""
        r = self.position[node] - self.position[self.root[self.body[node]]]
        a = np.eye(6)
        a[:3, 3:] = [[0.0, r[2], -r[1]], [-r[2], 0.0, r[0]], [r[1], -r[0], 0.0]]
        return a

    def reach(self, body):
        """Largest distance of a node from its body's root; one where there is none."""
        root = self.position[self.root[body]]
        farthest = max(np.linalg.norm(p - root) for p, b in zip(self.position, self.body) if b == body)
        return farthest or 1.0

    def read_supports(self):
        """Supports and springs; and freedoms that nothing stiffens, which are held."""
        self.springs = [
            (s["point"], FREEDOMS.index(s["dof"]), s["k"]) for s in self.spec.get("springs", []) if s["k"] > 0.0
        ]
        stiff = np.zeros((len(self.root), 6))
        turns = [[] for _ in self.root]
        for member in self.members:
            for node, active in zip(member.nodes, member.active()):
                motion = np.kron(np.eye(2), member.axes) @ self.arm(node)
                motion[np.abs(motion) <= 1e-12 * max(1.0, self.reach_of(node))] = 0.0
                stiff[self.body[node]] += np.abs(motion[active]).sum(axis=0)
                turns[self.body[node]].append(motion[active][:, 3:])
        for node, freedom, _ in self.springs:
            stiff[self.body[node]] += np.abs(self.arm(node)[freedom])
            turns[self.body[node]].append(self.arm(node)[[freedom], 3:])
        rows = [
            (support["point"], FREEDOMS.index(word))
            for support in self.spec.get("supports", [])
            for word in support["fix"]
        ]
        rows += [(self.root[b], k) for b in range(len(self.root)) for k in range(6) if stiff[b, k] == 0.0]
        self.idle = [
            (body, axis) for body in range(len(self.root)) for axis in self.idle_axes(body, turns[body], stiff[body], rows)
        ]
        rows.sort(key=lambda row: row[0] != self.root[self.body[row[0]]])
        # Rows of one body that follow from others would make a singular system of multipliers.
        self.fixed, kept = [], {}
        for node, freedom in dict.fromkeys(rows):
            body = self.body[node]
            scale = np.array([1.0] * 3 + [1.0 / self.reach(body)] * 3)
            row = self.arm(node)[freedom] * scale
            for other in kept.get(body, []):
                row = row - other * (other @ row)
            size = np.linalg.norm(row)
            if size > 1e-9 * np.linalg.norm(scale):
                kept.setdefault(body, []).append(row / size)
                self.fixed.append((node, freedom))
        # Supports away from the root are the same as supports there where they hold whole freedoms of it.
        for body, rows in kept.items():
            basis, root = np.array(rows), self.root[body]
            whole = [k for k in range(6) if np.linalg.norm(basis[:, k]) > 1.0 - 1e-9]
            if len(whole) == len(rows):
                self.fixed = [(n, f) for n, f in self.fixed if self.body[n] != body]
                self.fixed += [(root, k) for k in whole]

    def idle_axes(self, body, turns, stiff, rows):
        """Axes, not global, about which neither a member nor a spring nor a support resists the rotation of a body."""
        held = {freedom for node, freedom in rows if self.body[node] == body}
        free = [k for k in range(3) if stiff[3 + k] > 0.0 and 3 + k not in held]
        if not free or any(node != self.root[body] for node, _ in rows if self.body[node] == body):
            return []
        parts = np.vstack(turns)[:, free]
        sizes = np.abs(parts).max(axis=0)
        _, values, axes = np.linalg.svd(parts / sizes)
        values = np.append(values, np.zeros(len(free) - len(values)))
        found = [axis / sizes for axis, value in zip(axes, values) if value <= IDLE * values[0]]
        return [unit(np.array([axis[free.index(k)] if k in free else 0.0 for k in range(3)])) for axis in found]

    def reach_of(self, node):
        return np.linalg.norm(self.position[node] - self.position[self.root[self.body[node]]])

    def preload_forces(self):
        """(node, global force, global moment) of the preload; the weight of a beam acts as its clamped ends would feel it."""
        given = self.spec["preload"]
        forces = []
        for load in given.get("loads", []):
            point = load["point"]
            if isinstance(point, str):
                point = self.spec["point_sets"][point][0]
            forces.append((point, np.array(load["force"], dtype=float), np.zeros(3)))
        if given.get("weight", False):
            standard = GRAVITY / METRES[self.spec["units"]["length"]]
            down = -given.get("gravity", standard) * unit(np.array(self.spec.get("up", [0.0, 1.0, 0.0]), dtype=float))
            for member in self.members:
                length = np.linalg.norm(self.position[member.nodes[1]] - self.position[member.nodes[0]])
                line = member.section["mass"] * down
                turn = np.cross(member.axes[0], line) * length**2 / 12.0 if member.kind == "beam" else np.zeros(3)
                for node, sign in zip(member.nodes, (1.0, -1.0)):
                    forces.append((node, 0.5 * length * line, sign * turn))
            for mass in self.spec.get("masses", []):
                if np.any(mass.get("offset", [0.0] * 3)):
                    raise Refused("a mass with an offset is not loaded in other codes")
                forces.append((mass["point"], mass["mass"] * down, np.zeros(3)))
        return forces

    def unit_loads(self):
        """(head, direction, node, global force) of all 3 n unit loads; direction counts x, y, z of the rail."""
        for k, (_, node, axes) in enumerate(self.heads):
            for direction in range(3):
                yield k, direction, node, axes[direction]

    def answer(self, motion, versions, elements, notes=(), tolerance=None):
        """What goes back: motion[(k, d), head] = displacement of a head, global 3, under unit load d at head k."""
        n = len(self.heads)
        axes = np.array([head[2] for head in self.heads])
        influence = {}
        for name, (row, column) in QUANTITIES.items():
            if {row, column} <= self.known:
                loads = motion.reshape(n, 3, n, 3)[:, column]
                grid = np.einsum("jik,ik->ij", loads, axes[:, row])
                influence[name] = grid.tolist()
        answer = {
            "versions": versions,
            "elements": elements,
            "stations": [head[0] for head in self.heads],
            "influence": influence,
            "notes": [*self.notes, *notes],
        }
        if tolerance is not None:
            answer["tolerance"] = tolerance
        return answer


def reply(solve, question):
    """Writes the answer of `solve` to standard output, or why there is none."""
    try:
        answer = solve(question)
    except Refused as refused:
        answer = {"refused": str(refused)}
    json.dump(answer, sys.stdout, allow_nan=False)


def serve(solve):
    """Reads {"spec": ..., "theory": ...} from standard input, writes the answer to standard output."""
    reply(lambda question: solve(Frame(question["spec"], question["theory"])), json.load(sys.stdin))
