"""Exceptions of the package."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from .scene import Run


class Diagnostic(TypedDict):
    """One fault of an input with its place."""

    file: str
    line: int | None
    column: int | None
    path: str
    expected: str
    found: str | None
    hint: str | None


def _text(fault: Diagnostic) -> str:
    place = f":{fault['line']}:{fault['column']}" if fault["line"] is not None else ""
    path = f"{fault['path']}: " if fault["path"] else ""
    found = f", got {fault['found']}" if fault["found"] is not None else ""
    hint = f"  hint: {fault['hint']}" if fault["hint"] is not None else ""
    return f"{fault['file']}{place}: {path}{fault['expected']}{found}{hint}"


class InputError(ValueError):
    """An input is invalid, or a file cannot be read or written.

    The fields are those of the first fault; `faults` has all of them. For a dictionary `file` is `spec`, `scene`,
    `changes` or `design`, and `line` and `column` are None; for an argument of a call it is `argument`.
    """

    def __init__(self, faults: list[Diagnostic]) -> None:
        super().__init__("\n".join(_text(fault) for fault in faults))
        self.faults: list[Diagnostic] = faults
        first = faults[0]
        self.file: str = first["file"]
        self.line: int | None = first["line"]
        self.column: int | None = first["column"]
        self.path: str = first["path"]
        self.expected: str = first["expected"]
        self.found: str | None = first["found"]
        self.hint: str | None = first["hint"]

    def __reduce__(self) -> tuple[type[InputError], tuple[list[Diagnostic]]]:
        return type(self), (self.faults,)


class UntrustedError(ArithmeticError):
    """Numbers that cannot be trusted: a mechanism, a scene without equilibrium, a run that did not reach its end.

    `run` is the run up to where it stopped, if there is one.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.run: Run | None = None
