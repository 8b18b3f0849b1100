"""Sobol indices, parts of the variance, and elementary effects of the parameters on a channel."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import labelled
from dalembert.uncertainty import Screening, SensitivityIndices


def effects(screening: Screening, channel: str, *, title: str = "") -> go.Figure:
    """Each parameter as a point: mean absolute effect on the whole channel, and the spread of its effects.

    Parameters
    ----------
    told : Screening
    channel : str
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    column = screening.channels.index(channel)
    sizes, unit = screening.aggregated_effects[column], screening.units[column]
    figure = go.Figure()
    figure.add_scatter(
        x=sizes,
        y=screening.aggregated_spread[column],
        error_x={"array": 2 * screening.errors[column], "width": 4},
        text=[plain(name) for name in screening.box.names],
        textposition="top center",
        mode="markers+text",
        marker={"color": LIGHT.series[0], "size": 9},
        showlegend=False,
    )
    return themed(
        figure,
        title or f"Effects on {plain(channel)}",
        x=labelled("mean absolute effect", unit),
        y=labelled("spread of the effects", unit),
    )


def indices(sensitivity: SensitivityIndices, channel: str, *, title: str = "") -> go.Figure:
    """Two charts: the indices of each parameter, and below them the standard deviation of the channel.

    Parameters
    ----------
    told : SensitivityIndices
    channel : str
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    column, along = sensitivity.channels.index(channel), sensitivity.coordinate
    title = title or f"Sobol indices of {plain(channel)}"
    if len(along.values) == 1:
        return _bars(sensitivity, column, title)
    figure = stacked(0.68, 0.32)
    for number, name in enumerate(sensitivity.box.names):
        for word, values, dash in (("first-order", sensitivity.first, "solid"), ("total", sensitivity.total, "dot")):
            label, values = f"{plain(name)}, {word}", values[:, column, number]
            draw(figure, along.values, values, label, colour_of(number), row=1, line_dash=dash)
    draw(figure, along.values, sensitivity.deviations[:, column], "", LIGHT.ink, 1.5, row=2, showlegend=False)
    y = [{"title": "index", "range": [-0.02, 1.05]}, labelled("standard deviation", sensitivity.units[column])]
    return themed(figure, title, 520, x=labelled(along.name, along.unit), y=y)


def _bars(sensitivity: SensitivityIndices, column: int, title: str) -> go.Figure:
    figure = go.Figure()
    for word, values, opacity in (("first-order", sensitivity.first, 1.0), ("total", sensitivity.total, 0.45)):
        figure.add_bar(
            x=[plain(name) for name in sensitivity.box.names],
            y=np.nan_to_num(values[0, column]),
            name=word,
            marker={"color": LIGHT.series[0], "opacity": opacity},
        )
    return themed(figure, title, x="parameter", y={"title": "index", "range": [0, 1.05]}, barmode="group")


def shares(sensitivity: SensitivityIndices, channel: str, *, title: str = "") -> go.Figure:
    """First-order indices of a channel as areas above each other; what is left up to 1 are interactions.

    Parameters
    ----------
    told : SensitivityIndices
    channel : str
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure, along = go.Figure(), sensitivity.coordinate
    parts = np.nan_to_num(sensitivity.first[:, sensitivity.channels.index(channel)])
    for number, name in enumerate(sensitivity.box.names):
        colour = LIGHT.series[number % len(LIGHT.series)]
        figure.add_scatter(
            x=along.values,
            y=parts[:, number],
            name=plain(name),
            stackgroup="first",
            mode="lines",
            line={"color": colour},
        )
    y = {"title": "first-order index", "range": [0, 1.02]}
    return themed(
        figure, title or f"Causes of the variance of {plain(channel)}", x=labelled(along.name, along.unit), y=y
    )
