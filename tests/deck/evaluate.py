"""An evaluation of ADAMS data sets that shares nothing with the program: reader, expressions, splines, and frames of markers.

Parts have the small rotations theta of the simulator: the point r of a part at O stands at O + r + theta x r. Markers of the ground
are not turned, and displacements are taken in their axes.
"""

import math
import re

FUNCTIONS = {"FUNCTION", "FX", "FY", "FZ", "TX", "TY", "TZ", *(f"F{i}" for i in range(1, 9))}


class Statement:
    def __init__(self, keyword, number, name):
        self.keyword, self.number, self.name, self.arguments = keyword, number, name, []

    def get(self, name):
        return next((value for own, value in self.arguments if own == name), None)

    def all(self, name):
        return [value for own, value in self.arguments if own == name]

    def label(self):
        return f"{self.keyword}/{self.number} ({self.name})"


def read(text):
    """The statements of a data set by keyword and number."""
    out, name, now, last = {}, None, None, None
    for line in text.split("\n")[1:]:
        if line.startswith("!"):
            found = re.match(r"!\s+adams_view_name='(.*)'", line)
            name = found.group(1) if found else name
        elif line.startswith(","):
            rest = line[1:].strip()
            found = re.match(r"([A-Z][A-Z0-9_]*)\s*=\s*(.*)$", rest)
            if found:
                last = [found.group(1), found.group(2)]
                now.arguments.append(last)
            elif re.fullmatch(r"[A-Z_]+", rest):
                last = [rest, ""]
                now.arguments.append(last)
            elif last[0] in FUNCTIONS:
                last[1] += rest
            else:
                last[1] = last[1].rstrip(",") + "," + rest
        elif "/" in line:
            keyword, number = line.split("/", 1)
            now, last = Statement(keyword.strip(), int(number) if number.strip() else 0, name), None
            out[now.keyword, now.number] = now
            name = None
    for one in out.values():
        for own in one.arguments:
            own[1] = own[1].rstrip("\\").strip()
    return out


def numbers(text):
    return [float(v) for v in text.split(",") if v.strip()]


# splines


def natural(x, y):
    """Second derivatives of the natural cubic spline."""
    n = len(x)
    below, over = [0.0] * n, [0.0] * n
    for i in range(1, n - 1):
        a, b = x[i] - x[i - 1], x[i + 1] - x[i]
        load = 6 * ((y[i + 1] - y[i]) / b - (y[i] - y[i - 1]) / a)
        pivot = 2 * (a + b) - a * below[i - 1]
        below[i] = b / pivot
        over[i] = (load - a * over[i - 1]) / pivot
    out = [0.0] * n
    for i in range(n - 2, 0, -1):
        out[i] = over[i] - below[i] * out[i + 1]
    return out


def akima(x, y):
    """Slopes at the points by Akima's rule of 1970."""
    m = [(b - a) / (q - p) for a, b, p, q in zip(y, y[1:], x, x[1:])]
    m = [3 * m[0] - 2 * m[1], 2 * m[0] - m[1], *m, 2 * m[-1] - m[-2], 3 * m[-1] - 2 * m[-2]]
    out = []
    for i in range(len(x)):
        a, b, c, d = m[i: i + 4]
        left, right = abs(d - c), abs(b - a)
        out.append((b + c) / 2 if left + right == 0 else (left * b + right * c) / (left + right))
    return out


def interval(x, at):
    low, high = 0, len(x) - 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if x[middle] <= at else (low, middle)
    return low


class Curve:
    """A curve by a natural cubic spline or by Akima's cubics, with values and slopes."""

    def __init__(self, x, y, kind):
        self.x, self.y, self.kind = x, y, kind
        self.own = natural(x, y) if kind == "cubspl" else akima(x, y)

    def value(self, at, order=0):
        i = interval(self.x, at)
        h, (a, b), (p, q) = self.x[i + 1] - self.x[i], self.y[i: i + 2], self.own[i: i + 2]
        s = (at - self.x[i]) / h
        if self.kind == "cubspl":
            if order:
                return (b - a) / h - h / 6 * ((3 * (1 - s) ** 2 - 1) * p - (3 * s**2 - 1) * q)
            return (1 - s) * a + s * b + h * h / 6 * (((1 - s) ** 3 - (1 - s)) * p + (s**3 - s) * q)
        if order:
            return 6 * s * (1 - s) * (b - a) / h + (1 - s) * (1 - 3 * s) * p + s * (3 * s - 2) * q
        return (1 + 2 * s) * (1 - s) ** 2 * a + s * (1 - s) ** 2 * h * p + s * s * (3 - 2 * s) * b + s * s * (s - 1) * h * q


class Spline:
    """A curve, or a family of curves that is linear between them."""

    def __init__(self, statement, kind):
        x, rows = numbers(statement.get("X")), [numbers(row) for row in statement.all("Y")]
        self.x, self.z = x, None
        if len(rows) == 1 and len(rows[0]) == len(x):
            self.curves = [Curve(x, rows[0], kind)]
        else:
            self.z = [row[0] for row in rows]
            self.curves = [Curve(x, row[1:], kind) for row in rows]

    def value(self, x, z, order=0):
        if self.z is None:
            return self.curves[0].value(x, order)
        i = interval(self.z, z)
        s = (z - self.z[i]) / (self.z[i + 1] - self.z[i])
        return (1 - s) * self.curves[i].value(x) + s * self.curves[i + 1].value(x)


# functions


def step(x, x0, h0, x1, h1):
    if x <= x0:
        return h0
    if x >= x1:
        return h1
    d = (x - x0) / (x1 - x0)
    return h0 + (h1 - h0) * d * d * (3 - 2 * d)


def impact(x, rate, free, k, e, c, d):
    return max(0.0, k * (free - x) ** e - step(x, free - d, c, free, 0.0) * rate) if x < free else 0.0


def branch(x, below, at, above):
    return below if x < 0 else at if x == 0 else above


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class Deck:
    """A data set whose expressions can be evaluated where parts stand."""

    def __init__(self, text):
        self.statements = read(text)
        self.kept, self.code = {}, {}
        self.parts, self.given, self.differentials, self.rates, self.known = {}, {}, {}, {}, {}
        self.calls = {
            "VARVAL": self.variable, "DIF": lambda k: self.differentials[k], "DIF1": lambda k: self.rates[k],
            "AKISPL": lambda x, z, k, order=0: self.spline(k, "akispl").value(x, z, order),
            "CUBSPL": lambda x, z, k, order=0: self.spline(k, "cubspl").value(x, z, order),
            "STEP": step, "IMPACT": impact, "IF": branch, "MAX": max, "MIN": min, "ABS": abs, "TANH": math.tanh,
            "SQRT": math.sqrt, "WZ": self.spin, "TIME": 0.0,
        }
        for axis, letter in enumerate("XYZ"):
            self.calls[f"D{letter}"] = lambda i, j=0, k=0, axis=axis: self.apart(axis, i, j, k)
            self.calls[f"V{letter}"] = lambda i, j=0, k=0, m=0, axis=axis: self.speed(axis, i, j, k, m)

    def spline(self, number, kind):
        if (number, kind) not in self.kept:
            self.kept[number, kind] = Spline(self.statements["SPLINE", number], kind)
        return self.kept[number, kind]

    def of(self, keyword):
        return [one for (own, _), one in self.statements.items() if own == keyword]

    def place(self, parts, given, differentials, rates):
        """Sets where parts stand: origin, rotation, velocity, angular velocity; and the values that are given."""
        self.parts, self.given, self.differentials, self.rates = parts, given, differentials, rates
        self.known = dict(given)

    def point(self, marker):
        """Position and velocity of a marker, and the angular velocity of its part; the marker 0 is the ground."""
        if marker == 0:
            return [0.0] * 3, [0.0] * 3, [0.0] * 3
        own = self.statements["MARKER", marker]
        at = numbers(own.get("QP") or "0,0,0")
        if own.get("REULER") or own.get("FLOATING") is not None:
            raise ValueError(f"{own.label()} is turned or floating")
        part = int(own.get("PART"))
        if self.statements["PART", part].get("GROUND") is not None:
            return at, [0.0] * 3, [0.0] * 3
        origin, turn, velocity, spin = self.parts[part]
        place = [o + r + t for o, r, t in zip(origin, at, cross(turn, at))]
        return place, [v + w for v, w in zip(velocity, cross(spin, at))], spin

    def is_ground(self, marker):
        if marker == 0:
            return True
        part = int(self.statements["MARKER", marker].get("PART"))
        return self.statements["PART", part].get("GROUND") is not None

    def axes(self, *markers):
        for marker in markers:
            if not self.is_ground(marker):
                raise ValueError(f"the axes of MARKER/{marker} move")

    def apart(self, axis, i, j, k):
        self.axes(k)
        return self.point(i)[0][axis] - self.point(j)[0][axis]

    def speed(self, axis, i, j, k, m):
        self.axes(k, m)
        return self.point(i)[1][axis] - self.point(j)[1][axis]

    def spin(self, i, j=0, k=0):
        self.axes(k)
        return self.point(i)[2][2] - self.point(j)[2][2]

    def evaluate(self, text):
        """The value of an expression, whose operators have the precedence of FORTRAN."""
        if text not in self.code:
            for word in re.findall(r"[A-Za-z_][A-Za-z0-9_]*", re.sub(r"\d\.?\d*[eE][-+]?\d+", "", text)):
                if word not in self.calls:
                    raise ValueError(f"unknown function {word}")
            self.code[text] = compile(text.replace(":", ","), "deck", "eval")
        return float(eval(self.code[text], {"__builtins__": {}}, self.calls))  # noqa: S307: words were checked

    def variable(self, number):
        """The given value of a VARIABLE, or that of its expression."""
        if number not in self.known:
            self.known[number] = self.expression(number)
        return self.known[number]

    def expression(self, number):
        return self.evaluate(self.statements["VARIABLE", number].get("FUNCTION"))
