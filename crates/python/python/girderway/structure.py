"""Structures: influence coefficients anywhere on their rails, natural modes, tables and designs."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _frames, _html, _inputs, _native, _meshes
from .design import Design

if TYPE_CHECKING:
    from ._inputs import Source

Floats = npt.NDArray[np.float64]


def _places(x: npt.ArrayLike) -> Floats:
    return np.ascontiguousarray(np.atleast_1d(np.asarray(x, dtype=np.float64)))


class Structure:
    """A structure with rails, described by a beam spec; solved at the first question.

    Parameters
    ----------
    spec:
        Path of a beam spec, or a dictionary with its members.
    folder:
        Folder of the files that a dictionary names; the working folder by default.

    Raises
    ------
    InputError
        The spec is invalid.
    UntrustedError
        At the first question: the structure is a mechanism.

    >>> girder = Structure({"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
    ...     "theory": "euler-bernoulli", "girder": {"spans": [10], "E": 210e6, "I_vertical": 5.768e-4}})
    >>> float(round(girder.influence(5, 5)[0, 0] * 48 * 210e6 * 5.768e-4 / 10**3, 12))
    1.0
    """

    def __init__(self, spec: Source, *, folder: str | os.PathLike[str] | None = None) -> None:
        self._native = _native.Structure(_inputs.given(spec, "spec", folder))
        self._import_warnings: list[str] = []

    @classmethod
    def from_meshio(
        cls,
        mesh: Any,
        sections: Mapping[str, Mapping[str, Any]] | Sequence[Mapping[str, Any]],
        *,
        units: Mapping[str, str],
        materials: Sequence[Mapping[str, Any]],
        supports: Mapping[str, Sequence[str]] | Sequence[Mapping[str, Any]],
        rails: Mapping[str, Any],
        up: Sequence[float] = (0.0, 0.0, 1.0),
        **members: Any,
    ) -> Structure:
        """A structure on the lines of a `meshio.Mesh`.

        `sections` are those of a beam spec by the name of the set of cells (or of the physical group of gmsh) that has
        them; or a list, with the index of each cell in `mesh.cell_data["section"]`. `supports` are lists of degrees of
        freedom by the name of a set of points or of vertices, or those of a beam spec. `rails` has for each rail the
        name of the set of cells along which it runs, or its members `set`, `offset` and `stations`. Blocks of
        vertices are left out, those of other cells are refused. `members` are further members of the beam spec, such
        as `name` and `theory`.
        """
        return cls(_meshes.spec(mesh, sections, units, materials, supports, rails, up, members))

    @property
    def name(self) -> str:
        """Its name."""
        return self._native.name

    @property
    def units(self) -> dict[str, str]:
        """Units of length, force and time."""
        return self._native.units

    @property
    def theory(self) -> str:
        """Keyword of the beam theory."""
        return self._native.theory

    @property
    def spec(self) -> dict[str, Any]:
        """The beam spec as a dictionary."""
        spec: dict[str, Any] = json.loads(self._native.text)
        return spec

    @property
    def rails(self) -> dict[str, dict[str, Any]]:
        """For each rail `range`, its first and last coordinate, and `stations`, an array."""
        return self._native.rails

    @property
    def warnings(self) -> list[str]:
        """Values that are probably wrong, and what an import left out."""
        return self._import_warnings + self._native.warnings

    @property
    def notes(self) -> list[str]:
        """Numbers that follow from names of sections, and directions without tables."""
        return self._native.notes()

    @property
    def error_bound(self) -> float | None:
        """Guaranteed bound of |error of G_ij| / sqrt(G_ii G_jj) by rounding."""
        return self._native.error_bound

    @property
    def critical_factor(self) -> float | None:
        """Smallest factor on the `preload` at which the structure buckles, by axial forces alone; infinite above 1e6."""
        return self._native.critical_factor

    @property
    def grid(self) -> dict[str, Floats]:
        """Influence coefficients between all stations by block, as in the file of `girderway fea`."""
        return self._native.grid()

    def influence(
        self,
        x: npt.ArrayLike,
        z: npt.ArrayLike,
        axis: str = "vertical",
        rail: str | None = None,
        load_rail: str | None = None,
    ) -> Floats:
        """Influence coefficients at any places, in length per force.

        Parameters
        ----------
        x, z:
            Coordinates along the rails of the deflections and of the unit loads.
        axis:
            `vertical`, `lateral`, `longitudinal`, or a coupling such as `vertical_lateral`: vertical deflections under
            lateral loads.
        rail, load_rail:
            Rails of x and z; `rail` may be left out where there is one, `load_rail` where it is the same.

        Returns
        -------
        Array [i, j]: deflection at x[i] per unit load at z[j], exact at every place.
        """
        return self._native.influence(_places(x), _places(z), axis, rail, load_rail)

    def modes(self, count: int = 6) -> Modes:
        """The `count` natural modes with the lowest frequencies."""
        return Modes(self._native.modes(count))

    def write_tables(self, path: str | os.PathLike[str]) -> None:
        """Writes the tables of the grid; the ending gives the format: .adm, .cmd, .csv, .json or .npz.

        The folder is made where it does not exist.
        """
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        self._native.write_tables(os.fspath(path))

    def write_grid(self, path: str | os.PathLike[str]) -> None:
        """Writes the grid file of `girderway fea`. The folder is made where it does not exist."""
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        self._native.write_grid(os.fspath(path))

    def design(self, trains: Sequence[Mapping[str, Any]], **members: Any) -> Design:
        """Wheel trains on the structure, statically: exact envelopes and extremes.

        `trains` and the further members, such as `cases`, `dead_load` and `practice`, are those of a design file;
        `units` and `name` are those of the structure where they are left out.
        """
        design = {"format": "girderway-design/1", "name": self.name, "units": self.units, **members}
        design.update(spec="spec", trains=list(trains))
        return Design(self._native.design(_inputs.text(design, "design")))

    def plot(self, axis: str = "vertical", rail: str | None = None, ax: Any = None) -> Any:
        """Draws the influence line of every station of a rail with matplotlib; returns the axes."""
        ax = _frames.axes(ax)
        rails = self.rails
        name = rail if rail is not None else next(iter(rails))
        low, high = rails[name]["range"]
        x, stations = np.linspace(low, high, 401), rails[name]["stations"]
        lines = self.influence(x, stations, axis, name)
        for line in lines.T:
            ax.plot(x, line)
        ax.set_xlabel(f"x of rail {name} ({self.units['length']})")
        ax.set_ylabel(f"{axis} deflection under a unit load ({self.units['length']}/{self.units['force']})")
        ax.grid(True, linewidth=0.4, alpha=0.6)
        return ax

    def __repr__(self) -> str:
        rails = ", ".join(f"{name} {rail['range']}" for name, rail in self.rails.items())
        return f"<girderway.Structure {self.name}: rails {rails}>"

    def _repr_html_(self) -> str:
        rows = [(name, *rail["range"], len(rail["stations"])) for name, rail in self.rails.items()]
        unit = self.units["length"]
        return _html.table(f"Structure {self.name}", ["rail", f"from ({unit})", f"to ({unit})", "stations"], rows)


class Modes:
    """Natural modes of a structure, lowest frequency first."""

    def __init__(self, native: _native.Modes) -> None:
        self._native = native
        #: Frequencies in Hz.
        self.frequency: Floats = native.frequency
        #: Estimated relative error of the frequencies due to the mesh.
        self.mesh_error: float | None = native.mesh_error

    def shape(self, x: npt.ArrayLike, axis: str = "vertical", rail: str | None = None) -> Floats:
        """Displacements at places of a rail: array [mode, place]; generalised masses are one."""
        return self._native.shape(_places(x), axis, rail)

    def __len__(self) -> int:
        return len(self._native)

    def __repr__(self) -> str:
        return f"<girderway.Modes {', '.join(f'{hertz:.4g}' for hertz in self.frequency)} Hz>"

    def _repr_html_(self) -> str:
        return _html.table("Natural modes", ["mode", "frequency (Hz)"], enumerate(map(float, self.frequency), 1))
