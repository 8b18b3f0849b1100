"""Elementary effects of parameters on a channel: their mean size and their spread."""

import plotly.graph_objects as go

from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.quantities import labelled
from dalembert.uncertainty import Screening


def effects(told: Screening, channel: str, *, title: str = "") -> go.Figure:
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
    column = told.channels.index(channel)
    sizes, unit = told.whole_effects[column], told.units[column]
    figure = go.Figure()
    figure.add_scatter(
        x=sizes,
        y=told.whole_spread[column],
        error_x={"array": 2 * told.errors[column], "width": 4},
        text=[plain(name) for name in told.box.names],
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
