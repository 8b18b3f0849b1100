"""Bounds of a response over its samples: a band a channel, and how wide it is."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.data import Bands, Measurements
from dalembert.errors import InputError, unknown
from dalembert.inverse import Prediction
from dalembert.quantities import common, quantity
from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.look import faint, plain, themed
from dalembert.report.thinning import thin, thinned
from dalembert.tables import labelled

Channels = Bands | Measurements | Prediction


def bands(bounds: Bands | Prediction, channels: Sequence[str] | None = None, *, title: str = "Bounds") -> go.Figure:
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
    figure = stacked(0.72, 0.28, spacing=0.05)
    chosen = selected(bounds, channels, "bands")
    for place, name in enumerate(chosen):
        column, colour = bounds.channels.index(name), colour_of(place)
        draw_band(figure, bounds, column, colour)
        width = bounds.upper[:, column] - bounds.lower[:, column]
        draw_line(figure, bounds.coordinate.values, width, f"{plain(name)}, width", plain(name), colour, row=2)
    return dressed(figure, bounds, chosen, title, below="width").update_yaxes(rangemode="tozero", row=2)


def selected(owner: Channels, channels: Sequence[str] | None, where: str) -> tuple[str, ...]:
    """Names of the channels to draw, all if not given; InputError for one that there is not."""
    chosen = owner.channels if channels is None else tuple(channels)
    for name in chosen:
        if name not in owner.channels:
            raise InputError(unknown("channel", name, owner.channels, where=where))
    return chosen


def draw_band(figure: go.Figure, given: Bands | Prediction, column: int, colour: str, *, legend: str = "") -> None:
    """One channel's band in the first row: its inside faint, its two bounds as lines."""
    at, name = given.coordinate.values, plain(given.channels[column])
    bounds = {"upper": given.upper[:, column], "lower": given.lower[:, column]}
    fill_band(figure, at, bounds["lower"], bounds["upper"], f"{name}{legend}", name, colour, faint(colour))
    for side, values in bounds.items():
        draw_line(figure, at, values, f"{name}, {side}", name, colour, row=1)


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
    style = {"fill": "toself", "fillcolor": inside, "hoverinfo": "skip"}
    draw(figure, x, y, name, colour, 0, row=1, legendgroup=group, **style)


def draw_line(
    figure: go.Figure,
    at: np.ndarray,
    values: np.ndarray,
    name: str,
    group: str,
    colour: str,
    width: float = 1.5,
    **style: Any,
) -> None:
    """A thinned line over the samples, without an entry in the legend unless the style says so."""
    draw(figure, *thinned(at, values), name, colour, width, legendgroup=group, **{"showlegend": False, **style})


def outline(at: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the closed outline of a band over its samples: along the lower bounds and back along the upper ones."""
    forward, back = thin(lower), thin(upper)[::-1]
    x = np.concatenate([at[forward], at[back], at[:1]])
    return x, np.concatenate([lower[forward], upper[back], lower[:1]])


def dressed(figure: go.Figure, owner: Channels, chosen: Sequence[str], title: str, *, below: str) -> go.Figure:
    """The figure with its look and the labels of its two rows."""
    units = dict(zip(owner.channels, getattr(owner, "units", ()), strict=False))
    label = common((quantity(name, plain(units.get(name, ""))) for name in chosen), "response")
    y = (label, label.replace(label.partition(" (")[0], below))
    x = labelled(owner.coordinate.name, owner.coordinate.unit)
    return themed(figure, title, 480, x=x, y=y, hovermode="x unified")
