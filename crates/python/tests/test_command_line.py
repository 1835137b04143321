"""Numbers and files are those of the command line, bit for bit."""

import csv
import hashlib
import json
import struct
from pathlib import Path

import numpy as np
import pytest

import girderway as gw

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
SCENES = sorted(path.parent.name for path in EXAMPLES.glob("*/scene.json"))


def columns_of(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return {name: [row[k] for row in rows[1:]] for k, name in enumerate(rows[0])}


def bits(values):
    return [struct.pack("<d", float(value)) for value in values]


@pytest.mark.parametrize("example", SCENES)
def test_every_example_equals_the_command_line_bit_for_bit(example, command_line, tmp_path):
    scene = EXAMPLES / example / "scene.json"
    folder = command_line("run", scene, example)
    run = gw.run(scene)
    cases = {"history.csv": run, **{f"history-{label}.csv": case for label, case in run.comparisons.items()}}
    assert sorted(cases) == sorted(path.name for path in folder.glob("history*.csv"))
    for name, case in cases.items():
        table = columns_of(folder / name)
        assert list(table) == case.columns
        for column, cells in table.items():
            assert bits(cells) == bits(case[column]), (name, column)
    assert run.summary == json.loads((folder / "summary.json").read_text())

    saved = run.save(tmp_path / "saved")
    files = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    assert files == sorted(path.relative_to(saved) for path in saved.rglob("*") if path.is_file())
    for file in files:
        if file.name != "timing.json":
            digests = [hashlib.sha256((root / file).read_bytes()).hexdigest() for root in (folder, saved)]
            assert digests[0] == digests[1], file


def test_grids_equal_those_of_the_command_line_bit_for_bit(girderway, tmp_path):
    import subprocess

    for spec in sorted(EXAMPLES.glob("*/spec.json")):
        text = subprocess.run([girderway, "fea", str(spec), "--quiet"], check=True, capture_output=True, text=True)
        influence = json.loads(text.stdout)["influence"]
        structure = gw.Structure(spec)
        assert sorted(structure.grid) == sorted(influence)
        for block, rows in influence.items():
            assert np.array_equal(structure.grid[block], np.array(rows)), (spec, block)
        if len(structure.rails) == 1:
            (rail,) = structure.rails.values()
            x = rail["stations"]
            for block, rows in influence.items():
                assert np.array_equal(structure.influence(x, x, block), np.array(rows)), (spec, block)
        structure.write_grid(tmp_path / "grid.json")
        assert (tmp_path / "grid.json").read_text() == text.stdout


def test_tables_equal_those_of_the_command_line(girderway, tmp_path):
    import subprocess

    spec = EXAMPLES / "bogie" / "spec.json"
    structure = gw.Structure(spec)
    structure.write_grid(tmp_path / "grid.json")
    for ending in ("adm", "cmd", "csv", "json", "npz"):
        theirs, ours = tmp_path / f"theirs.{ending}", tmp_path / f"ours.{ending}"
        command = [girderway, "splines", str(tmp_path / "grid.json"), "-o", str(theirs), "--quiet"]
        subprocess.run(command, check=True)
        structure.write_tables(ours)
        assert theirs.read_bytes() == ours.read_bytes(), ending


def test_a_design_equals_that_of_the_command_line(command_line, tmp_path):
    file = EXAMPLES / "runway" / "design.json"
    folder = command_line("design", file, "design")
    design = gw.design(file)
    assert design.summary == json.loads((folder / "summary.json").read_text())
    for name, ours in [("envelope", design.envelope), ("reactions", design.reactions)]:
        theirs = columns_of(folder / f"{name}.csv")
        assert list(theirs) == list(ours)
        for column, cells in theirs.items():
            if isinstance(ours[column], list):
                assert cells == ours[column]
            else:
                assert np.array_equal([float(cell or "nan") for cell in cells], ours[column], equal_nan=True)
    saved = design.save(tmp_path / "design")
    assert (saved / "report.html").read_bytes() == (folder / "report.html").read_bytes()
    raw = json.loads(file.read_text())
    spec = file.parent / raw.pop("spec")
    # the same design by its members, on a structure in hand
    members = {key: value for key, value in raw.items() if key not in ("format", "$schema", "trains")}
    ours = gw.Structure(spec).design(raw["trains"], **members)
    assert ours.extremes == design.extremes
