"""How hard each point of a curve was to find, and how well it is balanced."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.report.charts.logarithm import positive
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
    figure = make_subplots(rows=2, shared_xaxes=True, vertical_spacing=0.06)
    for row, name, values, colour in (
        (1, "Newton iterations", curve.iterations, LIGHT.ink),
        (2, "left unbalanced", positive(np.asarray(curve.residuals, dtype=float)), LIGHT.series[0]),
        (2, "change with twice the samples", positive(np.asarray(curve.sampling_errors, dtype=float)), LIGHT.series[1]),
    ):
        figure.add_scatter(
            x=curve.frequencies,
            y=values,
            name=name,
            mode="markers",
            marker={"color": colour, "size": 4},
            row=row,
            col=1,
        )
    themed(figure, title, height=480)
    figure.update_yaxes(title_text="iterations", rangemode="tozero", row=1)
    figure.update_yaxes(title_text="part of the forces", type="log", row=2)
    return figure.update_xaxes(title_text="frequency (Hz)", row=2).update_layout(showlegend=True)
