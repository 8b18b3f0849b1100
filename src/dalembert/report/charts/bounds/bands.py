"""Bounds of a response over its samples: a band a channel, and how wide it is."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.data import Bands
from dalembert.errors import InputError, unknown
from dalembert.inverse import Prediction
from dalembert.report.look import LIGHT, faint, plain, themed
from dalembert.report.quantities import labelled, quantity
from dalembert.report.thin import thin


def bands(given: Bands | Prediction, channels: Sequence[str] | None = None, *, title: str = "Bounds") -> go.Figure:
    """A filled band between the lower and upper bounds of each channel; below, upper minus lower.

    Parameters
    ----------
    given : Bands | Prediction
        Lower and upper bounds, (samples, channels).
    channels : sequence of str, optional
        Channels to draw, all if not given; they share an axis.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a channel that the bands do not have.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from dalembert.forward import Coordinate
    >>> lower = np.zeros((3, 1))
    >>> given = SimpleNamespace(
    ...     coordinate=Coordinate("time", "s", np.arange(3.0)), channels=("x",), lower=lower, upper=lower + 1
    ... )
    >>> [trace.name for trace in bands(given).data]
    ['x', 'x, upper', 'x, lower', 'x, width']
    """
    figure = make_subplots(rows=2, shared_xaxes=True, row_heights=[0.72, 0.28], vertical_spacing=0.05)
    chosen = selected(given, channels, "bands")
    for place, name in enumerate(chosen):
        column, colour = given.channels.index(name), LIGHT.series[place % len(LIGHT.series)]
        draw_band(figure, given, column, colour)
        width, look = given.upper[:, column] - given.lower[:, column], {"color": colour, "width": 1.5}
        draw_line(figure, given.coordinate.values, width, f"{plain(name)}, width", plain(name), look, row=2)
    return dressed(figure, given, chosen, title, below="width").update_yaxes(rangemode="tozero", row=2)


def selected(given: Bands | Prediction, channels: Sequence[str] | None, where: str) -> tuple[str, ...]:
    """Names of the channels to draw; InputError for one that the bands do not have."""
    chosen = given.channels if channels is None else tuple(channels)
    for name in chosen:
        if name not in given.channels:
            raise InputError(unknown("channel", name, given.channels, where=where))
    return chosen


def draw_band(figure: go.Figure, given: Bands | Prediction, column: int, colour: str, *, legend: str = "") -> None:
    """One channel's band in the first row: its inside faint, its two bounds as lines."""
    at, name = given.coordinate.values, plain(given.channels[column])
    bounds = {"upper": given.upper[:, column], "lower": given.lower[:, column]}
    fill_band(figure, at, bounds["lower"], bounds["upper"], f"{name}{legend}", name, colour, faint(colour))
    for side, values in bounds.items():
        draw_line(figure, at, values, f"{name}, {side}", name, {"color": colour, "width": 1.5}, row=1)


def fill_band(
    figure: go.Figure,
    at: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    name: str,
    group: str,
    colour: str,
    inside: str,
) -> None:
    """A band in the first row, filled with the colour of its inside."""
    x, y = outline(at, lower, upper)
    figure.add_scatter(
        x=x,
        y=y,
        name=name,
        legendgroup=group,
        mode="lines",
        line={"width": 0, "color": colour},
        fill="toself",
        fillcolor=inside,
        hoverinfo="skip",
        row=1,
        col=1,
    )


def draw_line(
    figure: go.Figure,
    at: np.ndarray,
    values: np.ndarray,
    name: str,
    group: str,
    look: dict[str, Any],
    *,
    row: int,
    legend: bool = False,
) -> None:
    """A line over the samples in one of the rows, thinned."""
    kept = thin(values)
    figure.add_scatter(
        x=at[kept],
        y=values[kept],
        name=name,
        legendgroup=group,
        showlegend=legend,
        mode="lines",
        line=look,
        row=row,
        col=1,
    )


def outline(at: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Closed outline of a band over its samples: along the lower bounds and back along the upper ones.

    Examples
    --------
    >>> outline(np.arange(2.0), np.zeros(2), np.ones(2))[1].tolist()
    [0.0, 0.0, 1.0, 1.0, 0.0]
    """
    there, back = thin(lower), thin(upper)[::-1]
    x = np.concatenate([at[there], at[back], at[:1]])
    return x, np.concatenate([lower[there], upper[back], lower[:1]])


def dressed(
    figure: go.Figure, given: Bands | Prediction, chosen: Sequence[str], title: str, *, below: str
) -> go.Figure:
    """The figure with its look and the labels of its two rows."""
    themed(figure, title, height=480)
    units = dict(zip(given.channels, getattr(given, "units", ()), strict=False))
    labels = {quantity(name, plain(units.get(name, ""))) for name in chosen}
    label = labels.pop() if len(labels) == 1 else "response"
    figure.update_yaxes(title_text=label, row=1)
    figure.update_yaxes(title_text=label.replace(label.partition(" (")[0], below), row=2)
    along = given.coordinate
    figure.update_xaxes(title_text=labelled(along.name, along.unit), row=2)
    return figure.update_layout(hovermode="x unified")
