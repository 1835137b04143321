"""Random scenes: trucks on girders and frames, wheels by themselves, ties, and bridge cranes."""

import specs
from case import significant, units as draw_units

GRAVITY = specs.GRAVITY


class Scene:
    """A scene while it is drawn, with the files beside it."""

    def __init__(self, draw, units):
        self.draw = draw
        self.units = units
        self.tags = set()
        self.files = {}
        self.wheels = {}
        self.json = {
            "format": "girderway-scene/1", "name": "drawn", "units": units.names, "gravity": units.length(GRAVITY),
            "structures": {}, "bodies": {}, "wheels": self.wheels, "trucks": [],
        }
        self.columns = []
        self.deck = True
        self.seconds = 1.0
        self.auto = False

    def effects(self, name):
        """Whether a structure's spec names sections for internal forces."""
        entry = self.json["structures"][name]
        return bool(self.files.get(entry.get("spec"), {}).get("effects"))

    def tag(self, *tags):
        self.tags.update(tags)

    def listed(self, key, entry):
        self.json.setdefault(key, []).append(entry)


def wheel(scene, name, weight, linear=False, damper=True, flange=None, friction=None, driven=False, braked=False, spin=False):
    """A kind of wheels that carries `weight` newtons with a few tenths of a millimetre of penetration."""
    draw, units = scene.draw, scene.units
    k = weight / draw.size(2e-4, 5e-3)
    rate = 2 * (k * weight / GRAVITY) ** 0.5
    radius = draw.number(0.2, 0.7, 3)
    vertical = {}
    law = "linear" if linear else draw.weighted(default=4, linear=3, impact=3)
    if law == "impact":
        exponent = draw.choice([None, 1.0, 1.1, 1.3, 1.5])
        power = exponent or 1.1
        depth = weight / k
        vertical |= {"law": "impact", "k": units.of(weight / depth**power, -power, 1)}
        if exponent:
            vertical["exponent"] = exponent
        scene.tag("wheel: impact")
    else:
        vertical |= {"k": units.stiffness(k)}
        if law == "linear":
            vertical["law"] = "linear"
        scene.tag("wheel: linear")
    if damper and draw.yes(0.7):
        vertical["c"] = units.stiffness(rate * draw.size(0.005, 0.3))
        if law == "impact":
            vertical["depth"] = units.length(weight / k * draw.number(0.1, 1))
        if draw.yes(0.3):
            vertical["damper"] = draw.choice(["rail", "ground"])
            scene.tag(f"wheel: damper {vertical['damper']}")
    if law != "impact" and draw.yes(0.12):
        vertical["bilateral"] = True
        scene.tag("wheel: bilateral")
    entry = {"radius": units.length(radius), "vertical": vertical}
    if flange if flange is not None else draw.yes(0.25):
        entry["lateral"] = {"k": units.stiffness(k * draw.number(0.1, 1))}
        if draw.yes(0.75):
            entry["lateral"]["clearance"] = units.length(draw.size(5e-4, 0.012))
        if draw.yes(0.5):
            entry["lateral"]["release"] = [units.length(radius), units.length(radius * 1.1)]
        scene.tag("wheel: flange")
    if friction if friction is not None else draw.yes(0.25):
        entry["friction"] = {"mu": draw.number(0.05, 0.4, 2), "slip": units.length(draw.size(0.01, 0.1))}
        if draw.yes(0.6):
            entry["friction"]["law"] = draw.choice(["step", "coulomb"])
        scene.tag("wheel: friction")
    if spin:
        entry["spin_inertia"] = units.inertia(weight / GRAVITY * 0.05 * radius**2)
        scene.tag("wheel: spin")
    if driven:
        entry["driven"] = True
    if braked:
        entry["braked"] = True
    scene.wheels[name] = entry
    return entry


def tree(draw, half):
    """Offsets of a truck's wheels within plus and minus `half`: fixed ones, and equalisers."""
    kind = draw.weighted(one=3, two=4, three=2, equaliser=2, nested=2, deep=1)
    h = half
    return {
        "one": [0], "two": [-h, h], "three": [-h, round(0.1 * h, 3), h], "equaliser": [[-h, h]],
        "nested": [[-h, -h / 2], [h / 2, h]], "deep": [[[-h, -h / 2], [h / 2, h]]],
    }[kind], kind


def scaled(value, units):
    """A tree in the units of the file."""
    return [scaled(v, units) for v in value] if isinstance(value, list) else units.length(value)


def count(value):
    return sum(count(v) for v in value) if isinstance(value, list) else 1


def points_of(value):
    """Number of places a body stands on: wheels and outermost equalisers of a truck."""
    return len(value)


def add_structure(scene, name, structure, on_file=None):
    """Puts a spec beside the scene, at times in other units than the scene's, and a member into `structures`."""
    file = on_file or f"{name}.json"
    scene.files[file] = structure.file(name)
    scene.tags |= structure.tags
    entry = {"spec": file}
    scene.json["structures"][name] = entry
    return entry


def foundation(scene, entry, structure, kinds=None, carried=False):
    """Draws how a structure carries its rails."""
    draw, units = scene.draw, scene.units
    weights = {"influence": 8, "rigid": 2, "default": 1}
    if structure.straight and len(structure.rails) == 1 and not carried:
        weights["parts"] = 3
    if structure.has_mass:
        weights |= {"modal": 4, "full": 3, "auto": 2}
    if carried:
        weights.pop("default")
        weights.pop("auto", None)
    if kinds:
        weights = {key: value for key, value in weights.items() if key in kinds}
    kind = draw.weighted(**weights)
    if kind != "default":
        entry["foundation"] = kind
    if kind in ("auto", "default") and structure.has_mass:
        scene.auto = True
        if draw.yes(0.9):
            entry["tolerance"] = draw.choice([0.02, 0.05, 0.1, 0.2])
        scene.seconds = min(scene.seconds, 0.5)
    if kind == "parts":
        if draw.yes(0.7):
            entry["count"] = draw.randint(2, 5)
        entry["handover"] = draw.choice(["blend", "per-part"])
        if draw.yes(0.4):
            entry["blend"] = units.length(structure.span * draw.number(0.2, 1))
        scene.tag(f"parts: {entry['handover']}")
    if kind == "modal" and draw.yes(0.8):
        entry["modes"] = draw.randint(1, 8)
    if kind == "full":
        entry["elements"] = draw.choice([1, 2, 3, 4])
    if kind in ("modal", "full", "auto") and draw.yes(0.6):
        entry["damping"] = draw.choice([0.005, 0.01, 0.05])
    if kind == "influence":
        reading = draw.weighted(none=5, exact=1, natural=2, akispl=2, cubspl=1)
        if reading != "none" and not (carried and reading != "exact"):
            entry["reading"] = reading
            scene.tag(f"reading: {reading}")
        elif draw.yes(0.15):
            entry["couplings"] = draw.choice(["all", "within rails", "none"])
            scene.tag("couplings")
    scene.tag(f"foundation: {kind}")
    if draw.yes(0.2) and not carried:
        rail = draw.choice(structure.rails)
        gauge = {"x": units.length(draw.uniform(rail.first, rail.last))}
        if len(structure.rails) > 1:
            gauge["rail"] = rail.name
        if structure.lateral and draw.yes(0.3):
            gauge["direction"] = "lateral"
        entry["gauges"] = {"probe": gauge}
        scene.tag("gauges")
    return kind


def irregularities(scene, entry, structure, flanged):
    """Uneven rails."""
    draw, units = scene.draw, scene.units
    listed = []
    for _ in range(draw.randint(1, 3)):
        rail = draw.choice(structure.rails)
        span = rail.last - rail.first
        kind = draw.choice(["joint", "dip", "sinusoid", "profile", "file", "step"])
        item = {"kind": "profile" if kind == "file" else kind}
        x = draw.uniform(rail.first + 0.2 * span, rail.last - 0.2 * span)
        small = draw.size(2e-4, 3e-3)
        if kind in ("joint", "dip"):
            item |= {"x": units.length(x), "depth": units.length(small), "length": units.length(draw.number(0.3, 1.5))}
        elif kind == "step":
            item |= {"x": units.length(x), "height": units.length(small * 0.3)}
        elif kind == "sinusoid":
            item |= {"amplitude": units.length(small), "length": units.length(draw.number(1, 6))}
            if draw.yes(0.5):
                item["phase"] = draw.number(0, 6)
            if draw.yes(0.4):
                item["range"] = units.lengths([rail.first + 0.2 * span, rail.first + 0.7 * span])
        else:
            rows = [[rail.first + span * i / 7, draw.uniform(-1e-3, 1e-3)] for i in range(8)]
            if kind == "profile":
                item["rows"] = [[units.length(a), units.length(b)] for a, b in rows]
            else:
                scene.files["survey.csv"] = "x,level\n" + "".join(f"{units.length(a)},{units.length(b) * 1000}\n" for a, b in rows)
                item |= {"file": "survey.csv", "columns": ["x", "level"], "scale": 0.001}
        if flanged and draw.yes(0.3) and kind != "step":
            item["direction"] = "lateral"
        if len(structure.rails) > 1:
            item["rail"] = rail.name
        listed.append(item)
        scene.tag(f"irregularity: {kind}")
    entry["irregularities"] = listed
    scene.deck = False


def profile(draw, units, end, speed):
    """Rows [time, speed] that never exceed `speed` in size, in SI."""
    if draw.yes(0.5):
        return [[0, units.length(speed)]]
    knots = sorted({0.0, round(end * 0.4, 3), round(end * draw.uniform(0.5, 0.9), 3)})
    return [[t, units.length(speed * draw.choice([0.5, 1, 0.8] if i else [0, 0.3, 1]))] for i, t in enumerate(knots)]


def motion(scene, body, entry, low, high, kind):
    """A motion that keeps the body's wheels on their rail: its x stays between `low` and `high`."""
    draw, units = scene.draw, scene.units
    end = scene.seconds
    room = high - low
    speed = room / end * draw.number(0.3, 0.8)
    speed = min(speed, draw.size(0.5, 40))
    start = draw.uniform(low, high - speed * end)
    if draw.yes(0.25):
        start, speed = start + speed * end, -speed
    entry["x0"] = units.length(start)
    table = profile(draw, units, end, speed)
    given = {"body": body, "dof": "x", "kind": kind}
    if kind == "prescribed":
        form = draw.weighted(speed=5, position=2, acceleration=2)
        if form == "speed":
            given["speed"] = table
        elif form == "position":
            entry.pop("x0")
            given["position"] = [[0, units.length(start)], [end, units.length(start + speed * end)]]
        else:
            given["acceleration"] = [[0, units.length(speed / end)], [end * 0.6, units.length(-speed / end)]]
            if draw.yes(0.5):
                entry["v0"] = units.length(speed * 0.3)
        scene.tag(f"motion: {form}")
    elif kind == "drive":
        weight = entry["_weight"]
        given |= {"speed": table, "gain": units.stiffness(weight / GRAVITY * draw.size(2, 30))}
        if draw.yes(0.5):
            given["max_force"] = units.force(weight * draw.number(0.02, 0.3))
        if draw.yes(0.5):
            entry["v0"] = units.length(speed * 0.7)
        scene.tag("motion: drive")
    else:
        entry["v0"] = units.length(speed)
        scene.tag("motion: free")
    scene.listed("motions", given)
    return given


def suits_collocation(scene):
    """Whether the steppers that need prescribed places and linear vertical contacts can take the scene."""
    plain = all(
        "friction" not in kind and "lateral" not in kind and kind["vertical"].get("law") != "impact" for kind in scene.wheels.values()
    )
    carriers = {entry.get("foundation") for entry in scene.json["structures"].values()}
    uneven = any("irregularities" in entry for entry in scene.json["structures"].values())
    return plain and not uneven and scene.prescribed and carriers <= {"influence", "modal", "rigid", "ties"} and not scene.json.get("stops")


def closing(scene, options=True):
    """End, output, accuracy, stepper, comparisons."""
    draw, scene_json = scene.draw, scene.json
    end = significant(scene.seconds, 3)
    scene_json["end"] = {"time": end}
    scene_json["output"] = {"dt": significant(end / draw.choice([20, 40, 60, 100]), 3)}
    accuracy = draw.choice([None, 1e-3, 1e-4, 1e-4, 1e-5])
    if accuracy:
        scene_json["accuracy"] = accuracy
    if options and draw.yes(0.6 if suits_collocation(scene) else 0.2):
        stepper = draw.choice(["sdirk4", "auto"])
        if suits_collocation(scene) or draw.yes(0.1):
            stepper = draw.weighted(radau=3, gauss2=2, gauss3=2, series=3, auto=1, sdirk4=1)
            if stepper in ("gauss2", "gauss3", "series"):
                for kind in scene.wheels.values():
                    kind["vertical"].pop("c", None)
                    kind["vertical"].pop("damper", None)
        scene_json["stepper"] = stepper
        if stepper.startswith("gauss") or (stepper != "series" and draw.yes(0.2)):
            scene_json["step"] = significant(end / draw.choice([100, 200]), 2)
        scene.tag(f"stepper: {stepper}")
    for body in scene_json["bodies"].values():
        body.pop("_weight", None)


def outputs(scene, structures, stressed):
    """Which reactions, internal forces and stresses the history has; fatigue; own weight."""
    draw, out = scene.draw, scene.json["output"]
    if draw.yes(0.3):
        out["reactions"] = draw.choice([True, False, structures[:1]])
        scene.tag("output: reactions")
    if draw.yes(0.15):
        named = [name for name in structures if scene.effects(name)]
        out["sections"] = draw.choice([False, named[-1:]])
        scene.tag("output: sections")
    if draw.yes(0.2):
        out["dead_load"] = True
        scene.tag("output: dead_load")
    if stressed:
        out["stresses"] = True
        scene.tag("output: stresses")
        if draw.yes(0.8):
            out["fatigue"] = {"gamma_Mf": draw.choice([1, 1.15, 1.35])}
            if draw.yes(0.5):
                out["fatigue"]["history"] = draw.choice(["once", "repeated"])
            if draw.yes(0.5):
                out["fatigue"]["crossings"] = 2e5
            scene.tag("output: fatigue")


def comparisons(scene, names, straight=False):
    """Runs of the same scene beside it."""
    draw = scene.draw
    listed = []
    for label, change in (
        ("rigid", {"structures": {name: {"foundation": "rigid", "reading": None, "couplings": None} for name in names}}),
        ("influence", {"structures": {name: {"foundation": "influence"} for name in names}}),
        ("finer", {"accuracy": 1e-6}),
        ("light", {"gravity": scene.json["gravity"] / 2}),
        ("quasi static", {"analysis": "quasi-static", "stepper": None, "step": None}),
    ):
        if draw.yes(0.35):
            listed.append({"label": label, **change})
    if any(item["label"] == "quasi static" for item in listed) and not scene.prescribed:
        listed = [item for item in listed if item["label"] != "quasi static"]
    if listed:
        scene.json["compare"] = listed
        scene.tag("compare")


def trucks(draw):
    """Bodies on the rails of one structure: prescribed, driven or free, with trucks, events, stops and loads."""
    units = draw_units(draw)
    scene = Scene(draw, units)
    weight = draw.size(2e4, 3e6)
    spec_units = units if draw.yes(0.7) else draw_units(draw)
    structure = specs.short(draw, spec_units, weight) if draw.yes(0.6) else specs.frame(draw, spec_units, weight, rails=1)
    name = draw.choice(["girder", "track way", "bridge-1"])
    entry = add_structure(scene, name, structure)
    rail = structure.rails[0]
    several = draw.yes(0.2)
    scene.seconds = draw.choice([0.3, 0.5, 0.8, 1.2])
    quasi = draw.yes(0.12)
    kind = foundation(scene, entry, structure)
    kinds = ["prescribed"] if quasi else (["drive", "free", "prescribed"] if draw.yes(0.4) else ["prescribed"])
    if quasi:
        scene.json["analysis"] = "quasi-static"
        scene.tag("analysis: quasi-static")
    scene.prescribed = True
    span = rail.last - rail.first
    slots = [(rail.first, rail.last)]
    if several:
        slots = [(rail.first, rail.first + 0.48 * span), (rail.first + 0.52 * span, rail.last)]
        scene.tag("several bodies")
    flanged = any_friction = False
    moves = []
    for number, (low, high) in enumerate(slots):
        body = ["bogie", "car"][number]
        how = draw.choice(kinds)
        lateral = structure.lateral and kind != "parts" and not quasi and draw.yes(0.25)
        drive_wheels = how == "drive" and draw.yes(0.7)
        brake = how in ("drive", "free") and draw.yes(0.5)
        spin = how == "free" and draw.yes(0.3) and not brake
        half = min(draw.number(0.3, 1.5, 3), 0.15 * (high - low))
        count_trucks = draw.choice([1, 1, 2])
        spread = 0.12 * (high - low) if count_trucks == 2 else 0.0
        mass = weight / len(slots)
        offsets, kind_tree = tree(draw, half)
        stands = points_of(offsets) * count_trucks
        entry_body = {"_weight": mass}
        if draw.yes(0.5):
            entry_body["weight"] = units.force(mass)
        else:
            entry_body["mass"] = units.mass(mass / GRAVITY)
        freedoms = ["y"]
        if stands > 1 and draw.yes(0.85):
            freedoms.append("pitch")
        inertia = mass / GRAVITY * (half + spread + 0.3) ** 2
        if "pitch" in freedoms or draw.yes(0.3):
            entry_body["inertia"] = [0, 0, units.inertia(inertia)]
        if lateral:
            freedoms.append("z")
        if how != "prescribed" or draw.yes(0.4):
            freedoms.insert(0, "x")
        if draw.yes(0.25):
            entry_body["cg"] = units.lengths([draw.number(-0.2, 0.2, 2), draw.number(0, 1, 2), 0])
        entry_body["dof"] = freedoms
        if draw.yes(0.15) and not quasi:
            entry_body["start"] = {"y": units.length(draw.number(-0.002, 0.004))}
            scene.tag("body: start")
        scene.json["bodies"][body] = entry_body
        wheel_name = f"kind {number}"
        touches = count(offsets) * count_trucks
        friction = how != "prescribed" and (brake or spin or draw.yes(0.6)) or draw.yes(0.1)
        wheel(scene, wheel_name, mass / touches, flange=lateral or draw.yes(0.1) and structure.lateral and kind != "parts",
              friction=friction, driven=drive_wheels, braked=brake, spin=spin)
        flanged = flanged or "lateral" in scene.wheels[wheel_name]
        any_friction = any_friction or friction
        for t in range(count_trucks):
            truck = {"wheel": wheel_name, "tree": scaled(offsets, units)}
            if several or draw.yes(0.5):
                truck["body"] = body
            truck["rail"] = f"{name}.{rail.name}"
            if draw.yes(0.6):
                truck["name"] = f"{body} T{t + 1}"
            if spread:
                truck["at"] = units.lengths([(2 * t - 1) * spread, 0, 0])
            scene.listed("trucks", truck)
            moves.append((body, truck.get("name", f"{body}.truck{t + 1}"), t))
        scene.tag(f"tree: {kind_tree}")
        reach = half + spread + 0.02 * (high - low)
        given = motion(scene, body, entry_body, low + reach, high - reach, how)
        if how != "prescribed":
            scene.prescribed = False
            if brake and draw.yes(0.5):
                given["brake"] = significant(scene.seconds * draw.uniform(0.2, 0.8), 3)
                scene.tag("brake: at a time")
            elif brake:
                scene.listed("events", {"when": f"time >= {significant(scene.seconds * 0.4, 2)}", "do": {"brake": body}})
                scene.tag("event: brake")
            if brake and "brake" in given and draw.yes(0.5):
                late = significant(given["brake"] + 0.3 * (scene.seconds - given["brake"]), 4)
                scene.listed("events", {"name": f"{body} goes on", "when": f"time >= {late}", "do": {"release_brake": body}})
                scene.tag("event: release_brake")
            if how == "drive" and draw.yes(0.4):
                when = f"time > {significant(scene.seconds * 0.3, 2)}"
                do = draw.choice([{"drive_off": body}, {"drive": {"body": body, "speed": units.length(0.5)}}])
                scene.listed("events", {"name": f"{body} driver", "when": when, "do": do})
                scene.tag(f"event: {next(iter(do))}")
        if draw.yes(0.2) and not quasi:
            freedom = draw.choice([f for f in freedoms if f != "x" or how in ("free", "drive")])
            value = units.moment(mass * 0.05) if freedom == "pitch" else units.force(mass * 0.1)
            scene.listed("loads", {"body": body, "dof": freedom, "value": [[0, 0], [scene.seconds / 3, value], [scene.seconds, -value]]})
            scene.tag(f"load: {freedom}")
    if flanged or any_friction:
        scene.tag("tangential")
    if kind in ("influence", "full", "modal", "rigid") and structure.longitudinal and not scene.prescribed and "reading" not in entry and draw.yes(0.3):
        entry["longitudinal"] = True
        scene.deck = False
        scene.tag("longitudinal")
    if draw.yes(0.35):
        irregularities(scene, entry, structure, flanged)
    dynamic = not quasi
    if dynamic and draw.yes(0.15):
        first = moves[0]
        scene.listed("events", {"name": "lift off", "when": f"{first[1]}.wheel1.vertical <= 0", "do": {"end": True}})
        scene.tag("event: end")
    if dynamic and not scene.prescribed and draw.yes(0.35):
        stop = {"rail": f"{name}.{rail.name}", "x": units.length(rail.first + span * draw.uniform(0.7, 0.98)),
                "k": units.stiffness(weight / 0.05)}
        if draw.yes(0.5):
            stop |= {"c": units.stiffness(weight / GRAVITY * 5), "name": "end stop"}
        scene.listed("stops", stop)
        scene.tag("stop: rail")
    if dynamic and several and not scene.prescribed and draw.yes(0.5):
        scene.listed("stops", {"name": "buffer", "body": "bogie", "against": "car", "gap": units.length(span * 0.2),
                               "k": units.stiffness(weight / 0.05)})
        scene.tag("stop: buffer")
    if any(key in scene.json for key in ("events", "stops", "loads")) or "drive" in [m["kind"] for m in scene.json["motions"]]:
        scene.deck = False
    if kind in ("parts", "modal", "full", "auto", "default"):
        scene.deck = False
    closing(scene)
    if quasi:
        scene.json.pop("stepper", None)
        scene.json.pop("step", None)
    outputs(scene, [name], structure.stresses)
    if draw.yes(0.3):
        comparisons(scene, [name], structure.straight)
    scene.structure = structure
    return scene


def wagon(draw):
    """A carriage on two pinned bogies."""
    units = draw_units(draw)
    scene = Scene(draw, units)
    weight = draw.size(5e4, 1e6)
    structure = specs.short(draw, units, weight)
    entry = add_structure(scene, "track", structure)
    foundation(scene, entry, structure, kinds=["rigid", "influence", "modal", "full", "parts"])
    rail = structure.rails[0]
    span = rail.last - rail.first
    scene.seconds = draw.choice([0.2, 0.4])
    base = draw.number(0.12, 0.2, 2) * span
    half = min(0.06 * span, 1.0)
    mass = weight / GRAVITY
    freedoms = ["y", "pitch"]
    how = draw.choice(["prescribed", "prescribed", "free", "drive"])
    scene.prescribed = how == "prescribed"
    if how != "prescribed":
        freedoms.insert(0, "x")
    carriage = {"weight": units.force(weight), "inertia": [0, 0, units.inertia(mass * base**2)], "dof": freedoms, "_weight": weight}
    scene.json["bodies"]["carriage"] = carriage
    wheel(scene, "steel", weight / 4, flange=False, friction=False)
    for number, side in enumerate((-1, 1)):
        name = f"bogie {number + 1}"
        scene.json["bodies"][name] = {"weight": units.force(weight * 0.1), "inertia": [0, 0, units.inertia(mass * 0.1 * half**2)],
                                      "dof": ["pitch"], "pinned": {"to": "carriage", "at": units.lengths([side * base, 0, 0])}}
        scene.listed("trucks", {"name": f"T{number + 1}", "body": name, "rail": "track.rail", "tree": scaled([-half, half], units)})
    reach = base + half + 0.02 * span
    motion(scene, "carriage", carriage, rail.first + reach, rail.last - reach, how)
    if draw.yes(0.3):
        irregularities(scene, entry, structure, False)
    scene.tag("pinned body")
    scene.deck = False
    closing(scene)
    outputs(scene, ["track"], structure.stresses)
    if draw.yes(0.3):
        comparisons(scene, ["track"])
    scene.structure = structure
    return scene


def single_wheel(draw):
    """A hub with one wheel or two whose spins are free or prescribed."""
    units = draw_units(draw)
    scene = Scene(draw, units)
    weight = draw.size(1e4, 1e6)
    structure = specs.short(draw, units, weight)
    entry = add_structure(scene, "floor", structure)
    foundation(scene, entry, structure, kinds=["rigid", "influence", "modal", "full"])
    rail = structure.rails[0]
    span = rail.last - rail.first
    prescribed_spin = draw.yes(0.5)
    scene.seconds = draw.choice([0.3, 0.6])
    scene.prescribed = False
    wheel(scene, "roller", weight, friction=True, spin=True, flange=False)
    freedoms = ["x", "y"]
    body = {"weight": units.force(weight), "dof": freedoms, "x0": units.length(rail.first + span * 0.3)}
    two = draw.yes(0.3)
    half = min(0.5, span * 0.1)
    if two:
        freedoms.append("pitch")
        body["inertia"] = [0, 0, units.inertia(weight / GRAVITY * half**2)]
    speed = min(draw.number(0, 3), span * 0.3 / scene.seconds)
    if speed and draw.yes(0.8):
        body["v0"] = units.length(speed)
    scene.json["bodies"]["hub"] = body
    scene.listed("trucks", {"name": "axle", "rail": "floor.rail", "tree": scaled([-half, half], units) if two else [0]})
    if draw.yes(0.5):
        scene.listed("motions", {"body": "hub", "dof": "x", "kind": "free"})
    if prescribed_spin:
        radius = scene.wheels["roller"]["radius"] / units.metre
        form = draw.choice(["speed", "position", "acceleration"])
        turn = speed / radius
        tables = {"speed": [[0, 0], [scene.seconds, significant(-1.2 * turn)]],
                  "position": [[0, 0], [scene.seconds, significant(-turn * scene.seconds)]],
                  "acceleration": [[0, significant(-turn / scene.seconds)]]}
        given = {"dof": "spin", "kind": "prescribed", form: tables[form]}
        if two:
            given |= {"truck": "axle", "wheel": 2}
        scene.listed("motions", given)
        scene.tag(f"spin motion: {form}")
        scene.deck = False
    if draw.yes(0.2):
        irregularities(scene, entry, structure, False)
    if draw.yes(0.3):
        scene.listed("events", {"when": f"hub.x >= {units.length(rail.first + span * 0.31)}", "do": {"end": True}})
        scene.tag("event: end")
    closing(scene, options=False)
    outputs(scene, ["floor"], structure.stresses)
    if entry.get("foundation") in ("modal", "full"):
        scene.deck = False
    scene.structure = structure
    return scene


def ties(draw):
    """A truck on a rail over sprung ties, over the ground or a girder."""
    units = draw_units(draw)
    scene = Scene(draw, units)
    weight = draw.size(5e4, 5e5)
    scene.deck = False
    scene.seconds = draw.choice([0.1, 0.2])
    scene.prescribed = True
    spacing = draw.number(0.5, 0.8, 2)
    over_ground = draw.yes(0.6)
    with_mass = draw.yes(0.5)
    rail = {"E": units.modulus(2.1e11), "I_vertical": units.second_moment(draw.size(2e-5, 4e-5))}
    if with_mass:
        rail["mass_per_length"] = units.line_mass(60)
    tie = {"spacing": units.length(spacing), "k": units.stiffness(draw.size(1e7, 5e7)), "rail": rail}
    if with_mass and draw.yes(0.6):
        tie["mass"] = units.mass(draw.number(60, 300))
    lateral = draw.yes(0.3)
    if lateral:
        rail["I_lateral"] = units.second_moment(5e-6)
        tie["lateral_k"] = units.stiffness(2e7)
    if with_mass and draw.yes(0.25):
        tie["c"] = units.stiffness(3e4)
    entry = {"foundation": "ties", "ties": tie}
    if draw.yes(0.2):
        tie["first"] = units.length(spacing * 0.5)
    if over_ground:
        first, last = 0.0, spacing * draw.randint(10, 18)
        entry["range"] = units.lengths([first, last])
        scene.json["structures"]["track"] = entry
    else:
        structure = specs.short(draw, units, weight)
        first, last = structure.rails[0].first, structure.rails[0].last
        if last - first > 25:
            tie["spacing"] = units.length((last - first) / 25)
        entry |= add_structure(scene, "track", structure)
        scene.json["structures"]["track"] = entry
        scene.tag("ties: over a structure")
    if with_mass and draw.yes(0.5):
        entry["damping"] = 0.03
    if with_mass and draw.yes(0.5):
        entry["modes"] = draw.randint(5, 20)
    scene.tag("foundation: ties")
    half = min(1.0, (last - first) * 0.1)
    body = {"weight": units.force(weight), "inertia": [0, 0, units.inertia(weight / GRAVITY * half**2)], "dof": ["y", "pitch"],
            "_weight": weight}
    wheel(scene, "steel", weight / 2, flange=False, friction=False)
    scene.json["bodies"]["truck"] = body
    scene.listed("trucks", {"name": "axles", "body": "truck", "rail": "track.rail", "tree": scaled([-half, half], units), "wheel": "steel"})
    if over_ground:
        scene.json["trucks"][0].pop("rail")
    motion(scene, "truck", body, first + half * 1.2, last - half * 1.2, "prescribed")
    closing(scene)
    scene.structure = None
    return scene


def crane(draw):
    """A bridge crane on two rails: with a trolley on its own girders, a hung load, pins, events, stops, codes."""
    units = draw_units(draw)
    scene = Scene(draw, units)
    bridge_weight = draw.size(5e4, 6e5)
    gauge = draw.number(6, 16, 3)
    aisle = specs.frame(draw, units, bridge_weight, rails=2, gauge=gauge)
    entry = add_structure(scene, "aisle", aisle)
    kind = foundation(scene, entry, aisle, kinds=["influence", "rigid", "modal", "full", "auto"])
    rail = aisle.rails[0]
    length = rail.last - rail.first
    scene.seconds = draw.choice([0.2, 0.4])
    middle = {r.name: r.across for r in aisle.rails}
    base = min(0.9, 0.18 * length)
    how = draw.choice(["prescribed", "drive", "free", "held"])
    freedoms = {"prescribed": [], "drive": ["x"], "free": ["x"], "held": []}[how]
    freedoms = freedoms + ["y"] + draw.choice([["pitch"], ["pitch", "roll"], ["z", "roll", "yaw", "pitch"]])
    sideways = "z" in freedoms
    braked = how in ("drive", "free") and draw.yes(0.5)
    wheel(scene, "runway", bridge_weight / 8, flange=True if sideways else None,
          friction=True if how in ("drive", "free") else None, driven=how == "drive", braked=braked)
    m = bridge_weight / GRAVITY
    bridge = {"weight": units.force(bridge_weight), "dof": freedoms, "cg": units.lengths([0, 0.5, 0]), "_weight": bridge_weight,
              "inertia": [units.inertia(m * gauge**2 / 12), units.inertia(m * gauge**2 / 12), units.inertia(m * 2)],
              "track": ["aisle.north", "aisle.south"]}
    scene.json["bodies"]["bridge"] = bridge
    # frames list north at smaller z; to the right looking along x is +z
    for name, across in middle.items():
        short_tree = draw.choice([[-0.3, 0.3], [[-0.3, 0.3]], [0]])
        for t in (-1, 1):
            scene.listed("trucks", {"name": f"{name[0].upper()}{'BF'[t > 0]}", "body": "bridge", "rail": f"aisle.{name}",
                                    "at": units.lengths([t * base, 0, across]), "tree": scaled(short_tree, units), "wheel": "runway"})
    low, high = rail.first + base + 0.4, rail.last - base - 0.4
    if how == "held":
        bridge["x0"] = units.length(draw.uniform(low, high))
    else:
        given = motion(scene, "bridge", bridge, low, high, how)
        if braked and draw.yes(0.5):
            given["brake"] = significant(scene.seconds / 2, 2)
    scene.prescribed = how in ("prescribed", "held")
    scene.tag("crane")
    with_trolley = draw.yes(0.7)
    structures = ["aisle"]
    stressed = aisle.stresses
    if with_trolley:
        trolley_weight = bridge_weight * draw.number(0.2, 0.6)
        girder_length = gauge * 0.9
        girders = specs.carried(draw, units, trolley_weight, girder_length, 2.0)
        on = add_structure(scene, "girders", girders)
        foundation(scene, on, girders, carried=True)
        on |= {"on": "bridge", "at": units.lengths([0, 0.6, 0])}
        structures.append("girders")
        stressed = stressed or girders.stresses
        how_trolley = draw.choice(["held", "prescribed", "drive"])
        wheel(scene, "trolley", trolley_weight / 4, flange=False, friction=how_trolley == "drive" or None, driven=how_trolley == "drive")
        mass = trolley_weight / GRAVITY
        dof = (["x"] if how_trolley == "drive" else []) + ["y"] + draw.choice([["pitch"], ["roll", "pitch"]])
        trolley = {"weight": units.force(trolley_weight), "inertia": [units.inertia(mass)] * 3, "dof": dof, "_weight": trolley_weight,
                   "track": ["girders.west", "girders.east"]}
        scene.json["bodies"]["trolley"] = trolley
        for name, across in (("west", -1.0), ("east", 1.0)):
            scene.listed("trucks", {"name": f"T{name[0].upper()}", "body": "trolley", "rail": f"girders.{name}",
                                    "at": units.lengths([0, 0, across]), "tree": scaled([-0.6, 0.6], units), "wheel": "trolley"})
        if how_trolley == "held":
            trolley["x0"] = units.length(draw.uniform(0.9, girder_length - 0.9))
        else:
            motion(scene, "trolley", trolley, 0.8, girder_length - 0.8, how_trolley)
        if how_trolley == "drive":
            scene.prescribed = False
        scene.tag("structure on a body")
        scene.deck = False
        if draw.yes(0.7):
            hang(scene, "trolley", trolley_weight)
    elif draw.yes(0.4):
        hang(scene, "bridge", bridge_weight * 0.3)
    if draw.yes(0.3):
        irregularities(scene, entry, aisle, sideways)
    if kind in ("influence", "full", "modal") and how in ("drive", "free") and "reading" not in entry and draw.yes(0.4):
        entry["longitudinal"] = True
        scene.tag("longitudinal")
    if how == "free" and draw.yes(0.5):
        scene.listed("stops", {"rail": "aisle.north", "x": units.length(rail.last), "k": units.stiffness(bridge_weight / 0.05)})
        scene.tag("stop: rail")
    if draw.yes(0.5):
        practice = draw.choice([{}, {"kind": "ladle", "hoisting": "HC2"}, {"kind": "mill", "drives": "sudden"},
                                {"guide": "rollers", "rail_head": units.length(0.06)}, {"release": "slow", "approach": units.length(1)}])
        scene.json["practice"] = practice
        scene.tag("practice")
    if scene.auto or how in ("drive", "free", "held") or kind in ("modal", "full", "auto"):
        scene.deck = False
    closing(scene)
    outputs(scene, structures, stressed)
    if draw.yes(0.25):
        comparisons(scene, structures)
    scene.structure = aisle
    return scene


def hang(scene, carrier, weight):
    """A load on a rope below a body, at times hoisted, dropped, or set on a floor."""
    draw, units = scene.draw, scene.units
    load = {"weight": units.force(weight), "dof": ["X", "Y", "Z"]}
    scene.json["bodies"]["load"] = load
    length = draw.number(3, 12, 3)
    rope = {"from": {"body": carrier, "at": units.lengths([0, 0.5, 0])}, "to": {"body": "load"},
            "EA": units.force(weight * length / draw.size(2e-3, 2e-2)), "length": units.length(length)}
    if draw.yes(0.3):
        rope["c"] = units.stiffness(weight / GRAVITY * 2)
    if draw.yes(0.4):
        rope["speed"] = [[0, 0], [scene.seconds / 2, units.length(draw.number(-0.3, 0.3))]]
        scene.tag("rope: hoists")
    if draw.yes(0.5):
        rope["name"] = "hoist"
    scene.listed("ropes", rope)
    name = rope.get("name", "rope1")
    scene.tag("rope")
    time = significant(scene.seconds * draw.uniform(0.2, 0.7), 2)
    event = draw.choice([None, None, {"drop": "load"}, {"hoist": {"rope": name, "speed": units.length(0.2)}}])
    if event:
        scene.listed("events", {"when": f"time >= {time}", "do": event})
        scene.tag(f"event: {next(iter(event))}")
    if draw.yes(0.25):
        scene.listed("events", {"name": "taut", "when": f"{name}.tension > {units.force(weight * 1.3)}", "do": {"end": True}})
    if draw.yes(0.25):
        scene.listed("stops", {"name": "floor", "body": "load", "Y": units.length(-length * 1.5), "k": units.stiffness(weight / 0.01)})
        scene.tag("stop: floor")
    scene.deck = False
