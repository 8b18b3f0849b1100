"""How well the joints hold, at the levels of position, velocity and acceleration."""

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Trajectory
from dalembert.report.charts.logarithm import logarithmic, positive
from dalembert.report.look import LIGHT, themed
from dalembert.report.thin import largest_of_stretches

LEVELS = {"position": "position (m)", "velocity": "velocity (m/s)", "acceleration": "acceleration (m/s²)"}


def violations(trajectory: Trajectory, *, title: str = "Constraint violations") -> go.Figure:
    """Largest violation of a constraint over time at the three levels, on a logarithmic scale; zero is a gap.

    Of a long motion each point is the largest of a stretch, so that rounding noise does not fill the figure.

    Parameters
    ----------
    trajectory : Trajectory
        With ``violations``: arrays (samples,), by level.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    times = np.asarray(trajectory.times)
    figure = go.Figure()
    for (level, label), colour in zip(LEVELS.items(), LIGHT.series, strict=False):
        if level in trajectory.violations:
            ends, values = largest_of_stretches(times, np.asarray(trajectory.violations[level], dtype=float))
            line = {"color": colour, "width": 1.5, "shape": "vh"}
            figure.add_scatter(x=ends, y=positive(values), name=label, mode="lines", line=line)
    themed(figure, title, height=360)
    figure.update_xaxes(title="time (s)")
    return figure.update_yaxes(title="violation", **logarithmic(figure))
