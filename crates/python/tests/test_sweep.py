"""Sweeps: the bytes of the command line, in shards, and on the workers of Dask with one of them killed."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path

import pytest

import girderway as gw

SWEEP = {
    "format": "girderway-sweep/1",
    "name": "scatter",
    "scene": "scene.json",
    "axes": {
        "/bodies/crane/weight": {"lognormal": [330, 30]},
        "/motions/0/speed/0/1": {"uniform": [0.5, 1.7]},
        "/structures/girder/foundation": ["influence", "rigid"],
    },
    "sampling": "sobol",
    "count": 48,
    "results": ["ratios", "girder.midspan"],
}


@pytest.fixture
def runway(tmp_path: Path, examples: Path) -> Path:
    for name in ("scene.json", "spec.json"):
        shutil.copy(examples / "runway" / name, tmp_path)
    (tmp_path / "sweep.json").write_text(json.dumps(SWEEP))
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    files = (path for path in sorted(folder.rglob("*")) if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def test_a_sweep_writes_the_bytes_of_the_command_line(runway: Path, girderway: str) -> None:
    subprocess.run([girderway, "sweep", "sweep.json", "-o", "line", "--quiet"], check=True, cwd=runway)
    fractions: list[float] = []
    made = gw.sweep(runway / "sweep.json", runway / "package", progress=fractions.append)
    assert contents(runway / "package") == contents(runway / "line")
    assert fractions[-1] == 1.0
    assert made.summary["with_results"] + len(made.failures) == 48
    assert all("must stay on rail" in reason for reason in made.failures.values()) and made.failures


def test_shards_join_and_wrong_ones_are_refused(runway: Path) -> None:
    whole = gw.sweep(runway / "sweep.json", runway / "whole")
    for k in (1, 2):
        gw.sweep(runway / "sweep.json", runway / f"shard{k}", shard=(k, 2))
    joined = gw.join_shards([runway / "shard1", runway / "shard2"], runway / "joined")
    assert contents(joined.folder) == contents(whole.folder)
    with pytest.raises(gw.InputError, match="needs all 2 shards"):
        gw.join_shards([runway / "shard1"], runway / "other")
    with pytest.raises(gw.InputError, match="K from 1 to N"):
        gw.sweep(runway / "sweep.json", runway / "other", shard=(3, 2))


def test_a_sweep_that_is_stopped_resumes(runway: Path) -> None:
    whole = gw.sweep(runway / "sweep.json", runway / "whole")

    def stop(fraction: float) -> None:
        if fraction > 0.2:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        gw.sweep(runway / "sweep.json", runway / "stopped", threads=1, progress=stop)
    made = len((runway / "stopped" / ".girderway-sweep").read_text().splitlines())
    assert made > 5
    again = gw.sweep(runway / "sweep.json", runway / "stopped")
    assert contents(again.folder) == contents(whole.folder)


def test_workers_of_dask_make_the_same_bytes_although_one_is_killed(runway: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="needs dask.distributed")
    from girderway.dask import sweep

    text = {**SWEEP, "count": 240}
    (runway / "sweep.json").write_text(json.dumps(text))
    whole = gw.sweep(runway / "sweep.json", runway / "whole")
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "host": "127.0.0.1"}
    with distributed.LocalCluster(dashboard_address=None, **options) as cluster, distributed.Client(cluster) as client:
        pids = list(client.run(os.getpid).values())

        def is_begun() -> bool:
            rows = runway.glob("out-*/.girderway-sweep")
            return sum(path.read_text().count("values") for path in rows) > 10

        from threading import Thread

        def kill() -> None:
            limit = time.monotonic() + 60
            while not is_begun() and time.monotonic() < limit:
                time.sleep(0.01)
            os.kill(pids[0], signal.SIGKILL)

        killer = Thread(target=kill)
        killer.start()
        made = sweep(client, runway / "sweep.json", runway / "out", shards=4)
        killer.join()
        alive = list(client.run(os.getpid).values())
    assert pids[0] not in alive
    assert contents(made.folder) == contents(whole.folder)


def test_ctrl_c_stops_runs_at_work(tmp_path: Path, examples: Path):
    """Four runs of a scene in steps of a microsecond: to the end they take minutes."""
    import _thread

    for name in ("scene.json", "spec.json"):
        shutil.copy(examples / "bogie" / name, tmp_path)
    scene = json.loads((tmp_path / "scene.json").read_text())
    scene |= {"stepper": "sdirk4", "step": 1e-6}
    del scene["accuracy"], scene["compare"]
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    axes = {"/bodies/bogie/weight": {"uniform": [4e6, 5e6]}}
    kinds = {"sampling": "sobol", "count": 4, "results": ["peaks"]}
    sweep = {"format": "girderway-sweep/1", "name": "long", "scene": "scene.json", "axes": axes} | kinds
    (tmp_path / "sweep.json").write_text(json.dumps(sweep))
    # a shell that starts the tests in the background has it ignored
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.5, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        gw.sweep(tmp_path / "sweep.json", tmp_path / "out")
    timer.join()
    signal.signal(signal.SIGINT, before)
    assert not (tmp_path / "out" / "results.csv").exists()
