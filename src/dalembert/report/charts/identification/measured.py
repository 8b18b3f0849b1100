"""Measured data as they were read, before anything is fitted to them."""

import plotly.graph_objects as go

from dalembert.data import Measurements
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.quantities import labelled, quantity
from dalembert.report.thin import thin

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
        values, colour = data.values[taken, place], LIGHT.series[place % len(LIGHT.series)]
        kept = thin(values)
        figure.add_scatter(x=along.values[taken][kept], y=values[kept], mode=mode, name=plain(name))
        figure.update_traces(
            marker={"color": colour, "size": 5}, line={"color": colour}, selector={"name": plain(name)}
        )
    themed(figure, title)
    quantities = {quantity(name) for name in data.channels}
    if len(quantities) == 1:
        figure.update_yaxes(title_text=quantities.pop())
    return figure.update_xaxes(title_text=labelled(along.name, along.unit)).update_layout(hovermode="x unified")
