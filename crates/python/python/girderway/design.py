"""Static designs: envelopes and extremes of wheel trains."""

from __future__ import annotations

import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _frames, _html, _inputs, _native

if TYPE_CHECKING:
    from ._inputs import Source


def design(design: Source, *, folder: str | os.PathLike[str] | None = None) -> Design:
    """Solves a design: a path, or a dictionary whose spec is relative to `folder` (the working folder by default).

    Raises
    ------
    InputError
        The design or its spec is invalid.
    UntrustedError
        The structure is a mechanism.
    """
    return Design(_native.design(_inputs.given(design, "design", folder)))


class Design:
    """The results of a static design. Numbers are those of `girderway design`, bit for bit."""

    def __init__(self, native: _native.Design) -> None:
        self._native = native

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The contents of `summary.json`."""
        return self._native.summary()

    @property
    def verdict(self) -> dict[str, Any]:
        """All checks, worst first, and what was not checked: `result`, `checks` and `not_checked`."""
        verdict: dict[str, Any] = self.summary["verdict"]
        return verdict

    @property
    def extremes(self) -> list[dict[str, Any]]:
        """Extremes of every span, reaction and named section, each with the position that governs."""
        extremes: list[dict[str, Any]] = self.summary["extremes"]
        return extremes

    @cached_property
    def envelope(self) -> dict[str, Any]:
        """The columns of `envelope.csv`: arrays of numbers, lists of words."""
        return self._native.table("envelope")

    @cached_property
    def reactions(self) -> dict[str, Any]:
        """The columns of `reactions.csv`."""
        return self._native.table("reactions")

    @cached_property
    def influence_lines(self) -> dict[str, Any]:
        """The columns of `influence.csv`: influence lines of the values that govern."""
        return self._native.table("influence")

    @property
    def within(self) -> bool:
        """Whether every limit and strength is kept."""
        return bool(self.summary["within"])

    @property
    def warnings(self) -> list[str]:
        """What the design does not cover."""
        return list(self.summary["warnings"])

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Writes what `girderway design` would; files of others are replaced only with `force`."""
        return Path(self._native.save(os.fspath(path), force))

    def to_dataframe(self, library: str | None = None) -> Any:
        """The envelope as a data frame of pandas or polars."""
        return _frames.data_frame(self.envelope, library)

    def plot(self, quantity: str = "moment", plane: str = "vertical", case: int = 1, ax: Any = None) -> Any:
        """Draws the envelope of a quantity with matplotlib; returns the axes."""
        ax = _frames.axes(ax)
        rows = self.envelope
        for kind in ("max", "min"):
            keys = zip(rows["case"], rows["quantity"], rows["plane"], rows["kind"])
            at = [k for k, key in enumerate(keys) if (int(key[0]), *key[1:]) == (case, quantity, plane, kind)]
            ax.plot(rows["x"][at], rows["value"][at], label=kind)
        ax.set_xlabel(f"x ({self.summary['units']['length']})")
        ax.set_ylabel(f"{plane} {quantity}")
        ax.grid(True, linewidth=0.4, alpha=0.6)
        ax.legend()
        return ax

    def __repr__(self) -> str:
        return f"<girderway.Design {self.summary['name']}: {len(self.extremes)} extremes>"

    def _repr_html_(self) -> str:
        spans = [one for one in self.extremes if "span" in one]
        rows = [(e["case"], e["rail"], e["span"], e["plane"], e["quantity"], e["kind"], e["value"], e["x"]) for e in spans]
        head = ["case", "rail", "span", "plane", "quantity", "kind", "value", "x"]
        return _html.table(f"Design {self.summary['name']}", head, rows)
