"""Models of other programs."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from . import _native
from .structure import Structure


def import_model(
    path: str | os.PathLike[str],
    *,
    length: str | None = None,
    force: str | None = None,
    up: Sequence[float] | None = None,
    rail: str | Sequence[str] = (),
    fix: str | Sequence[str] = (),
    sections: str | os.PathLike[str] | None = None,
    spc: int | None = None,
    skip: Sequence[str] = (),
    skip_unused: bool = False,
    mass: str | None = None,
    changes: Mapping[str, Any] | None = None,
) -> Structure:
    """A structure from NASTRAN bulk data (.bdf, .dat, .nas, .fem), an Abaqus input file (.inp) or a gmsh mesh (.msh).

    The options are those of `girderway import`: units of the model, the upward direction, rails such as
    `"runway=12,23,30-35"`, supports such as `"feet=ux,uy,uz"`. `changes` are members of the beam spec that replace
    those of the import. What was left out is in `warnings` of the structure, the beam spec in `spec`.

    Raises
    ------
    InputError
        The model or an option is invalid; every fault with its place.
    """
    rails = [rail] if isinstance(rail, str) else list(rail)
    supports = [fix] if isinstance(fix, str) else list(fix)
    file = os.fspath(sections) if sections is not None else None
    direction = (float(up[0]), float(up[1]), float(up[2])) if up is not None else None
    text, warnings = _native.import_model(
        os.fspath(path), length, force, direction, rails, supports, file, spc, list(skip), skip_unused, mass
    )
    import json

    structure = Structure({**json.loads(text), **(changes or {})})
    structure._import_warnings = warnings
    return structure
