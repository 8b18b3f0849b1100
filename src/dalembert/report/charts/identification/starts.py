"""Which starts end in the same minimum, and how far each came down."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import BandFit, Fit
from dalembert.report.charts.logarithm import logarithmic, positive
from dalembert.report.look import LIGHT, plain, themed


def starts(fit: Fit | BandFit, *, title: str = "Starts and their ends") -> go.Figure:
    """Waterfall: final fitness of every start, best first, each with a stem from where it started.

    A flat step of several starts is a minimum that many ways lead to.

    Parameters
    ----------
    fit : Fit or BandFit
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    order = ranked(fit)
    ends = positive(np.array([fit.starts[number].fitness for number in order], dtype=float))
    began = positive(np.array([_first(fit, number) for number in order], dtype=float))
    rank = np.arange(1, len(order) + 1)
    stems = np.stack([began, ends, np.full(len(order), np.nan)], axis=1).ravel()
    figure = go.Figure()
    figure.add_scatter(
        x=np.repeat(rank, 3), y=stems, mode="lines", line={"color": LIGHT.grid, "width": 3}, hoverinfo="skip"
    ).update_traces(showlegend=False)
    figure.add_scatter(
        x=rank, y=began, name="at its start", mode="markers", marker={"symbol": "line-ew-open", "size": 12}
    ).update_traces(marker_color=LIGHT.muted, selector={"name": "at its start"})
    for name, success, colour, symbol in (
        ("converged", True, LIGHT.series[0], "circle"),
        ("not converged", False, LIGHT.series[1], "x"),
    ):
        here = [place for place, number in enumerate(order) if fit.starts[number].success is success]
        figure.add_scatter(
            x=rank[here],
            y=ends[here],
            name=name,
            mode="markers",
            marker={"color": colour, "symbol": symbol, "size": 9},
            text=[f"start {order[place] + 1}: {plain(fit.starts[order[place]].message)}" for place in here],
            showlegend=bool(here),
        )
    themed(figure, title, height=360)
    figure.update_xaxes(title="starts, best first", dtick=max(1, len(order) // 10))
    return figure.update_yaxes(title="fitness", **logarithmic(figure))


def ranked(fit: Fit | BandFit) -> list[int]:
    """Numbers of the starts, the lowest final fitness first, those that failed last."""
    return sorted(range(len(fit.starts)), key=lambda number: np.nan_to_num(fit.starts[number].fitness, nan=np.inf))


def _first(fit: Fit | BandFit, number: int) -> float:
    return next((step.best for step in fit.history if step.start == number), np.nan)
