"""Random frames of hard geometry with their influence coefficients to 50 digits and more, for the test of the error bound.

    python3 fea/hard_frames.py SEED COUNT [wide|close] > frames.json
    HARD_FRAMES=frames.json cargo test --release -p girderway-fea --features nightly --test it -- hard --nocapture

Needs fea/requirements-frames.txt: python-flint (ball arithmetic: every digit is proved). The method shares nothing with the crate: a node is put at
every station, released ends are unknowns of their own, and the stiffness is solved densely with 1200 bits. All numbers
of a frame are the doubles that are printed; each coefficient is printed as a sum of two doubles.

Distribution `wide`: lengths 1e-6 to 1e3, stiffnesses over 16 decades, rigid offsets to 10, coordinates to 1e6.
Distribution `close`: members of one length, long chains of nearly equal stiffness, offsets beside a small member.
"""

import json
import math
import random
import sys

import flint
from flint import arb, arb_mat

flint.ctx.prec = 1200
ZERO, ONE = arb(0), arb(1)


# Small vectors and matrices of balls ------------------------------------------------------------------------------

def vec(v):
    return [arb(x) for x in v]


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def scale(s, a):
    return [s * x for x in a]


def dot(a, b):
    return sum((x * y for x, y in zip(a, b)), ZERO)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return scale(ONE / dot(a, a).sqrt(), a)


def triad(x, y):
    y = unit(sub(y, scale(dot(x, y), x)))
    return [x, y, cross(x, y)]


def arm(r):
    """6 x 6 motion of the tip of a rigid arm r by that of its root."""
    m = [[ONE if i == j else ZERO for j in range(6)] for i in range(6)]
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        m[i][3 + j] = r[k]
        m[j][3 + i] = -r[k]
    return m


# Reference ----------------------------------------------------------------------------------------------------------

class Frame:
    """Unknowns are numbered as they appear; a row is a dictionary from unknown to coefficient."""

    def __init__(self, spec):
        self.spec, self.count, self.terms = spec, 0, {}
        self.body, self.root = {}, {}
        points = [vec(p) for p in spec["points"]]
        self.points = points
        parent = list(range(len(points)))

        def find(k):
            while parent[k] != k:
                k = parent[k]
            return k

        for a, b in spec["links"]:
            parent[find(b)] = find(a)
        fixed = {p: f for p, f in spec["supports"]}
        for k in range(len(points)):
            group = [j for j in range(len(points)) if find(j) == find(k)]
            held = [j for j in group if j in fixed]
            assert len(held) <= 1
            self.root[k] = (held or [group[0]])[0]
        self.columns = {}
        for k in set(self.root.values()):
            self.columns[k] = [None if fixed.get(k, [False] * 6)[i] else self.new() for i in range(6)]

    def new(self):
        self.count += 1
        return self.count - 1

    def rows(self, point, offset):
        """The six displacements at a rigid offset from a point."""
        root = self.root[point]
        m = arm(add(sub(self.points[point], self.points[root]), offset))
        return [{c: m[i][k] for k, c in enumerate(self.columns[root]) if c is not None} for i in range(6)]

    def node(self):
        return [{self.new(): ONE} for _ in range(6)]

    def stiffen(self, rows, matrix):
        for i, a in enumerate(rows):
            for j, b in enumerate(rows):
                if matrix[i][j] != 0:
                    for p, x in a.items():
                        for q, y in b.items():
                            self.terms[p, q] = self.terms.get((p, q), ZERO) + x * matrix[i][j] * y


def combine(weights, rows):
    out = {}
    for w, row in zip(weights, rows):
        for k, x in row.items():
            out[k] = out.get(k, ZERO) + w * x
    return out


def stiffness(section, theory, l):
    e, g, a, iy, iz, j = (arb(section[k]) for k in ("E", "G", "A", "Iy", "Iz", "J"))
    k = [[ZERO] * 12 for _ in range(12)]

    def put(at, values):
        for i, p in enumerate(at):
            for m, q in enumerate(at):
                k[p][q] = values[i][m]

    for at, s in ((0, e * a / l), (3, g * j / l)):
        put((at, at + 6), [[s, -s], [-s, s]])
    for at, inertia, area, sign in (((1, 5, 7, 11), iz, section["Asy"], 1), ((2, 4, 8, 10), iy, section["Asz"], -1)):
        ei = e * inertia
        phi = 12 * ei / (g * arb(area) * l * l) if theory == "timoshenko" and area is not None else ZERO
        r = ei / (l * l * l * (1 + phi))
        p, q, s, t = 12 * r, sign * 6 * l * r, (4 + phi) * l * l * r, (2 - phi) * l * l * r
        put(at, [[p, q, -p, q], [q, s, -q, t], [-p, -q, p, -q], [q, t, -q, s]])
    return k


def reference(spec):
    """Coefficients of the probes, as balls; None where a member or a rail cannot be used."""
    frame = Frame(spec)
    rail = spec["rail"]
    axes = triad(unit(vec(rail["axis"])), vec(spec["up"]))
    origin = vec(rail["origin"])
    ends = [[add(frame.points[p], vec(o)) for p, o in zip(m["points"], m["offsets"])] for m in spec["members"]]
    stretches = []
    for member, offset in rail["segments"]:
        x = [dot(axes[0], sub(p, origin)) for p in ends[member]]
        stretches.append((member, x, vec(offset)))
    places = {}
    probes = []
    for x, axis in spec["probes"]:
        x = arb(x)
        near = []
        for member, (xa, xb), offset in stretches:
            t = (x - xa) / (xb - xa)
            beyond = max(float(-t), float(t - 1), 0.0)
            near.append((beyond * abs(float(xb - xa)), member, t, offset))
        _, member, t, offset = min(near, key=lambda entry: entry[0])
        t = min(max(t, ZERO), ONE) if float(t) < 0 or float(t) > 1 else t
        places.setdefault(member, []).append(t)
        probes.append((member, t, offset, axis))
    found = {}
    for index, member in enumerate(spec["members"]):
        p, q = ends[index]
        along = sub(q, p)
        length = dot(along, along).sqrt()
        local = triad(scale(ONE / length, along), vec(member["y"]))

        def turned(rows):
            return [combine(local[i % 3], rows[3 * (i // 3):3 * (i // 3) + 3]) for i in range(6)]

        # Flexible ends, global axes: a released displacement is an unknown of its own.
        flexible = []
        for end in range(2):
            rows = turned(frame.rows(member["points"][end], vec(member["offsets"][end])))
            for k in range(6):
                if member["releases"][end][k]:
                    rows[k] = {frame.new(): ONE}
            flexible.append(rows)
        cuts = [(ZERO, flexible[0])]
        inner = sorted(set(float(t) for t in places.get(index, [])))
        exact = {float(t): t for t in places.get(index, [])}
        for key in inner:
            t = exact[key]
            if float(t) <= 1e-200:
                found[index, key] = flexible[0]
            elif float(1 - t) <= 1e-200:
                found[index, key] = flexible[1]
            else:
                node = frame.node()
                found[index, key] = node
                cuts.append((t, node))
        cuts.append((ONE, flexible[1]))
        section = spec["sections"][member["section"]]
        for (ta, a), (tb, b) in zip(cuts, cuts[1:]):
            frame.stiffen(a + b, stiffness(section, spec["theory"], (tb - ta) * length))
        # Back to global axes, for the displacement of the rail.
        for key in inner:
            rows = found[index, key]
            back = [[local[k][i] for k in range(3)] for i in range(3)]
            found[index, key] = [combine(back[i % 3], rows[3 * (i // 3):3 * (i // 3) + 3]) for i in range(6)]
    for point, dof, k in spec["springs"]:
        frame.stiffen([frame.rows(point, vec([0, 0, 0]))[dof]], [[arb(k)]])
    loads = []
    for member, t, offset, axis in probes:
        rows = found[member, float(t)]
        m = arm(offset)
        at = [combine(m[i], rows) for i in range(3)]
        loads.append(combine(axes[axis], at))
    n = frame.count
    k = arb_mat(n, n)
    # Scaled to a unit diagonal.
    size = [arb(2) ** -round(math.log2(float(frame.terms[i, i])) / 2) for i in range(n)]
    for (i, j), value in frame.terms.items():
        k[i, j] = size[i] * value * size[j]
    p = arb_mat(n, len(loads))
    for j, load in enumerate(loads):
        for i, value in load.items():
            p[i, j] = value * size[i]
    u = k.solve(p)
    return p.transpose() * u


# Random frames ------------------------------------------------------------------------------------------------------

class Draw:
    def __init__(self, seed):
        self.random = random.Random(seed)

    def log(self, low, high):
        return 10 ** self.random.uniform(low, high)

    def chance(self, p):
        return self.random.random() < p

    def direction(self):
        while True:
            v = [self.random.uniform(-1, 1) for _ in range(3)]
            size = math.sqrt(sum(x * x for x in v))
            if 0.1 < size < 1:
                return [x / size for x in v]

    def offset(self):
        kind = self.random.random()
        if kind < 0.5:
            return [0.0, 0.0, 0.0]
        size = self.log(-3, 1)
        return [size * x for x in self.direction()] if kind < 0.8 else [0.0, size, 0.0]


def section(draw, middle, decades):
    ei = middle * draw.log(-decades, decades)
    iz = ei / 2e11
    a = iz / draw.log(-6, 1)
    return {"E": 2e11, "G": 8e10, "A": a, "Iy": iz * draw.log(-2, 2), "Iz": iz, "J": iz * draw.log(-3, 1),
            "Asy": None if draw.chance(0.3) else a * draw.random.uniform(0.1, 1),
            "Asz": None if draw.chance(0.3) else a * draw.random.uniform(0.1, 1)}


def frame(draw, wide):
    r = draw.random
    count = r.choice([1, 2, 2, 3, 4]) if wide else r.choice([1, 3, 8, 20])
    oblique = draw.chance(0.6)
    aligned = [1.0, 0.0, 0.0]
    axis = draw.direction() if oblique else aligned
    size = draw.log(-6, 3)
    lengths = [draw.log(-6, 3) if wide else size for _ in range(count)]
    far = 0.0 if draw.chance(0.2) else draw.log(-3, 6)
    far = min(far, min(lengths) * 1e11)
    start = [far * x for x in draw.direction()] if draw.chance(0.6) else [far, 0.0, 0.0]
    at, flexible = start, [start]
    for l in lengths:
        way = axis
        if oblique and draw.chance(0.5):
            skew = draw.direction()
            way = [a + 0.5 * s for a, s in zip(axis, skew)]
        at = [p + l * w for p, w in zip(at, way)]
        flexible.append(at)
    offsets = [draw.offset() for _ in flexible]
    points = [[p - o for p, o in zip(place, offset)] for place, offset in zip(flexible, offsets)]
    sections = [section(draw, 1e6, 8 if wide else 1) for _ in range(r.choice([1, 2, 3]))]
    both = draw.chance(0.7)
    members, supports, springs, links = [], [], [], []
    up = r.choice([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], draw.direction()])
    for k in range(count):
        y = draw.direction() if oblique and draw.chance(0.5) else up
        if draw.chance(0.1):
            # Nearly along the member.
            y = [w + draw.log(-4, 0) * s for w, s in zip(axis, draw.direction())]
        members.append({"points": [k, k + 1], "section": r.randrange(len(sections)), "y": y,
                        "offsets": [offsets[k], offsets[k + 1]], "releases": [[False] * 6, [False] * 6]})
    supports.append([0, [True] * 6])
    if both:
        supports.append([count, [True] * 6])
        if draw.chance(0.4):
            member, end, dof = r.randrange(count), r.randrange(2), r.choice([4, 5, 5, 3, 1])
            members[member]["releases"][end][dof] = True
    for k in range(1, count):
        kind = r.random()
        if kind < 0.2:
            springs.append([k, r.randrange(6), draw.log(-2, 14)])
        elif kind < 0.4:
            # A column, sometimes behind a rigid link.
            top = k
            if draw.chance(0.4):
                top = len(points)
                points.append([p + x for p, x in zip(points[k], draw.offset())])
                links.append([k, top])
            foot = len(points)
            l = draw.log(-3, 3) if wide else size * draw.log(-1, 1)
            l = max(l, far * 1e-11)
            points.append([p + l * x for p, x in zip(points[top], draw.direction())])
            supports.append([foot, [True] * 6])
            members.append({"points": [foot, top], "section": r.randrange(len(sections)), "y": draw.direction(),
                            "offsets": [[0.0] * 3, [0.0] * 3], "releases": [[False] * 6, [False] * 6]})
    origin = [0.0, 0.0, 0.0] if draw.chance(0.5) else start
    rail_offset = draw.offset()
    spec = {"theory": r.choice(["euler-bernoulli", "timoshenko"]), "points": points, "sections": sections,
            "members": members, "supports": supports, "springs": springs, "links": links, "up": up,
            "rail": {"origin": origin, "axis": axis, "segments": [[k, rail_offset] for k in range(count)]}}
    along = triad(unit(vec(axis)), vec(up))[0]
    ends = [sub(add(vec(points[k]), vec(offsets[k])), vec(origin)) for k in range(count + 1)]
    x = [float(dot(along, end)) for end in ends]
    spec["probes"] = []
    for _ in range(4):
        k = r.randrange(count)
        fraction = r.choice([1e-6, 1e-6, 1 - 1e-6, 1 - 1e-6, r.random(), r.random(), draw.log(-9, 0), 0.0, 1.0])
        spec["probes"].append([x[k] + fraction * (x[k + 1] - x[k]), r.randrange(3)])
    return spec if all(b > a for a, b in zip(x, x[1:])) else None


def main():
    seed, count = int(sys.argv[1]), int(sys.argv[2])
    wide = sys.argv[3:] != ["close"]
    draw = Draw(seed)
    print("[")
    done = 0
    while done < count:
        spec = frame(draw, wide)
        if spec is None:
            continue
        grid = reference(spec)
        n = len(spec["probes"])
        entries = [[grid[i, j] for j in range(n)] for i in range(n)]
        if any(not e.is_finite() or e.rad() > abs(e.mid()) * arb(10) ** -60 and e != 0 and abs(float(e)) > 1e-200
               for row in entries for e in row):
            print("not proved", file=sys.stderr)
            continue
        high = [[float(e.mid()) for e in row] for row in entries]
        low = [[float((e - h).mid()) for e, h in zip(row, own)] for row, own in zip(entries, high)]
        spec["grid"], spec["rest"] = high, low
        done += 1
        print(json.dumps(spec) + ("," if done < count else ""), flush=True)
    print("]")


if __name__ == "__main__":
    main()
