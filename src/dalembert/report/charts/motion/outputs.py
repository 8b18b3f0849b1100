"""Channels of a motion over time."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Trajectory
from dalembert.report.charts.drawing import colour_of, draw
from dalembert.report.look import plain, themed
from dalembert.report.quantities import common, quantity
from dalembert.report.thin import thinned


def outputs(trajectory: Trajectory, channels: Sequence[str], *, title: str = "Outputs over time") -> go.Figure:
    """Channels of a motion over time; they share an axis.

    Parameters
    ----------
    trajectory : Trajectory
    channels : sequence of str
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For an unknown channel.
    """
    times, values = np.asarray(trajectory.times), trajectory.channels(channels)
    figure = go.Figure()
    for place, channel in enumerate(channels):
        draw(figure, *thinned(times, values[:, place]), plain(channel), colour_of(place), showlegend=True)
    y = common(map(quantity, channels), "response")
    return themed(figure, title, 360, x="time (s)", y=y, hovermode="x unified")
