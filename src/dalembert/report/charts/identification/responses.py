"""Responses beside the data they were fitted to, with what is left over below."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.errors import InputError, unknown
from dalembert.inverse import ExperimentFit, Fit
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.quantities import labelled, quantity
from dalembert.report.thin import thin

FEW = 200
"""Samples up to which each is drawn as a circle of its own."""


def responses(
    fit: Fit | ExperimentFit, channels: Sequence[str] | None = None, *, title: str = "Response and data"
) -> go.Figure:
    """Computed responses as lines, data as circles, and below them computed minus measured.

    Dotted lines in the residuals are two standard deviations of the data, where these are known.

    Parameters
    ----------
    fit : Fit, or one of its experiments
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


def _channel(figure: go.Figure, fit: Fit | ExperimentFit, column: int, colour: str) -> None:
    at, name = fit.data.coordinate.values, plain(fit.data.channels[column])
    taken = np.flatnonzero(fit.data.taken[:, column])
    measured, residual = fit.data.values[:, column], fit.residuals[:, column]
    computed, nearest = fit.response[:, column], measured + residual
    computed = np.where(np.abs(computed - nearest) > 1, nearest, computed)  # whole turns away, where they do not count
    few = len(taken) <= FEW
    dots = (
        {"color": colour, "size": 7, "symbol": "circle-open"} if few else {"color": colour, "size": 3, "opacity": 0.4}
    )
    small = {"color": colour, "size": 4}
    for word, values, row, style in (
        ("measured", measured[taken], 1, {"mode": "markers", "marker": dots}),
        ("computed", computed, 1, {"mode": "lines", "line": {"color": colour, "width": 2}}),
        ("residual", residual[taken], 2, {"mode": "lines+markers" if few else "lines", "marker": small}),
    ):
        kept = thin(values)
        along = at if word == "computed" else at[taken]
        trace = go.Scatter(x=along[kept], y=values[kept], name=f"{name} {word}", legendgroup=name, showlegend=row == 1)
        figure.add_trace(trace.update(style), row=row, col=1)
    figure.update_traces(line={"color": colour, "width": 1}, selector={"name": f"{name} residual"})
    if fit.data.deviations is not None:
        line: Any = {"color": colour, "width": 1, "dash": "dot"}
        for bound in (-2 * fit.data.deviations[column], 2 * fit.data.deviations[column]):
            figure.add_hline(y=bound, row=2, col=1, line=line)  # pyright: ignore[reportArgumentType]
