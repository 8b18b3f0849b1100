"""A predicted response with its bands, beside the data."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import Prediction
from dalembert.report.charts.bounds.bands import draw_line, dressed, fill_band, selected
from dalembert.report.charts.drawing import colour_of, stacked
from dalembert.report.charts.identification.responses import FEW
from dalembert.report.look import faint, plain
from dalembert.report.thin import thinned


def prediction(result: Prediction, channels: Sequence[str] | None = None, *, title: str = "Prediction") -> go.Figure:
    """Response with the band of its true value, fainter the band of a new measurement; below, half the widths.

    Parameters
    ----------
    result : Prediction
    channels : sequence of str, optional
        Channels to draw, all if not given; they share an axis.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a channel that is not predicted.
    """
    chosen = selected(result, channels, "prediction")
    figure = stacked(0.72, 0.28, spacing=0.05)
    for place, name in enumerate(chosen):
        _channel(figure, result, result.channels.index(name), colour_of(place))
    return dressed(figure, result, chosen, title, below="± band").update_yaxes(rangemode="tozero", row=2)


def _channel(figure: go.Figure, result: Prediction, column: int, colour: str) -> None:
    along, name, centre = result.coordinate.values, plain(result.channels[column]), result.response[:, column]
    bands = (
        ("measurement", result.measured_lower[:, column], result.measured_upper[:, column], 0.12, "dot"),
        ("response", result.lower[:, column], result.upper[:, column], 0.3, "solid"),
    )
    for word, lower, upper, opacity, dash in bands:
        there = np.isfinite(upper - lower)
        if np.any(np.isinf(upper - lower)) or not there[0]:
            continue
        at, lower, upper = along[there], lower[there], upper[there]  # a band may end before the response
        legend = f"{name}, {100 * result.level:g} % of {word}"
        fill_band(figure, at, lower, upper, legend, name, colour, faint(colour, opacity))
        draw_line(figure, at, (upper - lower) / 2, f"{name}, ± {word}", name, colour, row=2, line_dash=dash)
    draw_line(figure, along, centre, f"{name} predicted", name, colour, 2, row=1, showlegend=True)
    if result.data is not None and result.channels[column] in result.data.channels:
        place = result.data.channels.index(result.channels[column])
        taken = result.data.taken[:, place]
        when, measured = thinned(result.data.coordinate.values[taken], result.data.values[taken, place])
        marker = {"color": colour, "size": 6 if len(when) <= FEW else 3, "symbol": "circle-open"}
        style = {"legendgroup": name, "mode": "markers", "marker": marker}
        figure.add_scatter(x=when, y=measured, name=f"{name} measured", **style, row=1, col=1)
