"""The motion of an exciting trajectory: positions, velocities and accelerations of all joints."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse.inertial import ExcitingTrajectory
from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.look import plain, themed

SAMPLES = 401


def exciting_motion(result: ExcitingTrajectory, *, title: str = "Exciting motion") -> go.Figure:
    """Positions, velocities and accelerations over one period, one colour a joint.

    Parameters
    ----------
    result : ExcitingTrajectory
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    times = np.linspace(0.0, result.motion.period, SAMPLES)
    figure = stacked(1.0, 1.0, 1.0)
    for row, table in enumerate(result.motion.motion(times), start=1):
        for k, joint in enumerate(result.joints):
            name = plain(joint)
            draw(figure, times, table[:, k], name, colour_of(k), row=row, legendgroup=name, showlegend=row == 1)
    for row, quantity in enumerate(("position", "velocity", "acceleration"), start=1):
        figure.update_yaxes(title=quantity, row=row, col=1)
    return themed(figure, title, 640, showlegend=True).update_xaxes(title="time (s)", row=3, col=1)
