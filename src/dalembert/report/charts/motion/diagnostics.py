"""How well motions were computed."""

from typing import TYPE_CHECKING

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Trajectory
from dalembert.report.charts.drawing import colour_of, draw, logarithmic, positive, stacked
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.thinning import largest_of_stretches, thinned

if TYPE_CHECKING:
    from dalembert.multibody import WorkPrecision

ENERGIES = {
    "kinetic": ("kinetic", LIGHT.series[0]),
    "potential": ("potential", LIGHT.series[1]),
    "total": ("total", LIGHT.ink),
    "work": ("work done on it", LIGHT.series[2]),
}
LEVELS = {"position": "position (m)", "velocity": "velocity (m/s)", "acceleration": "acceleration (m/s²)"}
BINS = 400


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
    times, energy = np.asarray(trajectory.times), trajectory.energies
    figure = stacked(0.68, 0.32)
    for key, (word, colour) in ENERGIES.items():
        if key in energy:
            draw(figure, *thinned(times, energy[key]), word, colour, row=1)
    if "balance" in energy:
        x, y = thinned(times, energy["balance"])
        draw(figure, x, y, "balance", LIGHT.series[3], 1.5, row=2, showlegend=False)
    return themed(figure, title, 460, x="time (s)", y=("energy (J)", "balance (J)"), hovermode="x unified")


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
    times, figure = np.asarray(trajectory.times), go.Figure()
    for (level, label), colour in zip(LEVELS.items(), LIGHT.series, strict=False):
        if level in trajectory.violations:
            ends, values = largest_of_stretches(times, np.asarray(trajectory.violations[level], dtype=float))
            draw(figure, ends, positive(values), label, colour, 1.5, line_shape="vh")
    return themed(figure, title, 360, x="time (s)", y={"title": "violation", **logarithmic(figure)})


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
    counts, figure = np.asarray(trajectory.newton_iterations), go.Figure()
    parts = np.array_split(counts, min(BINS, max(len(counts), 1)))
    steps = np.cumsum([0, *(len(part) for part in parts)])[:-1] + 1
    each = -(-len(counts) // max(len(parts), 1))
    most = [int(part.max(initial=0)) for part in parts]
    name = "a step" if each <= 1 else f"most in {each} steps"
    draw(figure, steps, most, name, LIGHT.series[0], 1.5, line_shape="hv")
    if each > 1:
        draw(figure, steps, [float(part.mean()) for part in parts], "mean", LIGHT.series[1], 1.5)
    return themed(figure, title, 360, x="step", y={"title": "iterations", "rangemode": "tozero"})


SYMBOLS = ("circle", "square", "diamond", "triangle-up", "x", "star", "cross", "pentagon")


def work_precision(comparison: "WorkPrecision", *, title: str = "Error against run time") -> go.Figure:
    """Error of each run over its run time, both logarithmic, one line an integrator; no runs that ended early.

    Parameters
    ----------
    found : WorkPrecision
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = go.Figure()
    for place, method in enumerate(comparison.methods):
        rows = [row for row in comparison.rows if row.method == method and not row.failure]
        seconds, errors = (positive(np.array([getattr(row, key) for row in rows])) for key in ("seconds", "error"))
        marker = {"size": 8, "symbol": SYMBOLS[place % len(SYMBOLS)]}
        hover = "%{text}<br>%{x:.3g} s, error %{y:.2e}<extra></extra>"
        style = {"text": [plain(row.settings) for row in rows], "hovertemplate": hover, "marker": marker}
        draw(figure, seconds, errors, plain(method), colour_of(place), 1.5, mode="lines+markers", **style)
    if comparison.apart > 0:
        figure.add_hline(y=comparison.apart, line={"color": LIGHT.muted, "dash": "dot"})
    x = {"title": "run time (s)", **logarithmic(figure, "x")}
    y = {"title": "largest error, relative to the range", **logarithmic(figure)}
    return themed(figure, title, 480, x=x, y=y, showlegend=True)
