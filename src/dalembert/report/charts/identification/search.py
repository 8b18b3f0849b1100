"""How the search went: the misfit of every start over its iterations, and the minima that the starts found."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import BandFit, Fit
from dalembert.inverse.fit.starts_table import ranked
from dalembert.report.charts.drawing import draw, logarithmic, positive
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.thinning import thin


def convergence(fit: Fit | BandFit, *, title: str = "Convergence") -> go.Figure:
    """Best misfit so far over the iterations, one line a start, the winning start in colour.

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
    other_starts = [start for start in starts if start != best]
    if other_starts:
        draw(figure, [None], [None], "the others", LIGHT.muted, 1, legendgroup="others")
    for start in [*other_starts, *(start for start in starts if start == best)]:
        steps = [step for step in fit.history if step.start == start]
        misfit = positive(np.array([step.best for step in steps], dtype=float))
        kept = thin(misfit, most=1000)
        iterations, simulations = np.array([(step.iteration, step.simulations) for step in steps])[kept].T
        won = start == best
        colour, width, size, opacity = (LIGHT.series[0], 2.5, 5, 1) if won else (LIGHT.muted, 1, 3, 0.6)
        style = {
            "customdata": simulations,
            "hovertemplate": "iteration %{x}, %{customdata} simulations: %{y}",
            "legendgroup": "best" if won else "others",
            "mode": "lines+markers" if len(steps) <= 60 else "lines",
        }
        name = f"start {start + 1}, the best" if won else f"start {start + 1}"
        marks = {"marker_size": size, "opacity": opacity, "showlegend": won}
        draw(figure, iterations, misfit[kept], name, colour, width, **style, **marks)
    y = {"title": "smallest misfit so far", **logarithmic(figure)}
    return themed(figure, title, 360, x="iteration", y=y, showlegend=True)


def winner(fit: Fit | BandFit) -> int:
    """Number of the start with the lowest misfit at its end."""
    ends = [start.misfit if np.isfinite(start.misfit) else np.inf for start in fit.starts]
    return int(np.argmin(ends)) if ends else 0


def starts(fit: Fit | BandFit, *, title: str = "Starts and their ends") -> go.Figure:
    """Waterfall: final misfit of every start, best first, each with a stem from where it started.

    A flat step of several starts is a minimum that many ways lead to.

    Parameters
    ----------
    fit : Fit or BandFit
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    order = ranked(fit.starts)
    ends = positive(np.array([fit.starts[number].misfit for number in order], dtype=float))
    firsts = [next((step.best for step in fit.history if step.start == number), np.nan) for number in order]
    began = positive(np.array(firsts, dtype=float))
    rank = np.arange(1, len(order) + 1)
    stems = np.stack([began, ends, np.full(len(order), np.nan)], axis=1).ravel()
    figure = go.Figure()
    draw(figure, np.repeat(rank, 3), stems, "", LIGHT.grid, 3, hoverinfo="skip", showlegend=False)
    marker = {"symbol": "line-ew-open", "size": 12, "color": LIGHT.muted}
    figure.add_scatter(x=rank, y=began, name="at its start", mode="markers", marker=marker)
    for name, success, colour, symbol in (
        ("converged", True, LIGHT.series[0], "circle"),
        ("not converged", False, LIGHT.series[1], "x"),
    ):
        here = [place for place, number in enumerate(order) if fit.starts[number].success is success]
        marker = {"color": colour, "symbol": symbol, "size": 9}
        text = [f"start {order[place] + 1}: {plain(fit.starts[order[place]].message)}" for place in here]
        style = {"mode": "markers", "marker": marker, "text": text, "showlegend": bool(here)}
        figure.add_scatter(x=rank[here], y=ends[here], name=name, **style)
    x = {"title": "starts, best first", "dtick": max(1, len(order) // 10)}
    return themed(figure, title, 360, x=x, y={"title": "misfit", **logarithmic(figure)})
