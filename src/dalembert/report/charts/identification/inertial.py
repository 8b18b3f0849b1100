"""Exciting motions and torques of robots."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse.inertial import ExcitingTrajectory
from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.thinning import thinned

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


def torques(
    times: np.ndarray, measured: np.ndarray, predicted: np.ndarray, noise: float, *, title: str = "Torque"
) -> go.Figure:
    """Measured and predicted torque of a joint over time, and below them predicted minus measured.

    Parameters
    ----------
    times, measured, predicted : array, shape (samples,)
        s; N m, or N.
    noise : float
        Standard deviation of the measured torque.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = stacked(0.7, 0.3)
    x, y = thinned(times, measured)
    marker = {"size": 4, "opacity": 0.6}
    draw(figure, x, y, "measured", LIGHT.muted, row=1, mode="markers", marker=marker, showlegend=True)
    draw(figure, *thinned(times, predicted), "predicted", colour_of(0), row=1, showlegend=True)
    draw(figure, *thinned(times, predicted - measured), "residual", colour_of(1), 1, row=2, showlegend=True)
    for bound in (-2 * noise, 2 * noise):
        draw(figure, times[[0, -1]], [bound, bound], "", LIGHT.muted, 1, row=2, line_dash="dot", showlegend=False)
    figure.update_yaxes(title="torque (N m)", row=1, col=1)
    figure.update_yaxes(title="residual", row=2, col=1)
    return themed(figure, plain(title), 420, showlegend=True).update_xaxes(title="time (s)", row=2, col=1)
