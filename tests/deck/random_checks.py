#!/usr/bin/env python3
"""The verdict of `deck --check` on random scenes beside an evaluation of the deck that shares nothing with the program.

    python3 tests/deck/random_checks.py PROGRAM [--scenes 300] [--seed 1] [--jobs 2] [--limit 10] [--share 0]
    python3 tests/deck/random_checks.py PROGRAM --changed FOLDER [--scenes 40] [--seed 1]

`random_scenes.py` draws the scenes. The text of each deck is read and evaluated by `evaluate.py`, beside:

- the contact forces of the scene at random states, by the equations of docs/formats.md, solved here; only the values at stations are
  taken from the deck. Products of curves must give the values of the tables, and tables of a file those of their closed form;
- the equilibria of `girderway run` with the same tables and the same method of reading (AKISPL; the natural splines are those of the
  factored form up to what it leaves out).

The check must fail exactly if the deck differs, within `--limit` seconds; a refusal must be one of a scene without equilibrium. No
deck that differs may pass; a share of `--share` of the scenes may have a false alarm or a late verdict. With
--changed every deck is written with one number changed and what the change makes of its forces, for a test that checks such decks.

Exit status: 0 all verdicts are right, 1 some are not, 2 usage.
"""

import argparse
import csv
import json
import math
import random
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from evaluate import Deck, cross, numbers, read, step
from random_scenes import scene_of

STATES = 6
# changed decks of a scene
CHANGES = 4
# differences below this fraction of the largest value of a quantity are rounding
NEAR = 1e-9
# what the factored form leaves out, of the largest entry of a table
LEFT_OUT = 1e-6
REFUSALS = ["no static equilibrium"]


class Wheel:
    def __init__(self, truck, number, body, kind, rail, hub, contact):
        self.name = f"{truck}_wheel{number}"
        self.column = f"{truck}.wheel{number}"
        self.body, self.kind, self.rail, self.hub, self.contact = body, kind, rail, hub, contact


def leaves(tree):
    return [tree] if not isinstance(tree, list) else [leaf for part in tree for leaf in leaves(part)]


class Scene:
    """The wheels of a scene and the equations of their forces."""

    def __init__(self, files, form, deck, tables):
        self.scene, self.form, self.deck, self.tables = files["scene.json"], form, deck, tables
        self.wheels, self.contacts = [], []
        for truck in self.scene["trucks"]:
            at, number = truck["at"], 0
            for part in truck["tree"]:
                group = []
                for offset in leaves(part):
                    number += 1
                    group.append(len(self.wheels))
                    hub = [at[0] + offset, at[1], at[2]]
                    kind = self.scene["wheels"][truck["wheel"]]
                    self.wheels.append(Wheel(truck["name"], number, truck["body"], kind, truck["rail"], hub, len(self.contacts)))
                self.contacts.append(group)
        names = {one.name: one for one in tables.of("SPLINE")}
        self.flexible = {wheel.rail: self.direction(wheel, "vertical") in names for wheel in self.wheels}
        self.rigid = all(not value for value in self.flexible.values())
        self.spline = names
        self.curves = {}
        for one in deck.of("SPLINE"):
            if "_product_" in one.name:
                name, k = one.name.rsplit("_product_", 1)
                self.curves.setdefault(name, {})[int(k)] = deck.spline(one.number, "cubspl")
        parts = {one.name: one.number for one in deck.of("PART")}
        self.part = {name: parts[name] for name in self.scene["bodies"]}
        self.spin = {w: parts[wheel.name] for w, wheel in enumerate(self.wheels) if wheel.name in parts}
        self.variable = {one.name: one.number for one in deck.of("VARIABLE")}
        self.gforce = {one.name: one for one in deck.of("GFORCE")}
        self.diff = {one.name: one.number for one in deck.of("DIFF")}

    def direction(self, wheel, axis):
        return f"{wheel.rail.replace('.', '_')}_{axis}"

    def lateral(self, w):
        return "lateral" in self.wheels[w].kind

    def directions(self):
        """Wheel and axis of every force."""
        out = [(w, "vertical") for w in range(len(self.wheels))]
        return out + [(w, "lateral") for w in range(len(self.wheels)) if self.lateral(w)]

    def influence(self, places):
        """G and its derivative by the place of the displacement, between all directions."""
        every = self.directions()
        name = [self.direction(self.wheels[w], axis) for w, axis in every]
        n = len(every)
        value, slope = [[0.0] * n for _ in every], [[0.0] * n for _ in every]
        products = {}
        for i, (w, _) in enumerate(every):
            own = self.curves.get(name[i], {})
            products[i] = {k: (curve.value(places[w], 0), curve.value(places[w], 0, 1)) for k, curve in own.items()}
        for i, (w, _) in enumerate(every):
            for j, (v, _) in enumerate(every):
                pair = name[i] if name[i] == name[j] else f"{name[i]}_from_{name[j]}"
                if pair not in self.spline:
                    continue
                if self.form == "factored":
                    for k, (a, by) in products[i].items():
                        if k in products[j]:
                            value[i][j] += a * products[j][k][0]
                            slope[i][j] += by * products[j][k][0]
                    continue
                own = self.tables.spline(self.spline[pair].number, "akispl").value
                value[i][j] = own(places[v], places[w])
                if self.form == "symmetrised":
                    back = name[i] if name[i] == name[j] else f"{name[j]}_from_{name[i]}"
                    other = self.tables.spline(self.spline[back].number, "akispl").value
                    value[i][j] = 0.5 * (value[i][j] + other(places[w], places[v]))
        return value, slope

    def law(self, contact, p, rate):
        """Force of each wheel of a contact."""
        own = self.wheels[self.contacts[contact][0]].kind["vertical"]
        k, e, c = own["k"], own.get("exponent", 1.0), own.get("c", 0.0)
        ramp = step(p, 0.0, 0.0, own["depth"], c) if "depth" in own else c
        if own.get("bilateral"):
            return k * abs(p) ** e * (1 if p > 0 else -1) + ramp * rate
        return max(0.0, k * max(p, 0.0) ** e + ramp * rate) if p > 0 else 0.0

    def flange(self, w, side, p):
        own = self.wheels[w].kind["lateral"]
        gap = own["clearance"]
        arm = self.wheels[w].kind["radius"] - p
        fade = step(arm, own["release"][0], 1.0, own["release"][1], 0.0) if "release" in own else 1.0
        return own["k"] * fade * (max(0.0, side - gap) + min(0.0, side + gap))

    def memory(self, c):
        """Whether the penetration of a contact is a state: a damper between wheel and flexible rail."""
        wheel = self.wheels[self.contacts[c][0]]
        own = wheel.kind["vertical"]
        return own.get("c", 0.0) > 0 and own.get("damper", "rail") == "rail" and self.flexible[wheel.rail]

    def solve(self, state, draw):
        """The contact forces at a state; nothing where Newton's method does not find them."""
        wheels, contacts = self.wheels, self.contacts
        place, approach, falling, side, arm_z = [], [], [], [], []
        for wheel in wheels:
            (x, y, z, roll, yaw, pitch), speed = state[wheel.body]
            hx, hy, hz = wheel.hub
            place.append(x + hx + yaw * hz - pitch * hy)
            approach.append(-(y + pitch * hx - roll * hz))
            falling.append(-(speed[1] + speed[5] * hx - speed[3] * hz))
            side.append(z + roll * hy - yaw * hx)
            arm_z.append(roll)
        value, slope = self.influence(place)
        every = self.directions()
        index = {one: i for i, one in enumerate(every)}
        mean = [sum(approach[w] for w in group) / len(group) for group in contacts]
        fall = [sum(falling[w] for w in group) / len(group) for group in contacts]
        fraction = [draw.uniform(-0.5, 0.5) for _ in contacts]
        sides = [w for w in range(len(wheels)) if self.lateral(w)]
        n, m = len(contacts), len(sides)
        # displacements of each unknown by forces: up is positive for rails, forces press down
        by = [[0.0] * (n + m) for _ in range(n + m)]
        for c, group in enumerate(contacts):
            for d, other in enumerate(contacts):
                by[c][d] = sum(value[w][v] for w in group for v in other) / len(group)
            for e, v in enumerate(sides):
                by[c][n + e] = -sum(value[w][index[v, "lateral"]] for w in group) / len(group)
        for e, w in enumerate(sides):
            i = index[w, "lateral"]
            for d, other in enumerate(contacts):
                by[n + e][d] = -sum(value[i][v] for v in other)
            for f, v in enumerate(sides):
                by[n + e][n + f] = value[i][index[v, "lateral"]]

        def rate_of(c, p):
            own = wheels[contacts[c][0]].kind["vertical"]
            if own.get("c", 0.0) == 0.0:
                return 0.0
            if not self.memory(c):
                return fall[c]
            spring = own["k"] * abs(p) ** own.get("exponent", 1.0)
            return fraction[c] * spring / own["c"] if p > 0 or own.get("bilateral") else 0.0

        def forces(u):
            press = [self.law(c, u[c], rate_of(c, u[c])) for c in range(n)]
            return press + [self.flange(w, u[n + e], u[wheels[w].contact]) for e, w in enumerate(sides)]

        def residual(u):
            force = forces(u)
            out = [u[i] + sum(g * f for g, f in zip(by[i], force)) for i in range(n)]
            out = [r - mean[i] for i, r in enumerate(out)]
            for e, w in enumerate(sides):
                moved = sum(g * f for g, f in zip(by[n + e], force))
                arm = wheels[w].kind["radius"] - u[wheels[w].contact]
                out.append(u[n + e] - (side[w] - arm_z[w] * arm - moved))
            return out

        u = [*mean, *(side[w] for w in sides)]
        size = max([1e-30, *(abs(v) for v in u)])
        left = residual(u)
        for _ in range(60):
            most = max(abs(r) for r in left)
            if most <= 1e-14 * size:
                break
            force, matrix = forces(u), [[0.0] * (n + m) for _ in range(n + m)]
            for j in range(n + m):
                h = 1e-7 * max(abs(u[j]), 1e-6 * size)
                moved = [*u]
                moved[j] += h
                change = [(a - b) / h for a, b in zip(forces(moved), force)]
                moving = [k for k in range(n + m) if change[k] != 0.0]
                for i in range(n + m):
                    matrix[i][j] = (1.0 if i == j else 0.0) + sum(by[i][k] * change[k] for k in moving)
                if j < n:
                    for e, w in enumerate(sides):
                        if wheels[w].contact == j:
                            matrix[n + e][j] -= arm_z[w]
            move = solved(matrix, left)
            if move is None:
                return None
            share = 1.0
            while share > 1e-4:
                trial = [a - share * b for a, b in zip(u, move)]
                after = residual(trial)
                if max(abs(r) for r in after) < (1 - 0.1 * share) * most:
                    break
                share /= 2
            if max(abs(r) for r in after) >= most:
                break
            u, left = trial, after
        if max(abs(r) for r in left) > 1e-11 * size:
            return None
        force = forces(u)
        return {"place": place, "p": u[:n], "side": dict(zip(sides, u[n:])), "press": force[:n], "flange": dict(zip(sides, force[n:])),
                "rate": [rate_of(c, u[c]) for c in range(n)], "value": value, "slope": slope, "every": every}

    def expected(self, state, spins, found):
        """What statements of the deck must give, by name: value and rounding error; and the values that are given."""
        out, given, every = {}, {}, found["every"]
        load = [-found["press"][self.wheels[w].contact] if axis == "vertical" else found["flange"][w] for w, axis in every]
        index = {one: i for i, one in enumerate(every)}
        moved = [sum(g * f for g, f in zip(row, load)) for row in found["value"]]
        turned = [sum(g * f for g, f in zip(row, load)) for row in found["slope"]]
        sizes = [sum(abs(g * f) for g, f in zip(row, load)) for row in found["value"]]
        for w, wheel in enumerate(self.wheels):
            (_, _, _, _, yaw, pitch), speed = state[wheel.body]
            own, first = wheel.kind, self.contacts[wheel.contact][0] == w
            p, press = found["p"][wheel.contact], found["press"][wheel.contact]
            arm = own["radius"] - p
            length = max(abs(found["place"][w]), own["radius"], sizes[w])

            def add(what, value, rounding, wheel=wheel):
                out[f"{wheel.name}_{what}"] = (value, rounding)
                given[self.variable[f"{wheel.name}_{what}"]] = value

            add("place", found["place"][w], 1e-13 * length)
            flexible = self.flexible[wheel.rail]
            if flexible:
                add("rise", moved[w], 1e-11 * max(sizes))
            if first:
                add("penetration", p, 1e-11 * max(sizes) + 1e-13 * length)
                add("press", press, 0.0)
            side = found["flange"].get(w, 0.0)
            if self.lateral(w):
                i = index[w, "lateral"]
                if flexible:
                    add("shift", moved[i], 1e-11 * max(sizes))
                add("sideways", found["side"][w], 1e-11 * max(sizes) + 1e-13 * max(length, abs(wheel.hub[2])))
                add("flange", side, own["lateral"]["k"] * 1e-13 * length)
            traction = 0.0
            if w in self.spin and "friction" in own:
                hx, hy, hz = wheel.hub
                slide = speed[0] + speed[4] * hz - speed[5] * hy + spins[w] * arm
                law = own["friction"]
                part = slide / law["slip"]
                sat = step(part, -1.0, -1.0, 1.0, 1.0) if law["law"] == "step" else math.tanh(part)
                traction = law["mu"] * press * sat
                add("traction", traction, 1e-11 * abs(press))
            along = -traction
            if self.form == "factored" and flexible:
                along += -press * turned[w] + (side * turned[index[w, "lateral"]] if self.lateral(w) else 0.0)
            loose = 1e-10 * abs(press * sum(abs(v) for v in found["slope"][w]) * max(map(abs, load)))
            for name, value in (("FX", along), ("FY", press), ("FZ", -side)):
                out[wheel.name, name] = (value, loose)
            for name, value in (("TX", arm * side), ("TY", 0.0), ("TZ", -arm * traction)):
                out[wheel.name, name] = (value / own["radius"], loose)
        return out, given

    def poses(self, state, spins):
        """Parts of the deck at a state: the height of a body is that of its first truck on its rail at height zero."""
        poses = {}
        for name, number in self.part.items():
            (x, y, z, roll, yaw, pitch), speed = state[name]
            height, aside = self.position(name)
            poses[number] = [[x, height + y, aside + z], [roll, yaw, pitch], speed[:3], speed[3:]]
        for w, number in self.spin.items():
            origin, turn, velocity, spin = poses[self.part[self.wheels[w].body]]
            hub = self.wheels[w].hub
            at = [o + h + t for o, h, t in zip(origin, hub, cross(turn, hub))]
            poses[number] = [at, turn, [v + s for v, s in zip(velocity, cross(spin, hub))], [spin[0], spin[1], spins[w]]]
        return poses

    def position(self, name):
        """Height and lateral position of a body, from the markers of its rails and its trucks."""
        for wheel in self.wheels:
            if wheel.body == name:
                rail = int(self.gforce[wheel.name].get("RM"))
                at = numbers(self.deck.statements["MARKER", rail].get("QP") or "0,0,0")
                return at[1] - (wheel.hub[1] - wheel.kind["radius"]), at[2] - wheel.hub[2]
        return 0.0, 0.0

    def place(self, deck, state, spins, found, given, rates):
        differentials, own_rates = {}, {}
        for c, group in enumerate(self.contacts):
            name = f"{self.wheels[group[0]].name}_gap"
            if name in self.diff:
                differentials[self.diff[name]], own_rates[self.diff[name]] = found["p"][c], rates[c]
        deck.place(self.poses(state, spins), given, differentials, own_rates)

    def random_state(self, draw, rails):
        """Where bodies stand: wheels are loaded, partly loaded or open."""
        state, spins = {}, [0.0] * len(self.wheels)
        length = 1.0 / self.scene["gravity"] * 9.81
        for name, body in self.scene["bodies"].items():
            own = [wheel for wheel in self.wheels if wheel.body == name]
            free = body["dof"]
            load = body["weight"] / len(own)
            law = own[0].kind["vertical"]
            depth = (load / law["k"]) ** (1 / law.get("exponent", 1.0))
            low = max(rails[wheel.rail][0] - wheel.hub[0] for wheel in own)
            high = min(rails[wheel.rail][1] - wheel.hub[0] for wheel in own)
            size = max(max(abs(h) for h in wheel.hub) for wheel in own) + own[0].kind["radius"]
            soft = depth * draw.choice([1, 3, 30])
            gap = own[0].kind.get("lateral", {}).get("clearance", 0.0) + depth
            margin = 0.02 * (high - low)
            position = [draw.uniform(low + margin, high - margin), draw.uniform(-1.5, 0.3) * soft, draw.uniform(-2, 2) * gap,
                        draw.uniform(-1, 1) * min(soft / size, 0.005), draw.uniform(-1, 1) * min(gap / size, 0.005),
                        draw.uniform(-1, 1) * min(soft / size, 0.005)]
            slip = own[0].kind.get("friction", {}).get("slip", 0.02 / length)
            speed = [draw.uniform(-3, 3) * slip, *(draw.uniform(-1, 1) * slip * f for f in (0.5, 0.5, 1 / size, 1 / size, 1 / size))]
            for i, dof in enumerate(("x", "y", "z", "roll", "yaw", "pitch")):
                if dof not in free and dof != "x":
                    position[i] = speed[i] = 0.0
            state[name] = (position, speed)
        for w in self.spin:
            speed = state[self.wheels[w].body][1]
            slip = self.wheels[w].kind["friction"]["slip"]
            spins[w] = (-speed[0] + draw.uniform(-1.5, 1.5) * slip) / self.wheels[w].kind["radius"]
        return state, spins


def solved(matrix, right):
    """The solution of linear equations by elimination with pivots; nothing for a singular matrix."""
    rows = [[*row, value] for row, value in zip(matrix, right)]
    n = len(rows)
    for j in range(n):
        k = max(range(j, n), key=lambda i: abs(rows[i][j]))
        if rows[k][j] == 0.0:
            return None
        rows[j], rows[k] = rows[k], rows[j]
        head = rows[j]
        for other in rows[j + 1:]:
            factor = other[j] / head[j]
            if factor:
                for i in range(j, n + 1):
                    other[i] -= factor * head[i]
    out = [0.0] * n
    for j in range(n - 1, -1, -1):
        out[j] = (rows[j][n] - sum(rows[j][i] * out[i] for i in range(j + 1, n))) / rows[j][j]
    return out


def states(scene, rails, seed):
    """Random states with their contact forces."""
    draw = random.Random(seed)
    out = []
    for _ in range(3 * STATES):
        state, spins = scene.random_state(draw, rails)
        found = scene.solve(state, draw)
        if found:
            out.append((state, spins, found))
        if len(out) == STATES:
            break
    return out


def differences(scene, deck, cases):
    """What the deck gives that the scene does not, with the relative difference: at random states."""
    largest, worst = {}, {}
    for state, spins, found in cases:
        expected, given = scene.expected(state, spins, found)
        scene.place(deck, state, spins, found, given, found["rate"])
        for key, (value, rounding) in expected.items():
            if isinstance(key, tuple):
                force = scene.gforce[key[0]].number
                own = deck.evaluate(deck.statements["GFORCE", force].get(key[1]))
                own /= next(w.kind["radius"] for w in scene.wheels if w.name == key[0]) if key[1][0] == "T" else 1.0
                kind = "force"
            else:
                own = deck.expression(scene.variable[key])
                kind = key.rsplit("_", 1)[1]
                kind = "force" if kind in ("press", "flange", "traction") else "length"
            largest[kind] = max(largest.get(kind, 0.0), abs(value))
            off = abs(own - value) - rounding
            if not off <= 0.0 and off > worst.get(key, (0.0,))[0]:
                worst[key] = (off, kind, own, value)
        for name, number in scene.diff.items():
            own = deck.evaluate(deck.statements["DIFF", number].get("FUNCTION"))
            if abs(own) > 1e-12 * max(abs(v) for v in found["place"]):
                worst[name] = (abs(own), "length", own, 0.0)
    out = []
    for key, (off, kind, own, value) in worst.items():
        scale = largest[kind] if kind == "force" else max(largest[kind] * 1e-6, 1e-300)
        if not off <= NEAR * scale:
            out.append((off / scale, f"{' '.join(key) if isinstance(key, tuple) else key}: the deck {own!r}, the scene {value!r}"))
    return [text for _, text in sorted(out, reverse=True)]


def wrong_tables(scene, files):
    """Values at stations: products of curves beside tables, tables beside the closed form of their file."""
    out = []
    for one in scene.tables.of("SPLINE"):
        rows = [numbers(row) for row in one.all("Y")]
        if len(rows) < 2 or "product" in one.name:
            continue
        deflection, _, load = one.name.partition("_from_")
        load = load or deflection
        if scene.form == "factored":
            most = max(abs(v) for row in rows for v in row[1:])
            axis = [scene.tables.spline(scene.spline[name].number, "akispl") for name in (deflection, load)]
            most = max([most, *(abs(v) for own in axis for curve in own.curves for v in curve.y)])
            a, b = scene.curves.get(deflection, {}), scene.curves.get(load, {})
            x = numbers(one.get("X"))
            for row in rows:
                for at, value in zip(x, row[1:]):
                    own = sum(curve.value(row[0], 0) * b[k].value(at, 0) for k, curve in a.items() if k in b)
                    if abs(own - value) > 2 * LEFT_OUT * most:
                        out.append(f"{one.name} at {row[0]}, {at}: products {own!r}, table {value!r}")
        structure = deflection.split("_")[0]
        if f"{structure}.adm" in files and deflection == load:
            number = 6 if deflection.endswith("vertical") else 7
            file = read(files[f"{structure}.adm"])["SPLINE", number]
            if numbers(file.get("X")) != numbers(one.get("X")) or [numbers(r) for r in file.all("Y")] != rows:
                out.append(f"{one.name} is not the table of its file")
    return out[:3]


def rail_ranges(scene):
    """First and last station of each flexible rail, or places of wheels within the motion of a rigid one."""
    out = {}
    for wheel in scene.wheels:
        name = f"{wheel.rail.replace('.', '_')}_vertical"
        if name in scene.spline:
            x = numbers(scene.spline[name].get("X"))
            out[wheel.rail] = (x[0], x[-1])
        else:
            out[wheel.rail] = (-1e3 * wheel.kind["radius"] / 10, 1e3 * wheel.kind["radius"] / 10)
    return out


def at_rest(program, folder, files, scene, deck, form):
    """Differences from the equilibria of `girderway run` with the same reading; and whether there were any."""
    own = json.loads(json.dumps(files["scene.json"]))
    if form not in ("akispl", "factored") or any("x" in body["dof"] for body in own["bodies"].values()):
        return [], 0
    for structure in own["structures"].values():
        if structure["foundation"] != "rigid":
            structure |= {"foundation": "influence", "reading": "akispl" if form == "akispl" else "natural"}
    own |= {"analysis": "quasi-static", "output": {"dt": own["end"]["time"] / 5}}
    (folder / "rest.json").write_text(json.dumps(own))
    done = subprocess.run([program, "run", "rest.json", "-o", "rest", "--quiet"], cwd=folder, capture_output=True, text=True, timeout=300)
    path = folder / "rest" / "history.csv"
    if done.returncode not in (0, 1) or not path.exists():
        return [], 0
    with open(path, newline="") as file:
        rows = [{name: float(value) for name, value in row.items() if value} for row in csv.DictReader(file)]
    out = []
    near = NEAR if form == "akispl" else 20 * LEFT_OUT
    for row in rows:
        state = {}
        for name in own["bodies"]:
            position = [row[f"{name}.x"], -row.get(f"{name}.deflection", 0.0), *(row.get(f"{name}.{d}", 0.0) for d in ("z", "roll", "yaw", "pitch"))]
            state[name] = (position, [0.0] * 6)
        press = [row[f"{scene.wheels[group[0]].column}.vertical"] for group in scene.contacts]
        p = [row[f"{scene.wheels[group[0]].column}.penetration"] for group in scene.contacts]
        given, most = {}, max([1e-300, *map(abs, press)])
        for c, group in enumerate(scene.contacts):
            given[scene.variable[f"{scene.wheels[group[0]].name}_press"]] = press[c]
        for w, wheel in enumerate(scene.wheels):
            if scene.lateral(w):
                given[scene.variable[f"{wheel.name}_flange"]] = row[f"{wheel.column}.lateral"]
        scene.place(deck, state, [0.0] * len(scene.wheels), {"p": p}, given, [0.0] * len(p))
        rises = [deck.variable(scene.variable[f"{wheel.name}_rise"]) for wheel in scene.wheels if scene.flexible[wheel.rail]]
        size = max([1e-300, *map(abs, rises)])
        radius = max(wheel.kind["radius"] for wheel in scene.wheels)
        for c, group in enumerate(scene.contacts):
            name = scene.wheels[group[0]].name
            depth = deck.expression(scene.variable[f"{name}_penetration"])
            if abs(depth - p[c]) > near * max(size, abs(p[c])) + 1e-13 * radius:
                out.append(f"at rest, t = {row['time']}: {name} is {depth!r} deep in the deck, {p[c]!r} in the run")
            deck.known[scene.variable[f"{name}_penetration"]] = p[c]
            force = deck.expression(scene.variable[f"{name}_press"])
            slack = abs(scene.law(c, p[c] + 1e-13 * radius, 0.0) - scene.law(c, p[c] - 1e-13 * radius, 0.0))
            if abs(force - press[c]) > NEAR * most + slack:
                out.append(f"at rest, t = {row['time']}: {name} has {force!r} in the deck, {press[c]!r} in the run")
    return out[:3], len(rows)


class Outcome:
    def __init__(self, kind, text="", spent=0.0, states=0, rest=0):
        self.kind, self.text, self.spent, self.states, self.rest = kind, text, spent, states, rest


def written(folder, files):
    for name, content in files.items():
        (folder / name).write_text(content if isinstance(content, str) else json.dumps(content))


def family_deck(program, folder, form, deck):
    """The deck in the form of families, from which tables are taken."""
    if form in ("akispl", "symmetrised", "paper"):
        return deck
    done = subprocess.run([program, "deck", "scene.json", "--form", "akispl"], cwd=folder, capture_output=True, text=True)
    # a scene that stands in one form may fall in another; its tables are then not known
    return Deck(done.stdout) if done.returncode == 0 else None


def form_of(text):
    return text.split("\n", 1)[0].rsplit(" ", 1)[1]


def run(program, seed, limit):
    files, form = scene_of(seed)
    with tempfile.TemporaryDirectory(prefix="girderway-") as name:
        folder = Path(name)
        written(folder, files)
        command = [program, "deck", "scene.json", "-o", "d.adm", "--check", "--json"] + (["--form", form] if form else [])
        begun = time.perf_counter()
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=max(60, 6 * limit))
        except subprocess.TimeoutExpired:
            return Outcome("late", "takes too long", time.perf_counter() - begun)
        spent = time.perf_counter() - begun
        if done.returncode not in (0, 1):
            if any(word in done.stderr for word in REFUSALS):
                return Outcome("refused", spent=spent)
            return Outcome("wrong", f"status {done.returncode}: {done.stderr.strip()[:300]}", spent)
        report = json.loads(done.stdout)
        text = (folder / "d.adm").read_text()
        form, deck = form_of(text), Deck(text)
        tables = family_deck(program, folder, form, deck)
        if tables is None:
            return Outcome("not evaluated", spent=spent)
        scene = Scene(files, form, deck, tables)
        cases = states(scene, rail_ranges(scene), seed)
        own = differences(scene, deck, cases)
        rest, rows = [], 0
        if form != "paper":
            own += wrong_tables(scene, files)
            rest, rows = at_rest(program, folder, files, scene, deck, form)
            own += rest
        said = [wrong["statement"] for row in report["forces"] for wrong in row["wrong"]] + (report["path"] or {}).get("causes", [])
        late = f"{spent:.1f} s; " if spent > limit else ""
        if report["holds"] and own:
            return Outcome("wrong", f"{late}false pass in the form {form}: {'; '.join(own[:3])}", spent, len(cases), rows)
        if not report["holds"] and not own and form != "paper":
            return Outcome("false alarm", f"{late}false alarm in the form {form}: {'; '.join(said[:3])}", spent, len(cases), rows)
        if late:
            return Outcome("late", f"{late}form {form}", spent, len(cases), rows)
        if not report["holds"] and not said:
            return Outcome("wrong", "failed without a cause", spent, len(cases), rows)
        return Outcome("holds" if report["holds"] else "differs", "", spent, len(cases), rows)


# a deck with one number changed


def block(lines, statement):
    """The lines of a statement."""
    first = lines.index(f"{statement.keyword}/{statement.number}")
    last = first + 1
    while last < len(lines) and lines[last].startswith(","):
        last += 1
    return range(first + 1, last)


def changed(draw, text, statement, argument, factor, shift=0.0):
    """The text with one of the numbers with a point of an argument of a statement changed; and what was changed."""
    lines, choices, inside = text.split("\n"), [], False
    for i in block(lines, statement):
        name = re.match(r", ([A-Z][A-Z0-9_]*)\s*(=|$)", lines[i])
        inside = (name.group(1) == argument) if name else inside
        if inside:
            start = lines[i].index("=") if name else 0
            choices += [(i, found) for found in re.finditer(r"(?<![\w.])\d+\.\d*(E[-+]?\d+)?", lines[i]) if found.start() >= start]
    if not choices:
        return None
    i, found = draw.choice(choices)
    value = float(found.group())
    other = value * factor + shift
    lines[i] = lines[i][: found.start()] + repr(other).upper() + lines[i][found.end():]
    return "\n".join(lines), f"{statement.label()}, {argument}: {value!r} became {other!r}"


def motion_differs(scene, deck, other):
    """Whether prescribed places differ."""
    for one in deck.of("MOTION"):
        again = other.statements["MOTION", one.number]
        for i in range(81):
            for own in (deck, other):
                own.calls["TIME"] = scene.scene["end"]["time"] * i / 80
            a, b = deck.evaluate(one.get("FUNCTION")), other.evaluate(again.get("FUNCTION"))
            if abs(a - b) > 1e-6 * (abs(a) + abs(b)):
                return True
    return False


def changes(draw, scene, deck, text):
    """Texts of decks with one number changed, with what was changed and the kind of the change."""
    length = max(wheel.kind["radius"] for wheel in scene.wheels)
    tables = [one for one in deck.of("SPLINE") if not re.search(r"_[ur][xyz]_", one.name)]
    variables = {kind: [one for one in deck.of("VARIABLE") if one.name.endswith(kind)]
                 for kind in ("_penetration", "_press", "_sideways", "_flange", "_traction")}
    markers = deck.of("MARKER")
    hubs = [one for one in markers if one.name.startswith("hub_")]
    rails = [one for one in markers if one.name.startswith("rail_")]
    bodies = [deck.statements["PART", number] for number in scene.part.values()]
    wanted = [("a value of a table", tables, "Y", 1 + 1e-5, 0.0), ("a station", tables, "X", 1 + 1e-6, 0.0)]
    wanted += [(f"a number of {kind[1:]}", own, "FUNCTION", 1 + 1e-5, 0.0) for kind, own in variables.items()]
    wanted += [("a hub", hubs, "QP", 1.0, 1e-5 * length), ("a rail", rails, "QP", 1.0, 1e-5 * length),
               ("a mass", bodies, "MASS", 1 + 1e-4, 0.0), ("a motion", deck.of("MOTION"), "FUNCTION", 1 + 1e-4, 0.0)]
    draw.shuffle(wanted)
    out = []
    for kind, statements, argument, factor, shift in wanted:
        one = changed(draw, text, draw.choice(statements), argument, factor, shift) if statements else None
        if one:
            out.append((kind, *one))
    return out


def write_changed(program, folder, seed, number):
    """Writes a scene, its deck and decks with one number changed, with what the change makes of the forces."""
    files, form = scene_of(seed)
    form = "akispl" if form == "paper" else form
    own = folder / str(seed)
    own.mkdir(parents=True)
    written(own, files)
    command = [program, "deck", "scene.json", "-o", "deck.adm", "--quiet"] + (["--form", form] if form else [])
    done = subprocess.run(command, cwd=own, capture_output=True, text=True)
    if done.returncode:
        return 0
    text = (own / "deck.adm").read_text()
    form, deck = form_of(text), Deck(text)
    tables = family_deck(program, own, form, deck)
    if tables is None:
        return 0
    scene = Scene(files, form, deck, tables)
    cases = states(scene, rail_ranges(scene), seed)
    held = all("x" not in body["dof"] for body in files["scene.json"]["bodies"].values())
    out = []
    for kind, other, what in changes(random.Random(seed), scene, deck, text)[:number]:
        again = Deck(other)
        if kind == "a mass":
            differs = held
        elif kind == "a motion":
            differs = held and motion_differs(scene, deck, again)
        else:
            differs = bool(differences(scene, again, cases))
        name = f"changed{len(out)}.adm"
        (own / name).write_text(other)
        out.append({"deck": name, "kind": kind, "what": what, "differs": differs})
    (own / "changed.json").write_text(json.dumps({"form": form, "decks": out}))
    return len(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--scenes", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=float, default=10.0, help="seconds of one check")
    parser.add_argument("--share", type=float, default=0.0, help="largest share of scenes with a false alarm or a late verdict")
    parser.add_argument("--changed", type=Path, metavar="FOLDER", help="write decks with one number changed, without checking them")
    options = parser.parse_args()
    program = options.program.resolve()
    seeds = range(1_000_000 * options.seed, 1_000_000 * options.seed + options.scenes)
    if options.changed:
        with ThreadPoolExecutor(options.jobs) as pool:
            number = sum(pool.map(lambda seed: write_changed(program, options.changed, seed, CHANGES), seeds))
        print(f"{number} decks with one number changed")
        return 0
    counts, spent, slowest, evaluated, rest = {}, 0.0, 0.0, 0, 0
    with ThreadPoolExecutor(options.jobs) as pool:
        for seed, one in zip(seeds, pool.map(lambda seed: run(program, seed, options.limit), seeds)):
            counts[one.kind] = counts.get(one.kind, 0) + 1
            spent, slowest = spent + one.spent, max(slowest, one.spent)
            evaluated, rest = evaluated + one.states, rest + one.rest
            if one.text:
                print(f"{seed}: {one.text}", flush=True)
    print(f"{options.scenes} scenes: {counts}; {evaluated} states and {rest} equilibria evaluated; "
          f"{spent:.1f} s in the program, at most {slowest:.1f} s")
    allowed = options.share * options.scenes
    return 1 if counts.get("wrong") or counts.get("false alarm", 0) + counts.get("late", 0) > allowed else 0


if __name__ == "__main__":
    sys.exit(main())
