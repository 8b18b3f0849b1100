"""A posterior: marginal densities, pairs, traces and predictive bands."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.errors import InputError, unknown
from dalembert.inverse import Posterior, Profiles
from dalembert.report.charts.bounds.bands import dressed, fill_band, selected
from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.charts.identification.responses import FEW
from dalembert.report.look import LIGHT, faint, plain, themed
from dalembert.report.thinning import thinned
from dalembert.tables import labelled, with_deviation

BINS = 40
MOST_PAIRS = 5
"""Parameters of a matrix of pairs."""

MOST_POINTS = 1000
"""Draws in a panel."""


def marginal(result: Posterior, name: str, profiles: Profiles | None = None, *, title: str = "") -> go.Figure:
    """Histogram of the draws of a parameter, with its prior and what the linearised response and the profile say.

    Parameters
    ----------
    result : Posterior
    name : str
        The parameter.
    profiles : Profiles, optional
        The profile likelihood L is drawn as L/∫L.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a parameter that is not in the posterior.
    """
    k = _number(result, name, "marginal")
    item, values = result.parameters.items[k], result.flat[:, k]
    height, edges = np.histogram(values, bins=BINS, density=True)
    figure = go.Figure()
    colour = LIGHT.series[0]
    middle, width = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
    figure.add_bar(
        x=middle, y=height, width=width, name="draws", marker={"color": faint(colour, 0.45), "line_width": 0}
    )
    at = np.linspace(edges[0], edges[-1], 201)
    centre, deviation = result.mode[k], result.linear_deviations[k]
    linear = np.exp(-0.5 * ((at - centre) / deviation) ** 2) / (deviation * np.sqrt(2 * np.pi))
    style = {"mode": "lines", "hoverinfo": "skip"}
    line = {"color": LIGHT.series[1], "dash": "dash", "width": 2}
    figure.add_scatter(x=at, y=linear, name="linearised", line=line, **style)
    curve = None if profiles is None else {curve_here.name: curve_here for curve_here in profiles.curves}.get(name)
    if curve is not None and len(curve.values) > 1:
        line = {"color": LIGHT.series[2], "width": 2}
        likely = np.exp(-0.5 * (curve.excess - np.min(curve.excess)))
        fine = np.linspace(curve.values[0], curve.values[-1], 201)
        likely = np.exp(np.interp(fine, curve.values, np.log(np.maximum(likely, 1e-300))))
        figure.add_scatter(x=fine, y=likely / np.trapezoid(likely, fine), name="profile", line=line, **style)
    known = np.exp(item.distribution.log_density(at))
    line = {"color": LIGHT.muted, "dash": "dot", "width": 2}
    figure.add_scatter(x=at, y=known, name="prior", line=line, **style)
    for end in result.intervals()[name]:
        figure.add_vline(x=end, line={"color": colour, "width": 1, "dash": "dot"})
    title = title or f"{plain(name)}: {with_deviation(float(values.mean()), float(result.deviations[k]))}"
    x = {"title": labelled(plain(name), plain(item.unit)), "range": [edges[0], edges[-1]]}
    return themed(figure, title, 340, x=x, y={"title": "density", "rangemode": "tozero"}, bargap=0)


def pair_plots(
    result: Posterior, names: Sequence[str] | None = None, *, title: str = "Pairs of parameters"
) -> go.Figure:
    """Draws of each pair of parameters; divergent ones are marked.

    Parameters
    ----------
    result : Posterior
    names : sequence of str, optional
        Two to five parameters; the first ones if not given.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a parameter that is not in the posterior, or fewer than two.
    """
    chosen = list(result.parameters.names[:MOST_PAIRS] if names is None else names)
    if len(chosen) < 2:
        raise InputError(f"pair_plots: {len(chosen)} parameters were given; expected two or more")
    columns = [_number(result, name, "pair_plots") for name in chosen]
    diverging = np.asarray(result.statistics.get("diverging", np.zeros(result.draws.shape[:2], dtype=bool))).ravel()
    some = np.linspace(0, len(result.flat) - 1, min(MOST_POINTS, len(result.flat))).astype(int)
    apart, size = np.flatnonzero(diverging), len(chosen) - 1
    figure = make_subplots(
        size, size, shared_xaxes=True, shared_yaxes=True, horizontal_spacing=0.02, vertical_spacing=0.02
    )
    for row in range(size):
        for column in range(row + 1):
            x, y = columns[column], columns[row + 1]
            at = {"row": row + 1, "col": column + 1}
            marker = {"color": LIGHT.series[0], "size": 3, "opacity": 0.4}
            style = {"mode": "markers", "showlegend": row == column == 0}
            figure.add_scatter(
                x=result.flat[some, x], y=result.flat[some, y], name="draws", marker=marker, **style, **at
            )
            if len(apart):
                marker = {"color": LIGHT.series[1], "size": 5, "symbol": "x"}
                figure.add_scatter(
                    x=result.flat[apart, x], y=result.flat[apart, y], name="divergent", marker=marker, **style, **at
                )
    themed(figure, title, 180 + 170 * size)
    for number, k in enumerate(columns):
        label = labelled(plain(chosen[number]), plain(result.parameters.items[k].unit))
        if number < size:
            figure.update_xaxes(title_text=label, row=size, col=number + 1)
        if number > 0:
            figure.update_yaxes(title_text=label, row=number, col=1)
    return figure


def traces(result: Posterior, name: str, *, title: str = "") -> go.Figure:
    """Draws of a parameter in their order, a line for each chain.

    Parameters
    ----------
    result : Posterior
    name : str
        The parameter.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a parameter that is not in the posterior.
    """
    k = _number(result, name, "traces")
    figure, item = go.Figure(), result.parameters.items[k]
    for chain, values in enumerate(result.draws[:, :, k]):
        x, y = thinned(np.arange(len(values)), values)
        draw(figure, x, y, f"chain {chain + 1}", colour_of(chain), 1)
    title = title or f"{plain(name)}: R-hat {result.r_hat[k]:.3f}"
    return themed(
        figure, title, 280, x="draw", y=labelled(plain(name), plain(item.unit)), showlegend=len(result.draws) < 9
    )


def predictive(
    result: Posterior,
    channels: Sequence[str] | None = None,
    *,
    level: float = 0.95,
    title: str = "Posterior predictive",
) -> go.Figure:
    """Data in the band that contains a new measurement; below, the data less the middle of the band.

    Parameters
    ----------
    result : Posterior
    channels : sequence of str, optional
        Channels to draw, all if not given; they share an axis.
    level : float
        Probability of the band.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a channel that the data do not have.
    """
    chosen, figure = selected(result.data, channels, "predictive"), stacked(0.7, 0.3, spacing=0.05)
    lower, upper = result.band(level)
    along = result.data.coordinate.values
    for place, channel in enumerate(chosen):
        column, colour, name = result.data.channels.index(channel), colour_of(place), plain(channel)
        finite = np.isfinite(lower[:, column])
        at, low, high = along[finite], lower[finite, column], upper[finite, column]
        middle = (low + high) / 2
        fill_band(figure, at, low, high, f"{name}, {100 * level:g} %", name, colour, faint(colour, 0.25))
        measured = result.data.values[finite, column]
        size = 6 if len(at) <= FEW else 3
        style = {
            "legendgroup": name,
            "mode": "markers",
            "marker": {"color": colour, "size": size, "symbol": "circle-open"},
        }
        for row, values in ((1, measured), (2, measured - middle)):
            x, y = thinned(at, values)
            figure.add_scatter(x=x, y=y, name=f"{name} measured", showlegend=row == 1, **style, row=row, col=1)
        for bound in (low - middle, high - middle):
            draw(figure, *thinned(at, bound), f"{name} band", colour, 1, row=2, legendgroup=name, showlegend=False)
    return dressed(figure, result.data, chosen, title, below="measured − middle")


def _number(result: Posterior, name: str, where: str) -> int:
    if name not in result.parameters.names:
        raise InputError(unknown("parameter", name, result.parameters.names, where=where))
    return result.parameters.names.index(name)
