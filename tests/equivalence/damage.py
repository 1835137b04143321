"""Mutations of good input: missing keys, wrong types, unknown keys, negative numbers, broken text."""

import copy
import json


def places(value, path=()):
    """Every (container, key) below a JSON value."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, below in items:
        yield path + (key,)
        yield from places(below, path + (key,))


def at(value, path):
    for key in path:
        value = value[key]
    return value


def damaged_json(draw, value):
    """A copy of a JSON value with one to three faults, and their kinds."""
    value = copy.deepcopy(value)
    tags = set()
    for _ in range(draw.choice([1, 1, 1, 2, 3])):
        path = draw.choice(list(places(value)))
        holder, key = at(value, path[:-1]), path[-1]
        old = holder[key]
        numeric = isinstance(old, (int, float)) and not isinstance(old, bool)
        kind = draw.weighted(missing=3, type=3, unknown=3, negative=6 if numeric else 0, zero=2 if numeric else 0,
                             huge=1 if numeric else 0, misspelt=4 if isinstance(old, str) else 0,
                             longer=2 if isinstance(old, list) else 0, shorter=2 if isinstance(old, list) and old else 0)
        if kind == "missing":
            del holder[key]
        elif kind == "type":
            holder[key] = draw.choice([x for x in ("text", 7, True, None, [], {}, [1, 2], {"a": 1}) if type(x) is not type(old)])
        elif kind == "unknown":
            target = holder if isinstance(holder, dict) else value
            name = key if isinstance(holder, dict) else "colour"
            target[draw.choice(["colour", str(name) + "s", str(name)[::-1]])] = 1
        elif kind == "negative":
            holder[key] = -abs(old) - (old == 0)
        elif kind == "zero":
            holder[key] = 0
        elif kind == "huge":
            holder[key] = draw.choice([1e300, 1e-300, 1e12])
        elif kind == "misspelt":
            holder[key] = draw.choice([old[1:], old + "x", "", "a/b"])
        elif kind == "longer":
            holder[key] = old + draw.choice([[0], old[-1:], ["x"]])
        else:
            holder[key] = old[:-1]
        tags.add(f"malformed: {kind}")
    return value, tags


def damaged_text(draw, text):
    """A text with a stretch cut out, doubled or replaced by something else."""
    start = draw.randrange(len(text))
    end = min(len(text), start + draw.choice([1, 2, 5, 20]))
    piece = draw.choice(["", "", "-", "1e999", "NaN", '"', "}", ",", "?", "\n", "\u00e9", "0x1"])
    if draw.yes(0.2):
        piece = text[start:end] * 2
    return text[:start] + piece + text[end:], {"malformed: text"}


def damage(draw, case):
    """Makes one of a case's files faulty; returns the tags. JSON files are damaged by their members or as text."""
    name = draw.choice(sorted(case.files))
    source = case.files[name]
    if name.endswith(".json") and draw.yes(0.85):
        value, tags = damaged_json(draw, json.loads(source))
        case.files[name] = json.dumps(value, indent=1) + "\n"
    else:
        case.files[name], tags = damaged_text(draw, source)
    return tags
