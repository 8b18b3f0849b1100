"""What is known beyond a fit: profiles, predictions, and designs of experiments."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from dalembert.errors import InputError, unknown
from dalembert.inverse import Designs, Prediction, Profiles
from dalembert.report.charts.bounds.bands import draw_line, dressed, fill_band, selected
from dalembert.report.charts.drawing import colour_of, draw, logarithmic, positive, stacked
from dalembert.report.charts.identification.identifiability import labelled_points
from dalembert.report.charts.identification.responses import FEW
from dalembert.report.look import LIGHT, faint, plain, themed
from dalembert.report.thinning import thinned
from dalembert.tables import interval, labelled, shown


def prediction(result: Prediction, channels: Sequence[str] | None = None, *, title: str = "Prediction") -> go.Figure:
    """Response with the band of its true value, fainter the band of a new measurement; below, half the widths.

    Parameters
    ----------
    result : Prediction
    channels : sequence of str, optional
        Channels to draw, all if not given; they share an axis.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a channel that is not predicted.
    """
    chosen = selected(result, channels, "prediction")
    figure = stacked(0.72, 0.28, spacing=0.05)
    for place, name in enumerate(chosen):
        _channel(figure, result, result.channels.index(name), colour_of(place))
    return dressed(figure, result, chosen, title, below="± band").update_yaxes(rangemode="tozero", row=2)


def _channel(figure: go.Figure, result: Prediction, column: int, colour: str) -> None:
    along, name, centre = result.coordinate.values, plain(result.channels[column]), result.response[:, column]
    bands = (
        ("measurement", result.measured_lower[:, column], result.measured_upper[:, column], 0.12, "dot"),
        ("response", result.lower[:, column], result.upper[:, column], 0.3, "solid"),
    )
    for word, lower, upper, opacity, dash in bands:
        finite = np.isfinite(upper - lower)
        if np.any(np.isinf(upper - lower)) or not finite[0]:
            continue
        at, lower, upper = along[finite], lower[finite], upper[finite]  # a band may end before the response
        legend = f"{name}, {100 * result.level:g} % of {word}"
        fill_band(figure, at, lower, upper, legend, name, colour, faint(colour, opacity))
        draw_line(figure, at, (upper - lower) / 2, f"{name}, ± {word}", name, colour, row=2, line_dash=dash)
    draw_line(figure, along, centre, f"{name} predicted", name, colour, 2, row=1, showlegend=True)
    if result.data is not None and result.channels[column] in result.data.channels:
        place = result.data.channels.index(result.channels[column])
        taken = result.data.taken[:, place]
        when, measured = thinned(result.data.coordinate.values[taken], result.data.values[taken, place])
        marker = {"color": colour, "size": 6 if len(when) <= FEW else 3, "symbol": "circle-open"}
        style = {"legendgroup": name, "mode": "markers", "marker": marker}
        figure.add_scatter(x=when, y=measured, name=f"{name} measured", **style, row=1, col=1)


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
    ranked = np.flatnonzero(np.isfinite(result.scores))[:MOST]
    rows = [f"{k + 1} · {named(result, k)}" for k in ranked]
    texts = [shown(float(score), digits=3) for score in result.scores[ranked]]
    figure = labelled_points(positive(result.scores[ranked]), rows, texts, "middle right", 10)
    x = {"title": f"score ({result.criterion}), in parts of the scales", **logarithmic(figure, "x")}
    layout = {"showlegend": False, "margin_r": 72}
    return themed(figure, title, 150 + 26 * max(2, len(ranked)), x=x, y={"autorange": "reversed"}, **layout)


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
        places = [k for k, sensors in enumerate(result.sensors) if sensors == chosen]
        places.sort(key=lambda k: result.horizons[k])
        x, y = result.horizons[places], positive(result.scores[places])
        draw(figure, x, y, plain(", ".join(chosen)), colour, mode="lines+markers")
    y = {"title": "score", **logarithmic(figure)}
    return themed(figure, title, 400, x=labelled(result.along, result.unit), y=y, showlegend=True)


def named(result: Designs, k: int) -> str:
    """A design in a few words."""
    sensors = plain(", ".join(result.sensors[k]))
    several = len(set(result.horizons.tolist())) > 1
    return f"{sensors} · {shown(float(result.horizons[k]))} {plain(result.unit)}" if several else sensors


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
    other_parameters = [other for other in range(len(result.parameters)) if other != k]
    for place, other in enumerate(other_parameters):
        spread = result.deviations[other]
        unit = spread if np.isfinite(spread) and spread > 0 else result.parameters.scale[other]
        y = (curve.points[:, other] - result.values[other]) / unit
        draw(figure, at, y, plain(result.parameters.names[other]), colour_of(place + 2), 1.5, row=2)
    x = labelled(plain(name), plain(result.parameters.items[k].unit))
    excess = {"title": "excess misfit", "range": [-0.04 * top, top]}
    y = (excess, "others (deviations)") if several else excess
    title = title or f"{plain(name)} in {interval(curve.lower, curve.upper)}"
    return themed(figure, title, 460 if several else 360, x=x, y=y)
