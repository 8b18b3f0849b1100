"""How well the joints hold, at the levels of position, velocity and acceleration."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.logarithm import logarithmic, positive
from dalembert.report.look import LIGHT, themed
from dalembert.report.needs import TrajectoryLike
from dalembert.report.thin import thin

LEVELS = {"position": "position (m)", "velocity": "velocity (m/s)", "acceleration": "acceleration (m/s²)"}


def violations(trajectory: TrajectoryLike, *, title: str = "Constraint violations") -> go.Figure:
    """Largest violation of a constraint over time at the three levels, on a logarithmic scale; zero is a gap.

    Parameters
    ----------
    trajectory : TrajectoryLike
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
            values = positive(np.asarray(trajectory.violations[level], dtype=float))
            kept = thin(values)
            figure.add_scatter(
                x=times[kept], y=values[kept], name=label, mode="lines", line={"color": colour, "width": 1.5}
            )
    themed(figure, title, height=360)
    figure.update_xaxes(title="time (s)")
    return figure.update_yaxes(title="violation", **logarithmic(figure))
