"""A predicted response with its bands, beside the data."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.inverse import Prediction
from dalembert.report.charts.bounds.bands import draw_line, dressed, fill_band, selected
from dalembert.report.charts.identification.responses import FEW
from dalembert.report.look import LIGHT, faint, plain
from dalembert.report.thin import thin


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
    figure = make_subplots(rows=2, shared_xaxes=True, row_heights=[0.72, 0.28], vertical_spacing=0.05)
    for place, name in enumerate(chosen):
        _channel(figure, result, result.channels.index(name), LIGHT.series[place % len(LIGHT.series)])
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
        look = {"color": colour, "width": 1.5, "dash": dash}
        draw_line(figure, at, (upper - lower) / 2, f"{name}, ± {word}", name, look, row=2)
    draw_line(figure, along, centre, f"{name} predicted", name, {"color": colour, "width": 2}, row=1, legend=True)
    if result.data is not None and result.channels[column] in result.data.channels:
        place = result.data.channels.index(result.channels[column])
        taken = result.data.taken[:, place]
        measured, when = result.data.values[taken, place], result.data.coordinate.values[taken]
        kept = thin(measured)
        size = 6 if len(when) <= FEW else 3
        figure.add_scatter(
            x=when[kept],
            y=measured[kept],
            name=f"{name} measured",
            legendgroup=name,
            mode="markers",
            marker={"color": colour, "size": size, "symbol": "circle-open"},
            row=1,
            col=1,
        )
