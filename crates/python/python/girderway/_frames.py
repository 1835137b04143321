"""Columns as data frames and as figures, with libraries that may be installed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


def data_frame(columns: Mapping[str, Any], library: str | None) -> Any:
    """A data frame of pandas or polars; pandas first where both are installed."""
    if library not in (None, "pandas", "polars"):
        raise ValueError(f'library must be "pandas" or "polars", got {library!r}')
    if library in (None, "pandas"):
        try:
            import pandas
        except ImportError:
            if library == "pandas":
                raise
        else:
            return pandas.DataFrame(dict(columns))
    try:
        import polars
    except ImportError as error:
        raise ImportError("data frames need pandas or polars: pip install pandas") from error
    return polars.DataFrame(dict(columns))


def axes(given: Any) -> Any:
    """The axes to draw in: those given, or new ones of matplotlib."""
    if given is not None:
        return given
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("plots need matplotlib: pip install matplotlib") from error
    return pyplot.subplots(layout="constrained")[1]


def lines(ax: Any, x: Any, series: Sequence[tuple[str, Any]]) -> Any:
    """Draws series over x with a legend."""
    for name, values in series:
        ax.plot(x, values, label=name)
    ax.grid(True, linewidth=0.4, alpha=0.6)
    if len(series) > 1:
        ax.legend()
    return ax
