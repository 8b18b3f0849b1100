"""How far the modes of a reduced structure are from those of the full one."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import positive, stacked
from dalembert.report.look import LIGHT, themed
from dalembert.structure import ReductionErrors


def reduction_errors(errors: ReductionErrors, *, title: str = "Modes of the reduced structure") -> go.Figure:
    """Error of each frequency in percent; below, what is missing of the shape's similarity to 1; both logarithmic.

    Parameters
    ----------
    errors : ReductionErrors
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    modes = np.arange(1, len(errors.full) + 1)
    figure = stacked(1, 1)
    for row, name, values, colour in (
        (1, "frequency too high by", 100 * np.asarray(errors.relative), LIGHT.series[0]),
        (2, "shape unlike by", 1 - np.asarray(errors.similarity), LIGHT.series[1]),
    ):
        marker = {"color": colour, "size": 9}
        figure.add_scatter(x=modes, y=positive(values), name=name, mode="markers", marker=marker, row=row, col=1)
    x = {"title": "mode", "dtick": max(1, len(modes) // 12)}
    y = ({"title": "frequency error (%)", "type": "log", "dtick": 1}, {"title": "1 − similarity", "type": "log"})
    return themed(figure, title, 440, x=x, y=y, showlegend=False)
