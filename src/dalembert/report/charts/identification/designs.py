"""Designs of an experiment: which would tell the parameters best, and what a longer measurement brings."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import Designs
from dalembert.report.charts.drawing import draw, logarithmic, positive
from dalembert.report.charts.identification.identifiability import labelled_points
from dalembert.report.digits import shown
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.quantities import labelled

MOST = 20
"""Designs that a ranking shows."""


def ranking(result: Designs, *, title: str = "Ranking") -> go.Figure:
    """Scores of the best designs on a logarithmic scale, the best on top; small is good.

    Designs that leave a combination of the parameters unseen have no score and are left out.

    Parameters
    ----------
    result : Designs
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    told = np.flatnonzero(np.isfinite(result.scores))[:MOST]
    rows = [f"{k + 1} · {named(result, k)}" for k in told]
    texts = [shown(float(score), digits=3) for score in result.scores[told]]
    figure = labelled_points(positive(result.scores[told]), rows, texts, "middle right", 10)
    x = {"title": f"score ({result.criterion}), in parts of the scales", **logarithmic(figure, "x")}
    layout = {"showlegend": False, "margin_r": 72}
    return themed(figure, title, 150 + 26 * max(2, len(told)), x=x, y={"autorange": "reversed"}, **layout)


def horizons(result: Designs, *, title: str = "What a longer measurement brings") -> go.Figure:
    """Score over the horizon, one line a set of sensors, on a logarithmic scale; a gap where something is unseen.

    Parameters
    ----------
    result : Designs
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = go.Figure()
    for chosen, colour in zip(dict.fromkeys(result.sensors), LIGHT.series, strict=False):
        own = [k for k, sensors in enumerate(result.sensors) if sensors == chosen]
        own.sort(key=lambda k: result.horizons[k])
        x, y = result.horizons[own], positive(result.scores[own])
        draw(figure, x, y, plain(", ".join(chosen)), colour, mode="lines+markers")
    y = {"title": "score", **logarithmic(figure)}
    return themed(figure, title, 400, x=labelled(result.along, result.unit), y=y, showlegend=True)


def named(result: Designs, k: int) -> str:
    """A design in a few words."""
    sensors = plain(", ".join(result.sensors[k]))
    several = len(set(result.horizons.tolist())) > 1
    return f"{sensors} · {shown(float(result.horizons[k]))} {plain(result.unit)}" if several else sensors
