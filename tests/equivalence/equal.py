"""What must be equal of two folders that two programs left, file by file.

Each function returns the first difference of two things as a text, or None. `Rules` says what is allowed to differ.
"""

import csv
import io
import json
import math
import re
import zipfile
from collections import namedtuple
from dataclasses import dataclass, field
from pathlib import Path

import pictures

Difference = namedtuple("Difference", "kind place text")

# members whose value is a sentence for people; with Rules.messages_may_differ only the numbers in it are compared
SENTENCES = {"reason", "what", "why", "warnings", "notes", "text", "expected", "hint", "found", "message", "description", "title"}
NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w])")
LOCATION = re.compile(r"^(?:(?:error|warning): )?([^\s:]+(?::\d+){1,2}):")
# with a tolerance: numbers in messages, which are printed with a few digits
PRINTED = 1e-3
# with a tolerance: a column that is smaller than this part of the largest of its unit is measured by that
SMALL = 1e-4
FLANGE = re.compile(r"\.wheel\d+\.lateral$")


@dataclass
class Rules:
    """What may differ.

    `renamed`: old key -> new key of our own JSON files and of the headers of our own CSV files; an old key may be
    written with the key above it, as `predicted/give`. `messages_may_differ`: the wording of what people read, not its
    places and numbers. `tolerance`: histories and peaks to this part of the largest value of their column until the
    first flange strikes, counts of steps within 1 %. `pictures`: pictures and reports are compared.
    """

    renamed: dict = field(default_factory=dict)
    messages_may_differ: bool = False
    tolerance: float | None = None
    pictures: bool = False

    def key(self, path, key):
        """The new name of a key that stands below `path`."""
        above = path[-1] if path else ""
        return self.renamed.get(f"{above}/{key}", self.renamed.get(key, key))


def read_renames(text):
    """Lines `old<TAB>new`; empty lines and lines that begin with # are passed over."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return dict(line.split("\t")[:2] for line in lines)


def folders(old, new, rules):
    """All differences of two folders."""
    found = []
    names = [{str(p.relative_to(root)) for p in root.rglob("*") if p.is_file()} for root in (old, new)]
    pictured = lambda name: name.endswith((".svg", ".html"))
    for name in sorted(names[0] ^ names[1]):
        if rules.pictures or not pictured(name):
            found.append(Difference("files", name, "only the old one wrote it" if name in names[0] else "only the new one wrote it"))
    for name in sorted(names[0] & names[1]):
        a, b = (old / name).read_bytes(), (new / name).read_bytes()
        kind = kind_of(name, a)
        if a == b or (pictured(name) and not rules.pictures) or name.endswith("timing.csv"):
            continue
        try:
            text = of_kind(kind, a, b, rules, Path(name), old, new)
        except (ValueError, KeyError, IndexError) as trouble:
            text = f"cannot be compared: {trouble!r}"
        if text:
            found.append(Difference(kind, name, text))
    return found


def kind_of(name, content):
    """What a file is, by its name and, of JSON, its format."""
    base = Path(name).name
    for beginning, kind in (("timing", "timing"), ("manifest", "manifest"), ("summary", "summary"), ("cycles", "cycles"), ("history", "history")):
        if base.startswith(beginning):
            return kind
    for ending, kind in ((".svg", "picture"), ("report.html", "report"), (".html", "report"), (".npz", "table"), (".cmd", "table"), (".acf", "deck")):
        if base.endswith(ending):
            return kind
    if base.endswith(".adm"):
        return "deck" if b"GFORCE" in content or b"PART/" in content else "table"
    if base.endswith(".csv"):
        return "table"
    if base.endswith(".json"):
        for word, kind in ((b"girderway-grid/", "grid"), (b"girderway-beam/", "spec"), (b"girderway-tables/", "table"),
                           (b"girderway-scene/", "scene"), (b"girderway-study", "summary"), (b"girderway-stability", "summary")):
            if word in content[:200]:
                return kind
        return "json"
    return "file"


def of_kind(kind, a, b, rules, name, old, new):
    """The first difference of two files of one kind whose bytes differ."""
    if kind == "timing":
        return values(stages(a), stages(b), rules)
    if kind == "manifest":
        return values(without_hashes(json.loads(a), rules), without_hashes(json.loads(b), rules), rules)
    if kind == "summary":
        if rules.tolerance is not None:
            return summaries_nearly(json.loads(a), json.loads(b), rules, old, new, name)
        return values(json.loads(a), json.loads(b), rules)
    if kind == "history" and rules.tolerance is not None:
        return histories_nearly(a.decode(), b.decode(), rules.tolerance, units_of(old / name))
    if kind == "cycles" and rules.tolerance is not None:
        strike = struck(old / str(name).replace("cycles", "history", 1))
        return None if strike else numbers_nearly(a.decode(), b.decode(), rules.tolerance)
    if kind == "deck" and rules.tolerance is not None:
        return numbers_nearly(a.decode(), b.decode(), rules.tolerance)
    if kind == "picture":
        return pictures.drawings(a.decode(), b.decode(), rules)
    if kind == "report":
        return pictures.reports(a.decode(), b.decode(), rules)
    if name.suffix == ".npz":
        return archives(a, b)
    if name.suffix == ".json" and (rules.renamed or rules.messages_may_differ):
        return values(digits(a), digits(b), rules)
    if name.suffix == ".csv" and rules.renamed:
        head, _, rest = a.decode().partition("\n")
        a = (",".join(rules.key((), cell) for cell in head.split(",")) + "\n" + rest).encode()
        return None if a == b else texts(a.decode(), b.decode())
    return texts(a.decode(errors="replace"), b.decode(errors="replace"))


def texts(a, b):
    """The first line that differs."""
    lines = [a.splitlines(), b.splitlines()]
    for number, (left, right) in enumerate(zip(*lines), 1):
        if left != right:
            column = next((i for i, (x, y) in enumerate(zip(left, right)) if x != y), min(len(left), len(right)))
            start = max(0, column - 30)
            return f"line {number}, column {column + 1}: {clip(left[start:])!r} became {clip(right[start:])!r}"
    if len(lines[0]) != len(lines[1]):
        return f"{len(lines[0])} lines became {len(lines[1])}"
    return None if a == b else "line ends differ"


def clip(value, most=90):
    text = str(value)
    return text if len(text) <= most else text[:most] + "..."


class Digits(str):
    """A number as it is written."""


def digits(content):
    """JSON with numbers as they are written, so that every digit counts."""
    return json.loads(content, parse_float=Digits, parse_int=Digits)


def numberless(value):
    """JSON with its numbers left out, also those in texts."""
    if isinstance(value, dict):
        return {key: numberless(below) for key, below in value.items()}
    if isinstance(value, list):
        return [numberless(below) for below in value]
    if isinstance(value, Digits) or isinstance(value, (int, float)) and not isinstance(value, bool):
        return "#"
    return NUMBER.sub("#", value) if isinstance(value, str) else value


def stages(content):
    """The structure of a file of times: its keys."""
    shape = lambda v: {k: shape(x) for k, x in v.items()} if isinstance(v, dict) else [shape(x) for x in v] if isinstance(v, list) else None
    return shape(json.loads(content))


def without_hashes(manifest, rules):
    """A manifest without hashes, and without the sizes of what was written."""
    kept = dict(manifest)
    pictured = lambda name: not rules.pictures and name.endswith((".svg", ".html"))
    kept["outputs"] = sorted(f["name"] for f in manifest.get("outputs", []) if not pictured(f["name"]))
    kept["inputs"] = [{k: v for k, v in f.items() if k != "sha256"} for f in manifest.get("inputs", [])]
    return kept


def archives(a, b):
    """Arrays of two .npz files."""
    open_a, open_b = zipfile.ZipFile(io.BytesIO(a)), zipfile.ZipFile(io.BytesIO(b))
    if open_a.namelist() != open_b.namelist():
        return f"arrays {open_a.namelist()} became {open_b.namelist()}"
    for name in open_a.namelist():
        if open_a.read(name) != open_b.read(name):
            return f"array {name} differs"
    return None


def sentence(text):
    """Numbers of a sentence, in any order."""
    return sorted(NUMBER.findall(text.replace("\u2212", "-")))


def same_number(a, b):
    return a == b or (isinstance(a, float) and isinstance(b, float) and math.isnan(a) and math.isnan(b))


def values(a, b, rules, path=()):
    """The first difference of two JSON values; keys of the old one are renamed, order of keys does not count."""
    place = "/".join(map(str, path)) or "the whole"
    if isinstance(a, dict) and isinstance(b, dict):
        renamed = {rules.key(path, key): (key, value) for key, value in a.items()}
        if renamed.keys() != b.keys():
            gone, come = sorted(renamed.keys() - b.keys()), sorted(b.keys() - renamed.keys())
            return f"{place}: keys gone {gone[:5]}, come {come[:5]}"
        for new_key, (key, value) in renamed.items():
            if found := values(value, b[new_key], rules, path + (key,)):
                return found
        return None
    if isinstance(a, list) and isinstance(b, list):
        if len(a) != len(b):
            return f"{place}: {len(a)} items became {len(b)}"
        for index, pair in enumerate(zip(a, b)):
            if found := values(*pair, rules, path + (index,)):
                return found
        return None
    if isinstance(a, bool) or isinstance(b, bool) or type(a) is not type(b) and not {type(a), type(b)} <= {int, float}:
        return None if a is b else f"{place}: {clip(a)} became {clip(b)}"
    if isinstance(a, Digits):
        return None if a == b else f"{place}: {a} became {b}"
    if isinstance(a, str):
        key = next((k for k in reversed(path) if isinstance(k, str)), "")
        if rules.messages_may_differ and key in SENTENCES and (key in ("description", "title") or sentence(a) == sentence(b)):
            return None
        return None if a == b else f"{place}: {clip(a)!r} became {clip(b)!r}"
    return None if same_number(a, b) else f"{place}: {a} became {b}"


def messages(a, b, rules):
    """What was printed: JSON by its members, text line by line."""
    if a == b:
        return None
    try:
        read = (lambda text: numberless(json.loads(text))) if rules.tolerance is not None else digits
        return values(read(a), read(b), rules)
    except ValueError:
        pass
    if rules.messages_may_differ:
        return placed(a, b, 0.0 if rules.tolerance is None else PRINTED)
    if rules.tolerance is not None:
        return numbers_nearly(a, b, PRINTED)
    return texts(a, b)


def placed(a, b, tolerance):
    """Messages of any wording with the same places and numbers, line by line."""
    lines = [a.splitlines(), b.splitlines()]
    if len(lines[0]) != len(lines[1]):
        return f"{len(lines[0])} lines became {len(lines[1])}"
    place = lambda line: (found := LOCATION.match(line)) and found.group(1)
    for number, (left, right) in enumerate(zip(*lines), 1):
        x, y = (sorted(map(float, sentence(line))) for line in (left, right))
        near = len(x) == len(y) and all(abs(p - q) <= tolerance * max(abs(p), abs(q)) for p, q in zip(x, y))
        if place(left) != place(right) or not near:
            return f"line {number}: other place or numbers: {clip(left)!r} became {clip(right)!r}"
    return None


def numbers_nearly(a, b, tolerance):
    """Texts whose words are equal and whose numbers agree within `tolerance` of the largest number of their line."""
    lines = [a.splitlines(), b.splitlines()]
    if len(lines[0]) != len(lines[1]):
        return f"{len(lines[0])} lines became {len(lines[1])}"
    for number, (left, right) in enumerate(zip(*lines), 1):
        if left == right:
            continue
        if NUMBER.sub("#", left) != NUMBER.sub("#", right):
            return f"line {number}: {clip(left)!r} became {clip(right)!r}"
        x, y = ([float(v) for v in NUMBER.findall(line)] for line in (left, right))
        largest = max(map(abs, x + y), default=0.0)
        if any(abs(p - q) > tolerance * largest for p, q in zip(x, y)):
            return f"line {number}: {clip(left)!r} became {clip(right)!r}"
    return None


def table(text):
    """Header and rows of a history; empty cells are None."""
    rows = list(csv.reader(io.StringIO(text)))
    return rows[0], [[float(cell) if cell else None for cell in row] for row in rows[1:]]


def first_strike(header, rows):
    """Index of the first row with a flange force, or the number of rows."""
    flanges = [i for i, name in enumerate(header) if FLANGE.search(name)]
    return next((k for k, row in enumerate(rows) if any(row[i] for i in flanges)), len(rows))


def struck(file):
    """Whether a flange strikes in a history."""
    if not file.exists():
        return True
    header, rows = table(file.read_text())
    return first_strike(header, rows) < len(rows)


def units_of(history):
    """Unit of each column of a history, from the summary beside it."""
    file = history.parent / "summary.json"
    summary = json.loads(file.read_text()) if file.exists() else {}
    label = history.stem.removeprefix("history").removeprefix("-")
    run = summary.get("compare", {}).get(label, {}) if label else summary
    return run.get("units") or summary.get("units", {})


def sizes(columns, units):
    """What each column is measured by: its largest value, or a part of the largest of its unit where that is more.

    Columns that would be zero without rounding hold numbers which mean nothing.
    """
    nothing = 1e-25 * max(columns.values(), default=0.0)
    of_unit = {}
    for name, size in columns.items():
        unit = units.get(name, name)
        of_unit[unit] = max(of_unit.get(unit, 0.0), size)
    return {name: max(size, nothing, SMALL * of_unit[units.get(name, name)]) for name, size in columns.items()}


def histories_nearly(a, b, tolerance, units):
    """Histories within `tolerance` of the size of each column, until a flange strikes in one of them."""
    (head_a, rows_a), (head_b, rows_b) = table(a), table(b)
    if head_a != head_b:
        return "other columns"
    last = min(first_strike(head_a, rows_a), first_strike(head_b, rows_b))
    if last == min(len(rows_a), len(rows_b)) and len(rows_a) != len(rows_b):
        return f"{len(rows_a)} rows became {len(rows_b)}"
    columns = {name: max((abs(row[i]) for row in rows_a if row[i] is not None), default=0.0) for i, name in enumerate(head_a)}
    largest = list(sizes(columns, units).values())
    for k in range(last):
        for i, (x, y) in enumerate(zip(rows_a[k], rows_b[k])):
            if (x is None) != (y is None) or x is not None and abs(x - y) > tolerance * largest[i]:
                apart = f", {abs(x - y) / largest[i]:.1e} of the largest" if x is not None and y is not None and largest[i] else ""
                return f"row {k + 1}, {head_a[i]}: {x} became {y}{apart}"
    return None


def summaries_nearly(a, b, rules, old, new, name):
    """Statuses and texts equal, counts of steps within 1 %, peaks within the tolerance where no flange strikes.

    Other numbers follow from the history and are not compared: where a column is flat, the time of its peak jumps.
    """
    strike = {"": struck(old / name.parent / "history.csv")}
    for file in (old / name.parent).glob("history-*.csv"):
        strike[file.stem.removeprefix("history-")] = struck(file)

    def walk(x, y, path, label):
        place = "/".join(map(str, path))
        if isinstance(x, dict) and isinstance(y, dict):
            x = {rules.key(path, key): value for key, value in x.items()}
            if x.keys() != y.keys():
                return f"{place}: keys {sorted(x.keys() ^ y.keys())[:5]}"
            for key in x:
                below = key if path[-1:] == ("compare",) else label
                if found := walk(x[key], y[key], path + (key,), below):
                    return found
            return None
        if isinstance(x, list) and isinstance(y, list):
            if len(x) != len(y):
                return None if strike.get(label, True) else f"{place}: {len(x)} items became {len(y)}"
            return next((f for i, pair in enumerate(zip(x, y)) if (f := walk(*pair, path + (i,), label))), None)
        if isinstance(x, (int, float)) and isinstance(y, (int, float)) and not isinstance(x, bool):
            if len(path) >= 2 and path[-2] == "steps" and "energy" not in path:
                return None if abs(x - y) <= max(1, math.ceil(0.01 * abs(x))) else f"{place}: {x} became {y}"
            if path[-1] == "value" and "peaks" in path and not strike.get(label, True):
                largest = peaks(a, label).get(path[-3], 0.0)
                return None if abs(x - y) <= rules.tolerance * largest else f"{place}: {x} became {y}"
            return None
        if isinstance(x, str) and isinstance(y, str):
            same = x == y or NUMBER.sub("#", x) == NUMBER.sub("#", y) or rules.messages_may_differ and path[-1] in SENTENCES
            return None if same else f"{place}: {clip(x)!r} became {clip(y)!r}"
        return None if x is y or x == y or strike.get(label, True) else f"{place}: {x} became {y}"

    return walk(a, b, (), "")


def peaks(summary, label):
    """What the peaks of each column of a run are measured by."""
    run = summary.get("compare", {}).get(label, {}) if label else summary
    columns = {}
    for column, ends in run.get("peaks", {}).items():
        columns[column] = max((abs(end["value"]) for end in ends.values() if isinstance(end, dict)), default=0.0)
    return sizes(columns, run.get("units") or summary.get("units", {}))
