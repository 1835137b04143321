"""A sweep on the workers of Dask, which share a file system with the caller.

>>> from dask.distributed import Client
>>> from girderway.dask import sweep
>>> sweep(Client("tcp://scheduler:8786"), "sweep.json", "out", shards=64)  # doctest: +SKIP
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .sweep import StrPath, Sweep, join_shards
from .sweep import sweep as _sweep


def _shard(file: str, folder: str, shard: tuple[int, int], threads: int) -> str:
    return str(_sweep(file, folder, shard=shard, threads=threads).folder)


def sweep(client: Any, sweep: StrPath, output: StrPath, *, shards: int, threads: int = 1, force: bool = False) -> Sweep:
    """Makes a sweep in shards on the workers of a `dask.distributed.Client` and joins them in `output`.

    Each shard has a folder beside `output`. A shard whose worker dies is made by another worker, which resumes after
    the runs that are made; so does a later call after the whole cluster was lost. `threads` is that of one shard.
    """
    file, target = str(Path(sweep).resolve()), Path(output).resolve()
    folders = [str(target.with_name(f"{target.name}-{k}-of-{shards}")) for k in range(1, shards + 1)]
    numbers = [(k, shards) for k in range(1, shards + 1)]
    made = client.map(_shard, [file] * shards, folders, numbers, [threads] * shards, pure=False)
    return join_shards(client.gather(made), target, force=force)
