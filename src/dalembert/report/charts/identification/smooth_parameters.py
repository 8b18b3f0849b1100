"""Smooth parameters with their band, and the L-curve that their penalty was chosen by."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import RegularisedFit
from dalembert.report.charts.drawing import draw, logarithmic, positive
from dalembert.report.look import LIGHT, themed


def smooth_parameters(fit: RegularisedFit, *, title: str = "") -> go.Figure:
    """Values of the smooth parameters in their order, with a band of two standard deviations.

    Parameters
    ----------
    fit : RegularisedFit
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    places = [fit.names.index(name) for name in fit.smooth]
    values, deviations = fit.values[places], fit.deviations[places]
    numbers, units = np.arange(1, len(places) + 1), {fit.units[place] for place in places}
    unit = f" in {units.pop()}" if len(units) == 1 and "" not in units else ""
    figure = go.Figure()
    edge = {"mode": "lines", "line": {"width": 0}, "showlegend": False, "hoverinfo": "skip"}
    figure.add_scatter(x=numbers, y=values - 2 * deviations, **edge)
    band = {**edge, "showlegend": True, "name": "two standard deviations"}
    figure.add_scatter(
        x=numbers, y=values + 2 * deviations, fill="tonexty", fillcolor="rgba(70, 120, 200, 0.2)", **band
    )
    draw(figure, numbers, values, "value", LIGHT.series[0], 2, text=list(fit.smooth))
    heading = title or f"{len(places)} smooth parameters"
    return themed(figure, heading, x={"title": "number of the parameter"}, y={"title": f"value{unit}"})


def penalty_curve(fit: RegularisedFit, *, title: str = "L-curve") -> go.Figure:
    """Penalty over residual of the linearised problem for all weights, with the weights of both rules.

    Parameters
    ----------
    fit : RegularisedFit
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = go.Figure()
    x, y = positive(fit.residual_norms), positive(fit.penalty_norms)
    draw(figure, x, y, "all weights", LIGHT.series[0], 2, text=[f"μ = {weight:.3g}" for weight in fit.weights])
    marks = (("corner", fit.corner, "circle"), ("discrepancy principle", fit.discrepancy, "diamond"))
    for number, (name, weight, symbol) in enumerate(marks, 1):
        if np.isfinite(weight):
            place = [np.interp(np.log(weight), np.log(fit.weights), np.log(norms)) for norms in (x, y)]
            figure.add_scatter(
                x=[np.exp(place[0])], y=[np.exp(place[1])], name=name, text=[f"μ = {weight:.3g}"], mode="markers",
                marker={"color": LIGHT.series[number], "size": 11, "symbol": symbol},
            )  # fmt: skip
    across = {"title": "residual norm", **logarithmic(figure, "x")}
    return themed(figure, title, x=across, y={"title": "norm of the differences", **logarithmic(figure)})
