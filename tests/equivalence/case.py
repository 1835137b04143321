"""A case: files, and commands that run in the folder which holds them."""

import json
import random
from dataclasses import dataclass, field


@dataclass
class Case:
    """What both programs are given.

    `files` maps a path in the case's folder to its text or bytes; `commands` are the arguments of one call each, run
    in order in that folder. `tags` say what the case exercises; they are counted, never judged. `folder` is a folder
    whose files are copied in addition (for the examples).
    """

    name: str
    files: dict
    commands: list
    tags: set = field(default_factory=set)
    folder: str = ""
    timeout: float = 120.0


class Draw(random.Random):
    """Random numbers with a few digits, so that the files read like those that people write."""

    def number(self, least, most, digits=4):
        """A number between two bounds, uniform, rounded to `digits` significant digits."""
        return significant(self.uniform(least, most), digits)

    def size(self, least, most, digits=4):
        """A positive number between two bounds, uniform in its logarithm."""
        return significant(least * (most / least) ** self.random(), digits)

    def yes(self, probability):
        """True with this probability."""
        return self.random() < probability

    def weighted(self, **weights):
        """One of the keywords, by its weight."""
        return self.choices(list(weights), list(weights.values()))[0]


def significant(value, digits=4):
    """`value` rounded to significant digits."""
    return float(f"{value:.{digits}g}")


LENGTHS = {"ft": 0.3048, "in": 0.0254, "m": 1.0, "mm": 0.001}
FORCES = {"lbf": 4.4482216152605, "kip": 4448.2216152605, "N": 1.0, "kN": 1000.0}


class Units:
    """Converts from metres, newtons and seconds to the units of one file, with a few digits.

    Method names say the quantity: `length(3.0)` is three metres in the file's unit of length.
    """

    def __init__(self, length, force):
        self.names = {"length": length, "force": force, "time": "s"}
        self.metre = 1.0 / LENGTHS[length]
        self.newton = 1.0 / FORCES[force]

    def of(self, value, lengths, forces, digits=6):
        """`value` in SI units of dimension length^lengths force^forces, in the units of the file."""
        return significant(value * self.metre**lengths * self.newton**forces, digits)

    def length(self, value):
        return self.of(value, 1, 0)

    def lengths(self, values):
        return [self.length(value) for value in values]

    def area(self, value):
        return self.of(value, 2, 0)

    def second_moment(self, value):
        return self.of(value, 4, 0)

    def modulus(self, value):
        return self.of(value, -2, 1)

    def force(self, value):
        return self.of(value, 0, 1)

    def moment(self, value):
        return self.of(value, 1, 1)

    def stiffness(self, value):
        """Force per length; also a damping, force per speed."""
        return self.of(value, -1, 1)

    def mass(self, value):
        return self.of(value, -1, 1)

    def inertia(self, value):
        """Mass times length squared."""
        return self.of(value, 1, 1)

    def density(self, value):
        return self.of(value, -4, 1)

    def line_mass(self, value):
        return self.of(value, -2, 1)


def units(draw):
    """Units of a file, all combinations."""
    return Units(draw.choice(list(LENGTHS)), draw.choice(list(FORCES)))


def text(value):
    """JSON of a drawn file."""
    return json.dumps(value, indent=1) + "\n"
