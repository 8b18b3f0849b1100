"""Energies of a motion, and what their balance leaves over."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.multibody import Trajectory
from dalembert.report.look import LIGHT, themed
from dalembert.report.thin import thin

LINES = {
    "kinetic": ("kinetic", LIGHT.series[0]),
    "potential": ("potential", LIGHT.series[1]),
    "total": ("total", LIGHT.ink),
    "work": ("work done on it", LIGHT.series[2]),
}


def energies(trajectory: Trajectory, *, title: str = "Energies") -> go.Figure:
    """Kinetic, potential and total energy and the work of loads over time; below, their balance on its own scale.

    The balance is zero for an exact solution, so what is seen there is the error of the integration.

    Parameters
    ----------
    trajectory : Trajectory
        With ``energies``: arrays (samples,) in J, by name.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    times, given = np.asarray(trajectory.times), trajectory.energies
    figure = make_subplots(rows=2, shared_xaxes=True, row_heights=[0.68, 0.32], vertical_spacing=0.06)
    for key, (word, colour) in LINES.items():
        if key in given:
            kept = thin(given[key])
            line = {"color": colour, "width": 2}
            figure.add_scatter(x=times[kept], y=given[key][kept], name=word, mode="lines", line=line, row=1, col=1)
    if "balance" in given:
        kept = thin(given["balance"])
        figure.add_scatter(x=times[kept], y=given["balance"][kept], name="balance", mode="lines", row=2, col=1)
        figure.update_traces(line={"color": LIGHT.series[3], "width": 1.5}, showlegend=False, row=2)
    themed(figure, title, height=460)
    figure.update_yaxes(title_text="energy (J)", row=1)
    figure.update_yaxes(title_text="balance (J)", row=2)
    figure.update_xaxes(title_text="time (s)", row=2)
    return figure.update_layout(hovermode="x unified")
