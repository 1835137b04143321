#!/usr/bin/env python3
"""Compare what the first page of random runs says with their histories at a fiftieth of the interval.

Each scene is drawn by rule: runways of 1 to 80 spans and halls of 4 to 16 bays, round and odd dimensions, 1 to 16 wheels, one
crossing or many trips, braking, lateral forces between flanges, steps and dips of the rail, quasi-static runs, foundations
without mass, of rigid parts, on ties and by natural modes. It is run once. Sections and gauges are then placed where the
summary says that its extremes are, and along the spans of chords, and the scene is run again with rows at a fiftieth of the
interval. Damage of details is counted again from the stresses in these rows, by a count of this script. Of every peak, extreme,
reaction, deflection of a chord and damage two differences are taken, relative to the largest value of its kind: by how much the history exceeds the page, which must not be more than the
accuracy of the scene, and by how much the page exceeds the history, which is what its rows miss: beside a step of the rail a
force of a damper lasts less than a row.

Values that a run says are not determined (`undetermined`) are left out.

    python3 tests/extremes/page_one.py target/release/girderway --scenes 300 --seed 1 --jobs 2
"""

import argparse
import csv
import json
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

# Scenes that take longer are left out, and counted, s.
LONGEST = 90
# Largest number of rows of a history.
ROWS = 40_000


def spec(draw):
    """A girder on supports with random spans and the properties of a rolled section."""
    count = draw.choice([1, 1, 2, 2, 3, 3, 4, 5, 8, 20, 80])
    odd = draw.random() < 0.5
    length = lambda: draw.uniform(4, 12) if odd else float(draw.randint(4, 12))
    spans = [length()] * count if draw.random() < 0.4 else [length() for _ in range(count)]
    spans = [round(span, 3) for span in spans]
    scale = (max(spans) / 8) ** 3
    girder = {
        "spans": spans,
        "E": 2.1e8,
        "G": 8.1e7,
        "A": 0.02,
        "I_vertical": 6e-4 * scale * draw.uniform(0.7, 3),
        "I_lateral": 1e-4 * scale * draw.uniform(0.7, 3),
        "J": 4e-6,
        "rail_height": draw.choice([0.0, 0.35]),
        "mass_per_length": 0.16,
    }
    if draw.random() < 0.5:
        girder |= {"kA_vertical": 0.0051, "kA_lateral": 0.012}
    if draw.random() < 0.3:
        girder["overhangs"] = [0.8, 1.1]
    units = {"length": "m", "force": "kN", "time": "s"}
    return {"format": "girderway-beam/1", "name": "g", "units": units, "girder": girder}


def hall(draw):
    """A hall: frames with columns and roof beams, girders on brackets, and ties along the eaves."""
    bays = draw.choice([4, 4, 6, 8, 16])
    odd = draw.random() < 0.5
    length = lambda: round(draw.uniform(5, 9), 3) if odd else float(draw.randint(5, 9))
    lengths = [length()] * bays if draw.random() < 0.5 else [length() for _ in range(bays)]
    places = [0.0]
    for own in lengths:
        places.append(places[-1] + own)
    points, cells, of, supports = [], [], [], []

    def member(a, b, section):
        cells.append([a, b])
        of.append(section)
        return len(cells) - 1

    frames = []
    for x in places:
        sides = []
        for sign in (-1, 1):
            first = len(points)
            points.extend([[x, 0, 12 * sign], [x, 10, 12 * sign], [x, 10, 11.4 * sign], [x, 13, 12 * sign]])
            supports.append({"point": first, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"]})
            member(first, first + 1, 0)
            member(first + 1, first + 3, 0)
            member(first + 1, first + 2, 1)
            sides.append(first)
        member(sides[0] + 3, sides[1] + 3, 2)
        frames.append(sides)
    rails = {"north": [], "south": []}
    for before, behind in zip(frames, frames[1:]):
        for side, rail in enumerate(rails):
            rails[rail].append(member(before[side] + 2, behind[side] + 2, 3))
            member(before[side] + 3, behind[side] + 3, 4)
            member(before[side] + 1, behind[side] + 1, 4)
    stiff = draw.uniform(0.7, 2)
    section = lambda name, a, iy, iz, j: {
        "name": name, "material": "steel", "A": a, "Iy": stiff * iy, "Iz": stiff * iz, "J": j, "Asy": 0.4 * a, "Asz": 0.5 * a}
    sections = [section("column", 0.03, 2e-4, 1.2e-3, 6e-6), section("bracket", 0.02, 1e-4, 8e-4, 5e-6),
                section("roof", 0.02, 1e-4, 9e-4, 3e-6), section("girder", 0.03, 2.5e-4, 2.4e-3, 8e-6),
                section("tie", 0.006, 2e-5, 6e-5, 1e-6)]
    sections[3]["points"] = [{"name": "bottom", "y": -0.4, "detail": 36}, {"name": "top", "y": 0.4, "z": 0.15, "detail": 36}]
    # local y is up, and across the hall in columns
    ends = [[points[at] for at in cell] for cell in cells]
    orientation = [[0, 0, 1] if a[0] == b[0] and a[2] == b[2] else [0, 1, 0] for a, b in ends]
    stations = [places[-1] * k / 8 for k in range(1, 8)]
    beam = {
        "format": "girderway-beam/1", "name": "hall", "units": {"length": "m", "force": "kN", "time": "s"}, "up": [0, 1, 0],
        "theory": "timoshenko", "points": points, "cells": [{"type": "line", "data": cells}],
        "cell_data": {"kind": [["beam"] * len(cells)], "section": [of], "orientation": [orientation]},
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.85}], "sections": sections, "supports": supports,
        "rails": {rail: {"origin": [0, 10, 0], "axis": [1, 0, 0], "stations": stations, "segments": [{"cell": [0, k], "offset": [0, 0.6, 0]} for k in own]}
                  for rail, own in rails.items()},
    }
    # two sections with details in the middle of girders
    beam["effects"] = [{"name": f"w{side}", "cell": [0, own[draw.randrange(bays)]], "at": draw.choice([0.5, 0.37])}
                       for side, own in enumerate(rails.values())]
    return beam, places, rails


def hall_scene(draw):
    """A bridge crane in a hall."""
    beam, places, rails = hall(draw)
    kind = draw.choice(["plain", "lateral", "quasi-static"])
    base = draw.uniform(2, 4)
    wheel = {"radius": 0.4, "vertical": {"k": 1e6, "c": draw.choice([500, 1000, 3000])}}
    dof = ["x", "y", "roll", "pitch"]
    if kind != "quasi-static":
        wheel["lateral"] = {"k": 5e5, "clearance": 0.005}
        dof = ["x", "y", "z", "roll", "yaw", "pitch"]
    first, last = base / 2 + 0.1, places[-1] - base / 2 - 0.1
    points, end = speeds(draw, first, last, draw.choice([1.0, 2.0]), 3)
    tree = draw.choice([[-base / 2, base / 2], [-base / 2, 0.6 - base / 2, base / 2 - 0.6, base / 2]])
    tree = [round(place, 3) for place in tree]
    trucks = [{"name": name, "body": "crane", "rail": f"g.{rail}", "at": [0, 0, side * 11.4], "tree": tree, "wheel": "w"}
              for name, rail, side in (("N", "north", -1), ("S", "south", 1))]
    out = {
        "format": "girderway-scene/1", "name": "hall", "units": beam["units"], "gravity": 9.81,
        "structures": {"g": {"spec": "g.json", "foundation": "influence"}},
        "bodies": {"crane": {"weight": draw.uniform(200, 600), "inertia": [4000, 4500, 250], "cg": [0, 0.5, 0], "x0": first,
                             "dof": dof, "track": ["g.north", "g.south"]}},
        "wheels": {"w": wheel}, "trucks": trucks,
        "motions": [{"body": "crane", "dof": "x", "kind": "prescribed", "speed": points}],
        "end": {"time": end}, "accuracy": draw.choice([1e-3, 1e-4]),
        "output": {"dt": draw.choice([0.02, 0.05]), "reactions": True, "stresses": True},
    }
    if kind == "lateral":
        t = [end * k / 6 for k in range(7)]
        out["loads"] = [{"body": "crane", "dof": "z", "value": [[time, draw.uniform(-20, 20)] for time in t]}]
    if kind == "quasi-static":
        out["analysis"] = "quasi-static"
    return beam, out, f"hall, {kind}"


def speeds(draw, first, last, speed, most):
    """The speed over time of one crossing, or of several trips, and the end of the run."""
    reach = last - first
    ramp = draw.uniform(0.5, 2)
    speed = min(speed, reach / (ramp + 0.2))
    cruise = reach / speed - ramp
    trips = min(draw.choice([1, 1, 1, 2, 5, 20]), most)
    points, t, sign = [[0, 0]], 0.0, 1
    for _ in range(trips):
        points += [[t + ramp, sign * speed], [t + ramp + cruise, sign * speed]]
        t += 2 * ramp + cruise
        points += [[t, 0], [t + 0.5, 0]]
        t += 0.5
        sign = -sign
    return points, t


def scene(draw):
    """A scene on a girder, or in a hall."""
    if draw.random() < 0.2:
        return hall_scene(draw)
    beam = spec(draw)
    length = sum(beam["girder"]["spans"])
    wheels = draw.choice([1, 2, 2, 2, 4, 4, 8, 16])
    base = min(draw.uniform(1, 4), 0.4 * length)
    half = base / 2 if wheels > 1 else 0.0
    places = [base * (k / (wheels - 1) - 0.5) for k in range(wheels)] if wheels > 1 else [0.0]
    places = [round(place, 3) for place in places]
    kind = draw.choice(["plain", "plain", "lateral", "yaw", "step", "dip", "quasi-static"])
    is_lateral = kind in ("lateral", "yaw")
    weight = draw.uniform(50, 400)
    wheel = {"radius": 0.3, "vertical": {"k": draw.choice([1e5, 3e5, 1e6])}}
    wheel["vertical"]["c"] = draw.choice([0.5, 2, 5]) * wheel["vertical"]["k"] / 1000
    dof = ["y"] + (["pitch"] if wheels > 1 else [])
    if is_lateral:
        wheel["lateral"] = {"k": draw.choice([1e4, 1e5, 1e6]), "clearance": draw.choice([0.0, 0.004])}
        dof += ["z"] + (["yaw"] if kind == "yaw" and wheels > 1 else [])
    first, last = half + 0.05, length - half - 0.05
    speed = draw.choice([0.5, 1.5, 2.5, 6.0])
    points, end = speeds(draw, first, last, speed, 20 if wheels <= 2 else 2)
    structure = {"spec": "g.json", "foundation": "influence"}
    if kind != "quasi-static" and len(beam["girder"]["spans"]) <= 5 and draw.random() < 0.3:
        structure = {"spec": "g.json", "foundation": "modal", "modes": draw.randint(3, 8), "damping": 0.01}
    truck = {"name": "T", "body": "b", "rail": "g.rail", "wheel": "w", "tree": places}
    if wheels == 1:
        truck["tree"] = [0]
    out = {
        "format": "girderway-scene/1",
        "name": "drawn",
        "units": beam["units"],
        "gravity": 9.81,
        "structures": {"g": structure},
        "bodies": {
            "b": {"weight": weight, "inertia": [weight / 5] * 3, "cg": [0, 0.4, 0], "dof": dof, "x0": first}
        },
        "wheels": {"w": wheel},
        "trucks": [truck],
        "motions": [{"body": "b", "dof": "x", "kind": "prescribed", "speed": points}],
        "end": {"time": min(end, 400.0)},
        "accuracy": draw.choice([1e-3, 1e-3, 1e-4, 1e-4, 1e-5 if wheels <= 2 else 1e-3]),
        "output": {"dt": draw.choice([0.02, 0.05, 0.11]), "reactions": True},
    }
    if is_lateral:
        t = [end * k / 6 for k in range(7)]
        load = [[time, draw.uniform(-0.1, 0.1) * weight] for time in t]
        out["loads"] = [{"body": "b", "dof": "z", "value": load}]
    at = draw.uniform(0.3, 0.7) * length
    if kind == "step":
        height = draw.choice([-0.002, 0.001, 0.002])
        structure["irregularities"] = [{"kind": "step", "x": at, "height": height}]
    if kind == "dip":
        structure["irregularities"] = [{"kind": "dip", "x": at, "length": 0.4, "depth": 0.003}]
    if kind == "quasi-static":
        out["analysis"] = "quasi-static"
    if kind == "plain" and structure["foundation"] == "influence" and draw.random() < 0.4:
        kind = draw.choice(["parts", "ties"] if length < 300 else ["parts"])
        if kind == "parts":
            structure |= {"foundation": "parts", "count": len(beam["girder"]["spans"]) + 1}
        else:
            rail = {"E": 2.1e8, "I_vertical": 3.0e-5, "mass_per_length": 0.06}
            structure |= {"foundation": "ties", "damping": 0.02, "ties": {"spacing": 0.6, "k": 4e4, "mass": 0.1, "rail": rail}}
    return beam, out, kind


def run(program, folder, beam, drawn, out):
    (folder / "g.json").write_text(json.dumps(beam))
    (folder / "scene.json").write_text(json.dumps(drawn))
    done = subprocess.run(
        [program, "run", "scene.json", "-o", out], cwd=folder, capture_output=True, text=True, timeout=LONGEST
    )
    summary = folder / out / "summary.json"
    if not summary.exists():
        raise RuntimeError(done.stderr.strip()[-400:])
    return json.loads(summary.read_text())


def history(path):
    with open(path) as lines:
        rows = csv.reader(lines)
        names = next(rows)
        values = [[float(value) for value in row] for row in rows]
    return {name: [row[k] for row in values] for k, name in enumerate(names)}


def effect(beam, ends, name, extreme):
    """The section of an extreme."""
    x = extreme["x"]
    if "girder" in beam:
        return {"name": name, "x": x}
    bay = max(k for k in range(len(ends) - 1) if ends[k] <= x)
    segment = beam["rails"][extreme["rail"].split(".")[1]]["segments"][bay]
    return {"name": name, "cell": segment["cell"], "at": (x - ends[bay]) / (ends[bay + 1] - ends[bay])}


COLUMN = {
    ("moment", "vertical"): ("Mz", 1),
    ("shear", "vertical"): ("Vy", 1),
    ("moment", "lateral"): ("My", 1),
    ("shear", "lateral"): ("Vz", 1),
}


def ranges(values):
    """The ranges of stress of a history and their numbers of cycles, by rainflow; what is left counts as half cycles."""
    turns = []
    for value in values:
        if len(turns) > 1 and (value - turns[-1]) * (turns[-1] - turns[-2]) >= 0:
            turns[-1] = value
        elif not turns or value != turns[-1]:
            turns.append(value)
    stack, out = [], []
    for value in turns:
        stack.append(value)
        while len(stack) >= 3:
            last, before = abs(stack[-1] - stack[-2]), abs(stack[-2] - stack[-3])
            if last < before:
                break
            if len(stack) == 3:
                out.append((before, 0.5))
                del stack[0]
            else:
                out.append((before, 1.0))
                del stack[-3:-1]
    out += [(abs(b - a), 0.5) for a, b in zip(stack, stack[1:])]
    return out


def damage(values, detail):
    """Miner's sum of EN 1993-1-9 for a history in N/mm2: slopes of 3 and 5, no damage below the cut-off at 100 million."""
    knee = detail * (2 / 5) ** (1 / 3)
    cut = knee * (5 / 100) ** (1 / 5)
    total = 0.0
    for size, count in ranges(values):
        if size > cut:
            power = 3 if size >= knee else 5
            total += count / (5e6 * (knee / size) ** power)
    return total


def compare(program, seed):
    """The differences of one scene: quantity, excess of the history, excess of the page, both relative to their kind."""
    draw = random.Random(seed)
    beam, drawn, kind = scene(draw)
    found = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        first = run(program, folder, beam, drawn, "first")
        if first["status"] != "done" or first.get("undetermined"):
            return kind, drawn["accuracy"], first["status"], found
        extremes = first.get("extremes", [])
        is_hall = "girder" not in beam
        ends = sorted({point[0] for point in beam["points"]}) if is_hall else [0.0]
        for span in [] if is_hall else beam["girder"]["spans"]:
            ends.append(ends[-1] + span)
        # at a support a column has the force of one side
        is_inside = lambda e: (e["quantity"] == "moment" and not is_hall) or all(abs(e["x"] - end) > 0.01 for end in ends)
        forces = [e for e in extremes if (e["quantity"], e.get("plane")) in COLUMN and is_inside(e)]
        if kind == "ties":
            # the page has the forces of the rail on the ties, and sections are those of the girder below
            forces = []
        draw.shuffle(forces)
        forces = sorted(forces, key=lambda e: -abs(e["value"]))[:6] + forces[:6]
        moved = [e for e in extremes if e["quantity"] == "deflection"]
        draw.shuffle(moved)
        moved = moved[:6]
        watched = beam.get("effects", [])
        beam = dict(beam, effects=watched + [effect(beam, ends, f"e{k}", e) for k, e in enumerate(forces)])
        on_rail = lambda e: {"rail": e["rail"].split(".")[1]} if is_hall else {}
        gauges = {f"d{k}": {"x": e["x"], "direction": e["plane"], **on_rail(e)} for k, e in enumerate(moved)}
        chords = first.get("deflection_ratios", [])
        draw.shuffle(chords)
        chords = chords[:4]
        for k, chord in enumerate(chords):
            # where it is largest, and elsewhere on the span
            chord["places"] = [chord["x"]] + [chord["from"] + n / 10 * (chord["to"] - chord["from"]) for n in range(11)]
            for n, x in enumerate(chord["places"]):
                gauges[f"c{k}_{n}"] = {"x": x, "direction": chord["direction"], **on_rail(chord)}
        structure = dict(drawn["structures"]["g"], gauges=gauges)
        fine = dict(drawn, structures={"g": structure})
        rows = min(drawn["end"]["time"] / drawn["output"]["dt"] * 50, ROWS)
        supports = [column for column in first["peaks"] if ".support" in column]
        draw.shuffle(supports)
        fine["output"] = {"dt": drawn["end"]["time"] / rows, "reactions": supports[:6], "sections": True, "stresses": True}
        run(program, folder, beam, fine, "fine")
        table = history(folder / "fine" / "history.csv")

    def add(what, size, page, values, is_max):
        # what is smaller is rounding
        if size <= 1e-12:
            return
        sign = 1 if is_max else -1
        best = max(sign * value for value in values)
        found.append((what, (best - sign * page) / size, (sign * page - best) / size))

    of_kind = {}
    for e in extremes:
        key = (e["quantity"], e.get("plane"))
        of_kind[key] = max(of_kind.get(key, 0.0), abs(e["value"]))
    for k, e in enumerate(forces):
        word, sign = COLUMN[(e["quantity"], e["plane"])]
        column = table.get(f"g.e{k}.{word}")
        if column:
            values = column
            # the sign of a column is that of the member; that of a moment and a shear by the side they name
            size = of_kind[(e["quantity"], e["plane"])]
            by_sign = [[s * value for value in values] for s in (1, -1)]
            near = min(by_sign, key=lambda own: abs(max((1 if e["kind"] == "max" else -1) * v for v in own) - abs(e["value"])))
            add(f"{e['plane']} {e['quantity']}", size, e["value"], near, e["kind"] == "max")
    for k, e in enumerate(moved):
        column = table.get(f"g.d{k}")
        if column:
            size = of_kind[("deflection", e["plane"])]
            add(f"{e['plane']} deflection", size, e["value"], column, e["kind"] == "max")
    for k, chord in enumerate(chords):
        own = [table.get(f"g.c{k}_{n}") for n in range(len(chord["places"]))]
        # what is smaller is rounding, as of a span of one rigid part
        is_seen = chord["deflection"] > 1e-9 * (chord["to"] - chord["from"])
        if is_seen and all(own) and chord["to"] > chord["from"]:
            trucks = [truck["name"] for truck in drawn["trucks"] if truck["rail"] == chord["rail"]]
            wheels = [column for name, column in table.items() if name.split(".")[0] in trucks and name.endswith(".x")]
            # with a wheel on the span
            on = [any(chord["from"] < x < chord["to"] for x in row) for row in zip(*wheels)]
            best = [0.0]
            for x, moved_there in zip(chord["places"], own):
                share = (x - chord["from"]) / (chord["to"] - chord["from"])
                values = [u - (1 - share) * a - share * b for u, a, b in zip(moved_there, own[1], own[-1])]
                # vertical deflections count downwards
                if chord["direction"] == "lateral":
                    values = [abs(value) for value in values]
                best.append(max((value for value, is_on in zip(values, on) if is_on), default=0.0))
            add("chord", chord["deflection"], chord["deflection"], best, True)
    for column, own in first.get("fatigue", {}).items():
        if column in table:
            # kN/m2 to N/mm2
            again = damage([value / 1000 for value in table[column]], own["detail"])
            add("damage", own["damage"], own["damage"], [again], True)
            add("largest range", own["largest_range"], own["largest_range"], [max(r for r, _ in ranges(table[column]))], True)
    sizes = {}
    for column, peak in first["peaks"].items():
        part = column.rsplit(".", 1)[1]
        size = max(abs(peak["max"]["value"]), abs(peak["min"]["value"]))
        sizes[part] = max(sizes.get(part, 0.0), size)
    for column, peak in first["peaks"].items():
        part = column.rsplit(".", 1)[1]
        kind_of = "reaction" if ".support" in column else part
        if column in table and part not in ("x",):
            for word, is_max in (("max", True), ("min", False)):
                add(kind_of, sizes[part], peak[word]["value"], table[column], is_max)
    return kind, drawn["accuracy"], "done", found


def one(program, seed):
    try:
        return compare(program, seed)
    except RuntimeError as error:
        return str(error)
    except subprocess.TimeoutExpired:
        return "", 1.0, "too long", []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    program = str(Path(args.program).resolve())
    seeds = [args.seed * 1_000_003 + k for k in range(args.scenes)]

    worst, wrong, left = {}, [], []
    with ProcessPoolExecutor(args.jobs) as pool:
        for seed, result in zip(seeds, pool.map(one, [program] * len(seeds), seeds)):
            if isinstance(result, str):
                wrong.append(f"{seed}: {result}")
                continue
            kind, accuracy, status, found = result
            print(f"{seed} {kind} {status} {len(found)}", file=sys.stderr, flush=True)
            if status != "done" or not found:
                left.append(seed)
            for what, above, missed in found:
                own = worst.setdefault(what, [0, 0.0, 0.0, 0.0, None])
                own[0] += 1
                if above / accuracy > own[1]:
                    own[1], own[4] = above / accuracy, seed
                own[2], own[3] = max(own[2], above), max(own[3], missed)
                if above > accuracy:
                    wrong.append(f"{seed} ({kind}): {what}, history {above:.1e} above the page")
    print(f"{len(seeds)} scenes, {len(left)} of them incomplete, not determined or too long")
    print("quantity | values | history above the page, in accuracies | relative | page above the history | seed")
    for what, own in sorted(worst.items()):
        print(f"{what} | {own[0]} | {own[1]:.2g} | {own[2]:.1e} | {own[3]:.1e} | {own[4]}")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
