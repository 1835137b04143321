"""Random scenes: trucks on girders and frames, wagons, wheels by themselves, ties."""

import specs
from case import significant, units as draw_units
from parts import (
    GRAVITY,
    Scene,
    add_structure,
    closing,
    comparisons,
    count,
    foundation,
    irregularities,
    motion,
    outputs,
    points_of,
    scaled,
    tree,
    wheel,
)


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
