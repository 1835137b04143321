"""Wheels that roll along flexible steel: influence functions, crane runways, scenes in motion.

>>> import girderway as gw
>>> girder = gw.Structure({"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
...     "girder": {"spans": [6, 7.5, 6], "section": "HEB 400", "crane_rail": "A65"}})
>>> girder.influence([3.0], [3.0]).shape
(1, 1)
"""

from ._errors import Diagnostic, InputError, UntrustedError
from ._native import __version__
from .design import Design, design
from .models import import_model
from .scene import Case, Run, map, run
from .structure import Modes, Structure
from .sweep import Sweep, join_shards, sweep

__all__ = [
    "Case",
    "Design",
    "Diagnostic",
    "InputError",
    "Modes",
    "Run",
    "Structure",
    "Sweep",
    "UntrustedError",
    "__version__",
    "design",
    "import_model",
    "join_shards",
    "map",
    "run",
    "sweep",
]
