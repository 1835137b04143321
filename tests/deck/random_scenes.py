"""Random scenes that a deck can express, drawn by rule; `random_checks.py` checks their decks.

One to four bodies run on one to three structures: girders of one to four spans with overhangs, two rails on frames that couple
them, tables of values, and rigid rails. Their trucks have single wheels and equalisers of 2 to 16 wheels, with every law of a wheel:
linear and power laws, dampers to the rail and to the ground with and without a ramp, contacts that pull, flanges with and without
release, both laws of friction on wheels that spin. Bodies are moved by tables of position, speed or acceleration, are free, or stand.
"""

import random

# length units of a metre, force units of a kilonewton, gravity
UNITS = {
    ("m", "kN"): (1.0, 1.0, 9.81),
    ("mm", "N"): (1000.0, 1000.0, 9810.0),
    ("m", "N"): (1.0, 1000.0, 9.80665),
    ("ft", "lbf"): (1 / 0.3048, 224.808943, 32.174),
    ("in", "kip"): (1 / 0.0254, 0.224808943, 386.0886),
}
FORMS = ["factored", "symmetrised", "akispl", "paper"]
LAWS = ["linear", "linear", "linear damped", "linear damped", "power", "power damped", "power damped"]
SIZES = [1, 1, 2, 2, 3, 4, 8, 16]
TIME = 8.0


def power(draw, low, high):
    return 10.0 ** draw.uniform(low, high)


def stations(draw, first, last, marks, least=4):
    """Stations from `first` to `last` with the marks, at equal or random distances between them."""
    marks = sorted({first, last, *marks})
    pieces = draw.choice([2, 3, 3, 4, 6])
    out = []
    for a, b in zip(marks, marks[1:]):
        inner = [a + (b - a) * i / pieces for i in range(pieces)]
        if draw.random() < 0.2:
            inner = [a, *(a + (b - a) * (i + draw.uniform(-0.3, 0.3)) / pieces for i in range(1, pieces))]
        out += inner
    out.append(last)
    while len(out) < least:
        out = sorted([*out, *((a + b) / 2 for a, b in zip(out, out[1:]))])
    return out


def girder(draw, scale):
    """A spec of one rail over some spans; its units, and the range of the rail in metres."""
    length, force, _ = scale
    spans = [draw.uniform(6, 15) for _ in range(draw.choice([1, 1, 1, 2, 2, 3, 4]))]
    overhangs = [draw.choice([0, 0, 1.5]), draw.choice([0, 0, 2.0])]
    stress = force / length**2
    inertia = power(draw, -4, -2)
    own = {
        "spans": [span * length for span in spans], "overhangs": [over * length for over in overhangs],
        "E": 2.1e8 * stress, "I_vertical": inertia * length**4, "I_lateral": 0.3 * inertia * length**4, "G": 8.1e7 * stress,
        "J": 0.02 * inertia * length**4, "A": 0.02 * length**2, "rail_height": draw.choice([0, 0.4]) * length,
    }
    if draw.random() < 0.3:
        own["kA_vertical"] = 0.008 * length**2
    marks, at = [0.0], 0.0
    for span in spans:
        at += span
        marks.append(at)
    first, last = -overhangs[0], at + overhangs[1]
    spec = {"format": "girderway-beam/1", "girder": own, "stations": [x * length for x in stations(draw, first, last, marks)]}
    return spec, {"rail": (first, last, 0.0)}


def runway(draw, scale):
    """A spec of two rails on frames with ties, or of two girders that are independent; and their ranges."""
    length, force, _ = scale
    gauge, bay, height = draw.choice([8.0, 10.0, 14.0]), draw.uniform(5, 8), 7.0
    tied = draw.random() < 0.6
    points, line, section, orientation, supports, rails = [], [], [], [], [], {}
    every = ["ux", "uy", "uz", "rx", "ry", "rz"]
    for r, name in enumerate(["north", "south"]):
        z, base = r * gauge, len(points)
        points += [[i * bay, height, z] for i in range(3)]
        if tied:
            points += [[i * bay, 0, z] for i in range(3)]
            line += [[base + 3 + i, base + i] for i in range(3)]
            section += ["column"] * 3
            orientation += [[1, 0, 0]] * 3
            supports += [{"point": base + 3 + i, "fix": every} for i in range(3)]
        else:
            supports += [{"point": base + i, "fix": ["uy", "uz", "rx"] + (["ux"] if i == 0 else [])} for i in range(3)]
        cell = len(line)
        line += [[base, base + 1], [base + 1, base + 2]]
        section += [draw.choice(["girder", "light"])] * 2
        orientation += [[0, 1, 0]] * 2
        marks = [0, bay, 2 * bay]
        rails[name] = {
            "origin": [0, height * length, z * length], "axis": [1, 0, 0],
            "segments": [{"cell": [0, cell + i], "offset": [0, 0.5 * length, 0]} for i in range(2)],
            "stations": [x * length for x in stations(draw, 0.0, 2 * bay, marks)],
        }
    if tied:
        line += [[i, 6 + i] for i in range(3)]
        section += ["tie"] * 3
        orientation += [[0, 1, 0]] * 3
    stress = force / length**2
    size = power(draw, -0.5, 0.7)

    def of(name, a, iy, iz, j):
        return {"name": name, "material": "steel", "A": a * length**2, "Iy": iy * size * length**4, "Iz": iz * size * length**4,
                "J": j * length**4}

    spec = {
        "format": "girderway-beam/1", "points": [[v * length for v in point] for point in points],
        "cells": [{"type": "line", "data": line}], "cell_data": {"section": [section], "orientation": [orientation]},
        "materials": [{"name": "steel", "E": 2.1e8 * stress, "G": 8.1e7 * stress}],
        "sections": [of("column", 0.02, 2e-4, 6e-4, 4e-6), of("girder", 0.02, 1e-4, 6e-4, 4e-6),
                     of("light", 0.01, 6e-5, 2e-4, 3e-6), of("tie", 0.01, 5e-5, 3e-4, 1e-6)],
        "supports": supports, "rails": rails,
    }
    return spec, {"north": (0.0, 2 * bay, 0.0), "south": (0.0, 2 * bay, gauge)}


def tables(draw, scale):
    """Tables of a simply supported girder in closed form, as the text of a file; and the range of the rail."""
    length, force, _ = scale
    span, bending = draw.uniform(8, 14), 2.1e8 * power(draw, -4, -2)
    places = stations(draw, 0.0, span, [], 5)

    def influence(a, b):
        x, b = min(a, b), span - max(a, b)
        return b * x * (span**2 - b**2 - x**2) / (6 * span * bending) * length / force

    rows = [f"scene tables\nUNITS/\n, FORCE = {FORCE_WORD[scale]}\n, MASS = KILOGRAM\n, LENGTH = {LENGTH_WORD[scale]}\n, TIME = SECOND"]
    for number, factor in ((6, 1.0), (7, 3.0)):
        rows.append(f"SPLINE/{number}\n, LINEAR_EXTRAPOLATE")
        rows.append(", X = " + ", ".join(f"{x * length!r}" for x in places))
        rows += [f", Y = {z * length!r}, " + ", ".join(f"{factor * influence(x, z)!r}" for x in places) for z in places]
    text = "\n".join(rows) + "\nEND\n"
    # a data set has short lines: a list continues after a comma
    return text.replace(", ", "\n, ").replace("\n\n", "\n"), {"rail": (0.0, span, 0.0)}


FORCE_WORD = {UNITS["m", "kN"]: "KNEWTON", UNITS["mm", "N"]: "NEWTON", UNITS["m", "N"]: "NEWTON", UNITS["ft", "lbf"]: "POUND_FORCE",
              UNITS["in", "kip"]: "KPOUND_FORCE"}
LENGTH_WORD = {UNITS["m", "kN"]: "METER", UNITS["mm", "N"]: "MILLIMETER", UNITS["m", "N"]: "METER", UNITS["ft", "lbf"]: "FOOT",
               UNITS["in", "kip"]: "INCH"}


def wheel(draw, scale, load, flanged, spins):
    """A kind of wheel for a load of `load` kN a wheel."""
    length, force, _ = scale
    depth = power(draw, -4.5, -2.3)
    stiffness = load / depth
    law = draw.choice(LAWS)
    own = {"radius": draw.choice([0.25, 0.4, 0.63]) * length}
    vertical = {}
    exponent = 1.0
    if law.startswith("power"):
        exponent = draw.choice([1.1, 1.3, 1.5, 2.2])
        vertical |= {"law": "impact", "exponent": exponent}
        if "damped" in law:
            vertical["depth"] = depth * draw.choice([0.1, 0.5, 2.0]) * length
    vertical["k"] = load * force / (depth * length) ** exponent
    if "damped" in law:
        # a fraction of the force at a speed of 0.01 to 1 m/s
        vertical["c"] = stiffness * depth * power(draw, -1, 1) * force / length
        vertical["damper"] = draw.choice(["rail", "rail", "ground"])
    if draw.random() < 0.15:
        vertical["bilateral"] = True
    own["vertical"] = vertical
    if flanged:
        lateral = {"k": stiffness * draw.uniform(0.05, 0.5) * force / length, "clearance": draw.choice([0.0, 0.001, 0.01]) * length}
        if draw.random() < 0.4:
            lateral["release"] = [own["radius"], own["radius"] + draw.uniform(0.005, 0.03) * length]
        own["lateral"] = lateral
    if spins:
        own["friction"] = {"law": draw.choice(["step", "coulomb"]), "mu": draw.uniform(0.05, 0.3), "slip": 0.02 * length}
        own["spin_inertia"] = 0.01 * load * force * length
    return own


def tree(draw, size, spacing):
    """An equaliser of `size` wheels, a power of two, or single wheels; offsets from the middle in metres."""
    if size == 3:
        return [-spacing, 0.0, spacing]
    offsets = [(i - (size - 1) / 2) * spacing * draw.uniform(0.98, 1.02) for i in range(size)]

    def nest(part):
        return part[0] if len(part) == 1 else [nest(part[: len(part) // 2]), nest(part[len(part) // 2:])]

    if size == 1:
        return [0.0]
    whole = nest(offsets)
    # one point of support, two, or wheels that are all fixed to the body
    kind = draw.choice(["one", "two", "two", "fixed"])
    return [whole] if kind == "one" else whole if kind == "two" else offsets


def ends(part):
    return [part, part] if isinstance(part, float) else [min(ends(p)[0] for p in part), max(ends(p)[1] for p in part)]


def middle_of(part):
    return part if isinstance(part, float) else sum(middle_of(p) for p in part) / 2


def support(part):
    """Points at which a tree supports its body: wheels, and the pins of equalisers."""
    return [middle_of(p) for p in part]


def scaled(part, factor):
    return part * factor if isinstance(part, float) else [scaled(p, factor) for p in part]


def body(draw, name, rails, scale, kinds):
    """A body with its trucks and its motion on a rail, or on both of a runway; nothing where it does not fit."""
    length, force, _ = scale
    weight = power(draw, 1, 3)
    pair = draw.random() < 0.7 if len(rails) == 2 else False
    chosen = list(rails) if pair else [draw.choice(list(rails))]
    size = draw.choice(SIZES)
    spacing = draw.uniform(0.5, 1.0)
    trucks, arms, held = [], [], []
    per_rail = 1 if size >= 8 else draw.choice([1, 1, 2])
    flanged = draw.random() < 0.4
    flags = {"roll": pair and draw.random() < 0.7, "pitch": draw.random() < 0.7, "z": flanged and draw.random() < 0.7}
    flags["yaw"] = flags["z"] and draw.random() < 0.5
    moved = draw.choice(["position", "speed", "speed", "acceleration", "held", "free"])
    spins = draw.random() < 0.3
    wheels = per_rail * len(chosen) * (3 if size == 3 else size)
    kind = f"k{name}"
    kinds[kind] = wheel(draw, scale, weight / wheels, flanged, spins)
    middle = sum(rails[rail][2] for rail in chosen) / len(chosen)
    apart = draw.uniform(1.0, 2.0) + size * spacing / 2
    drop = draw.choice([0.0, 0.0, 0.3])
    for rail in chosen:
        for p in range(per_rail):
            along = 0.0 if per_rail == 1 else (p - 0.5) * 2 * apart
            own = tree(draw, size, spacing)
            reach, points = ends(own), support(own)
            trucks.append({"name": f"{name}{rail[-5:].replace('.', '')}{p}", "body": name, "rail": rail,
                           "at": [along * length, drop * length, (rails[rail][2] - middle) * length],
                           "tree": scaled(own, length), "wheel": kind})
            arms.append((along + reach[0], along + reach[1]))
            held += [along + point for point in points]
    low = max(rails[rail][0] for rail in chosen) - min(a for a, _ in arms) + 0.3
    high = min(rails[rail][1] for rail in chosen) - max(b for _, b in arms) - 0.3
    if high < low + 0.2:
        return None
    x0, x1 = draw.uniform(low, high), draw.uniform(low, high)
    # the centre of mass stays between the points of support
    inside = 0.25 * (max(held) - min(held))
    if inside < 0.1:
        inside, flags["pitch"] = 0.0, False
    gauge = abs(rails[chosen[-1]][2] - rails[chosen[0]][2])
    cg = [draw.uniform(-inside, inside) if inside > 0 else 0.0, draw.choice([0.0, 1.0]),
          draw.uniform(-0.15, 0.15) * gauge if flags["roll"] else 0.0]
    free = {"x": moved == "free", "y": True, **flags}
    dof = [key for key in ("x", "y", "z", "roll", "yaw", "pitch") if free[key]]
    mass = weight / 9.81
    out = {"weight": weight * force, "inertia": [v * mass * force * length * draw.uniform(0.5, 2) for v in (4.0, 4.5, 2.0)],
           "cg": [v * length for v in cg], "dof": dof, "x0": x0 * length}
    if pair:
        out["track"] = chosen
    motion = None
    speed = (x1 - x0) / TIME
    if moved == "position":
        motion = {"position": [[0, x0 * length], [0.6 * TIME, x1 * length], [TIME, (0.7 * x1 + 0.3 * x0) * length]]}
    elif moved == "speed":
        motion = {"speed": [[0, 0], [2, speed * length], [TIME, speed * length]]}
    elif moved == "acceleration":
        motion = {"acceleration": [[0, speed / 2 * length], [2, 0]]}
    if motion:
        motion = {"body": name, "dof": "x", "kind": "prescribed", **motion}
    elif moved == "free":
        motion = {"body": name, "dof": "x", "kind": "free"}
    return out, trucks, motion


def scene_of(seed):
    """The files of a scene by name, and the form of its deck (none: the program chooses)."""
    draw = random.Random(seed)
    words = draw.choice(list(UNITS))
    scale = UNITS[words]
    length, force, gravity = scale
    units = {"length": words[0], "force": words[1], "time": "s"}
    files, structures, rails = {}, {}, {}
    for s in range(draw.choice([1, 1, 1, 2, 2, 3])):
        name = f"s{s}"
        kind = draw.choice(["girder", "girder", "runway", "tables"])
        own = {}
        if kind == "tables":
            text, ranges = tables(draw, scale)
            files[f"{name}.adm"] = text
            own["tables"] = {"file": f"{name}.adm", "vertical": 6, "lateral": 7}
            own["reading"] = draw.choice(["natural", "akispl", "cubspl"])
            own["foundation"] = "influence"
        else:
            spec, ranges = (girder if kind == "girder" else runway)(draw, scale)
            files[f"{name}.json"] = {**spec, "units": units}
            own["spec"] = f"{name}.json"
            own["foundation"] = draw.choice(["influence"] * 6 + ["rigid", "auto"])
            if own["foundation"] == "influence":
                own["reading"] = draw.choice(["exact", "natural", "akispl", "cubspl"])
                if kind == "runway":
                    own["couplings"] = draw.choice(["all", "all", "within rails", "none"])
        structures[name] = own
        rails[name] = {f"{name}.{rail}": place for rail, place in ranges.items()}
    bodies, kinds, trucks, motions = {}, {}, [], []
    wanted, tries = draw.choice([1, 1, 2, 3, 4]), 0
    while len(bodies) < wanted and tries < 40:
        tries += 1
        name = f"b{len(bodies)}"
        made = body(draw, name, rails[draw.choice(list(rails))], scale, kinds)
        if made:
            bodies[name] = made[0]
            trucks += made[1]
            motions += [made[2]] if made[2] else []
    files["scene.json"] = {
        "format": "girderway-scene/1", "name": f"scene{seed}", "units": units, "gravity": gravity, "structures": structures,
        "bodies": bodies, "wheels": {name: kinds[name] for name in {truck["wheel"] for truck in trucks}}, "trucks": trucks,
        "motions": motions, "end": {"time": TIME}, "output": {"dt": TIME / 20}, "accuracy": 1e-4,
    }
    return files, draw.choice([None, *FORMS])
