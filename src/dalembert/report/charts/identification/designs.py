"""Designs of an experiment: which would tell the parameters best, and what a longer measurement brings."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import Designs
from dalembert.report.charts.logarithm import logarithmic, positive
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
    figure = go.Figure(
        go.Scatter(
            x=positive(result.scores[told]),
            y=[f"{k + 1} · {named(result, k)}" for k in told],
            text=[shown(float(score), digits=3) for score in result.scores[told]],
            mode="markers+text",
            textposition="middle right",
            cliponaxis=False,
            marker={"color": LIGHT.series[0], "size": 10},
        )
    )
    themed(figure, title, height=150 + 26 * max(2, len(told)))
    figure.update_xaxes(title=f"score ({result.criterion}), in parts of the scales", **logarithmic(figure, "x"))
    return figure.update_yaxes(autorange="reversed").update_layout(showlegend=False, margin_r=72)


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
    for place, chosen in enumerate(list(dict.fromkeys(result.sensors))[: len(LIGHT.series)]):
        own = [k for k, sensors in enumerate(result.sensors) if sensors == chosen]
        own.sort(key=lambda k: result.horizons[k])
        figure.add_scatter(
            x=result.horizons[own],
            y=positive(result.scores[own]),
            name=plain(", ".join(chosen)),
            mode="lines+markers",
            line={"color": LIGHT.series[place], "width": 2},
        )
    themed(figure, title, height=400)
    figure.update_xaxes(title=labelled(result.along, result.unit))
    return figure.update_yaxes(title="score", **logarithmic(figure)).update_layout(showlegend=True)


def named(result: Designs, k: int) -> str:
    """A design in a few words."""
    sensors = plain(", ".join(result.sensors[k]))
    several = len(set(result.horizons.tolist())) > 1
    return f"{sensors} · {shown(float(result.horizons[k]))} {plain(result.unit)}" if several else sensors
