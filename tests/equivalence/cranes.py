"""Random bridge cranes: with a trolley on its own girders, and a load on a rope."""

import specs
from case import significant, units as draw_units
from parts import (
    GRAVITY,
    Scene,
    add_structure,
    closing,
    comparisons,
    foundation,
    irregularities,
    motion,
    outputs,
    scaled,
    tree,
    wheel,
)


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
