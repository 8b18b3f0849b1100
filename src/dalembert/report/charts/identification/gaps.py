"""How the gaps between the segments of multiple shooting were closed."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.inverse import Fit
from dalembert.report.charts.identification.convergence import winner
from dalembert.report.charts.logarithm import positive
from dalembert.report.look import LIGHT, themed


def gaps(fit: Fit, *, title: str = "Gaps between segments") -> go.Figure:
    """Largest gap and misfit of the best start after each step in segments, over the steps.

    Parameters
    ----------
    fit : Fit
        Of multiple shooting.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    steps = [step for step in fit.history if step.start == winner(fit) and step.gap is not None]
    number = np.arange(1, len(steps) + 1)
    figure = make_subplots(rows=2, cols=1, shared_xaxes=True, vertical_spacing=0.08)
    for row, name, key, colour in (
        (1, "largest gap", "gap", LIGHT.series[0]),
        (2, "misfit", "best", LIGHT.series[1]),
    ):
        values = positive(np.array([getattr(step, key) for step in steps], dtype=float))
        line = {"color": colour, "width": 1.5}
        figure.add_scatter(
            x=number, y=values, name=name, mode="lines+markers", line=line, marker={"size": 5}, row=row, col=1
        )
    themed(figure, title, height=480)
    for row, label in enumerate(("gap (part of the range)", "misfit"), 1):
        figure.update_yaxes(title=label, type="log", row=row, col=1)
    return figure.update_xaxes(title="step in segments", row=2, col=1)
