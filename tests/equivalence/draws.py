"""Random cases: which files and which commands, drawn by number so that a case stays the same in longer runs."""

import cranes
import damage
import models
import scenes
import specs
from case import Case, Draw, text, units

ENDINGS = ["adm", "cmd", "csv", "json", "npz"]


def threads(draw):
    return [] if draw.yes(0.15) else ["--threads", "1"]


def flags(draw):
    return threads(draw) + (["--json"] if draw.yes(0.12) else []) + (["--quiet"] if draw.yes(0.1) else [])


def of_scene(draw, scene):
    """A scene with its files, and what is done with it."""
    files = {"scene.json": text(scene.json)}
    for name, value in scene.files.items():
        files[name] = value if isinstance(value, str) else text(value)
    commands = [["run", "scene.json", "-o", "out", *flags(draw)]]
    tags = set(scene.tags) | {"command: run"}
    if draw.yes(0.12):
        commands.append(["sim", "scene.json", "-o", "out", *threads(draw)])
        tags.add("command: sim")
    if draw.yes(0.6 if scene.deck else 0.05):
        commands.append(["deck", "scene.json", "-o", "scene.adm", *form(draw), *threads(draw)])
        tags.add("command: deck")
        if draw.yes(0.25):
            commands.append(["deck", "scene.json", "--check", "--states", "20", *form(draw)])
            tags.add("command: deck --check")
    return Case("", files, commands, tags)


def form(draw):
    word = draw.choice([None, "akispl", "symmetrised", "factored", "paper"])
    return ["--form", word] if word else []


def of_tables(draw):
    """A scene that reads tables which an earlier command wrote."""
    scene = scenes.trucks(draw)
    entry = next(iter(scene.json["structures"].values()))
    spec = entry["spec"]
    ending = draw.choice(ENDINGS)
    structure = scene.structure
    tables = {"file": f"tables.{ending}", "vertical": 6}
    if structure.lateral and any("lateral" in w for w in scene.wheels.values()):
        tables["lateral"] = 7
    for key in ("spec", "count", "handover", "blend", "modes", "elements", "damping", "tolerance", "longitudinal", "couplings", "gauges"):
        entry.pop(key, None)
    entry |= {"tables": tables, "foundation": draw.choice(["influence", "rigid"])}
    entry.setdefault("reading", draw.choice(["akispl", "natural", "cubspl", "exact"]))
    scene.json.pop("compare", None)
    for key in ("reactions", "stresses", "fatigue", "dead_load", "sections"):
        scene.json["output"].pop(key, None)
    case = of_scene(draw, scene)
    before = [["fea", spec, "-o", "grid.json", *threads(draw)]]
    splines = ["splines", "grid.json", "-o", f"tables.{ending}"]
    if draw.yes(0.2):
        splines += ["--form", "factored"]
    case.commands = [*before, splines, *case.commands]
    case.tags |= {f"tables: .{ending}", "foundation: tables"}
    return case


def of_grid(draw):
    """A spec, its grid, modes, and tables of it in one format after the other."""
    unit = units(draw)
    weight = draw.size(1e4, 1e6)
    structure = specs.short(draw, unit, weight) if draw.yes(0.5) else specs.frame(draw, unit, weight)
    tags = set(structure.tags) | {"command: fea"}
    fea = ["fea", "spec.json", *threads(draw)]
    if draw.yes(0.3):
        fea += ["--theory", draw.choice(["euler-bernoulli", "timoshenko"])]
    if draw.yes(0.5) and (structure.has_mass or draw.yes(0.2)):
        fea += ["--modes", str(draw.randint(1, 8))]
        tags.add("command: fea --modes")
    if draw.yes(0.15):
        fea += ["--accuracy", draw.choice(["1e-12", "1e-14", "1e-3"])]
    commands = [fea + ["-o", "grid.json"]] if draw.yes(0.9) else [fea]
    if len(fea) and commands[0] != fea:
        ending = draw.choice(ENDINGS)
        splines = ["splines", "grid.json", "-o", f"tables.{ending}"]
        other = draw.weighted(plain=4, digits=2, factored=3, rank=1, only=2, stations=2, check=2, load=1)
        extra = {"plain": [], "digits": ["--digits", str(draw.randint(5, 12))], "factored": ["--form", "factored"],
                 "rank": ["--form", "factored", "--rank", "3"], "only": ["--only", draw.choice(["vertical", "vertical,lateral"])],
                 "stations": ["--reading", draw.choice(["natural", "akispl", "cubspl", "factored"]), "--tolerance", "0.05", "--directions", "vertical"]}
        if other in extra:
            commands.append(splines + extra[other] + (["--json"] if draw.yes(0.2) else []))
            tags.add(f"splines: {other} .{ending}")
            if draw.yes(0.7):
                second = draw.choice(ENDINGS)
                commands.append(["splines", f"tables.{ending}", "-o", f"again.{second}"])
                tags.add(f"splines: .{ending} to .{second}")
                if draw.yes(0.3):
                    commands.append(["splines", f"again.{second}"])
        else:
            check = ["splines", "grid.json", "--check"]
            if other == "load":
                check += ["--load", "1000", "--spacing", str(unit.length(0.6))]
            commands.append(check + draw.choice([[], ["--json"], ["-o", "check.json"]]))
            tags.add("splines: check")
    return Case("", {"spec.json": text({**structure.spec, "name": "drawn"})}, commands, tags)


def of_model(draw):
    """A model of another program, imported and, where it has a rail, solved."""
    files, arguments, tags = models.bulk_data(draw) if draw.yes(0.6) else models.mesh(draw)
    commands = [["import", *arguments, "-o", "spec.json"], ["fea", "spec.json", "-o", "grid.json"]]
    return Case("", files, commands, tags | {"command: import"})


def malformed(draw):
    """A case of any kind with a faulty file."""
    case = draw.weighted(scene=5, grid=3, model=2)
    case = of_scene(draw, draw.choice(SCENES)(draw)) if case == "scene" else of_grid(draw) if case == "grid" else of_model(draw)
    case.tags = damage.damage(draw, case) | {"malformed"}
    if draw.yes(0.2):
        case.commands = [command + ["--json"] * ("--json" not in command) for command in case.commands]
    return case


SCENES = [scenes.trucks, scenes.trucks, scenes.trucks, cranes.crane, cranes.crane, scenes.single_wheel, scenes.ties, scenes.wagon]


def random_case(seed, number):
    """The case of a number: always the same for one seed."""
    draw = Draw(f"{seed}/{number}")
    kind = draw.weighted(scene=58, tables=6, grid=14, model=6, malformed=16)
    if kind == "scene":
        case = of_scene(draw, draw.choice(SCENES)(draw))
    else:
        case = {"tables": of_tables, "grid": of_grid, "model": of_model, "malformed": malformed}[kind](draw)
    case.name = f"{number:04} {kind}"
    return case
