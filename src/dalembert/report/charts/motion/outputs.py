"""Outputs of a motion over time, and over a parameter."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Trajectory
from dalembert.quantities import common, derivative, quantity
from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.look import plain, themed
from dalembert.report.thinning import thinned
from dalembert.tables import labelled


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


def sweep(curve: Any, at: str = "", *, title: str | None = None) -> go.Figure:
    """Responses against the values of one parameter; below, their derivatives where they are known.

    Parameters
    ----------
    curve : Any
        Values (samples,), responses and sensitivities (samples, channels).
    at : str
        The instant that is looked at, for the title, for example ``"time 0.5 s"``.
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure
    """
    slopes = curve.sensitivities
    shown = [curve.responses] if slopes is None else [curve.responses, slopes]
    figure = stacked(*[1.0 for _ in shown])
    mode = "lines+markers" if len(curve.values) <= 60 else "lines"
    for place, channel in enumerate(curve.channels):
        style = {"legendgroup": plain(channel), "mode": mode, "marker_size": 5}
        for row, values in enumerate(shown, start=1):
            legend = None if row == 1 else False
            y, colour = values[:, place], colour_of(place)
            draw(figure, curve.values, y, plain(channel), colour, row=row, showlegend=legend, **style)
    labels = [
        (quantity(channel, plain(unit)), derivative(channel, plain(curve.unit), plain(unit)))
        for channel, unit in zip(curve.channels, curve.units, strict=True)
    ]
    name = plain(curve.parameter)
    title = title or f"Response along {name}{' at ' + plain(at) if at else ''}"
    x, y = labelled(name, plain(curve.unit)), common(labels, ("response", "derivative"))[: len(shown)]
    return themed(figure, title, 140 + 160 * len(shown), x=x, y=y, hovermode="x unified")
