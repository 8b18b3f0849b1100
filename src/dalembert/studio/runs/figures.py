"""Figures of unfinished runs, and of several runs together."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.report.charts.drawing import logarithmic, positive
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import labelled

if TYPE_CHECKING:
    from nicegui import ui

MOST_ROWS = 12
"""Parameters that are drawn over simulations, the first ones."""
CONFIG = {"displayModeBar": False, "responsive": False}
"""No buttons, which would cover a figure on a phone; the page fits it to its place, not NiceGUI."""
NEUTRAL = "#76818f"
"""Readable on a light and on a dark page."""


def convergence(curves: Mapping[str, Sequence[tuple[float, float]]]) -> go.Figure:
    """Best value so far over the number of simulations, a line a run.

    Parameters
    ----------
    curves : mapping of str to sequence of (simulations, best)
        By the runs' names.
    """
    figure = go.Figure()
    for place, (name, points) in enumerate(curves.items()):
        x, y = np.array(points, dtype=float).reshape(-1, 2).T
        line = {"color": LIGHT.series[place % len(LIGHT.series)], "width": 2}
        mode = "lines" if len(x) > 1 else "markers"  # a line through one point is not seen
        figure.add_scatter(x=x, y=positive(y), name=plain(name), mode=mode, line=line)
    themed(figure, "", height=320)
    figure.update_xaxes(title="simulations", rangemode="tozero")
    figure.update_yaxes(title="smallest misfit so far", **logarithmic(figure))
    return on_any_page(figure.update_layout(showlegend=len(curves) > 1))


def wandering(
    visited: Sequence[tuple[float, int, Sequence[float]]],
    names: Sequence[str],
    units: Mapping[str, tuple[str, float]] | None = None,
) -> go.Figure:
    """Parameters over the simulations, each in a row, a line for each start. ``visited`` has simulations, start and
    values of each point, ``names`` those of the parameters. ``units`` are the units in which they are drawn, and their
    sizes in SI units.
    """
    rows = min(len(names), MOST_ROWS)
    shown = [(units or {}).get(name, ("", 1.0)) for name in names]
    figure = make_subplots(rows=rows, cols=1, shared_xaxes=True, vertical_spacing=0.04)
    for start in sorted({start for _, start, _ in visited}):
        own = [(at, values) for at, number, values in visited if number == start]
        line = {"color": LIGHT.series[start % len(LIGHT.series)], "width": 2}
        for row in range(rows):
            style = {"name": f"start {start + 1}", "legendgroup": str(start), "showlegend": row == 0, "line": line}
            x, y = [at for at, _ in own], [values[row] / shown[row][1] for _, values in own]
            figure.add_scatter(x=x, y=y, mode="lines+markers", marker={"size": 4}, row=row + 1, col=1, **style)
    themed(figure, "", height=80 + 110 * rows)
    for row, name in enumerate(names[:rows], start=1):
        figure.update_yaxes(title=plain(labelled(name, shown[row - 1][0])), row=row)
    figure.update_xaxes(title="simulations", rangemode="tozero", row=rows)
    return on_any_page(figure)


def followed(points: Sequence[tuple[float, float]], axes: tuple[str, str]) -> go.Figure:
    """A path as far as it has come, points of (place, size), with its last point marked."""
    figure = go.Figure()
    x, y = np.array(points, dtype=float).reshape(-1, 2).T
    figure.add_scatter(x=x, y=y, mode="lines", line={"color": LIGHT.series[0], "width": 2})
    figure.add_scatter(x=x[-1:], y=y[-1:], mode="markers", marker={"color": LIGHT.series[0], "size": 9})
    themed(figure, "", height=320)
    figure.update_xaxes(title=plain(axes[0]))
    figure.update_yaxes(title=plain(axes[1]), rangemode="tozero")
    return on_any_page(figure.update_layout(showlegend=False))


def plot(figure: go.Figure) -> "ui.plotly":
    """The figure on a page, without the buttons that would cover it on a phone."""
    from nicegui import ui  # not for processes that make figures, and show none

    return ui.plotly(bare(figure))


def bare(figure: go.Figure) -> dict[str, Any]:
    """The figure as a page takes it, which fits it to its place: see :mod:`dalembert.studio.frame`."""
    return figure.to_plotly_json() | {"config": CONFIG}


def on_any_page(figure: go.Figure) -> go.Figure:
    """The figure with a transparent background, for a light and for a dark page."""
    clear = "rgba(0,0,0,0)"
    figure.update_layout(paper_bgcolor=clear, plot_bgcolor=clear, font_color=NEUTRAL)
    figure.update_layout(margin={"l": 60, "r": 10, "t": 20, "b": 45})
    grid = {"gridcolor": "rgba(118,129,143,0.25)", "linecolor": NEUTRAL, "zerolinecolor": "rgba(118,129,143,0.4)"}
    return figure.update_xaxes(grid).update_yaxes(grid)
