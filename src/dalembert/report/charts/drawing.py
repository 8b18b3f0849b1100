"""Parts of figures: lines, rows below each other, and logarithmic axes."""

from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.report.look import LIGHT

LABELS = 8
"""Decades of an axis up to which each has a label."""


HOVER = "%{x:.6g} Hz, %{y:.5g}"
"""Text at a point of a curve over frequency."""


def stacked(*heights: float, spacing: float = 0.06) -> go.Figure:
    """An empty figure of rows below each other, with relative heights, over the same abscissa."""
    return make_subplots(rows=len(heights), row_heights=heights, shared_xaxes=True, vertical_spacing=spacing)


def draw(
    figure: go.Figure, x: Any, y: Any, name: str, colour: str, width: float = 2, *, row: int | None = None, **style: Any
) -> None:
    """Add a line (samples,) to a figure, or to one of its rows.

    ``style`` has further settings of the trace; those of the line, such as ``dash``, are named as ``line_dash``.
    """
    style_here = {"mode": "lines", "line_color": colour, "line_width": width, **style}
    figure.add_scatter(x=x, y=y, name=name or None, row=row, col=None if row is None else 1, **style_here)


def colour_of(place: int) -> str:
    """The colour of a series by its number from 0; the colours repeat."""
    return LIGHT.series[place % len(LIGHT.series)]


def positive(values: np.ndarray) -> np.ndarray:
    """Return values for a logarithmic axis: NaN, a gap, where they are not positive or not finite."""
    return np.where((values > 0) & np.isfinite(values), values, np.nan)


def logarithmic(figure: go.Figure, along: str = "y") -> dict[str, Any]:
    """Settings of a logarithmic axis: a label at every decade or few; at 2 and 5 too where there are few."""
    traces: Any = figure.data
    series = [np.asarray(trace[along], dtype=float) for trace in traces]
    values = np.concatenate([*series, [np.nan]])
    values = np.log10(values[np.isfinite(values) & (values > 0)])
    span = float(np.ptp(values)) if len(values) else 0.0
    if span <= 1:
        return {"type": "log"}
    if span < 2:
        decades = range(int(np.floor(values.min())) - 1, int(np.ceil(values.max())) + 2)
        return {"type": "log", "tickvals": [float(f"{step}e{decade}") for decade in decades for step in (1, 2, 5)]}
    return {"type": "log", "dtick": max(1, int(np.ceil(span / LABELS)))}
