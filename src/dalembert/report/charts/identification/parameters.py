"""Identified parameters within their bounds."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import Fit
from dalembert.inverse.fit.fit_tables import on_bound
from dalembert.report.charts.drawing import draw
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import shown

BETWEEN = {"showgrid": False, "tickvals": [0, 0.5, 1], "ticktext": ["lower", "middle", "upper"]}
"""Axis of the way between the bounds."""


def parameters(fit: Fit, *, title: str = "Parameters within their bounds") -> go.Figure:
    """Each value where it lies between its bounds, with two standard deviations; a value on a bound is a diamond.

    Where the logarithm of a parameter is searched, the way between its bounds is logarithmic too.

    Parameters
    ----------
    fit : Fit
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    box = fit.parameters
    deviations = np.asarray(fit.deviations, dtype=float)
    spread = np.where(np.isfinite(deviations), 2 * deviations, 0.0)
    place, low, high = [
        box.shares(box.clip(values)) for values in (fit.values, fit.values - spread, fit.values + spread)
    ]
    stuck = on_bound(box, fit.values)
    texts = [
        f"{shown(value, deviation)} {plain(item.unit)}".strip()
        for item, value, deviation in zip(box, fit.values, fit.deviations, strict=True)
    ]
    names = [plain(name) for name in box.names]
    figure = tracks(names)
    bars = {"array": high - place, "arrayminus": place - low, "symmetric": False}
    symbols = [("diamond", LIGHT.series[1]) if at else ("circle", LIGHT.series[0]) for at in stuck]
    style = {
        "error_x": {**bars, "thickness": 2, "width": 6, "color": LIGHT.ink},
        "textposition": [f"top {side_of(at)}" for at in place],
        "cliponaxis": False,
        "marker": {"size": 11, "symbol": [symbol for symbol, _ in symbols], "color": [colour for _, colour in symbols]},
    }
    figure.add_scatter(x=place, y=names, mode="markers+text", text=texts, **style, showlegend=False)
    x, y = {**BETWEEN, "range": [-0.1, 1.1]}, {"range": [len(box) - 0.5, -0.7], "showgrid": False}
    return themed(figure, title, 110 + 56 * len(box), x=x, y=y, margin_t=56)


def tracks(names: Sequence[str]) -> go.Figure:
    """A figure with a track between the bounds of each parameter, from 0 to 1, a row each."""
    figure = go.Figure()
    for name in names:
        draw(figure, [0, 1], [name, name], "", LIGHT.grid, 8, hoverinfo="skip", showlegend=False)
    return figure


def side_of(place: float) -> str:
    """Side of a point on its track at which its text has room."""
    return "right" if place < 0.25 else "left" if place > 0.75 else "center"
