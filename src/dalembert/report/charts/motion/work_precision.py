"""Integrators compared: error against run time."""

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import WorkPrecision
from dalembert.report.charts.logarithm import logarithmic, positive
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
        figure.add_scatter(
            x=positive(np.array([row.seconds for row in own])),
            y=positive(np.array([row.error for row in own])),
            name=plain(method),
            text=[plain(row.settings) for row in own],
            hovertemplate="%{text}<br>%{x:.3g} s, error %{y:.2e}<extra></extra>",
            mode="lines+markers",
            line={"width": 1.5, "color": LIGHT.series[place % len(LIGHT.series)]},
            marker={"size": 8, "symbol": SYMBOLS[place % len(SYMBOLS)]},
        )
    if found.apart > 0:
        figure.add_hline(y=found.apart, line={"color": LIGHT.muted, "dash": "dot"})
    themed(figure, title, height=480)
    figure.update_xaxes(title="run time (s)", **logarithmic(figure, "x"))
    return figure.update_yaxes(title="largest error, relative to the range", **logarithmic(figure)).update_layout(
        showlegend=True
    )
