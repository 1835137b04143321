"""Runs of scenes: histories as arrays, summaries, comparisons; many runs on all threads."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, overload

import numpy as np
import numpy.typing as npt

from . import _frames, _html, _inputs, _native
from ._errors import UntrustedError

if TYPE_CHECKING:
    from ._inputs import Source

Floats = npt.NDArray[np.float64]
T = TypeVar("T")
Progress = Callable[[float], object]


class Case(Mapping[str, Floats]):
    """One run: the scene itself or one of its comparisons.

    It is a mapping of the columns of `history.csv` to arrays, which are views that cannot be written and equal to the
    columns of the file to the last bit.
    """

    def __init__(self, native: _native.Run, index: int) -> None:
        self._native = native
        self._index = index

    @property
    def label(self) -> str:
        """Label of the comparison; of the scene itself the foundations of its structures."""
        return self._native.labels[self._index]

    @cached_property
    def history(self) -> dict[str, Floats]:
        """The columns by name."""
        return self._native.columns(self._index)

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return list(self.history)

    @property
    def time(self) -> Floats:
        """The time of each row, s."""
        return self.history["time"]

    @cached_property
    def units(self) -> dict[str, str]:
        """Unit of each column."""
        return self._native.units(self._index)

    @cached_property
    def envelope(self) -> dict[str, Any]:
        """The columns of `envelope.csv`: arrays of numbers, lists of words; empty without girders."""
        return self._native.envelope(self._index)

    @property
    def summary(self) -> dict[str, Any]:
        """The part of `summary.json` about this run."""
        return self._whole["compare"][self.label] if self._index else self._whole

    @cached_property
    def _whole(self) -> dict[str, Any]:
        return self._native.summary()

    @property
    def verdict(self) -> dict[str, Any] | None:
        """All checks, worst first, and what was not checked: `result`, `checks` and `not_checked`; `None` where the run did
        not reach its end."""
        return self.summary.get("verdict")

    @property
    def extremes(self) -> list[dict[str, Any]]:
        """Extremes of the girders and reactions, each with its time."""
        return list(self.summary.get("extremes", []))

    def __getitem__(self, column: str) -> Floats:
        try:
            return self.history[column]
        except KeyError:
            from difflib import get_close_matches

            near = get_close_matches(column, self.columns, 3)
            hint = f"; did you mean {', '.join(near)}?" if near else f"; columns: {', '.join(self.columns)}"
            raise KeyError(f"no column {column!r}{hint}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self.history)

    def __len__(self) -> int:
        return len(self.history)

    def to_dataframe(self, library: str | None = None) -> Any:
        """The history as a data frame of pandas or polars."""
        return _frames.data_frame(self.history, library)

    def plot(self, *columns: str, x: str = "time", ax: Any = None) -> Any:
        """Draws columns over `x` with matplotlib, the deflections of the bodies by default; returns the axes."""
        names = columns or tuple(name for name in self.columns if name.endswith(".deflection"))
        ax = _frames.lines(_frames.axes(ax), self[x], [(name, self[name]) for name in names])
        ax.set_xlabel(f"{x} ({self.units[x]})")
        if names and len({self.units[name] for name in names}) == 1:
            ax.set_ylabel(f"{names[0] if len(names) == 1 else ''} ({self.units[names[0]]})".strip())
        return ax

    def __repr__(self) -> str:
        return f"<girderway.{type(self).__name__} {self.label}: {len(self.time)} rows of {len(self)} columns>"

    def _repr_html_(self) -> str:
        rows = [
            (name, self.units[name], float(values.min()), float(values.max()))
            for name, values in self.history.items()
            if values.size
        ]
        return _html.table(repr(self)[1:-1], ["column", "unit", "min", "max"], rows)


class Run(Case):
    """A run of a scene and of its comparisons. Nothing is written before `save`."""

    def __init__(self, native: _native.Run) -> None:
        super().__init__(native, 0)

    @cached_property
    def comparisons(self) -> dict[str, Case]:
        """The comparisons of the scene by label."""
        cases = [Case(self._native, index) for index in range(1, len(self._native.labels))]
        return {case.label: case for case in cases}

    @cached_property
    def messages(self) -> list[str]:
        """Warnings and notes, as the command line prints them."""
        return self._native.messages()

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Writes what `girderway run` would: histories, grids, tables, summary, pictures, report and manifest.

        Files of others in the folder are replaced only with `force`.
        """
        return Path(self._native.save(os.fspath(path), force))


def _patch(changes: Mapping[str, Any] | None) -> str | None:
    return None if changes is None else _inputs.text(changes, "changes")


def run(
    scene: Source,
    changes: Mapping[str, Any] | None = None,
    *,
    folder: str | os.PathLike[str] | None = None,
    comparisons: bool = True,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Run:
    """Solves the structures of a scene and runs it. Numbers are those of `girderway run`, bit for bit.

    Extremes of girders take many times as long as a run; they are computed when `extremes`, `summary`, `envelope`,
    `messages` or `save` first asks for them.

    Parameters
    ----------
    scene:
        Path of a scene, or a dictionary with its members; the files that a dictionary names are relative to `folder`
        (the working folder by default).
    changes:
        A merge patch (RFC 7386) under the rules of `compare`: it cannot concern `format`, `units`, `name` and
        `compare`.
    comparisons:
        Whether the comparisons of the scene are run as well.
    threads:
        Largest number of threads; as many as the machine has by default. Results do not depend on it.
    progress:
        Called from this thread with the fraction that is done, 0 to 1. An exception stops the run and is raised.

    Raises
    ------
    InputError
        The scene, the changes or a file is invalid.
    UntrustedError
        A structure is a mechanism, or a run did not reach its end; then `run` of the exception is the run so far.
    KeyboardInterrupt
        Ctrl-C stops the run.
    """
    source = _inputs.given(scene, "scene", folder)
    try:
        return Run(_native.run(source, _patch(changes), comparisons, threads, progress))
    except UntrustedError as error:
        raise _with_run(error) from None


def _with_run(error: UntrustedError) -> UntrustedError:
    if isinstance(error.run, _native.Run):
        error.run = Run(error.run)
    return error


@overload
def map(
    scene: Source,
    patches: Iterable[Mapping[str, Any]],
    *,
    each: None = None,
    threads: int | None = None,
    comparisons: bool = False,
    folder: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    errors: str = "raise",
) -> list[Run]: ...


@overload
def map(
    scene: Source,
    patches: Iterable[Mapping[str, Any]],
    *,
    each: Callable[[Run], T],
    threads: int | None = None,
    comparisons: bool = False,
    folder: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    errors: str = "raise",
) -> list[T]: ...


def map(
    scene: Source,
    patches: Iterable[Mapping[str, Any]],
    *,
    each: Callable[[Run], Any] | None = None,
    threads: int | None = None,
    comparisons: bool = False,
    folder: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    errors: str = "raise",
) -> list[Any]:
    """Runs a scene once for each patch, on all threads. Files are read once, equal structures are solved once.

    Parameters
    ----------
    scene, folder, threads, progress:
        As in `run`.
    patches:
        The changes of each run.
    each:
        Called with each run as soon as it ends, from any thread; what it returns is kept in place of the run, so that
        histories need not stay in memory.
    comparisons:
        Whether the comparisons of the scene are run as well; not by default.
    errors:
        `"raise"`: the exception of the first run that has one is raised at the end; `"return"`: exceptions stand in
        the places of such runs.

    Returns
    -------
    The runs, or what `each` made of them, in the order of the patches.
    """
    if errors not in ("raise", "return"):
        raise ValueError(f'errors must be "raise" or "return", got {errors!r}')
    texts = [_inputs.text(patch, "changes") for patch in patches]

    def made(native: _native.Run) -> Any:
        return Run(native) if each is None else each(Run(native))

    source = _inputs.given(scene, "scene", folder)
    results = _native.run_many(source, texts, comparisons, threads, progress, made)
    for index, result in enumerate(results):
        if isinstance(result, UntrustedError):
            _with_run(result)
        if errors == "raise" and isinstance(result, Exception) and not isinstance(result, Run):
            result.add_note(f"in run {index} of girderway.map") if hasattr(result, "add_note") else None
            raise result
    return results
