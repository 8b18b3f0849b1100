"""A ring-down: frequency and damping ratio of a mode over its amplitude, and the decay over time."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import RingDown
from dalembert.report.charts.drawing import colour_of, draw, logarithmic, stacked
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import labelled, prefixed


def ring_down(result: RingDown, *, title: str | None = None) -> go.Figure:
    """Frequency and damping ratio over the amplitude, with two standard deviations to each side.

    Parameters
    ----------
    result : RingDown
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure
    """
    amplitudes = np.asarray(result.amplitudes)
    factor, unit = prefixed(float(amplitudes.max()), result.unit)
    figure = stacked(1, 1)
    records = int(np.max(result.record))
    for row, values, deviations in (
        (1, result.frequencies, result.frequency_deviations),
        (2, 100 * result.damping, 100 * result.damping_deviations),
    ):
        for number in range(1, records + 1):
            rows = result.record == number
            name = "" if records == 1 else f"record {number}"
            bars = {"type": "data", "array": 2 * deviations[rows], "thickness": 1}
            draw(
                figure, factor * amplitudes[rows], values[rows], name, colour_of(number - 1), row=row, mode="markers",
                marker_size=5, error_y=bars, legendgroup=name, showlegend=records > 1 and row == 1,
            )  # fmt: skip
    figure.update_xaxes(**logarithmic(figure, "x"))
    x = labelled(f"amplitude of {plain(result.reference)}", unit)
    y = ("frequency (Hz)", {"title": "damping ratio (%)", "rangemode": "tozero"})
    return themed(figure, title or "Frequency and damping over the amplitude", 480, x=x, y=y, showlegend=records > 1)


def decay(result: RingDown, *, title: str | None = None) -> go.Figure:
    """Amplitude, frequency and damping of the decay over time, by the windows and by the band-pass filter.

    Parameters
    ----------
    result : RingDown
        The first record is drawn.
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure
    """
    rows = np.asarray(result.record) == 1
    times = result.times[rows]
    factor, unit = prefixed(float(result.amplitudes[rows].max()), result.unit)
    figure = stacked(1, 1, 1)
    draw(figure, times, factor * result.amplitudes[rows], "", LIGHT.ink, row=1, showlegend=False)
    for row, windows, band in (
        (2, result.decay_frequencies[rows], result.band_frequencies[rows]),
        (3, 100 * result.decay_damping[rows], 100 * result.band_damping[rows]),
    ):
        style = {"row": row, "showlegend": row == 2}
        draw(figure, times, windows, "windows", LIGHT.series[0], mode="lines+markers", marker_size=4, **style)
        draw(figure, times, band, "band-pass filter", LIGHT.series[1], line_dash="dot", **style)
    y = (
        {"title": labelled("amplitude", unit), "type": "log"},
        "frequency (Hz)",
        {"title": "damping ratio (%)", "rangemode": "tozero"},
    )
    return themed(figure, title or "The decay by both methods", 560, x="time (s)", y=y, showlegend=True)
