"""Integrators compared: error against run time."""

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import WorkPrecision
from dalembert.report.charts.drawing import colour_of, draw, logarithmic, positive
from dalembert.report.look import LIGHT, plain, themed

SYMBOLS = ("circle", "square", "diamond", "triangle-up", "x", "star", "cross", "pentagon")


def work_precision(found: WorkPrecision, *, title: str = "Error against run time") -> go.Figure:
    """Error of each run over its run time, both logarithmic, one line an integrator; no runs that ended early.

    Parameters
    ----------
    found : WorkPrecision
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = go.Figure()
    for place, method in enumerate(found.methods):
        own = [row for row in found.rows if row.method == method and not row.failure]
        seconds, errors = (positive(np.array([getattr(row, key) for row in own])) for key in ("seconds", "error"))
        marker = {"size": 8, "symbol": SYMBOLS[place % len(SYMBOLS)]}
        hover = "%{text}<br>%{x:.3g} s, error %{y:.2e}<extra></extra>"
        style = {"text": [plain(row.settings) for row in own], "hovertemplate": hover, "marker": marker}
        draw(figure, seconds, errors, plain(method), colour_of(place), 1.5, mode="lines+markers", **style)
    if found.apart > 0:
        figure.add_hline(y=found.apart, line={"color": LIGHT.muted, "dash": "dot"})
    x = {"title": "run time (s)", **logarithmic(figure, "x")}
    y = {"title": "largest error, relative to the range", **logarithmic(figure)}
    return themed(figure, title, 480, x=x, y=y, showlegend=True)
