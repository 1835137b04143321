#!/usr/bin/env python3
"""How time and memory of girderway grow with spans, simulated time, rows and runs; prints the tables of docs/performance.md.

    python3 tests/performance/growth.py BINARY [--before BINARY] [--quick] [--only spans time rows runs]

Whole processes, each into a folder that does not exist: processor time of user and system, largest resident memory, and
the time by the clock for runs of a sweep on one and on two threads. Least of three runs, one where it takes over ten
seconds; with --before the two programs take turns. The girder is that of examples/runway/spec.json with n spans of 6 m
and 41 stations, under one truck of two wheels at 1.5 m/s. Exponents are between the last two rows.

Needs Python 3.11 and nothing else. Written for Linux: memory is read from the usage of child processes.
"""

import argparse
import json
import math
import os
import pathlib
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPAN, SPEED, AXLES = 6.0, 1.5, 1.8
REPETITIONS, LONG = 3, 10.0


def girder(spans, stations=41):
    """The spec of the runway with `spans` equal spans."""
    spec = json.loads((ROOT / "examples/runway/spec.json").read_text())
    spec["girder"]["spans"] = [SPAN] * spans
    length = SPAN * spans
    spec["stations"] = [length * k / (stations - 1) for k in range(stations)]
    return spec


def truck(end, dt, speed=((0.0, SPEED),)):
    """A scene on spec.json until `end`, with a row each `dt`."""
    return {
        "format": "girderway-scene/1", "name": "growth",
        "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.81,
        "structures": {"girder": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"crane": {"weight": 360, "inertia": [0, 0, 120], "dof": ["x", "y", "pitch"], "x0": 2.0}},
        "wheels": {"crane": {"radius": 0.2, "vertical": {"law": "linear", "k": 4e5, "c": 400}}},
        "trucks": [{"name": "truck", "body": "crane", "rail": "girder.rail", "tree": [-AXLES, AXLES], "wheel": "crane"}],
        "motions": [{"body": "crane", "dof": "x", "kind": "prescribed", "speed": [list(pair) for pair in speed]}],
        "end": {"time": end}, "output": {"dt": dt},
    }  # fmt: skip


def back_and_forth(end, way):
    """Speeds that turn each time after `way`."""
    period, speeds, sign = way / SPEED, [], 1.0
    for k in range(math.ceil(end / period)):
        at = k * period
        speeds += [(at, sign * SPEED)] if k == 0 else [(at - 0.05, -sign * SPEED), (at + 0.05, sign * SPEED)]
        sign = -sign
    return speeds


def once(command, folder):
    """Processor time, time by the clock, and largest memory in MB of one process."""
    began = time.perf_counter()
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    errors = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    process.stderr.close()
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}: {errors.decode()}")
    return usage.ru_utime + usage.ru_stime, time.perf_counter() - began, usage.ru_maxrss / 1024


def least(binaries, files, arguments, repetitions=REPETITIONS):
    """For each binary the least times and the largest memory; the programs take turns."""
    found = {binary: [] for binary in binaries}
    for _ in range(repetitions):
        for binary in binaries:
            with tempfile.TemporaryDirectory() as folder:
                for name, content in files.items():
                    (pathlib.Path(folder) / name).write_text(json.dumps(content))
                found[binary].append(once([binary, *arguments, "-o", "out"], folder))
        if max(run[0] for runs in found.values() for run in runs) > LONG:
            break
    return [(min(r[0] for r in runs), min(r[1] for r in runs), max(r[2] for r in runs)) for runs in found.values()]


def told(seconds):
    return f"{1e3 * seconds:.0f} ms" if seconds < 1.0 else f"{seconds:.2f} s"


def exponent(sizes, values):
    return math.log(values[-1] / values[-2]) / math.log(sizes[-1] / sizes[-2])


def table(title, heads, sizes, columns):
    """Rows by size; each column is a list of (time, memory), or of times alone."""
    print(f"\n{title}\n\n| " + " | ".join(heads) + " |\n" + "|---" * len(heads) + "|")
    for k, size in enumerate(sizes):
        cells = [f"{told(c[k][0])}, {c[k][1]:.0f} MB" if isinstance(c[k], tuple) else told(c[k]) for c in columns]
        print(f"| {size} | " + " | ".join(cells) + " |")
    powers = []
    for column in columns:
        if isinstance(column[0], tuple):
            powers.append(", ".join(f"{exponent(sizes, [cell[k] for cell in column]):.1f}" for k in (0, 1)))
        else:
            powers.append(f"{exponent(sizes, column):.2f}")
    print("| exponent | " + " | ".join(powers) + " |", flush=True)


def by_size(binaries, sizes, files, arguments):
    """A column for each binary."""
    found = [least(binaries, files(size), arguments) for size in sizes]
    return [[(row[k][0], row[k][2]) for row in found] for k in range(len(binaries))]


def names(binaries):
    return ["before", "after"][-len(binaries) :]


def compared(binaries, sizes, title, what, jobs):
    """A table of some jobs, each the files for a size and the arguments of the command."""
    columns = [column for files, arguments in jobs for column in by_size(binaries, sizes, files, arguments)]
    heads = [f"{job}: {name}" for job in what for name in names(binaries)]
    table(title, [title.lower(), *heads], sizes, columns)


RUN = ["run", "--quiet", "--threads", "1", "scene.json"]


def spans(binaries, quick):
    def crossing(end):
        return lambda n: {"spec.json": girder(n), "scene.json": truck(end(n), 0.01)}

    jobs = [(crossing(lambda n: 1.3), RUN), (crossing(lambda n: (SPAN * n - 4.0) / SPEED), RUN)]
    jobs.append((lambda n: {"spec.json": girder(n)}, ["fea", "--quiet", "spec.json"]))
    sizes = [1, 16, 64] if quick else [1, 16, 64, 256, 480]
    compared(binaries, sizes, "Spans", ["1.3 s", "end to end", "`fea`"], jobs)


def simulated(binaries, quick):
    def crossing(count, scene):
        return lambda k: {"spec.json": girder(count), "scene.json": scene(k)}

    jobs = [
        (crossing(160, lambda k: truck(9.6 * k, 0.01)), RUN),
        (crossing(160, lambda k: truck(9.6 * k, 9.6e-3 * k)), RUN),
        (crossing(3, lambda k: truck(19.2 * k, 0.01, back_and_forth(19.2 * k, 14.0))), RUN),
    ]
    what = ["times 9.6 s, 160 spans", "the same, 1,000 rows", "times 19.2 s, to and fro"]
    compared(binaries, [1, 4] if quick else [1, 4, 16, 64], "Times", what, jobs)


def rows(binaries, quick):
    sizes = [100, 1000] if quick else [100, 1000, 10_000, 100_000]
    files = lambda n: {"spec.json": girder(3), "scene.json": truck(9.0, 9.0 / n)}  # noqa: E731
    table("Rows of 9 s on three spans", ["rows", *names(binaries)], sizes, by_size(binaries, sizes, files, RUN))


def runs(binaries, quick):
    sizes = [16, 64] if quick else [16, 64, 256]
    bogie = ROOT / "examples/bogie"
    files = {name: json.loads((bogie / name).read_text()) for name in ("scene.json", "spec.json", "sweep.json")}
    own = files["scene.json"]
    own.pop("compare", None)
    columns, heads = [], []
    for binary, name in zip(binaries, names(binaries)):
        for threads in ("1", "2"):
            found = []
            for count in sizes:
                changed = files | {"sweep.json": files["sweep.json"] | {"count": count}}
                found += least([binary], changed, ["sweep", "--quiet", "--threads", threads, "sweep.json"])
            columns += [[(run[0], run[2]) for run in found], [run[1] for run in found]]
            heads += [f"{name}, {threads} threads: processor", "clock"]
    table("Runs of a sweep of the bogie", ["runs", *heads], sizes, columns)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("--before", type=pathlib.Path, help="a program to take turns with")
    parser.add_argument("--quick", action="store_true", help="fewer sizes")
    jobs = {"spans": spans, "time": simulated, "rows": rows, "runs": runs}
    parser.add_argument("--only", nargs="+", choices=jobs, default=list(jobs))
    options = parser.parse_args()
    binaries = [str(binary.resolve()) for binary in (options.before, options.binary) if binary]
    for name in options.only:
        jobs[name](binaries, options.quick)


if __name__ == "__main__":
    main()
