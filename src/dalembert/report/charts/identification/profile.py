"""A profile likelihood: how much worse the data are explained with one parameter held elsewhere."""

import numpy as np
import plotly.graph_objects as go

from dalembert.errors import InputError, unknown
from dalembert.inverse import Profiles
from dalembert.report.charts.drawing import colour_of, draw, stacked
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
    figure = stacked(0.65, 0.35) if several else stacked(1)
    at, deviation, top = curve.values, result.deviations[k], 1.6 * result.threshold
    draw(figure, at, curve.excess, "profile", LIGHT.series[0], row=1, mode="lines+markers", marker_size=5)
    if np.isfinite(deviation) and deviation > 0:
        x = np.linspace(at[0], at[-1], 101)
        y = ((x - result.values[k]) / deviation) ** 2
        draw(figure, x, y, "by the standard deviation", LIGHT.muted, 1.5, row=1, line_dash="dot")
    height, name_of_it = [result.threshold] * 2, f"threshold of {100 * result.level:g} %"
    draw(figure, [at[0], at[-1]], height, name_of_it, LIGHT.series[1], 1.5, row=1, line_dash="dash")
    figure.add_vrect(
        x0=curve.lower,
        x1=curve.upper,
        fillcolor=faint(LIGHT.series[0], 0.1),
        line_width=0,
        row=1,  # pyright: ignore[reportArgumentType]
        col=1,  # pyright: ignore[reportArgumentType]
    )
    for number, (lower, upper) in enumerate(curve.elsewhere):
        legend = number == 0
        draw(figure, [lower, upper], height, "not contradicted either", LIGHT.series[0], 5, row=1, showlegend=legend)
    others = [other for other in range(len(result.parameters)) if other != k]
    for place, other in enumerate(others):
        spread = result.deviations[other]
        unit = spread if np.isfinite(spread) and spread > 0 else result.parameters.scale[other]
        y = (curve.points[:, other] - result.values[other]) / unit
        draw(figure, at, y, plain(result.parameters.names[other]), colour_of(place + 2), 1.5, row=2)
    x = labelled(plain(name), plain(result.parameters.items[k].unit))
    excess = {"title": "excess misfit", "range": [-0.04 * top, top]}
    y = (excess, "others (deviations)") if several else excess
    title = title or f"{plain(name)} in {interval(curve.lower, curve.upper)}"
    return themed(figure, title, 460 if several else 360, x=x, y=y)
