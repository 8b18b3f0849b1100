"""How far the modes of a reduced structure are from those of the full one."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.report.charts.logarithm import positive
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
    figure = make_subplots(rows=2, shared_xaxes=True, vertical_spacing=0.06)
    for row, name, values, colour in (
        (1, "frequency too high by", 100 * np.asarray(errors.relative), LIGHT.series[0]),
        (2, "shape unlike by", 1 - np.asarray(errors.similarity), LIGHT.series[1]),
    ):
        marker = {"color": colour, "size": 9}
        figure.add_scatter(x=modes, y=positive(values), name=name, mode="markers", marker=marker, row=row, col=1)
    themed(figure, title, height=440)
    figure.update_yaxes(title_text="frequency error (%)", type="log", dtick=1, row=1)
    figure.update_yaxes(title_text="1 − similarity", type="log", row=2)
    return figure.update_xaxes(title_text="mode", dtick=max(1, len(modes) // 12), row=2).update_layout(showlegend=False)
