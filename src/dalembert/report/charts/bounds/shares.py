"""Parts of the variance of a channel that the parameters cause, over its samples."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.quantities import labelled
from dalembert.uncertainty import SensitivityIndices


def shares(told: SensitivityIndices, channel: str, *, title: str = "") -> go.Figure:
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
    figure, along = go.Figure(), told.coordinate
    parts = np.nan_to_num(told.first[:, told.channels.index(channel)])
    for number, name in enumerate(told.box.names):
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
