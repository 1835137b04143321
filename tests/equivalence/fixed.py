"""Cases that are not drawn: the malformed inputs of the tests, the examples, and calls without a scene."""

import json
import re
from pathlib import Path

from case import Case

ROOT = Path(__file__).resolve().parents[2]
# half a minute and more
SLOW = {"examples/bridge_crane/damping.json", "examples/bridge_crane/foundations.json"}


def calls():
    """Schemas, starter files, and calls that are refused."""
    listed = [["schema", word] for word in ("beam", "grid", "scene")]
    listed += [["schema", "scene", "-o", "scene.schema.json"], ["schema", "beam", "--json", "-o", "s.json"], ["schema", "study"]]
    listed += [["init", word, "made"] for word in ("bogie", "crane", "girderway")] + [["init", "bogie", "--json"], ["init", "house"]]
    listed += [["fly"], ["run"], ["run", "none.json"], ["run", "none.json", "--json"], ["run", ".", "--quiet"], ["fea", "none.json"],
               ["splines", "none.adm"], ["splines", "none.xyz"], ["deck", "none.json"], ["import", "none.bdf"], ["import", "none.inp"],
               ["import", "none.msh", "--length", "m"], ["run", "x", "--threads", "0"], ["fea", "x", "--modes", "-1"], ["--version"]]
    for words in listed:
        yield Case(f"call {' '.join(words)}", {}, [words], {"call"})
    yield Case("call init bogie twice", {}, [["init", "bogie", "made"], ["init", "bogie", "made"], ["run", "made/scene.json", "-o", "out"]], {"call"})


def unescaped(text):
    """The bytes of a text with \\xNN in it."""
    return re.sub(rb"\\x([0-9a-fA-F]{2})", lambda found: bytes([int(found.group(1), 16)]), text.encode())


def refused():
    """The cases of tests/malformed, whose mini-language its main.rs describes."""
    folder = ROOT / "tests/malformed"
    base = {file.name: file.read_bytes() for file in sorted((folder / "base").iterdir())}
    for page in sorted((folder / "cases").glob("*.txt")):
        for number, block in enumerate(page.read_text().strip().split("\n\n"), 1):
            files, command = dict(base), []
            for line in block.splitlines():
                if line.startswith(("# ", "> ", "= ")):
                    continue
                if " :=" in line:
                    name, _, text = line.partition(" :=")
                    files[name] = unescaped(text.lstrip())
                elif " =>" in line:
                    edited, _, new = line.partition(" =>")
                    name, _, old = edited.partition(": ")
                    files[name] = files[name].replace(unescaped(old), unescaped(new.lstrip()), 1)
                else:
                    command = line.split(" ")
            if command:
                yield Case(f"malformed {page.stem} {number}", files, [command], {"refused"})


def examples(slow):
    """Every scene and spec under examples/, and the scenes of the deck tests."""
    folders = sorted(p for p in (ROOT / "examples").iterdir() if p.is_dir()) + [ROOT / "tests/deck/scenes"]
    for folder in folders:
        for file in sorted(folder.glob("*.json")):
            name = f"{folder.relative_to(ROOT)}/{file.name}"
            kind = json.loads(file.read_text()).get("format", "")
            if kind == "girderway-scene/1":
                if name not in SLOW or slow:
                    yield Case(f"example {name}", {}, [["run", file.name, "-o", "out"], ["sim", file.name, "-o", "out"]], {"example"}, str(folder), 3600)
                forms = ["akispl", "symmetrised", "factored", "paper"] if name not in SLOW else ["factored"]
                decks = [["deck", file.name, "-o", f"{form}.adm", "--form", form] for form in forms]
                yield Case(f"example {name} decks", {}, [*decks, ["deck", file.name, "--check", "--states", "100"]], {"example"}, str(folder), 600)
            elif kind == "girderway-beam/1":
                tables = [["splines", "g.json", "-o", f"t.{ending}"] for ending in ("adm", "cmd", "csv", "json", "npz")]
                yield Case(f"example {name} grid", {}, [["fea", file.name, "--modes", "5", "-o", "g.json"], *tables,
                           ["splines", "g.json", "--form", "factored"]], {"example"}, str(folder), 600)
    imports = ROOT / "tests/import"
    for file in sorted((imports / "decks").glob("*.bdf")):
        yield Case(f"example import {file.name}", {}, [["import", file.name, "--length", "ft", "--force", "lbf"]], {"example"}, str(imports / "decks"), 600)
    for file in sorted((imports / "meshes").glob("*.msh")):
        sections = file.name.split("_")[0].split(".")[0] + ".json"
        yield Case(f"example import {file.name}", {}, [["import", file.name, "--length", "m", "--sections", sections, "--up", "0,1,0"]],
                   {"example"}, str(imports / "meshes"), 600)


def cases(slow):
    return [*calls(), *refused(), *examples(slow)]
