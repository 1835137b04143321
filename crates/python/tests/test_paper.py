"""The girder and the bogie of McConville's paper."""

import re
from pathlib import Path

import numpy as np
import pytest

import girderway as gw

BOGIE = Path(__file__).resolve().parents[3] / "examples" / "bogie"


def printed(number):
    """The printed values of a SPLINE of the data set: [deflection station][load station]."""
    text = re.sub(r",\s*\n,", ",", (BOGIE / "printed.adm").read_text())
    statement = re.search(rf"SPLINE/{number}\b(.*?)(?=\nSPLINE/|\nEND|\Z)", text, re.S).group(1)
    curves = re.split(r"\bY\s*=", statement)[1:]
    rows = [[float(word) for word in re.findall(r"-?\d+\.?\d*(?:[eE][-+]?\d+)?", curve)] for curve in curves]
    # each curve begins with the z of its load
    return np.array([row[-7:] for row in rows])


def test_all_98_printed_entries_are_met_within_one_unit_of_their_last_digit():
    girder = gw.Structure(BOGIE / "spec.json")
    x = girder.rails["rail"]["stations"]
    entries = 0
    for number, axis in [(6, "vertical"), (7, "lateral")]:
        table, found = printed(number), girder.influence(x, x, axis)
        assert table.shape == found.shape == (7, 7)
        for digits, value in zip(table.ravel(), found.ravel()):
            unit = 10.0 ** (np.floor(np.log10(abs(digits))) - 2) if digits else 1e-20
            assert abs(value - digits) <= unit * (1 + 1e-9), (axis, digits, value)
            entries += 1
    assert entries == 98


def test_influence_is_exact_between_stations():
    # Macaulay's formula for a simply supported beam: the load at z, the place at x <= z
    length, ei = 60.0, 4.32e9 * 9.528
    girder = gw.Structure(BOGIE / "spec.json")
    x, z = np.array([7.3, 21.9, 33.3]), np.array([33.3, 41.7])
    b = length - z[None, :]
    # positive upwards under a load upwards
    formula = b * x[:, None] * (length**2 - b**2 - x[:, None] ** 2) / (6 * length * ei)
    found = girder.influence(x, z)
    assert np.allclose(found, formula, rtol=1e-12, atol=0)


def test_the_bogie_meets_the_values_of_the_paper():
    import json

    run = gw.run(BOGIE / "scene.json")
    cases = {None: run, **run.comparisons}
    for check in json.loads((BOGIE / "expected.json").read_text())["checks"]:
        case = cases[check["run"]]
        values = case[check["column"]]
        if check.get("peak"):
            value = values.max()
        else:
            ((column, at),) = check["where"].items()
            value = np.interp(at, case[column], values)
        assert value == pytest.approx(check["value"], abs=max(check["tolerance"], 1e-6)), check
