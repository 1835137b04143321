"""Random scenes of wheels on girders and frames, run with "auto" as a user runs them, judged by other runs.

    python3 tests/selector/wide.py PROGRAM [--seed N] [--first N] [--scenes N] [--jobs N]

Each scene is run twice with "auto", by extremes and by values at equal times, and compared in every recorded column with
two references that differ in their discretization: a mesh, and natural modes. Where these differ by more than half of
the tolerance and did not take long, two more, in natural modes, are run with finer steps, because the accelerations of
high modes, which enter reactions and internal forces, keep the errors of the steps longest. The two references that are
nearest to each other count, and the error is the smaller one of those from either; where "auto" chose the foundation of
one of them, it is the error from the other. A scene in which they still differ by more than half of the tolerance is
counted, not judged. In runs of more than 100 bounces of the wheels extremes are those of the whole run and of all wheels
of a body, as the measure is defined. CPU times are those of whole processes: of "auto", and of the same scene on the
foundation that was chosen, with the accuracy that "auto" runs it with. One line for each run, and a summary at the end.
"""

import argparse
import bisect
import csv
import json
import math
import os
import random
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

E, G, DENSITY, GRAVITY = 210e9, 81e9, 7850.0, 9.81
UNITS = {"length": "m", "force": "N", "time": "s"}


def decades(draw, low, high):
    """A number between two bounds, uniform in its logarithm."""
    return low * (high / low) ** draw.random()


class Girder:
    """A girder or a frame of one to four spans along x."""

    def __init__(self, draw):
        span = decades(draw, 4, 30)
        self.spans = [span * draw.uniform(0.7, 1.3) for _ in range(draw.choice([1, 1, 2, 3, 4]))]
        self.longest = max(self.spans)
        overhangs = [draw.choice([0, 0, 0, 0.25]) * self.spans[end] for end in (0, -1)]
        self.inertia = decades(draw, 1e-4, 3e-2) * (self.longest / 10) ** 2
        self.area = 1.5 * self.inertia**0.5
        self.theory = draw.choice(["euler-bernoulli", "timoshenko"])
        if draw.random() < 0.67:
            self.spec, self.ends = self.short(overhangs), (-overhangs[0], sum(self.spans) + overhangs[1])
        else:
            self.spec, self.ends = self.frame(draw), (0.0, sum(self.spans))

    def frequency(self):
        """First frequency of the longest span, simply supported, Hz."""
        line = DENSITY * self.area
        return math.pi / (2 * self.longest**2) * math.sqrt(E * self.inertia / line)

    def short(self, overhangs):
        girder = {
            "spans": self.spans, "overhangs": overhangs, "E": E, "G": G, "A": self.area, "I_vertical": self.inertia,
            "I_lateral": 0.3 * self.inertia, "J": 0.1 * self.inertia, "mass_per_length": DENSITY * self.area,
        }
        if self.theory == "timoshenko":
            girder["kA_vertical"] = 0.4 * self.area
        effects = [{"name": "mid", "x": self.spans[0] / 2}, {"name": "end", "x": 0.9 * self.spans[0]}]
        stations = [-overhangs[0], sum(self.spans) + overhangs[1]]
        return {**self.head(), "girder": girder, "stations": stations, "effects": effects}

    def head(self):
        return {"format": "girderway-beam/1", "name": "g", "units": UNITS, "theory": self.theory}

    def frame(self, draw):
        """Spans on supports or columns, with hinges and changes of section."""
        has_columns = draw.random() < 0.4
        height = decades(draw, 3, 8) if has_columns else 0.0
        has_hinge, has_change = len(self.spans) > 1 and draw.random() < 0.5, draw.random() < 0.5
        points, members, supports, rail = [], [], [], []

        def point(x, y):
            points.append([x, y, 0.0])
            return len(points) - 1

        def member(ends, section, across, releases=((), ())):
            members.append((list(ends), section, across, [list(release) for release in releases]))
            return len(members) - 1

        places = [sum(self.spans[:i]) for i in range(len(self.spans) + 1)]
        tops = [point(x, height) for x in places]
        for i, top in enumerate(tops):
            if has_columns:
                foot = point(places[i], 0.0)
                member((foot, top), 1, [1, 0, 0])
                supports.append({"point": foot, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"]})
            else:
                supports.append({"point": top, "fix": ["ux"] * (i == 0) + ["uy", "uz", "rx"]})
        for i, span in enumerate(self.spans):
            begin, end, is_hinged = tops[i], tops[i + 1], has_hinge and i > 0 and (has_columns or i == 1)
            if is_hinged and has_columns:
                rail.append(member((begin, end), 0, [0, 1, 0], (["rz"], [])))
            elif is_hinged or has_change:
                middle = point(places[i] + (0.2 if is_hinged else 0.6) * span, height)
                rail.append(member((begin, middle), 0, [0, 1, 0], ([], ["rz"] if is_hinged else [])))
                rail.append(member((middle, end), 2 if has_change else 0, [0, 1, 0]))
            else:
                rail.append(member((begin, end), 0, [0, 1, 0]))
        columns = list(zip(*members))
        data = {
            "section": [list(columns[1])], "orientation": [list(columns[2])],
            "release_a": [[own[0] for own in columns[3]]], "release_b": [[own[1] for own in columns[3]]],
        }
        sections = [self.section(name, factor) for name, factor in (("girder", 1), ("column", 1.5), ("strong", 2.2))]
        return {
            **self.head(), "up": [0, 1, 0], "points": points, "cells": [{"type": "line", "data": list(columns[0])}],
            "cell_data": data, "materials": [{"name": "steel", "E": E, "G": G, "density": DENSITY}],
            "sections": sections, "supports": supports, "effects": [{"name": "mid", "cell": [0, rail[0]], "at": 0.5}],
            "rails": {"rail": {"origin": [0, height, 0], "axis": [1, 0, 0],
                               "segments": [{"cell": [0, cell]} for cell in rail], "stations": [0, places[-1]]}},
        }

    def section(self, name, factor):
        own = {"name": name, "material": "steel", "A": self.area * factor**0.5, "Iy": 0.3 * self.inertia * factor,
               "Iz": self.inertia * factor, "J": 0.1 * self.inertia * factor}
        shear = {"Asy": 0.4 * self.area, "Asz": 0.4 * self.area} if self.theory == "timoshenko" else {}
        return {**own, **shear}


def wheel(draw, mass, count, stiffness):
    """The vertical law of a wheel."""
    static = mass * GRAVITY / count / stiffness
    law = {"law": "linear", "k": stiffness}
    if draw.random() < 1 / 3:
        exponent = draw.choice([1.1, 1.5])
        law = {"law": "impact", "k": stiffness * static ** (1 - exponent), "exponent": exponent}
    ratio = draw.choice([0, decades(draw, 0.01, 0.3)])
    if ratio > 0:
        law["c"] = 2 * ratio * math.sqrt(stiffness * mass / count)
        law["damper"] = draw.choice(["rail", "rail", "ground"])
        if law["law"] == "impact":
            law["depth"] = 0.3 * static
    if law["law"] == "linear" and draw.random() < 0.2:
        law["bilateral"] = True
    return law, static


def irregularities(draw, static, ends, passed):
    """An uneven rail, or none."""
    if draw.random() > 0.35:
        return {}
    length = ends[1] - ends[0]
    size, kind = static * decades(draw, 0.02, 0.5), draw.choice(["joint", "dip", "sinusoid", "profile", "step"])
    own = {"kind": kind}
    if kind in ("joint", "dip"):
        own |= {"x": passed, "depth": size, "length": length * draw.uniform(0.03, 0.1)}
    elif kind == "step":
        own |= {"x": passed, "height": 0.3 * size}
    elif kind == "sinusoid":
        own |= {"amplitude": size, "length": length * draw.uniform(0.05, 0.3)}
    else:
        own["rows"] = [[ends[0] + length * i / 7, size * draw.uniform(-1, 1)] for i in range(8)]
    return {"irregularities": [own]}


def drawn(seed, index):
    """Spec, scene and tolerance of a random crossing."""
    draw = random.Random(seed * 1000003 + index)
    girder = Girder(draw)
    first, ends = girder.frequency(), girder.ends
    length = ends[1] - ends[0]
    bodies, wheels = draw.choice([1, 1, 1, 2]), draw.choice([1, 2, 2, 4, 8])
    wheels = min(wheels, 4) if bodies == 2 else wheels
    mass = decades(draw, 0.02, 20) * DENSITY * girder.area * girder.longest
    tolerance = draw.choice([1e-2, 1e-3])
    ratio, speed = decades(draw, 0.15, 15), decades(draw, 0.002, 0.9) * 2 * girder.longest * first
    law, static = wheel(draw, mass, wheels, mass * (2 * math.pi * first * ratio) ** 2 / wheels)
    base = min(0.25 * girder.longest, 0.12 * length) if wheels > 1 else 0.0
    tree = [base * (i / max(wheels - 1, 1) - 0.5) for i in range(wheels)]
    gap = 0.3 * length + base if bodies == 2 else 0.0
    low, high = ends[0] + base / 2, ends[1] - base / 2 - gap
    end, start = (high - low) / speed, low
    longest = 60 / first / min(ratio, 1)
    if end > longest:
        end, start = longest, draw.uniform(low, high - speed * longest)
    rows = [[0, speed]] if draw.random() < 0.75 else [[0, 0.3 * speed], [0.7 * end, speed]]
    scene = {
        "format": "girderway-scene/1", "name": f"scene {index}", "units": UNITS, "gravity": GRAVITY,
        "structures": {"g": {
            "spec": "spec.json", "damping": draw.choice([0.0, decades(draw, 1e-3, 0.1)]),
            "gauges": {"mid": {"x": ends[0] + length * draw.uniform(0.3, 0.7)}},
            **irregularities(draw, static, ends, start + speed * end * draw.uniform(0.3, 0.7)),
        }},
        "bodies": {}, "wheels": {"w": {"radius": 0.3, "vertical": law}}, "trucks": [], "motions": [],
        "end": {"time": 0.999 * end}, "output": {"dt": output_step(law, mass / wheels, end)}, "accuracy": 1e-4,
    }
    loads = []
    for b, name in enumerate("AB"[:bodies]):
        body = {"mass": mass, "dof": ["y"], "x0": start + b * gap}
        if wheels > 1:
            body |= {"dof": ["y", "pitch"], "inertia": [0, 0, mass * (0.4 * base) ** 2 * draw.uniform(0.5, 2)]}
        scene["bodies"][name] = body
        scene["trucks"].append({"name": f"t{name}", "body": name, "rail": "g.rail", "tree": tree, "wheel": "w"})
        scene["motions"].append({"body": name, "dof": "x", "kind": "prescribed", "speed": rows})
        if draw.random() < 0.25:
            at, ramp = end * draw.uniform(0.2, 0.6), end * draw.choice([1e-6, 0.1])
            force = -mass * GRAVITY * draw.uniform(0.1, 0.8) * draw.choice([1, 1, -1])
            loads.append({"body": name, "dof": "y", "value": [[0, 0], [at, 0], [at + ramp, force]]})
    return girder.spec, scene | ({"loads": loads} if loads else {}), tolerance


def output_step(law, share, end):
    """Output step that resolves the bounces on rigid rails, of which 500 to 10,000 rows are written."""
    exponent = law.get("exponent", 1.0)
    depth = (share * GRAVITY / law["k"]) ** (1 / exponent)
    bounce = 2 * math.pi * math.sqrt(share / (exponent * law["k"] * depth ** (exponent - 1)))
    return min(end / 500, max(bounce / 8, end / 10_000))


# Accuracy of the runs of "auto", relative to the tolerance.
RUN_ACCURACY = {"extremes": 2e-3, "history": 1e-3}
KINDS = {"x": "position", "speed": "speed", "pitch": "rotation", "penetration": "penetration"}
# CPU seconds of the first two references from which no finer ones are run.
LONG = 20
# CPU seconds after which a run is ended; such a reference is left out.
MOST = 300
# Number of bounces above which their phases are not known, so that the wheels of a body are one in the extremes.
MANY = 100
MOMENTS = {"Mx", "My", "Mz", "rx", "ry", "rz", "twist"}
LENGTHS = {"deflection", "rail_deflection", "mid"}


def scales(names, columns):
    """Scale of each column: its range with zero included, at least 1e-3 of the largest of its kind."""
    def kind(name):
        last = name.split(".")[-1]
        return KINDS.get(last) or ("moment" if last in MOMENTS else "length" if last in LENGTHS else "force")

    kinds, ranges = [kind(name) for name in names], []
    for own, column in zip(kinds, columns):
        start = column[0] if own == "position" else 0.0
        ranges.append(max(start, *column) - min(start, *column))
    largest = {own: max(r for k, r in zip(kinds, ranges) if k == own) for own in kinds}
    floors = {"moment": 1e-5 * largest.get("force", 0), "rotation": 1e-6 * largest.get("length", 0)}
    return [max(r, 1e-3 * largest[k], floors.get(k, 0)) for k, r in zip(kinds, ranges)]


def remembered(scene):
    """Number of bounces after which a run still depends on the phase of the first one, on rigid rails."""
    law, most = scene["wheels"]["w"]["vertical"], 0.0
    for truck in scene["trucks"]:
        mass, count = scene["bodies"][truck["body"]]["mass"], len(truck["tree"])
        exponent = law.get("exponent", 1.0)
        depth = (mass * GRAVITY / count / law["k"]) ** (1 / exponent)
        stiffness = count * exponent * law["k"] * depth ** (exponent - 1)
        ramp = min(depth / law.get("depth", depth), 1.0)
        damping = count * law.get("c", 0.0) * (ramp * ramp * (3 - 2 * ramp))
        omega = math.sqrt(stiffness / mass)
        bounces = scene["end"]["time"] * omega / (2 * math.pi)
        if damping > 0:
            bounces = min(bounces, math.log(100) * 2 * mass * omega / (2 * math.pi * damping))
        most = max(most, bounces)
    return most


def windows(time, period, bounces):
    """Windows of three periods that overlap by half, and the same widened by one, as ranges of rows; one in a run of more
    than 100 bounces."""
    count = int((time[-1] - time[0]) / (1.5 * period))
    if count < 2 or bounces > MANY:
        return [(0, len(time), 0, len(time))]
    spans = [(time[0] + 1.5 * period * k, time[0] + 1.5 * period * (k + 2)) for k in range(count - 1)]
    spans[-1] = (spans[-1][0], time[-1])
    left, right = bisect.bisect_left, bisect.bisect_right
    return [(left(time, a), right(time, b), left(time, a - period), right(time, b + period)) for a, b in spans]


def difference(a, b, measure, around):
    """Difference of two columns in a measure."""
    if measure == "history":
        return max(abs(x - y) for x, y in zip(a, b))
    worst = max(abs(max(a) - max(b)), abs(min(a) - min(b)))
    for p, q, first, last in around:
        worst = max(worst, max(a[p:q]) - max(b[first:last]), max(b[p:q]) - max(a[first:last]),
                    min(b[first:last]) - min(a[p:q]), min(a[first:last]) - min(b[p:q]),
                    abs(sum(a[p:q]) - sum(b[p:q])) / (q - p))
    return worst


def of_a_wheel(name):
    """Body and quantity of a column that belongs to a wheel, or None."""
    parts = name.split(".")
    return (parts[0], parts[-1]) if len(parts) == 3 and parts[1].startswith("wheel") else None


def judged(found, reference, measure, bounces):
    """The largest error of a column, and its name."""
    names, columns = reference
    if found[0] != names:
        return math.inf, "columns"
    index = {name: i for i, name in enumerate(names)}
    depths = [max(p + d for p, d in zip(columns[i], columns[index[name.replace("penetration", "rail_deflection")]]))
              for i, name in enumerate(names) if name.endswith(".penetration")]
    around = windows(columns[0], 2 * math.pi * math.sqrt(max(depths) / GRAVITY), bounces)
    rows = min(len(found[1][0]), len(columns[0]))
    sizes = scales(names[1:], columns[1:])

    def group_of(name):
        return of_a_wheel(name) if measure == "extremes" and bounces > MANY else None

    # wheels of a body are one quantity, with the largest of their scales
    largest = {}
    for name, size in zip(names[1:], sizes):
        largest[group_of(name)] = max(size, largest.get(group_of(name), 0))
    sizes = [largest[group_of(name)] if group_of(name) else size for name, size in zip(names[1:], sizes)]

    def ends(run, group):
        own = [column for name, column in zip(names, run) if of_a_wheel(name) == group]
        return max(map(max, own)), min(map(min, own))

    def of_column(i, name):
        group = group_of(name)
        if group:
            return max(abs(a - b) for a, b in zip(ends(found[1], group), ends(columns, group)))
        return difference(found[1][i][:rows], columns[i][:rows], measure, around)

    return max((of_column(i, name) / size, name) for i, (name, size) in enumerate(zip(names[1:], sizes), 1) if size > 0)


class Folder:
    """A folder with one scene and its runs."""

    def __init__(self, program, path, spec, scene):
        self.program, self.path, self.scene = program, path, scene
        (path / "spec.json").write_text(json.dumps(spec))

    def run(self, name, accuracy=1e-4, **structure):
        """Runs the scene on a foundation; returns CPU seconds, history and summary, or the message of a refusal."""
        scene = json.loads(json.dumps(self.scene)) | {"accuracy": accuracy}
        scene["structures"]["g"] |= structure
        (self.path / f"{name}.json").write_text(json.dumps(scene))
        words = ["sh", "-c", f'ulimit -t {MOST}; exec "$0" "$@"']
        words += [self.program, "run", f"{name}.json", "-o", name, "--force", "--threads", "1"]
        process = subprocess.Popen(words, cwd=self.path, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        message = process.stderr.read().decode()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        cpu = usage.ru_utime + usage.ru_stime
        if process.returncode != 0:
            return cpu, None, (message.strip().splitlines() or [f"ended after {MOST} s"])[-1]
        with open(self.path / name / "history.csv", newline="") as file:
            rows = list(csv.reader(file))
        columns = [[float(value) for value in column] for column in zip(*rows[1:])]
        return cpu, (rows[0], columns), json.loads((self.path / name / "summary.json").read_text())


# Structures of the references and their accuracies, relative to the tolerance.
REFERENCES = {
    "usual": [({"foundation": "full", "elements": 24}, 1e-3), ({"foundation": "modal", "modes": 64}, 3e-3)],
    "finer steps": [({"foundation": "modal", "modes": 64}, 1e-4), ({"foundation": "modal", "modes": 96}, 3e-5)],
    "finer meshes": [({"foundation": "full", "elements": 64}, 1e-3), ({"foundation": "modal", "modes": 192}, 3e-4)],
}


class References:
    """Runs of one scene on other foundations, by kind; those that are refused are left out."""

    def __init__(self, folder, tolerance):
        self.folder, self.tolerance, self.known = folder, tolerance, {}

    def add(self, kind):
        """Makes the references of a kind; returns their CPU seconds."""
        runs = [self.folder.run("reference", accuracy * self.tolerance, **structure)
                for structure, accuracy in REFERENCES[kind]]
        structures = [structure for structure, _ in REFERENCES[kind]]
        self.known[kind] = [(own, run[1]) for own, run in zip(structures, runs) if run[1]]
        return sum(run[0] for run in runs)

    def nearest(self, measure, bounces):
        """The two references of different discretizations that are nearest to each other, after their difference."""
        known = [reference for kind in self.known.values() for reference in kind]
        pairs = [(judged(a, b, measure, bounces)[0], i, j) for i, (own, a) in enumerate(known)
                 for j, (other, b) in enumerate(known[:i]) if other != own]
        apart, i, j = min(pairs, default=(math.inf, 0, 0))
        return apart, [known[i], known[j]] if pairs else []


def examined(program, seed, index):
    """Both runs of one scene with "auto", as dictionaries."""
    spec, scene, tolerance = drawn(seed, index)
    bounces = remembered(scene)
    with tempfile.TemporaryDirectory() as path:
        folder = Folder(program, Path(path), spec, scene)
        references = References(folder, tolerance)
        cost = references.add("usual")
        for measure in ("extremes", "history"):
            out = {"scene": index, "measure": measure, "tolerance": tolerance}
            cpu, found, summary = folder.run("auto", foundation="auto", tolerance=tolerance, measure=measure)
            if found is None:
                yield out | {"state": "refused", "why": summary}
                continue
            apart, pair = references.nearest(measure, bounces)
            if apart > tolerance / 2 and list(references.known) == ["usual"] and cost < LONG:
                references.add("finer steps")
                apart, pair = references.nearest(measure, bounces)
            if not pair:
                yield out | {"state": "no reference"}
                continue
            choice = summary["foundation"]["g"]
            chosen = choice["reason"].split(";")[0].removeprefix("auto: ")
            fixed = {"foundation": chosen.split(",")[0]}
            if fixed["foundation"] == "modal":
                fixed["modes"] = int(chosen.split()[1])
            own, _, _ = folder.run("own", min(1e-4, RUN_ACCURACY[measure] * tolerance), **fixed)
            others = [history for structure, history in pair if structure != fixed]
            error = min(judged(found, reference, measure, bounces) for reference in others)
            warned = any("estimated error" in warning or "not known" in warning for warning in summary.get("warnings", []))
            if error[0] > tolerance and not warned and cost < LONG:
                if "finer meshes" not in references.known:
                    references.add("finer meshes")
                finest = [history for _, history in references.known["finer meshes"]]
                if len(finest) == 2:
                    apart = judged(*finest, measure, bounces)[0]
                    error = min(judged(found, reference, measure, bounces) for reference in finest)
            state = "within" if error[0] <= tolerance else "warned" if warned else "silent"
            yield out | {"state": state if apart <= tolerance / 2 else f"{state}, reference not converged",
                         "chosen": chosen, "estimate": choice["estimate"], "error": error, "references": apart,
                         "cpu": cpu, "ratio": cpu / own}


def summed(results, measure):
    """The summary of one measure."""
    own = [result for result in results if result["measure"] == measure]
    states = {state: sum(r["state"] == state for r in own) for state in sorted({r["state"] for r in own})}
    ratios = sorted(result["ratio"] for result in own if "ratio" in result)
    at = lambda share: ratios[int(share * (len(ratios) - 1))] if ratios else math.nan
    return f"{measure}: {states}; CPU by that of the chosen foundation: median {at(0.5):.2f}, 99 % {at(0.99):.2f}, most {at(1):.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first scene")
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    program, results = str(Path(options.program).resolve()), []
    with ThreadPoolExecutor(options.jobs) as threads:
        for both in threads.map(lambda index: list(examined(program, options.seed, index)),
                                 range(options.first, options.first + options.scenes)):
            results += both
            for result in both:
                print(json.dumps(result), flush=True)
    for measure in ("extremes", "history"):
        print(summed(results, measure))


if __name__ == "__main__":
    main()
