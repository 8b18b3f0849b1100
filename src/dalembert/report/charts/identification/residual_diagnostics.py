"""Residuals of a fit in six panels: correlation, distribution, spectrum, time, response and influence."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.inverse import ResidualDiagnostics, SeriesResiduals
from dalembert.report.charts.drawing import colour_of
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.thinning import thinned
from dalembert.tables import labelled

MOST_SERIES = 12
"""Channels that are drawn, those that the tests doubt most."""

VISIBLE = 4
"""Channels that are visible at first; a click in the legend shows others."""

MOST = 800
"""Points of a channel in a panel."""

_TITLES = (
    "Autocorrelation",
    "Normal quantiles",
    "Spectrum",
    "Against the coordinate",
    "Against the response",
    "Influence",
)
Draw = Callable[..., None]


def residual_diagnostics(
    diagnostics: ResidualDiagnostics, channels: Sequence[str] | None = None, *, title: str = "Residual diagnostics"
) -> go.Figure:
    """Standardised residuals in six panels, a colour for each channel.

    Autocorrelations with the 95 % limits of independent noise (dotted); residuals over normal quantiles; power over its
    mean; residuals over the coordinate and over the response, as a share of its range; residuals over leverages.

    Parameters
    ----------
    found : ResidualDiagnostics
    channels : sequence of str, optional
        Names of the series to draw; without it those that the tests doubt most.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    chosen = (
        doubted(diagnostics) if channels is None else [item for item in diagnostics.series if item.name in channels]
    )
    figure = make_subplots(2, 3, subplot_titles=_TITLES, horizontal_spacing=0.07, vertical_spacing=0.2)
    for place, item in enumerate(chosen):
        _series(figure, item, colour_of(place), shown=True if place < VISIBLE else "legendonly")
    ends = [-3.0, 3.0]
    line = {"color": LIGHT.muted, "width": 1}
    figure.add_scatter(x=ends, y=ends, mode="lines", line=line, showlegend=False, hoverinfo="skip", row=1, col=2)
    unit = chosen[0].series.unit if chosen else ""
    figure = themed(figure, title, 640, showlegend=True)
    figure.update_layout(legend={"y": 1.09}, margin={"t": 110})
    for column, row, x, y in (
        (1, 1, labelled("lag", unit), "autocorrelation"),
        (2, 1, "normal quantile", "standardised residual"),
        (3, 1, labelled("frequency", "Hz" if unit == "s" else f"1/{unit}" if unit else ""), "power over its mean"),
        (1, 2, labelled("coordinate", unit), "standardised residual"),
        (2, 2, "response (share of its range)", "standardised residual"),
        (3, 2, "leverage", "standardised residual"),
    ):
        figure.update_xaxes(title=x, row=row, col=column)
        figure.update_yaxes(title=y, row=row, col=column)
    return figure


def doubted(diagnostics: ResidualDiagnostics) -> list[SeriesResiduals]:
    """Return the channels that are drawn: the least probable ones, in their order."""
    worst = sorted(diagnostics.series, key=lambda item: min(item.p_values.values(), default=1.0))[:MOST_SERIES]
    return worst if len(worst) > VISIBLE else [item for item in diagnostics.series if item in worst]


def _series(figure: go.Figure, item: SeriesResiduals, colour: str, *, shown: bool | str) -> None:
    name = plain(item.name)

    def draw(row: int, column: int, x: Any, y: Any, *, legend: bool = False, **style: Any) -> None:
        kept_x, kept_y = thinned(np.asarray(x), np.asarray(y), MOST)
        common = {"name": name, "legendgroup": name, "showlegend": legend, "visible": shown}
        figure.add_scatter(x=kept_x, y=kept_y, row=row, col=column, **{**common, **style})

    dots = {"mode": "markers", "marker": {"color": colour, "size": 4, "opacity": 0.7}}
    dotted = {"mode": "lines", "line": {"color": colour, "width": 1, "dash": "dot"}, "hoverinfo": "skip"}
    lags, correlations, limits = item.autocorrelation()
    stems = {"mode": "lines+markers", "line": {"color": colour, "width": 1}, "marker": {"color": colour, "size": 4}}
    draw(1, 1, lags, correlations, legend=True, **stems)
    for side in (-1, 1):
        draw(1, 1, lags, side * limits, **dotted)
    draw(1, 2, *item.normal_quantiles(), **dots)
    draw(1, 3, *item.spectrum(), mode="lines", line={"color": colour, "width": 1})
    draw(2, 1, item.series.along, item.standardised, **dots)
    size = float(np.ptp(item.response)) or 1.0
    draw(2, 2, (item.response - np.min(item.response)) / size, item.standardised, **dots)
    draw(2, 3, item.leverage, item.standardised, **dots)
