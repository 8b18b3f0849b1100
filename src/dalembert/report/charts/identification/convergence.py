"""How the fitness of every start, or of a swarm, came down."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import BandFit, Fit
from dalembert.report.charts.logarithm import logarithmic, positive
from dalembert.report.look import LIGHT, themed
from dalembert.report.thin import thin


def convergence(fit: Fit | BandFit, *, title: str = "Convergence") -> go.Figure:
    """Best fitness so far over the iterations, one line a start, the winning start in colour.

    Parameters
    ----------
    fit : Fit or BandFit
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    starts = sorted({step.start for step in fit.history})
    best = winner(fit)
    figure = go.Figure()
    others = [start for start in starts if start != best]
    if others:
        figure.add_scatter(x=[None], y=[None], name="the others", mode="lines", legendgroup="others")
        figure.update_traces(line={"color": LIGHT.muted, "width": 1})
    for start in [*others, *(start for start in starts if start == best)]:
        steps = [step for step in fit.history if step.start == start]
        fitness = positive(np.array([step.best for step in steps], dtype=float))
        kept = thin(fitness, most=1000)
        won = start == best
        figure.add_scatter(
            x=np.array([step.iteration for step in steps])[kept],
            y=fitness[kept],
            customdata=np.array([step.simulations for step in steps])[kept],
            hovertemplate="iteration %{x}, %{customdata} simulations: %{y}",
            name=f"start {start + 1}, the best" if won else f"start {start + 1}",
            legendgroup="best" if won else "others",
            mode="lines+markers" if len(steps) <= 60 else "lines",
            line={"color": LIGHT.series[0] if won else LIGHT.muted, "width": 2.5 if won else 1},
            marker={"size": 5 if won else 3},
            opacity=1 if won else 0.6,
            showlegend=won,
        )
    themed(figure, title, height=360)
    figure.update_xaxes(title="iteration")
    figure.update_yaxes(title="best fitness so far", **logarithmic(figure))
    return figure.update_layout(showlegend=True)


def winner(fit: Fit | BandFit) -> int:
    """Number of the start with the lowest fitness at its end."""
    ends = [start.fitness if np.isfinite(start.fitness) else np.inf for start in fit.starts]
    return int(np.argmin(ends)) if ends else 0
