"""How the gaps between the segments of multiple shooting were closed."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import Fit
from dalembert.report.charts.drawing import draw, positive, stacked
from dalembert.report.charts.identification.search import winner
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
    figure = stacked(1, 1, spacing=0.08)
    for row, name, key, colour in (
        (1, "largest gap", "gap", LIGHT.series[0]),
        (2, "misfit", "best", LIGHT.series[1]),
    ):
        values = positive(np.array([getattr(step, key) for step in steps], dtype=float))
        draw(figure, number, values, name, colour, 1.5, row=row, mode="lines+markers", marker_size=5)
    y = [{"title": label, "type": "log"} for label in ("gap (part of the range)", "misfit")]
    return themed(figure, title, 480, x="step in segments", y=y)
