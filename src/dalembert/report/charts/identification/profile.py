"""A profile likelihood: how much worse the data are explained with one parameter held elsewhere."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.errors import InputError, unknown
from dalembert.inverse import Profiles
from dalembert.report.digits import interval
from dalembert.report.look import LIGHT, faint, plain, themed
from dalembert.report.quantities import labelled


def profile(result: Profiles, name: str, *, title: str = "") -> go.Figure:
    """Excess of the misfit along one parameter with its threshold; below, how the other parameters make up for it.

    Dotted is what the standard deviation says, a parabola; shaded is the interval.

    Parameters
    ----------
    result : Profiles
    name : str
        The parameter.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a parameter that has no profile.
    """
    curves = {curve.name: curve for curve in result.curves}
    if name not in curves:
        raise InputError(unknown("parameter", name, curves, where="profile"))
    curve, k = curves[name], result.parameters.names.index(name)
    several = len(result.parameters) > 1
    heights = [0.65, 0.35] if several else [1.0]
    figure = make_subplots(rows=len(heights), row_heights=heights, shared_xaxes=True, vertical_spacing=0.06)
    at, deviation, top = curve.values, result.deviations[k], 1.6 * result.threshold
    figure.add_scatter(
        x=at,
        y=curve.excess,
        name="profile",
        mode="lines+markers",
        line={"color": LIGHT.series[0], "width": 2},
        marker={"size": 5},
        row=1,
        col=1,
    )
    if np.isfinite(deviation) and deviation > 0:
        x = np.linspace(at[0], at[-1], 101)
        line = {"color": LIGHT.muted, "width": 1.5, "dash": "dot"}
        y = ((x - result.values[k]) / deviation) ** 2
        figure.add_scatter(x=x, y=y, name="by the standard deviation", mode="lines", line=line, row=1, col=1)
    figure.add_scatter(
        x=[at[0], at[-1]],
        y=[result.threshold] * 2,
        name=f"threshold of {100 * result.level:g} %",
        mode="lines",
        line={"color": LIGHT.series[1], "width": 1.5, "dash": "dash"},
        row=1,
        col=1,
    )
    figure.add_vrect(
        x0=curve.lower,
        x1=curve.upper,
        fillcolor=faint(LIGHT.series[0], 0.1),
        line_width=0,
        row=1,  # pyright: ignore[reportArgumentType]
        col=1,  # pyright: ignore[reportArgumentType]
    )
    for number, (lower, upper) in enumerate(curve.elsewhere):
        figure.add_scatter(
            x=[lower, upper],
            y=[result.threshold] * 2,
            name="not contradicted either",
            showlegend=number == 0,
            mode="lines",
            line={"color": LIGHT.series[0], "width": 5},
            row=1,
            col=1,
        )
    others = [other for other in range(len(result.parameters)) if other != k]
    for place, other in enumerate(others):
        spread = result.deviations[other]
        unit = spread if np.isfinite(spread) and spread > 0 else result.parameters.scale[other]
        figure.add_scatter(
            x=at,
            y=(curve.points[:, other] - result.values[other]) / unit,
            name=plain(result.parameters.names[other]),
            mode="lines",
            line={"color": LIGHT.series[(place + 2) % len(LIGHT.series)], "width": 1.5},
            row=2,
            col=1,
        )
    themed(figure, title or f"{plain(name)} in {interval(curve.lower, curve.upper)}", height=460 if several else 360)
    figure.update_yaxes(title_text="excess misfit", range=[-0.04 * top, top], row=1, col=1)
    if several:
        figure.update_yaxes(title_text="others (deviations)", row=2, col=1)
    unit = plain(result.parameters.items[k].unit)
    return figure.update_xaxes(title_text=labelled(plain(name), unit), row=2 if several else 1, col=1)
