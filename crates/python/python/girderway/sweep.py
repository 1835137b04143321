"""Sweeps: many runs of a scene or design with other values of some of its numbers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Union

from . import _native

#: A path of a file or folder.
StrPath = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class Sweep:
    """The results of a sweep or of a shard; the tables are in the folder."""

    #: The folder with `results.csv`, `results.parquet`, `failures.csv`, `summary.json` and `report.html`.
    folder: Path
    #: The contents of `summary.json`.
    summary: dict[str, Any]
    #: Reason of each run without results, by its number.
    failures: dict[int, str]


def sweep(
    sweep: StrPath,
    output: StrPath,
    *,
    shard: tuple[int, int] | None = None,
    threads: int | None = None,
    force: bool = False,
    progress: Callable[[float], object] | None = None,
) -> Sweep:
    """Makes the runs of a sweep file and writes what `girderway sweep` writes, byte for byte.

    Each run is kept in the folder as it is made: after any interruption the same call resumes there. `shard=(k, n)`
    makes every n-th run from run k; `join_shards` joins the shards. `progress` is called with the fraction that is done.

    Raises
    ------
    InputError
        The sweep or one of its files is invalid, or the folder has files of others or runs of another sweep.
    UntrustedError
        The scene or design cannot be run as it is written.
    KeyboardInterrupt
        Ctrl-C stops the runs at work. Those that are made stay in the folder.
    """
    return _written(
        _native.sweep(os.fspath(sweep), os.fspath(output), shard, threads, force, progress)
    )


def join_shards(shards: Iterable[StrPath], output: StrPath, *, force: bool = False) -> Sweep:
    """Joins the folders of all shards of a sweep; the files are those of the sweep made in one piece.

    Raises
    ------
    InputError
        Shards are missing, there twice, changed, or of different sweeps.
    """
    return _written(_native.join_shards([os.fspath(shard) for shard in shards], os.fspath(output), force))


def _written(written: tuple[Path, dict[str, Any], list[tuple[int, str]]]) -> Sweep:
    folder, summary, failures = written
    return Sweep(folder, summary, dict(failures))
