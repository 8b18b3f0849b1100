"""Sobol indices of a channel over its samples, or as bars where there is one sample."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.quantities import labelled
from dalembert.uncertainty import SensitivityIndices


def indices(told: SensitivityIndices, channel: str, *, title: str = "") -> go.Figure:
    """First-order and total index of each parameter, above the standard deviation of the channel.

    Parameters
    ----------
    told : SensitivityIndices
    channel : str
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    column, along = told.channels.index(channel), told.coordinate
    title = title or f"Sobol indices of {plain(channel)}"
    if len(along.values) == 1:
        return _bars(told, column, title)
    figure = stacked(0.68, 0.32)
    for number, name in enumerate(told.box.names):
        for word, values, dash in (("first-order", told.first, "solid"), ("total", told.total, "dot")):
            label, values = f"{plain(name)}, {word}", values[:, column, number]
            draw(figure, along.values, values, label, colour_of(number), row=1, line_dash=dash)
    draw(figure, along.values, told.deviations[:, column], "", LIGHT.ink, 1.5, row=2, showlegend=False)
    y = [{"title": "index", "range": [-0.02, 1.05]}, labelled("standard deviation", told.units[column])]
    return themed(figure, title, 520, x=labelled(along.name, along.unit), y=y)


def _bars(told: SensitivityIndices, column: int, title: str) -> go.Figure:
    figure = go.Figure()
    for word, values, opacity in (("first-order", told.first, 1.0), ("total", told.total, 0.45)):
        figure.add_bar(
            x=[plain(name) for name in told.box.names],
            y=np.nan_to_num(values[0, column]),
            name=word,
            marker={"color": LIGHT.series[0], "opacity": opacity},
        )
    return themed(figure, title, x="parameter", y={"title": "index", "range": [0, 1.05]}, barmode="group")
