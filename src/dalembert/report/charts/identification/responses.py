"""Responses of a fit beside the data, and the gaps of multiple shooting."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import plotly.graph_objects as go

from dalembert.data import Measurements
from dalembert.inverse import Fit
from dalembert.quantities import common, quantity
from dalembert.report.charts.bounds.bands import dressed, selected
from dalembert.report.charts.drawing import colour_of, draw, positive, stacked
from dalembert.report.charts.identification.search import winner
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.thinning import thinned
from dalembert.tables import labelled

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


FEW_FITTED = 200
"""Samples of a fit up to which each is drawn as a circle."""


class Compared(Protocol):
    """A response beside data: a fit, one of its experiments, a regularised fit."""

    @property
    def data(self) -> Measurements: ...
    @property
    def response(self) -> np.ndarray: ...
    @property
    def residuals(self) -> np.ndarray: ...


def responses(fit: Compared, channels: Sequence[str] | None = None, *, title: str = "Response and data") -> go.Figure:
    """Computed responses as lines, data as circles, and below them computed minus measured.

    Dotted lines in the residuals are two standard deviations of the data, where these are known.

    Parameters
    ----------
    fit : Fit, one of its experiments, or RegularisedFit
    channels : sequence of str, optional
        Channels to draw, all if not given; they share an axis.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a channel that the data do not have.
    """
    chosen, figure = selected(fit.data, channels, "responses"), stacked(0.7, 0.3, spacing=0.05)
    for place, name in enumerate(chosen):
        _channel(figure, fit, fit.data.channels.index(name), colour_of(place))
    return dressed(figure, fit.data, chosen, title, below="residual")


def computed_line(fit: Compared, column: int) -> tuple[np.ndarray, np.ndarray]:
    """Abscissae and ordinates of the computed line of a channel."""
    measured = fit.data.values[:, column]
    computed, nearest = fit.response[:, column], measured + fit.residuals[:, column]
    computed = np.where(np.abs(computed - nearest) > 1, nearest, computed)  # whole turns away, where they do not count
    return thinned(fit.data.coordinate.values, computed)


def residual_line(fit: Compared, column: int) -> tuple[np.ndarray, np.ndarray]:
    """Abscissae and ordinates of the line of a channel's residuals."""
    taken = np.flatnonzero(fit.data.taken[:, column])
    return thinned(fit.data.coordinate.values[taken], fit.residuals[taken, column])


def _channel(figure: go.Figure, fit: Compared, column: int, colour: str) -> None:
    at, name = fit.data.coordinate.values, plain(fit.data.channels[column])
    taken = np.flatnonzero(fit.data.taken[:, column])
    few = len(taken) <= FEW_FITTED
    dots = {"size": 7, "symbol": "circle-open"} if few else {"size": 3, "opacity": 0.4}
    x, y = thinned(at[taken], fit.data.values[taken, column])
    style = {"mode": "markers", "marker": {"color": colour, **dots}, "legendgroup": name}
    figure.add_scatter(x=x, y=y, name=f"{name} measured", **style, showlegend=True, row=1, col=1)
    draw(figure, *computed_line(fit, column), f"{name} computed", colour, 2, row=1, legendgroup=name, showlegend=True)
    style = {"mode": "lines+markers" if few else "lines", "marker": {"color": colour, "size": 4}}
    hidden = {"legendgroup": name, "showlegend": False}
    draw(figure, *residual_line(fit, column), f"{name} residual", colour, 1, row=2, **hidden, **style)
    if fit.data.deviations is not None:
        line: Any = {"color": colour, "width": 1, "dash": "dot"}
        for bound in (-2 * fit.data.deviations[column], 2 * fit.data.deviations[column]):
            figure.add_hline(y=bound, row=2, col=1, line=line)  # pyright: ignore[reportArgumentType]


def gaps(fit: Fit, *, title: str = "Gaps between segments") -> go.Figure:
    """Largest gap and misfit of the best start after each step in segments, over the steps.

    Parameters
    ----------
    fit : Fit
        Of multiple shooting.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    steps = [step for step in fit.history if step.start == winner(fit) and step.gap is not None]
    number = np.arange(1, len(steps) + 1)
    figure = stacked(1, 1, spacing=0.08)
    for row, name, key, colour in (
        (1, "largest gap", "gap", LIGHT.series[0]),
        (2, "misfit", "best", LIGHT.series[1]),
    ):
        values = positive(np.array([getattr(step, key) for step in steps], dtype=float))
        draw(figure, number, values, name, colour, 1.5, row=row, mode="lines+markers", marker_size=5)
    y = [{"title": label, "type": "log"} for label in ("gap (part of the range)", "misfit")]
    return themed(figure, title, 480, x="step in segments", y=y)
