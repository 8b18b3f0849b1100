"""A response along one parameter, and its slope."""

from typing import Any

import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.quantities import derivative, labelled, quantity


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
    rows = 1 if slopes is None else 2
    figure = make_subplots(rows=rows, shared_xaxes=True, vertical_spacing=0.06)
    for place, channel in enumerate(curve.channels):
        name = plain(channel)
        style = {
            "name": name,
            "legendgroup": name,
            "mode": "lines+markers" if len(curve.values) <= 60 else "lines",
            "line": {"color": LIGHT.series[place % len(LIGHT.series)], "width": 2},
            "marker": {"size": 5},
        }
        figure.add_scatter(x=curve.values, y=curve.responses[:, place], row=1, col=1, **style)
        if slopes is not None:
            figure.add_scatter(x=curve.values, y=slopes[:, place], row=2, col=1, showlegend=False, **style)
    labels = {
        (quantity(channel, plain(unit)), derivative(channel, plain(curve.unit), plain(unit)))
        for channel, unit in zip(curve.channels, curve.units, strict=True)
    }
    label, slope = labels.pop() if len(labels) == 1 else ("response", "derivative")
    name = plain(curve.parameter)
    themed(figure, title or f"Response along {name}{' at ' + plain(at) if at else ''}", height=300 + 160 * (rows - 1))
    figure.update_yaxes(title_text=label, row=1)
    if slopes is not None:
        figure.update_yaxes(title_text=slope, row=2)
    figure.update_xaxes(title_text=labelled(name, plain(curve.unit)), row=rows)
    return figure.update_layout(hovermode="x unified")
