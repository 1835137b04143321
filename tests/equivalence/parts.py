"""What random scenes are made of: wheels, foundations, uneven rails, motions, outputs, comparisons."""

import specs
from case import significant

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
