"""Random models of other programs: NASTRAN bulk data and gmsh meshes."""

import json

from case import significant


def field(value):
    """A number of at most eight characters with its decimal point."""
    for digits in (7, 6, 5, 4, 3, 2):
        written = f"{value:.{digits}g}"
        if "e" in written:
            mantissa, exponent = written.split("e")
            written = (mantissa if "." in mantissa else mantissa + ".") + f"{int(exponent):+d}"
        elif "." not in written:
            written += "."
        if len(written) <= 8:
            return written
    return written


def card(name, *fields, style="small"):
    """A card in small field or free field format; `fields` of any number, blank where None."""
    words = ["" if f is None else field(f) if isinstance(f, float) else str(f) for f in fields]
    lines = []
    for start in range(0, len(words), 8):
        part = words[start : start + 8]
        head = name if start == 0 else ""
        lines.append(",".join([head, *part]) if style == "free" else "".join(w.ljust(8) for w in [head, *part]).rstrip())
    return "\n".join(lines)


def bulk_data(draw):
    """A row of bars on supports, with rods, offsets, pins, rigid links, masses and springs; and the arguments of import."""
    style = draw.choice(["small", "free"])
    count = draw.randint(2, 6)
    step = draw.number(2, 8, 3)
    up_z = draw.yes(0.4)
    lines = ["$ drawn"]
    lines += ["SOL 101", "CEND", "SPC = 1", "BEGIN BULK"] if draw.yes(0.6) else []
    put = lambda name, *fields: lines.append(card(name, *fields, style=style))
    put("MAT1", 1, draw.choice([2.1e11, 2.0e11]), None, 0.3, 7850.0)
    put("PBAR", 10, 1, draw.number(0.01, 0.05), draw.size(1e-4, 1e-3), draw.size(1e-5, 1e-4), draw.size(1e-6, 1e-5))
    shape = draw.choice(["BOX", "I", "TUBE", "BAR", "ROD", "H", "CHAN", "T"])
    sizes = {"BOX": [0.3, 0.5, 0.02, 0.01], "I": [0.5, 0.2, 0.25, 0.01, 0.02, 0.02], "TUBE": [0.2, 0.18], "BAR": [0.1, 0.3],
             "ROD": [0.1], "H": [0.2, 0.05, 0.4, 0.02], "CHAN": [0.2, 0.4, 0.01, 0.02], "T": [0.3, 0.4, 0.02, 0.02]}[shape]
    put("PBARL", 11, 1, None, shape, None, None, None, None, *sizes)
    put("PBEAM", 12, 1, 0.03, 5e-4, 6e-5, None, 7e-6)
    if style == "small" or True:
        put("PROD", 13, 1, 0.001)
    for i in range(count + 1):
        x = significant(i * step, 6)
        put("GRID", i + 1, None, float(x), 0.0, 0.0)
    up = (0.0, 0.0, 1.0) if up_z else (0.0, 1.0, 0.0)
    tags = {"import: NASTRAN", f"import: {shape}"}
    for i in range(count):
        kind, section = ("CBEAM", 12) if draw.yes(0.2) else ("CBAR", draw.choice([10, 11]))
        if draw.yes(0.2):
            put(kind, i + 1, section, i + 1, i + 2, *up, "GGG", None, None, *[0.1 * u for u in up], *[0.1 * u for u in up])
            tags.add("import: offsets")
        elif 0 < i and draw.yes(0.15) and kind == "CBAR":
            put(kind, i + 1, section, i + 1, i + 2, *up, None, 5 if not up_z else 6, None)
            tags.add("import: pins")
        else:
            put(kind, i + 1, section, i + 1, i + 2, *up)
    if count > 2 and draw.yes(0.4):
        put("CROD", 50, 13, 1, 3)
    if draw.yes(0.4):
        put("CONM2", 51, 2, None, draw.number(50, 500))
    if draw.yes(0.3):
        put("CELAS2", 52, 5e6, 2, 3 if up_z else 2)
    held = sorted(draw.sample(range(1, count + 2), max(2, count // 2)) + [1])
    put("SPC1", 1, 123456 if draw.yes(0.3) else 1234, *dict.fromkeys(held[:6]))
    if draw.yes(0.2):
        put("PARAM", "WTMASS", 0.5)
    if draw.yes(0.2):
        put("FORCE", 5, 1, None, 100.0, 0.0, 1.0, 0.0)
    lines.append("ENDDATA")
    arguments = ["model.bdf", "--length", draw.choice(["m", "ft", "mm"]), "--force", draw.choice(["N", "lbf", "kN"])]
    if draw.yes(0.85):
        arguments += ["--up", ",".join(str(int(u)) for u in up), "--rail", f"top=1-{count}" + draw.choice(["", "/offset=0,0,0.2" if up_z else "/offset=0,0.2,0"])]
    return {"model.bdf": "\n".join(lines) + "\n"}, arguments, tags


def mesh(draw):
    """A portal or a chain of beams as a gmsh 4.1 file with its sections."""
    count = draw.randint(2, 5)
    step = draw.number(1, 5, 3)
    brace = draw.yes(0.6)
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '0 1 "feet"', '1 2 "girder"', '1 3 "brace"',
             "$EndPhysicalNames", "$Entities", "2 2 0 0", "1 0 0 0 1 1", f"2 {count * step} 0 0 1 1",
             f"1 0 0 0 {count * step} 0 0 1 2 2 1 -2", f"2 0 0 0 {count * step} 0 0 1 3 2 1 -2", "$EndEntities"]
    inner = count - 1
    lines += ["$Nodes", f"3 {count + 1} 1 {count + 1}", "0 1 0 1", "1", "0 0 0", "0 2 0 1", "2", f"{count * step} 0 0"]
    lines += [f"1 1 0 {inner}", *[str(3 + i) for i in range(inner)], *[f"{significant((i + 1) * step, 8)} 0 0" for i in range(inner)]]
    lines += ["$EndNodes", "$Elements"]
    chain = [1, *range(3, 3 + inner), 2]
    bars = list(zip(chain, chain[1:]))
    total = 2 + len(bars) + brace
    lines += [f"{3 + brace} {total} 1 {total}", "0 1 15 1", "1 1", "0 2 15 1", "2 2", f"1 1 1 {len(bars)}"]
    lines += [f"{3 + i} {a} {b}" for i, (a, b) in enumerate(bars)]
    if brace:
        lines += ["1 2 1 1", f"{3 + len(bars)} 1 {chain[2]}"]
    lines.append("$EndElements")
    sections = {
        "format": "girderway-sections/1", "units": {"length": draw.choice(["m", "mm", "ft"]), "force": draw.choice(["kN", "N", "lbf"]), "time": "s"},
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7, **({"density": 7.85} if draw.yes(0.5) else {})}],
        "sections": [{"name": "girder", "material": "steel", "A": 0.02, "Iy": 2e-5, "Iz": draw.size(1e-4, 1e-3), "J": 2e-6},
                     {"name": "angle", "material": "steel", "A": 0.001}],
        "members": {"brace": {"section": "angle", "kind": "truss"}},
    }
    if draw.yes(0.3):
        sections["members"]["girder"] = {"section": "girder", "orientation": [0, 1, 0]}
    arguments = ["model.msh", "--length", draw.choice(["m", "mm", "ft"]), "--sections", "sections.json", "--up", "0,1,0",
                 "--fix", "feet=ux,uy,uz,rx"]
    if draw.yes(0.85):
        arguments += ["--rail", "top=girder"]
    return {"model.msh": "\n".join(lines) + "\n", "sections.json": json.dumps(sections, indent=1)}, arguments, {"import: gmsh"}
