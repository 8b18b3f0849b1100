"""How hard each point of a curve was to find, and how well it is balanced."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import positive, stacked
from dalembert.report.look import LIGHT, themed
from dalembert.vibration import FrequencyCurve


def points_found(curve: FrequencyCurve, *, title: str = "How the points were found") -> go.Figure:
    """Newton iterations of each point; below, what is left unbalanced and what twice as many samples would change.

    Parameters
    ----------
    curve : FrequencyCurve
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = stacked(1, 1)
    for row, name, values, colour in (
        (1, "Newton iterations", curve.iterations, LIGHT.ink),
        (2, "left unbalanced", positive(np.asarray(curve.residuals, dtype=float)), LIGHT.series[0]),
        (2, "change with twice the samples", positive(np.asarray(curve.sampling_errors, dtype=float)), LIGHT.series[1]),
    ):
        marker = {"color": colour, "size": 4}
        figure.add_scatter(x=curve.frequencies, y=values, name=name, mode="markers", marker=marker, row=row, col=1)
    y = ({"title": "iterations", "rangemode": "tozero"}, {"title": "part of the forces", "type": "log"})
    return themed(figure, title, 480, x="frequency (Hz)", y=y, showlegend=True)
