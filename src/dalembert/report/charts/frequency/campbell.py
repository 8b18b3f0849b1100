"""Frequencies of a rotating system over its speed."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw
from dalembert.report.look import LIGHT, themed
from dalembert.structure import Campbell

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
    critical = np.array([own.speed for own in diagram.critical_speeds])
    if len(critical):
        marker = {"color": LIGHT.ink, "size": 12, "symbol": "circle-open", "line": {"width": 2}}
        figure.add_scatter(x=critical, y=critical / (2.0 * np.pi), name="critical speed", mode="markers", marker=marker)
    y = {"title": f"frequency in the {diagram.frame} frame (Hz)", "rangemode": "tozero"}
    return themed(figure, title, 480, x="speed (rad/s)", y=y, showlegend=True)
