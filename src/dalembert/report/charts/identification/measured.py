"""Measured data as they were read, before anything is fitted to them."""

import plotly.graph_objects as go

from dalembert.data import Measurements
from dalembert.report.charts.drawing import colour_of
from dalembert.report.look import plain, themed
from dalembert.report.quantities import common, labelled, quantity
from dalembert.report.thin import thinned

FEW = 500
"""Samples up to which each is drawn as a circle."""


def measured(data: Measurements, *, title: str = "") -> go.Figure:
    """Every channel over the data's coordinate.

    Parameters
    ----------
    data : Measurements
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure, along = go.Figure(), data.coordinate
    mode = "markers" if len(along.values) <= FEW else "lines"
    for place, name in enumerate(data.channels):
        taken = data.taken[:, place]
        x, y = thinned(along.values[taken], data.values[taken, place])
        style = {"marker": {"color": colour_of(place), "size": 5}, "line_color": colour_of(place)}
        figure.add_scatter(x=x, y=y, mode=mode, name=plain(name), **style)
    label = common(map(quantity, data.channels), "")
    return themed(figure, title, x=labelled(along.name, along.unit), y=label, hovermode="x unified")
