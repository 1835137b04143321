"""Beam specs of the lines of a `meshio.Mesh`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import InputError

Indices = list[tuple[int, int]]


def _refuse(path: str, expected: str, hint: str | None = None) -> InputError:
    fault = {"file": "mesh", "line": None, "column": None, "path": path, "expected": expected, "found": None, "hint": hint}
    return InputError([fault])  # type: ignore[list-item]


def spec(
    mesh: Any,
    sections: Mapping[str, Mapping[str, Any]] | Sequence[Mapping[str, Any]],
    units: Mapping[str, str],
    materials: Sequence[Mapping[str, Any]],
    supports: Mapping[str, Sequence[str]] | Sequence[Mapping[str, Any]],
    rails: Mapping[str, Any],
    up: Sequence[float],
    members: Mapping[str, Any],
) -> dict[str, Any]:
    """The members of a beam spec; points without a line are left out."""
    kinds = [block.type for block in mesh.cells]
    strange = sorted(set(kinds) - {"line", "vertex"})
    if strange:
        hint = "keep the lines: mesh.cells, or Gmsh's physical groups of curves alone"
        raise _refuse("cells", f"must be lines (and vertices), got {', '.join(strange)}", hint)
    lines = [k for k, kind in enumerate(kinds) if kind == "line"]
    if not lines:
        raise _refuse("cells", "must have a block of lines")
    points = np.asarray(mesh.points, dtype=float)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    used = np.unique(np.concatenate([np.asarray(mesh.cells[k].data).ravel() for k in lines]))
    number = {int(old): new for new, old in enumerate(used)}
    blocks = [[[number[int(a)], number[int(b)]] for a, b in mesh.cells[k].data] for k in lines]

    index: list[list[int]] = [[-1] * len(block) for block in blocks]
    if isinstance(sections, Mapping):
        listed = []
        for position, (name, section) in enumerate(sections.items()):
            listed.append({"name": name, **section})
            for block, cell in _cells(mesh, lines, name):
                index[block][cell] = position
    else:
        listed = [dict(section) for section in sections]
        data = mesh.cell_data.get("section")
        if data is None:
            raise _refuse("cell_data", "must have `section`, the index of the section of each cell")
        index = [[int(value) for value in data[k]] for k in lines]
    missing = [(b, c) for b, block in enumerate(index) for c, value in enumerate(block) if value < 0]
    if missing:
        b, c = missing[0]
        raise _refuse(f"cells[{lines[b]}][{c}]", f"has no section; {len(missing)} such cells", "name its set in sections")

    orientation = mesh.cell_data.get("orientation")
    if orientation is not None:
        directions = [np.asarray(orientation[k], dtype=float).tolist() for k in lines]
    else:
        directions = [[_across(points, used, line, up) for line in block] for block in blocks]
    found: dict[str, Any] = {
        "format": "girderway-beam/1",
        "name": "mesh",
        "units": dict(units),
        "up": list(up),
        "points": points[used].tolist(),
        "cells": [{"type": "line", "data": block} for block in blocks],
        "cell_data": {"section": index, "orientation": directions},
        "materials": [dict(material) for material in materials],
        "sections": listed,
        "supports": _supports(mesh, number, supports),
        "rails": {name: _rail(mesh, lines, points[used], blocks, name, rail) for name, rail in rails.items()},
    }
    found.update(members)
    return found


def _cells(mesh: Any, lines: Sequence[int], name: str) -> Indices:
    """Cells of a set or of a physical group of lines, as (block among the lines, index)."""
    if name in mesh.cell_sets:
        sets = mesh.cell_sets[name]
        return [(b, int(c)) for b, k in enumerate(lines) for c in np.asarray(sets[k] if sets[k] is not None else [], dtype=int)]
    if name in mesh.field_data and "gmsh:physical" in mesh.cell_data:
        tag = int(mesh.field_data[name][0])
        groups = mesh.cell_data["gmsh:physical"]
        return [(b, int(c)) for b, k in enumerate(lines) for c in np.flatnonzero(np.asarray(groups[k]) == tag)]
    known = [*mesh.cell_sets, *mesh.field_data]
    raise _refuse("cell_sets", f"there is no set of cells {name!r}", f"known: {', '.join(known)}" if known else None)


def _supports(
    mesh: Any, number: Mapping[int, int], supports: Mapping[str, Sequence[str]] | Sequence[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    if not isinstance(supports, Mapping):
        return [{**one, "point": number[int(one["point"])]} for one in supports]
    found = []
    for name, fix in supports.items():
        points = _points(mesh, name)
        found += [{"point": number[point], "fix": list(fix)} for point in points if point in number]
    return found


def _points(mesh: Any, name: str) -> list[int]:
    """Points of a set, or of vertices in a set or physical group."""
    if name in mesh.point_sets:
        return [int(point) for point in mesh.point_sets[name]]
    vertices = [k for k, block in enumerate(mesh.cells) if block.type == "vertex"]
    cells = _cells(mesh, vertices, name)
    return [int(mesh.cells[vertices[b]].data[c][0]) for b, c in cells]


def _across(points: npt.NDArray[np.float64], used: Any, line: Sequence[int], up: Sequence[float]) -> list[float]:
    """The direction of local y of a cell: upwards, or along x where the cell is upright."""
    a, b = (points[used[end]] for end in line)
    along = (b - a) / np.linalg.norm(b - a)
    upwards = np.asarray(up, dtype=float) / np.linalg.norm(up)
    if abs(float(along @ upwards)) < 0.999:
        return [float(value) for value in upwards]
    return [1.0, 0.0, 0.0] if abs(float(upwards[0])) < 0.9 else [0.0, 1.0, 0.0]


def _rail(
    mesh: Any,
    lines: Sequence[int],
    points: npt.NDArray[np.float64],
    blocks: Sequence[Sequence[Sequence[int]]],
    name: str,
    rail: Any,
) -> dict[str, Any]:
    """A rail along the cells of a set, in the direction of its longest extent."""
    given = {"set": rail} if isinstance(rail, str) else dict(rail)
    if "set" not in given:
        return given
    cells = _cells(mesh, lines, given.pop("set"))
    offset = np.asarray(given.pop("offset", [0.0, 0.0, 0.0]), dtype=float)
    ends = np.array([[points[p] for p in blocks[b][c]] for b, c in cells]) + offset
    flat = ends.reshape(-1, 3)
    first = flat[np.lexsort(flat.round(9).T[::-1])[0]]
    last = flat[np.argmax(np.linalg.norm(flat - first, axis=1))]
    axis = (last - first) / np.linalg.norm(last - first)
    places = (ends - first) @ axis
    order = np.argsort(places.mean(axis=1))
    stations = np.unique(places.round(12))
    found: dict[str, Any] = {
        "origin": first.tolist(),
        "axis": axis.tolist(),
        "segments": [{"cell": list(cells[k]), "offset": offset.tolist()} for k in order],
        "stations": stations.tolist(),
    }
    found.update(given)
    return found
