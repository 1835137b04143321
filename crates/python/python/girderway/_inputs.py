"""Inputs: paths, or dictionaries as JSON texts."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any, Union

from ._errors import InputError

#: A path, or a dictionary with the members of the file.
Source = Union[str, "os.PathLike[str]", Mapping[str, Any]]


def _plain(value: Any) -> Any:
    """Arrays and numbers of numpy, paths and mappings as JSON has them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "__iter__"):
        return list(value)
    raise TypeError(f"{type(value).__name__} is not a value of JSON")


def text(value: Mapping[str, Any], name: str) -> str:
    """A dictionary as JSON text; numbers keep all their digits."""
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise InputError(
            [
                {
                    "file": name,
                    "line": None,
                    "column": None,
                    "path": "",
                    "expected": f"must consist of dictionaries, lists, strings and finite numbers: {error}",
                    "found": None,
                    "hint": None,
                }
            ]
        ) from None


def given(source: Source, name: str, folder: str | os.PathLike[str] | None) -> str | tuple[str, str]:
    """A source as the native module takes it: a path, or a text and the folder of the files that it names."""
    if isinstance(source, Mapping):
        return text(source, name), os.fspath(folder) if folder is not None else ""
    if folder is not None:
        raise TypeError("folder belongs to a dictionary; a file names others relative to its own folder")
    return os.fspath(source)
