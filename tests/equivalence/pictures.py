"""Pictures and reports: the data they draw and their visible text.

Two drawings are the same where their texts are, and where each line of one has a line of the other that runs within
half a percent of the drawing's size, once both are stretched to the box around all of their lines: margins, sizes and the
number of digits of coordinates may differ. Lines of two points (grids, ticks, keys) do not count. The charts of a report
carry their data as JSON, which is compared as numbers.
"""

import json
import re
from collections import Counter
from html.parser import HTMLParser
from xml.etree import ElementTree

NEAR = 0.005
TOKEN = re.compile(r"[A-Za-z]|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?!\w)")


def path_points(d):
    """Vertices of the pieces of an SVG path of moves and lines; curves count by their ends."""
    pieces, current, letter = [], [], "M"
    tokens = TOKEN.findall(d)
    x = y = 0.0
    i = 0
    while i < len(tokens):
        if tokens[i].isalpha():
            letter = tokens[i]
            i += 1
            if letter in "zZ":
                if current:
                    current.append(current[0])
                continue
        size = {"h": 1, "v": 1, "c": 6, "q": 4, "s": 4, "t": 2, "a": 7}.get(letter.lower(), 2)
        numbers = [float(v) for v in tokens[i : i + size]]
        if len(numbers) < size:
            break
        i += size
        relative = letter.islower()
        if letter.lower() == "h":
            x = x * relative + numbers[0]
        elif letter.lower() == "v":
            y = y * relative + numbers[0]
        else:
            x, y = x * relative + numbers[-2], y * relative + numbers[-1]
        if letter in "mM":
            current = []
            pieces.append(current)
            letter = "l" if letter == "m" else "L"
        current.append((x, y))
    return pieces


def shapes(svg):
    """Lines and circles of a drawing, and its texts."""
    root = ElementTree.fromstring(svg)
    lines, words = [], []
    for node in root.iter():
        tag = node.tag.rsplit("}", 1)[-1]
        if tag == "path":
            lines += path_points(node.get("d", ""))
        elif tag in ("polyline", "polygon"):
            numbers = [float(v) for v in re.findall(r"[-+\d.eE]+", node.get("points", ""))]
            lines.append(list(zip(numbers[::2], numbers[1::2])))
        elif tag in ("text", "title", "desc"):
            word = " ".join("".join(node.itertext()).split())
            if word:
                words.append(word)
    return [line for line in lines if len(line) > 2], words


def boxed(lines):
    """Lines stretched to the box around all of them."""
    xs, ys = [p[0] for line in lines for p in line], [p[1] for line in lines for p in line]
    if not xs:
        return lines
    wide, high = max(xs) - min(xs) or 1.0, max(ys) - min(ys) or 1.0
    return [[((x - min(xs)) / wide, (y - min(ys)) / high) for x, y in line] for line in lines]


def distance(point, a, b):
    """From a point to a stretch."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = dx * dx + dy * dy
    t = 0.0 if length == 0 else max(0.0, min(1.0, ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / length))
    return ((point[0] - a[0] - t * dx) ** 2 + (point[1] - a[1] - t * dy) ** 2) ** 0.5


def follows(line, other):
    """Whether a line runs near another, looked at in up to 60 of its vertices."""
    if len(line) == len(other) and all(max(abs(p[0] - q[0]), abs(p[1] - q[1])) <= NEAR for p, q in zip(line, other)):
        return True
    step = max(1, len(line) // 60)
    return all(any(distance(p, a, b) <= NEAR for a, b in zip(other, other[1:])) for p in line[::step])


def drawings(a, b, rules):
    """The first difference of two drawings."""
    (lines_a, words_a), (lines_b, words_b) = shapes(a), shapes(b)
    if found := words(words_a, words_b, rules):
        return f"text: {found}"
    lines_a, lines_b = boxed(lines_a), boxed(lines_b)
    for number, line in enumerate(lines_a, 1):
        if not any(follows(line, other) and follows(other, line) for other in lines_b):
            return f"data: line {number} of {len(lines_a)} has no like"
    for number, line in enumerate(lines_b, 1):
        if not any(follows(other, line) and follows(line, other) for other in lines_a):
            return f"data: new line {number} of {len(lines_b)} has no like"
    return None


def words(a, b, rules):
    """Texts in any order; where wording may differ, the numbers in them."""
    if rules.messages_may_differ:
        a, b = ([n for word in side for n in NUMBER.findall(word.replace("\u2212", "-"))] for side in (a, b))
    gone, come = Counter(a) - Counter(b), Counter(b) - Counter(a)
    return f"gone {list(gone)[:4]}, come {list(come)[:4]}" if gone or come else None


class Page(HTMLParser):
    """Visible text, drawings and chart data of a report."""

    def __init__(self, text):
        super().__init__()
        self.words, self.data, self.svg, self.depth, self.inside = [], [], [], 0, ""
        self.svgs = re.findall(r"<svg.*?</svg>(?:\s*</svg>)?", text, re.S)
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag in ("script", "style"):
            self.inside = tag
        if tag == "script" and dict(attributes).get("type") == "application/json":
            self.inside = "data"

    def handle_endtag(self, tag):
        if tag in ("script", "style"):
            self.inside = ""

    def handle_data(self, text):
        word = " ".join(text.split())
        if not word:
            return
        if self.inside == "data":
            self.data.append(json.loads(word))
        elif not self.inside:
            self.words.append(word)


def decoded(value):
    """Chart data with the packed numbers written out: {s, n, v} are steps of a power of ten."""
    if isinstance(value, dict) and value.keys() == {"s", "n", "v"}:
        total, numbers = 0, []
        for index in range(value["n"]):
            total += value["v"][min(index, len(value["v"]) - 1)]
            numbers.append(total * 10.0 ** value["s"])
        return numbers
    if isinstance(value, dict):
        return {key: decoded(v) for key, v in value.items() if key != "frame"}
    return [decoded(v) for v in value] if isinstance(value, list) else value


def series(data):
    """What a chart draws: axes and series with their numbers; the place of the frame on the page is left out."""
    shown = decoded(data)
    places = shown.get("places", [])
    axis = lambda k: {key: v for key, v in shown.get(k, {}).items()}
    listed = []
    for item in shown.get("series", []):
        item = dict(item)
        if isinstance(item.get("x"), int) and item["x"] < len(places):
            item["x"] = places[item["x"]]
        listed.append(item)
    return {"x": axis("x"), "y": axis("y"), "series": listed}


def reports(a, b, rules):
    """The first difference of two reports."""
    from equal import values

    page_a, page_b = Page(a), Page(b)
    if len(page_a.data) != len(page_b.data):
        return f"chart data: {len(page_a.data)} charts became {len(page_b.data)}"
    for number, (left, right) in enumerate(zip(page_a.data, page_b.data), 1):
        if found := values(series(left), series(right), rules):
            return f"chart data: chart {number}: {found}"
    found = words(page_a.words, page_b.words, rules)
    return f"text: {found}" if found else None
