#!/usr/bin/env python3
"""Designs of random structures told otherwise: the same physics must have the same extremes.

Usage: same_trains.py GIRDERWAY [--designs 40] [--seed 1] [--keep FOLDER]. Needs numpy.

The designs are those of `brute_force.py`. Each is told again
- in mm and N, in and kip, ft and lbf;
- in the general form in place of the short one, or with more points under its rails;
- with other global axes (a turn that exchanges x, y, z, so that up is another axis too);
- with its rails in the other direction, and with all members from b to a;
- with points, cells, rails and the trains of cases listed in another order;
- with the wheels of trains that may be turned counted from the other end;
- with all loads twice and 1.7 times as large;
- with more freedom, which lowers no extreme: any order, no gap, no ends, both directions, both signs, trains that may enter,
  and one more train that may stay outside.

Extremes, reactions, values of named sections and deflections from chords are compared by the largest of their quantity; where the
program states another position or other signs for an equal value, that is counted. The exit status is 1 where a difference
exceeds 1e-9, or 1e-5 of deflections from chords.
"""

import argparse
import copy
import json
import pathlib
import sys
import tempfile

import numpy as np

from brute_force import DOFS, Checker, Frame, draw, general, solve, subdivided

FOOT, POUND = 0.3048, 4.4482216152605e-3
UNITS = {"mm N": ("mm", "N", 1e3, 1e3), "in kip": ("in", "kip", 12 / FOOT, 1e-3 / POUND), "ft lbf": ("ft", "lbf", 1 / FOOT, 1 / POUND)}


def in_units(spec, design, units):
    """Spec and design with their numbers in other units, from m and kN; the time stays."""
    length, force, l, f = units
    named = {"length": length, "force": force, "time": "s"}
    s, d = copy.deepcopy(spec), copy.deepcopy(design)
    s["units"], d["units"] = named, named
    times = lambda v, by: [times(e, by) for e in v] if isinstance(v, list) else v * by
    mass = f / l  # force time^2 / length

    def scale(of, powers):
        for key, by in powers.items():
            if of.get(key) is not None:
                of[key] = times(of[key], by)
    if "girder" in s:
        scale(s["girder"], {"spans": l, "overhangs": l, "E": f / l**2, "G": f / l**2, "A": l**2, "I_vertical": l**4,
                            "I_lateral": l**4, "J": l**4, "kA_vertical": l**2, "kA_lateral": l**2, "rail_height": l,
                            "mass_per_length": mass / l})
        scale(s, {"stations": l})
    else:
        scale(s, {"points": l})
        scale(s["cell_data"], {})
        for key in ("offset_a", "offset_b"):
            if key in s["cell_data"]:
                s["cell_data"][key] = [None if v is None else times(v, l) for v in s["cell_data"][key]]
        for m in s["materials"]:
            scale(m, {"E": f / l**2, "G": f / l**2, "density": mass / l**3})
        for c in s["sections"]:
            scale(c, {"A": l**2, "Iy": l**4, "Iz": l**4, "J": l**4, "Asy": l**2, "Asz": l**2})
        for k in s["springs"]:
            k["k"] *= f / l if k["dof"][0] == "u" else f * l
        for r in s["rails"].values():
            scale(r, {"origin": l, "stations": l})
            for g in r["segments"]:
                scale(g, {"offset": l})
    scale(d, {"gravity": l})
    if isinstance(d.get("dead_load"), dict):
        scale(d["dead_load"]["line"], {k: f / l for k in d["dead_load"]["line"]})
    if "spans" in d:
        scale(d["spans"], {k: l for k in d["spans"]})
    for t in d["trains"]:
        scale(t, {"ends": l, "lateral": f, "longitudinal": f, "eccentricity": l})
        for w in t["wheels"]:
            scale(w, {"x": l, "lateral": f, "longitudinal": f, "eccentricity": l})
            w["vertical"] = {k: v * f for k, v in w["vertical"].items()} if isinstance(w["vertical"], dict) else w["vertical"] * f
    for c in d["cases"]:
        if isinstance(c, dict):
            scale(c, {"gap": l})
    for c in d.get("sections", []):
        scale(c, {"x": l})
    return s, d, l, f


def as_general(spec, design):
    """A short form told in the general form, with the names of its reactions."""
    s, d = general(spec), copy.deepcopy(design)
    names = {v: k for k, v in s.pop("names").items()}
    s.pop("words")
    low = s["points"][0][0]
    s |= {"format": "girderway-beam/1", "units": spec["units"], "springs": [], "links": []}
    s["sections"][0]["name"] = "girder"
    s["cell_data"] = {"orientation": [[[0, 1, 0]] * len(s["cells"][0]["data"])]}
    s["rails"]["rail"]["stations"] = [low, s["points"][-1][0]]
    d["spans"] = {"rail": list(map(float, np.concatenate([[0.0], np.cumsum(spec["girder"]["spans"])])))}
    for c in d.get("sections", []):
        x = c.pop("x")
        k = next(k for k in range(len(s["points"]) - 1) if s["points"][k][0] <= x < s["points"][k + 1][0])
        c["cell"], c["place"] = [0, k], (x - s["points"][k][0]) / (s["points"][k + 1][0] - s["points"][k][0])
    return s, d, names


def divided(spec, design, rng):
    """More points under the rails."""
    frame = Frame(spec)
    places = {}
    for rail in frame.rails:
        low, high = frame.range(rail)
        places[rail] = list(rng.uniform(low, high, 3))
    s, new = subdivided(spec, places)
    d = copy.deepcopy(design)
    for c in d.get("sections", []):
        cells, at = new[tuple(c["cell"])]
        k = max(i for i in range(len(cells)) if at[i] <= c["place"] or i == 0)
        c["cell"], c["place"] = [c["cell"][0], cells[k]], (c["place"] - at[k]) / (at[k + 1] - at[k])
    return s, d


def turned_axes(spec, rng):
    """The structure in other global axes: spec, and the new axis and sign of each old one."""
    order = list(rng.permutation(3))
    signs = rng.choice([-1, 1], 3)
    turn = np.zeros((3, 3))
    for k in range(3):
        turn[order[k], k] = signs[k]
    if np.linalg.det(turn) < 0:
        turn[:, 2] *= -1
        signs[2] *= -1
    apply = lambda v: [float(x) + 0.0 for x in turn @ np.array(v, float)]
    word = lambda dof: dof[0] + "xyz"[order["xyz".index(dof[1])]]
    s = copy.deepcopy(spec)
    s["points"] = [apply(p) for p in s["points"]]
    s["up"] = apply([0, 1, 0])
    for key in ("offset_a", "offset_b", "orientation"):
        if key in s["cell_data"]:
            s["cell_data"][key] = [None if v is None else [apply(x) for x in v] for v in s["cell_data"][key]]
    for of in s["supports"]:
        of["fix"] = [word(f) for f in of["fix"]]
    for of in s["springs"]:
        of["dof"] = word(of["dof"])
    for r in s["rails"].values():
        r["axis"], r["origin"] = apply(r["axis"]), apply(r.get("origin", [0, 0, 0]))
        for g in r["segments"]:
            g["offset"] = apply(g["offset"])
    return s, {d: (word(d), float(signs["xyz".index(d[1])])) for d in DOFS}


def against(spec, design):
    """The rails in the other direction."""
    s, d = copy.deepcopy(spec), copy.deepcopy(design)
    for r in s["rails"].values():
        r["axis"] = [-v + 0.0 for v in r["axis"]]
        r["stations"] = [-x for x in r["stations"]][::-1]
    if "spans" in d:
        d["spans"] = {k: [-x for x in v][::-1] for k, v in d["spans"].items()}
    for t in d["trains"]:
        other_end(t)
        for of in [t, *t["wheels"]]:
            for key in ("lateral", "longitudinal", "eccentricity"):
                if key in of:
                    of[key] = -of[key]
    for k, c in enumerate(d["cases"]):
        if isinstance(c, dict):
            c["trains"] = c["trains"][::-1]
    return s, d


def other_end(train):
    """Counts the wheels of a train from its other end."""
    for w in train["wheels"]:
        w["x"] = 0.0 - w["x"]
    train["wheels"].reverse()
    if "ends" in train:
        train["ends"] = train["ends"][::-1]


def exchanged(spec, design):
    """Members from b to a."""
    s, d = copy.deepcopy(spec), copy.deepcopy(design)
    data = s["cell_data"]
    flipped = set()
    for block, cells in enumerate(s["cells"]):
        for k, ends in enumerate(cells["data"]):
            section_b = data.get("section_b")
            if section_b and section_b[block] and section_b[block][k] is not None:
                continue
            flipped.add((block, k))
            ends.reverse()
            for a, b in (("offset_a", "offset_b"), ("release_a", "release_b")):
                default = [0, 0, 0] if a.startswith("offset") else []
                for key in (a, b):
                    if (a in data or b in data) and key not in data:
                        data[key] = [None if kind is None else [default] * len(c["data"]) for c, kind in
                                     zip(s["cells"], data.get(a, data.get(b)))]
                if a in data and data[a][block] is not None:
                    data[a][block][k], data[b][block][k] = data[b][block][k], data[a][block][k]
    signs = {}
    for c in d.get("sections", []):
        if tuple(c["cell"]) in flipped:
            c["place"] = 1 - c["place"]
            signs[c["name"]] = -1.0 if c["component"] in ("Vy", "My") else 1.0
    return s, d, signs


def shuffled(spec, design, rng):
    """Points, cells, rails and trains in another order: with the new names of points."""
    s, d = copy.deepcopy(spec), copy.deepcopy(design)
    order = rng.permutation(len(s["points"]))
    new = {int(old): k for k, old in enumerate(order)}
    s["points"] = [s["points"][old] for old in order]
    cell_of = {}
    for block, cells in enumerate(s["cells"]):
        own = list(map(int, rng.permutation(len(cells["data"]))))
        cells["data"] = [[new[p] for p in cells["data"][k]] for k in own]
        for data in s["cell_data"].values():
            if isinstance(data[block], list):
                data[block] = [data[block][k] for k in own]
        cell_of |= {(block, old): [block, k] for k, old in enumerate(own)}
    for of in s["supports"] + s["springs"]:
        of["point"] = new[of["point"]]
    for of in s["links"]:
        of["from"], of["to"] = new[of["from"]], new[of["to"]]
    first = next(iter(s["rails"]))
    for r in s["rails"].values():
        r["segments"] = [dict(g, cell=cell_of[tuple(g["cell"])]) for g in r["segments"]]
    s["rails"] = dict(reversed(s["rails"].items()))
    for c in d.get("sections", []):
        c["cell"] = cell_of[tuple(c["cell"])]
    for t in d["trains"]:
        t.setdefault("rail", first)
    for c in d["cases"]:
        if isinstance(c, dict) and c.get("order") != "given":
            c["trains"] = c["trains"][::-1]
    return s, d, {f"point{old}": f"point{k}" for old, k in new.items()}


def heavier(design, by):
    """All loads times a factor."""
    d = copy.deepcopy(design)
    for t in d["trains"]:
        for of in [t, *t["wheels"]]:
            for key in ("lateral", "longitudinal"):
                if key in of:
                    of[key] *= by
        for w in t["wheels"]:
            w["vertical"] = {k: v * by for k, v in w["vertical"].items()} if isinstance(w["vertical"], dict) else w["vertical"] * by
    d["gravity"] *= by
    if isinstance(d.get("dead_load"), dict):
        d["dead_load"]["line"] = {k: v * by for k, v in d["dead_load"]["line"].items()}
    return d


def freer(design):
    """Designs with more arrangements, by name."""
    out = {}
    for name, change in {"any order": lambda c, t: c.pop("order", None), "no gap": lambda c, t: c.pop("gap", None),
                         "no ends": lambda c, t: t.pop("ends", None), "turned": lambda c, t: t.pop("turned", None),
                         "both signs": lambda c, t: t.pop("signs", None),
                         "enters": lambda c, t: t.update(enters=True)}.items():
        d = copy.deepcopy(design)
        for c in d["cases"]:
            change(c if isinstance(c, dict) else {}, {})
        for t in d["trains"]:
            change({}, t)
        if d != design:
            out[name] = d
    d = copy.deepcopy(design)
    rail = d["trains"][0].get("rail") or d["trains"][0]["wheels"][0].get("rail")
    extra = {"name": "extra", "enters": True, "wheels": [{"x": 0.0, "vertical": 37.0}, {"x": 1.1, "vertical": 12.0}]}
    d["trains"].append(extra | ({"rail": rail} if rail else {}))
    parts = any(isinstance(w["vertical"], dict) for t in d["trains"] for w in t["wheels"])
    if not parts:
        for k, c in enumerate(d["cases"]):
            trains = c["trains"] if isinstance(c, dict) else c
            if len(trains) < 2:
                d["cases"][k] = (c if isinstance(c, dict) else {"name": f"more {k}"}) | {"trains": [*trains, "extra"]}
                if isinstance(c, dict) and c.get("order") == "given":
                    d["cases"][k]["order"] = "any"
        out["one more train"] = d
    return out


# Largest differences by the largest of a kind: of extremes, which are exact or enclosed, and of deflections from chords, which
# are sought.
LIMIT, CHORDS = 1e-9, 1e-5


class Values:
    """Values of a summary by name, with the size of each kind, and the stated states."""

    def __init__(self, summary, names=None):
        self.values, self.kinds, self.states = {}, {}, {}
        back = {new: old for old, new in (names or {}).items()}
        for e in summary["extremes"]:
            support = e.get("support")
            key = (e["case"], e.get("rail"), e.get("span"), back.get(support, support), e.get("direction"), e.get("section"),
                   e["quantity"], e.get("plane"), e["kind"])
            self.values[key] = e["value"]
            self.kinds[key] = Checker.kind(e)
            self.states[key] = (e.get("x"), e.get("side"), e["positions"], e["signs"])
        for e in summary["deflections"]:
            key = (e["case"], e["rail"], e["span"], None, None, None, "relative", e["plane"], "size")
            self.values[key] = abs(e["relative"])
            self.kinds[key] = ("relative", e["plane"])
            self.states[key] = (e.get("x"), "at", e["positions"], e["signs"])

    def sizes(self):
        out = {}
        for key, value in self.values.items():
            kind = self.kinds[key]
            out[kind] = max(out.get(kind, 0.0), abs(value))
        force = max([v for k, v in out.items() if k[0] not in ("deflection", "relative")], default=1.0)
        bend = max([v for k, v in out.items() if k[0] in ("deflection", "relative")], default=1.0)
        return {k: max(v, 1e-3 * bend if k[0] in ("deflection", "relative") else 1e-4 * force) or 1.0 for k, v in out.items()}


def is_same_state(one, other, length):
    """Whether a state is stated alike in a telling with other units of length."""
    (x, side, positions, signs), (x2, side2, positions2, signs2) = one, other
    near = lambda a, b: abs(a - b / length) < 1e-6
    if (x is None) != (x2 is None) or x is not None and not near(x, x2) or signs != signs2:
        return False
    return all(near(positions[n]["position"], positions2[n]["position"]) and positions[n]["turned"] == positions2[n]["turned"]
               for n in positions)


def compared(base, other, move, length):
    """Largest differences between two tellings, of extremes and of deflections from chords: `move` gives the key in the other
    one and the factor of its value. Where `length` is given, the states that are stated otherwise are counted."""
    sizes = base.sizes()
    worst, what, states = [0.0, 0.0], [None, None], []
    missing = []
    for key, value in base.values.items():
        to, factor = move(key)
        if to not in other.values:
            if abs(value) > 1e-12 * sizes[base.kinds[key]]:
                missing.append(key)
            continue
        apart = abs(other.values[to] * factor - value) / sizes[base.kinds[key]]
        chord = int(key[6] == "relative")
        if apart > worst[chord]:
            worst[chord], what[chord] = apart, (key, value, other.values[to] * factor)
        # zeros are reached in many states
        if length and not chord and abs(value) > 1e-9 * sizes[base.kinds[key]] and not is_same_state(base.states[key], other.states[to], length):
            states.append((key, value, base.states[key], other.states[to]))
    return worst, what, states, missing


def tellings(spec, design, rng):
    """Names, specs, designs, new names of supports, and how keys and values move."""
    swap = {"max": "min", "min": "max", "size": "size"}
    same = lambda key: (key, 1.0)
    for name, units in UNITS.items():
        s, d, l, f = in_units(spec, design, units)

        def scaled(key, l=l, f=f):
            case, rail, span, support, direction, section, quantity, plane, kind = key
            moment = quantity in ("moment", "torsion", "Mx", "My", "Mz") or (direction or "u")[0] == "r"
            if section:
                component = next(c["component"] for c in design["sections"] if c["name"] == section)
                moment = component[0] == "M"
            return key, 1 / (l if quantity in ("deflection", "relative") else f * l if moment else f)
        yield name, s, d, None, scaled
    frame, own, names = spec, design, None
    if "girder" in spec:
        frame, own, names = as_general(spec, design)
        words = {"ux": "longitudinal", "uy": "vertical", "uz": "lateral", "rx": "twist"}
        yield "general form", frame, own, names, same
    s, d = divided(frame, own, rng)
    yield "more points", s, d, names, same
    s, axes = turned_axes(frame, rng)

    def along_axes(key):
        case, rail, span, support, direction, section, quantity, plane, kind = key
        if direction is None:
            return key, 1.0
        word, sign = axes[direction]
        return (case, rail, span, support, word, section, quantity, plane, kind if sign > 0 else swap[kind]), sign
    yield "other axes", s, own, names, along_axes
    s, d = against(frame, own)
    ends = own["spans"]

    def reversed_rail(key):
        case, rail, span, support, direction, section, quantity, plane, kind = key
        if rail is None:
            return key, 1.0
        sign = -1.0 if (quantity, plane) in (("shear", "vertical"), ("moment", "lateral"), ("deflection", "lateral")) else 1.0
        return (case, rail, len(ends[rail]) - span, support, direction, section, quantity, plane,
                kind if sign > 0 else swap[kind]), sign
    yield "rails reversed", s, d, names, reversed_rail
    s, d, signs = exchanged(frame, own)

    def from_b(key):
        sign = signs.get(key[5], 1.0)
        return (*key[:-1], key[-1] if sign > 0 else swap[key[-1]]), sign
    yield "members reversed", s, d, names, from_b
    s, d, moved = shuffled(frame, own, rng)
    yield "other lists", s, d, {a: moved[b] for a, b in names.items()} if names else moved, same
    d = copy.deepcopy(design)
    for t in d["trains"]:
        if t.get("turned", True):
            other_end(t)
    yield "wheels from the other end", spec, d, None, same
    for by in (2.0, 1.7):
        yield f"loads times {by}", spec, heavier(design, by), None, lambda key, by=by: (key, 1 / by)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--designs", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--level", action="store_true", help="no member under a rail slopes")
    parser.add_argument("--slowest", type=float, default=4, help="designs that take more seconds are told once only")
    parser.add_argument("--states", action="store_true", help="shows values that are stated with other states")
    parser.add_argument("--keep", help="folder for the designs with faults")
    args = parser.parse_args()
    worst, states, count, faults, values = {}, {}, 0, 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        for n in range(args.first, args.first + args.designs):
            spec, design = draw(np.random.default_rng([args.seed, n]), args.level)
            code, said, summary, seconds = solve(args.program, spec, design, scratch, args.slowest)
            if code != 0:
                print(f"{n}: status {code}, {seconds:.1f} s: not told again", flush=True)
                continue
            count += 1
            base = Values(summary)
            values += len(base.values)
            largest = 0.0

            def fault(name, text, s, d):
                nonlocal faults
                faults += 1
                print(f"  {n} {name}: {text}"[:600], flush=True)
                if args.keep:
                    folder = pathlib.Path(args.keep) / f"same-{args.seed}-{n}-{name.replace(' ', '_')}"
                    folder.mkdir(parents=True, exist_ok=True)
                    for file, content in (("spec", spec), ("design", design), ("spec_other", s),
                                          ("design_other", d | {"spec": "spec_other.json"})):
                        (folder / f"{file}.json").write_text(json.dumps(content))
            for name, s, d, names, move in tellings(spec, design, np.random.default_rng([args.seed, n, 1])):
                code, said, other, seconds = solve(args.program, s, d, scratch)
                if code != 0:
                    fault(name, f"status {code}: {said}", s, d)
                    continue
                length = None if name in ("rails reversed", "wheels from the other end", "other lists") else \
                    UNITS[name][2] if name in UNITS else 1.0
                apart, what, differ, missing = compared(base, Values(other, names), move, length)
                for chord, limit in enumerate((LIMIT, CHORDS)):
                    worst[name, chord] = max(worst.get((name, chord), 0.0), apart[chord])
                    if apart[chord] > limit:
                        fault(name, f"{apart[chord]:.1e}: {what[chord]}", s, d)
                if length:
                    states[name] = states.get(name, 0) + len(differ)
                    if differ and args.states:
                        print(f"  {n} {name}: other state: {differ[0]}")
                largest = max(largest, apart[0])
                if missing:
                    fault(name, f"without {len(missing)} values, as {missing[0]}", s, d)
            for name, d in freer(design).items():
                code, said, other, seconds = solve(args.program, spec, d, scratch)
                if code != 0:
                    if code is not None:
                        fault(name, f"status {code}: {said}", spec, d)
                    continue
                found, sizes = Values(other).values, base.sizes()
                for key, value in base.values.items():
                    sign = -1 if key[-1] == "min" else 1
                    less = sign * (value - found.get(key, 0.0)) / sizes[base.kinds[key]]
                    chord = int(key[6] == "relative")
                    worst[name, chord] = max(worst.get((name, chord), 0.0), less)
                    if less > (LIMIT, CHORDS)[chord]:
                        fault(name, f"lowers {key} from {value} to {found.get(key)} ({less:.1e})", spec, d)
                        break
            print(f"{n}: {len(base.values)} values, largest difference {largest:.1e}", flush=True)
    print(f"{count} designs, {values} values; faults {faults}")
    for name in dict.fromkeys(name for name, _ in worst):
        said = f"; {states[name]} values with another state" if name in states else ""
        print(f"{name}: {worst[name, 0]:.1e}, deflections from chords {worst.get((name, 1), 0.0):.1e}{said}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
