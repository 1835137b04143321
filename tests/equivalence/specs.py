"""Random beam specs: the short form, and frames in the general form."""

from dataclasses import dataclass, field

from case import significant

STEEL = {"E": 2.1e11, "G": 8.1e10, "density": 7850.0}
GRAVITY = 9.80665


@dataclass
class Rail:
    """A rail as a scene sees it, in metres: its range, its place across, its height over the origin."""

    name: str
    first: float
    last: float
    across: float = 0.0
    height: float = 0.0


@dataclass
class Structure:
    """A drawn spec with what a scene needs to know of it."""

    spec: dict
    rails: list
    span: float
    has_mass: bool
    straight: bool
    lateral: bool
    longitudinal: bool
    stresses: bool
    along: str = "x"
    spans: int = 1
    tags: set = field(default_factory=set)

    def file(self, name):
        return {**self.spec, "name": name}


def theory(draw):
    """A theory, or none: the default."""
    return draw.choice([{}, {"theory": "euler-bernoulli"}, {"theory": "timoshenko"}])


def stations(draw, first, last, fewest=4, most=8):
    """Increasing coordinates from the first to the last, even or not; all in the unit of the file."""
    count = draw.randint(fewest, most)
    inside = lambda share: significant(first + (last - first) * share, 9)
    if draw.yes(0.6):
        return [first, *[inside(i / (count - 1)) for i in range(1, count - 1)], last]
    inner = sorted(draw.uniform(0.04, 0.96) for _ in range(count - 2))
    inner = [x for i, x in enumerate(inner) if i == 0 or x - inner[i - 1] > 0.03]
    inner = inner if len(inner) > 1 else [0.3, 0.7]
    return [first, *[inside(x) for x in inner], last]


def short(draw, units, weight):
    """A straight girder that carries `weight` newtons with a deflection of a usual share of its span."""
    tags = {"spec: short form"}
    spans = [draw.number(4, 25, 3) for _ in range(draw.choice([1, 1, 2, 3, 4]))]
    overhangs = [draw.choice([0, 0, draw.number(0.5, 4, 3)]) for _ in range(2)]
    ratio = draw.size(300, 5000)
    vertical = weight * max(spans) ** 2 * ratio / (48 * STEEL["E"])
    area = 1.5 * vertical**0.5
    girder = {
        "spans": units.lengths(spans),
        "E": units.modulus(STEEL["E"]),
        "I_vertical": units.second_moment(vertical),
    }
    if any(overhangs) or draw.yes(0.3):
        girder["overhangs"] = units.lengths(overhangs)
        tags.add("spec: overhangs")
    lateral = draw.yes(0.7)
    if lateral:
        girder["I_lateral"] = units.second_moment(vertical * draw.number(0.05, 0.6))
    full = lateral and draw.yes(0.85)
    if full:
        girder["G"] = units.modulus(STEEL["G"])
        girder["J"] = units.second_moment(vertical * draw.number(0.02, 0.5))
        girder["A"] = units.area(area)
    elif draw.yes(0.5):
        girder["A"] = units.area(area)
    if draw.yes(0.4):
        girder["G"] = units.modulus(STEEL["G"])
        girder["kA_vertical"] = units.area(area * draw.number(0.3, 0.8))
        if lateral:
            girder["kA_lateral"] = units.area(area * draw.number(0.3, 0.8))
        tags.add("spec: shear areas")
    if full and draw.yes(0.6):
        girder["rail_height"] = units.length(draw.number(0.2, 1.5, 3))
        tags.add("spec: rail_height")
    has_mass = draw.yes(0.65)
    if has_mass:
        girder["mass_per_length"] = units.line_mass(area * STEEL["density"])
    # the ends of the rail as the program adds them up, in the unit of the file
    begin = -units.length(overhangs[0])
    end = sum(girder["spans"]) + units.length(overhangs[1])
    first, last = begin / units.metre, end / units.metre
    spec = {"format": "girderway-beam/1", "units": units.names, **theory(draw), "girder": girder}
    stresses = full and draw.yes(0.35)
    if stresses:
        height = vertical**0.25
        girder["points"] = [
            {"name": "bottom", "y": units.length(-height), "detail": draw.choice([112, 71, "B", "C", "E'"])},
            {"name": "edge", "y": units.length(height), "z": units.length(height / 3)},
        ]
        tags.add("spec: points")
    if stresses or draw.yes(0.3):
        spec["effects"] = [
            {"name": name, "x": units.length(draw.uniform(first, last)) if name == "mid" else draw.choice([0, sum(girder["spans"])])}
            for name in draw.sample(["mid", "support"], draw.randint(1, 2))
        ]
        tags.add("spec: effects")
    spec["stations"] = stations(draw, begin, end)
    return Structure(
        spec, [Rail("rail", first, last)], max(spans), has_mass, True, lateral, "A" in girder, stresses,
        spans=len(spans), tags=tags,
    )


def shape(draw, units):
    """A section by its plates."""
    if draw.yes(0.5):
        length = {"length": "mm"}
        unit = lambda metres: significant(metres * 1000, 5)
    else:
        length, unit = {}, units.length
    height = draw.number(0.4, 1.2, 3)
    kind = draw.choice(["I", "I unequal", "box", "tube", "bar"])
    width, flange, web = height * 0.4, height * 0.03, height * 0.02
    if kind == "tube":
        return {"kind": "tube", "diameter": unit(height), "wall": unit(web), **length}
    if kind == "bar":
        return {"kind": "bar", "height": unit(height), "width": unit(height * 0.1), **length}
    plates = {"height": unit(height), "width": unit(width), "flange": unit(flange), "web": unit(web), **length}
    if kind == "I unequal":
        plates |= {"lower_width": unit(width * 0.7), "lower_flange": unit(flange * 1.2)}
    return {"kind": kind.split()[0], **plates}


def frame(draw, units, weight, rails=None, gauge=None):
    """A runway as a frame: one or two rows of girders on supports, springs, columns or brackets.

    Bays run along x, rows lie side by side along z, each row carries a rail; what joins, stiffens and releases the
    members is drawn. `gauge` is the distance of two rows.
    """
    tags = {"spec: general form"}
    rows = rails or draw.choice([1, 1, 2])
    gauge = gauge or draw.number(4, 14, 3)
    bays = draw.randint(1, 3)
    bay = draw.number(4, 14, 3)
    ratio = draw.size(400, 4000)
    iz = weight * bay**2 * ratio / (48 * STEEL["E"])
    area = 1.5 * iz**0.5
    columns = draw.yes(0.4)
    height = draw.number(3, 9, 3) if columns else 0.0
    points, beams, sections_of, orientation = [], [], [], []
    offset_a, offset_b, release_a, release_b, section_b, supports, springs = [], [], [], [], [], [], []
    sets, segments, effects, links, masses = {}, {}, [], [], []
    taper = draw.yes(0.2)
    offset_beams = draw.number(0.1, 0.5, 2) if draw.yes(0.35) else 0.0
    hinges = bays > 1 and draw.yes(0.35)
    split = draw.yes(0.4)
    sprung = draw.yes(0.3)
    bracket = columns and draw.yes(0.4)
    fixed = draw.yes(0.25)

    def point(x, y, z):
        points.append([units.length(x), units.length(y), units.length(z)])
        return len(points) - 1

    def member(a, b, section, across=None, releases=([], []), arms=(None, None), tapers=None):
        beams.append([a, b])
        sections_of.append(section)
        orientation.append(across or [0, 1, 0])
        release_a.append(releases[0])
        release_b.append(releases[1])
        zero = [0, 0, 0]
        offset_a.append(arms[0] or zero)
        offset_b.append(arms[1] or zero)
        section_b.append(tapers)
        return len(beams) - 1

    tops = []
    for row in range(rows):
        z = (row - (rows - 1) / 2) * gauge
        name = "rail" if rows == 1 else ["north", "south"][row]
        segments[name], line = [], []
        for joint in range(bays + 1):
            top = point(joint * bay, height, z)
            line.append(top)
            if columns:
                foot = point(joint * bay, 0, z)
                member(foot, top, 1, [1, 0, 0])
                supports.append({"point": foot, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"]})
                sets[f"{name} foot {joint}"] = [foot]
                if bracket:
                    end = point(joint * bay, height, z + 0.6)
                    if draw.yes(0.5):
                        links.append({"from": top, "to": end})
                        tags.add("spec: links")
                    else:
                        member(top, end, 1)
                    line[-1] = end
            elif sprung and joint > 0:
                springs.append({"point": top, "dof": "uy", "k": units.stiffness(draw.size(3e7, 1e9))})
                supports.append({"point": top, "fix": ["uz", "rx"]})
                tags.add("spec: springs")
            else:
                fix = ["ux"] * (joint == 0) + ["uy", "uz", "rx"] + ["rz", "ry"] * (fixed and joint in (0, bays))
                supports.append({"point": top, "fix": fix})
                if draw.yes(0.4):
                    sets[f"{name} pier {joint}"] = [top]
        for joint in range(bays):
            a, b = line[joint], line[joint + 1]
            arm = [0, units.length(offset_beams), 0] if offset_beams else None
            hinge = hinges and (columns or not fixed)
            ends = (["rz"] if hinge and joint > 0 else [], ["rz", "ry"] if hinge and joint + 1 < bays and draw.yes(0.3) else [])
            if split:
                middle = point((joint + 0.45) * bay, height, z + (0.6 if bracket else 0))
                halves = [member(a, middle, 0, None, (ends[0], []), (arm, arm)),
                          member(middle, b, 0, None, ([], ends[1]), (arm, arm))]
            else:
                halves = [member(a, b, 0, None, ends, (arm, arm), 3 if taper and joint == 0 else None)]
            for cell in halves:
                segments[name].append(cell)
            if draw.yes(0.5):
                effects.append({"name": f"{name} {joint + 1}", "cell": [0, draw.choice(halves)], "at": draw.choice([0, 0.5, 1, 0.37])})
        tops.append(line)
        if draw.yes(0.2):
            masses.append({"point": line[-1], "mass": units.mass(draw.size(100, 3000)),
                           **({"offset": [0, units.length(0.5), 0]} if draw.yes(0.5) else {})})
            tags.add("spec: masses")
    cross = [[a, b] for a, b in zip(*tops)] if rows == 2 and draw.yes(0.5) else []
    sections = [
        {"name": "girder", "material": "steel", "A": units.area(area), "Iy": units.second_moment(iz * 0.3),
         "Iz": units.second_moment(iz), "J": units.second_moment(iz * draw.number(0.05, 0.5))},
        {"name": "column", "material": "steel", "A": units.area(area), "Iy": units.second_moment(iz),
         "Iz": units.second_moment(iz * 1.5), "J": units.second_moment(iz * 0.5)},
        {"name": "tie", "material": "steel", "A": units.area(area * 0.2)},
    ]
    shear = draw.yes(0.5)
    if shear:
        sections[0] |= {"Asy": units.area(area * 0.4), "Asz": units.area(area * 0.5)}
        tags.add("spec: shear areas")
    if not taper and draw.yes(0.25):
        plates = shape(draw, units)
        sections[0] = {"name": "girder", "material": "steel", "shape": plates}
        if draw.yes(0.3):
            sections[0]["J"] = units.second_moment(iz * 0.3)
        tags.add("spec: shapes")
    stresses = bool(effects) and draw.yes(0.35)
    if stresses:
        sections[0]["points"] = [{"name": "bottom", "y": units.length(-(iz**0.25)), "detail": draw.choice([112, 90, "B"])}]
        tags.add("spec: points")
    if taper and not split:
        sections.append({**{k: v for k, v in sections[0].items() if k != "points"}, "name": "girder end",
                         "Iz": units.second_moment(iz * 1.8), "A": units.area(area * 1.3)})
        tags.add("spec: tapers")
    if hinges:
        tags.add("spec: releases")
    if offset_beams:
        tags.add("spec: offsets")
    if columns:
        tags.add("spec: columns")
    count = len(beams)
    cells = [{"type": "line", "data": beams}]
    data = {"section": [sections_of]}
    if columns:
        data["orientation"] = [orientation]
    if offset_beams:
        data |= {"offset_a": [offset_a], "offset_b": [offset_b]}
    if hinges:
        data |= {"release_a": [release_a], "release_b": [release_b]}
    if any(s is not None for s in section_b):
        data["section_b"] = [section_b]
    if cross:
        cells.append({"type": "line", "data": cross})
        data["kind"] = [["beam"] * count, ["truss"] * len(cross)]
        data["section"].append([2] * len(cross))
        for key in ("orientation", "offset_a", "offset_b", "release_a", "release_b", "section_b"):
            if key in data:
                data[key].append(None)
        tags.add("spec: trusses")
    has_mass = draw.yes(0.7)
    material = {"name": "steel", "E": units.modulus(STEEL["E"]), "G": units.modulus(STEEL["G"])}
    if has_mass:
        material["density"] = units.density(STEEL["density"])
    else:
        masses = []
    rail_height = draw.number(0.2, 1.0, 2) if draw.yes(0.6) else 0.0
    level = height + offset_beams + rail_height
    listed, seen = {}, []
    for row, (name, cells_of) in enumerate(segments.items()):
        z = (row - (rows - 1) / 2) * gauge + (0.6 if bracket else 0)
        offset = {"offset": [0, units.length(rail_height), 0]} if rail_height else {}
        listed[name] = {
            "origin": [0, units.length(level), units.length(z)], "axis": [1, 0, 0],
            "segments": [{"cell": [0, cell], **offset} for cell in cells_of],
            "stations": stations(draw, 0, units.length(bays * bay), 4, 6),
        }
        seen.append(Rail(name, 0.0, bays * bay, z, level))
    spec = {"format": "girderway-beam/1", "units": units.names, **theory(draw), "up": [0, 1, 0], "points": points,
            "cells": cells, "cell_data": data, "materials": [material], "sections": sections, "supports": supports,
            "rails": listed}
    for key, value in (("springs", springs), ("links", links), ("masses", masses), ("effects", effects), ("point_sets", sets)):
        if value:
            spec[key] = value
    if any(s is not None for s in section_b):
        spec["parts"] = draw.randint(1, 8)
    if rows > 1:
        tags.add("spec: several rails")
    if effects:
        tags.add("spec: effects")
    return Structure(spec, seen, bay, has_mass, False, True, True, stresses, spans=bays, tags=tags)


def carried(draw, units, weight, length, gauge):
    """The two girders of a bridge crane, along z of the bridge, `gauge` apart along its x, `length` long."""
    iz = weight * length**2 * draw.size(500, 3000) / (48 * STEEL["E"])
    area = 1.5 * iz**0.5
    half, side = length / 2, gauge / 2
    corners = [[-side, -half], [-side, half], [side, -half], [side, half]]
    points = [[units.length(x), 0, units.length(z)] for x, z in corners]
    material = {"name": "steel", "E": units.modulus(STEEL["E"]), "G": units.modulus(STEEL["G"])}
    has_mass = draw.yes(0.7)
    if has_mass:
        material["density"] = units.density(STEEL["density"])
    section = {"name": "box", "material": "steel", "A": units.area(area), "Iy": units.second_moment(iz * 0.4),
               "Iz": units.second_moment(iz), "J": units.second_moment(iz * 0.6)}
    stresses = draw.yes(0.3)
    if stresses:
        section["points"] = [{"name": "bottom flange", "y": units.length(-(iz**0.25)), "detail": 112}]
    rails = {}
    for index, name in enumerate(["east", "west"]):
        rails[name] = {
            "origin": [units.length((2 * index - 1) * side), units.length(0.5), units.length(-half)], "axis": [0, 0, 1],
            "segments": [{"cell": [0, index], "offset": [0, units.length(0.5), 0]}],
            "stations": stations(draw, 0, 2 * units.length(half), 4, 6),
        }
    first = ["ux", "uy", "uz", "rz"]
    spec = {"format": "girderway-beam/1", "units": units.names, "up": [0, 1, 0], "points": points,
            "cells": [{"type": "line", "data": [[0, 1], [2, 3]]}], "cell_data": {"orientation": [[[0, 1, 0], [0, 1, 0]]]},
            "materials": [material], "sections": [section],
            "supports": [{"point": i, "fix": first if i % 2 == 0 else ["ux", "uy", "rz"]} for i in range(4)],
            "effects": [{"name": "east mid", "cell": [0, 0], "at": 0.5}], "rails": rails}
    seen = [Rail("east", 0.0, length, side, 0.5), Rail("west", 0.0, length, -side, 0.5)]
    return Structure(spec, seen, length, has_mass, False, True, True, stresses, along="z", tags={"spec: general form"})
