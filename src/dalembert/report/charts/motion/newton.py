"""How hard each step was to solve."""

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Trajectory
from dalembert.report.look import LIGHT, themed

BINS = 400


def newton(trajectory: Trajectory, *, title: str = "Newton iterations") -> go.Figure:
    """Newton iterations of each step; in a long run the most and the mean of every few steps.

    Parameters
    ----------
    trajectory : Trajectory
        With ``newton_iterations``: array of int (steps,).
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    counts = np.asarray(trajectory.newton_iterations)
    parts = np.array_split(counts, min(BINS, max(len(counts), 1)))
    steps = np.cumsum([0, *(len(part) for part in parts)])[:-1] + 1
    each = -(-len(counts) // max(len(parts), 1))
    figure = go.Figure()
    most = [int(part.max(initial=0)) for part in parts]
    name = "a step" if each <= 1 else f"most in {each} steps"
    line = {"shape": "hv", "color": LIGHT.series[0], "width": 1.5}
    figure.add_scatter(x=steps, y=most, name=name, mode="lines", line=line)
    if each > 1:
        mean = [float(part.mean()) for part in parts]
        figure.add_scatter(x=steps, y=mean, name="mean", mode="lines", line={"color": LIGHT.series[1], "width": 1.5})
    themed(figure, title, height=360)
    figure.update_xaxes(title="step")
    return figure.update_yaxes(title="iterations", rangemode="tozero")
