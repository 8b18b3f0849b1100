"""Modes of linear structures: over the speed of rotation, and after a reduction."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw, positive, stacked
from dalembert.report.look import LIGHT, themed
from dalembert.structure import Campbell, ReductionErrors

FIXED = "fixed"


def campbell(diagram: Campbell, *, title: str = "Campbell diagram") -> go.Figure:
    """Frequency of each mode over the speed, with the line of the rotation and the critical speeds.

    Parameters
    ----------
    diagram : Campbell
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure, order = go.Figure(), np.argsort(diagram.speeds)
    speeds = diagram.speeds[order]
    mode = "lines+markers" if len(speeds) <= 60 else "lines"
    for number, frequencies in enumerate(diagram.frequencies[order].T):
        way = diagram.direction(number)
        dash = {"forward": "solid", "backward": "dash", "": "dot"}[way]
        name = f"mode {number + 1}" + (f", {way}" if way else "")
        style = {"mode": mode, "marker_size": 5, "line_dash": dash}
        draw(figure, speeds, frequencies, name, colour_of(number), **style)
    if diagram.frame == FIXED and len(speeds) > 1:
        draw(figure, speeds, speeds / (2.0 * np.pi), "rotation", LIGHT.muted, 1.0, mode="lines", line_dash="longdash")
    critical = np.array([critical_speed.speed for critical_speed in diagram.critical_speeds])
    if len(critical):
        marker = {"color": LIGHT.ink, "size": 12, "symbol": "circle-open", "line": {"width": 2}}
        figure.add_scatter(x=critical, y=critical / (2.0 * np.pi), name="critical speed", mode="markers", marker=marker)
    y = {"title": f"frequency in the {diagram.frame} frame (Hz)", "rangemode": "tozero"}
    return themed(figure, title, 480, x="speed (rad/s)", y=y, showlegend=True)


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
