"""Responses beside the data they were fitted to, with what is left over below."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.errors import InputError, unknown
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.needs import FitLike
from dalembert.report.quantities import labelled, quantity
from dalembert.report.thin import thin


def responses(fit: FitLike, channels: Sequence[str] | None = None, *, title: str = "Response and data") -> go.Figure:
    """Computed responses as lines, data as circles, and below them computed minus measured.

    Dotted lines in the residuals are two standard deviations of the data, where these are known.

    Parameters
    ----------
    fit : FitLike
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
    known = fit.data.channels
    chosen = known if channels is None else tuple(channels)
    for name in chosen:
        if name not in known:
            raise InputError(unknown("channel", name, known, where="responses"))
    along = fit.data.coordinate
    figure = make_subplots(rows=2, shared_xaxes=True, row_heights=[0.7, 0.3], vertical_spacing=0.05)
    for place, name in enumerate(chosen):
        _channel(figure, fit, known.index(name), LIGHT.series[place % len(LIGHT.series)])
    themed(figure, title, height=480)
    labels = {quantity(name) for name in chosen}
    label = labels.pop() if len(labels) == 1 else "response"
    figure.update_yaxes(title_text=label, row=1)
    figure.update_yaxes(title_text=label.replace(label.partition(" (")[0], "residual"), row=2)
    figure.update_xaxes(title_text=labelled(along.name, along.unit), row=2)
    return figure.update_layout(hovermode="x unified")


def _channel(figure: go.Figure, fit: FitLike, column: int, colour: str) -> None:
    at, name = fit.data.coordinate.values, plain(fit.data.channels[column])
    measured, computed = fit.data.values[:, column], fit.response[:, column]
    residual = computed - measured
    few = len(at) <= 200
    kept, left = thin(computed), thin(residual)
    dots = {"color": colour, "size": 7 if few else 3, "symbol": "circle-open" if few else "circle"}
    both = {"legendgroup": name, "line": {"color": colour, "width": 2}}
    line = go.Scatter(x=at[kept], y=computed[kept], name=f"{name} computed", mode="lines", **both)
    data = thin(measured)
    circles = go.Scatter(x=at[data], y=measured[data], name=f"{name} measured", mode="markers", marker=dots, **both)
    rest = go.Scatter(
        x=at[left],
        y=residual[left],
        name=f"{name} residual",
        mode="lines+markers" if few else "lines",
        showlegend=False,
    ).update(legendgroup=name, line={"color": colour, "width": 1}, marker={"color": colour, "size": 4})
    figure.add_trace(line, row=1, col=1)
    figure.add_trace(circles, row=1, col=1)
    figure.add_trace(rest, row=2, col=1)
    if fit.data.deviations is not None and np.isfinite(fit.data.deviations[column]):
        for bound in (-2 * fit.data.deviations[column], 2 * fit.data.deviations[column]):
            figure.add_hline(y=bound, row=2, col=1, line={"color": colour, "width": 1, "dash": "dot"})  # pyright: ignore[reportArgumentType]
