"""Regularised fits: the L-curve, and parameters that vary smoothly."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import BandFit, Fit, RegularisedFit
from dalembert.inverse.fit.starts_table import ranked
from dalembert.optimize.minimum import RegularisedStep
from dalembert.report.charts.drawing import draw, logarithmic, positive, stacked
from dalembert.report.look import LIGHT, themed


def l_curve(fit: Fit | BandFit, *, title: str = "L-curves") -> go.Figure:
    """Length of a step over the residual that it would leave, for all weights, with the weight chosen and that taken.

    One curve a step of the best start; in colour the last one that has a corner.

    Parameters
    ----------
    fit : Fit or BandFit
        With at least one step that has an account of its regularisation.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    steps = accounts(fit)
    figure = go.Figure()
    bent = [number for number, step in enumerate(steps, 1) if step.chosen > step.weights[0]]
    for number, step in enumerate(steps, 1):
        is_last = number == (bent[-1] if bent else len(steps))
        x, y = (positive(np.asarray(norms, dtype=float)) for norms in (step.residual_norms, step.step_norms))
        text = [f"μ = {weight:.3g}" for weight in step.weights]
        colour, width, opacity = (LIGHT.series[0], 2.5, 1) if is_last else (LIGHT.muted, 1, 0.6)
        draw(figure, x, y, f"step {number}", colour, width, text=text, opacity=opacity, showlegend=is_last)
    for name, key, marker in (
        ("chosen", "chosen", {"color": LIGHT.series[1], "size": 9}),
        ("taken", "mu", {"color": LIGHT.ink, "size": 13, "symbol": "circle-open"}),
    ):
        x, y = positive(np.array([_at(step, getattr(step, key)) for step in steps])).T
        text = [f"step {number}: μ = {getattr(step, key):.3g}" for number, step in enumerate(steps, 1)]
        figure.add_scatter(x=x, y=y, text=text, name=name, mode="markers", marker=marker)
    x = {"title": "residual that the linear model leaves", **logarithmic(figure, "x")}
    return themed(figure, title, x=x, y={"title": "length of the step", **logarithmic(figure)})


def steps(fit: Fit | BandFit, *, title: str = "Steps of the best start") -> go.Figure:
    """Residual before each step, weights chosen and taken, and agreement with the linear model, over the steps.

    Parameters
    ----------
    fit : Fit or BandFit
        With at least one step that has an account of its regularisation.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    accounts_here = accounts(fit)
    number = np.arange(1, len(accounts_here) + 1)
    figure = stacked(1, 1, 1)
    for row, name, key, colour, symbol in (
        (1, "residual before the step", "residual", LIGHT.series[0], "circle"),
        (2, "weight chosen", "chosen", LIGHT.series[1], "circle"),
        (2, "weight taken", "mu", LIGHT.ink, "circle-open"),
        (3, "agreement", "agreement", LIGHT.series[2], "circle"),
    ):
        values = np.array([getattr(step, key) for step in accounts_here], dtype=float)
        y, text = values if row == 3 else positive(values), [f"{step.trials} tried" for step in accounts_here]
        marker = {"symbol": symbol, "size": 9 if symbol == "circle-open" else 6}
        draw(figure, number, y, name, colour, 1.5, row=row, mode="lines+markers", text=text, marker=marker)
    figure.add_hline(y=1, line={"color": LIGHT.muted, "dash": "dot"}, row=3, col=1)  # pyright: ignore[reportArgumentType]
    logarithmically = [{"title": label, "type": "log", "rangemode": "normal"} for label in ("residual", "weight μ")]
    y = (*logarithmically, {"title": "agreement", "type": "linear", "rangemode": "tozero"})
    return themed(figure, title, 560, x={"title": "step", "dtick": max(1, len(accounts_here) // 10)}, y=y)


def accounts(fit: Fit | BandFit) -> list[RegularisedStep]:
    """Accounts of the steps of the best start that has several of them, or of the best that has any."""
    best: list[RegularisedStep] = []
    for start in ranked(fit.starts):
        steps = [step.regularised for step in fit.history if step.start == start]
        accounts_here = [step for step in steps if step is not None]
        if len(accounts_here) > 1:
            return accounts_here
        best = best or accounts_here
    return best


def _at(step: RegularisedStep, weight: float) -> tuple[float, float]:
    """Where a weight stands on the L-curve, between its points or at its ends."""
    along = np.log(weight), np.log(step.weights)
    return tuple(  # pyright: ignore[reportReturnType]
        float(np.exp(np.interp(*along, np.log(np.maximum(norms, 1e-300)))))
        for norms in (step.residual_norms, step.step_norms)
    )


def smooth_parameters(fit: RegularisedFit, *, title: str = "") -> go.Figure:
    """Values of the smooth parameters in their order, with a band of two standard deviations.

    Parameters
    ----------
    fit : RegularisedFit
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    places = [fit.names.index(name) for name in fit.smooth]
    values, deviations = fit.values[places], fit.deviations[places]
    numbers, units = np.arange(1, len(places) + 1), {fit.units[place] for place in places}
    unit = f" in {units.pop()}" if len(units) == 1 and "" not in units else ""
    figure = go.Figure()
    edge = {"mode": "lines", "line": {"width": 0}, "showlegend": False, "hoverinfo": "skip"}
    figure.add_scatter(x=numbers, y=values - 2 * deviations, **edge)
    band = {**edge, "showlegend": True, "name": "two standard deviations"}
    figure.add_scatter(
        x=numbers, y=values + 2 * deviations, fill="tonexty", fillcolor="rgba(70, 120, 200, 0.2)", **band
    )
    draw(figure, numbers, values, "value", LIGHT.series[0], 2, text=list(fit.smooth))
    heading = title or f"{len(places)} smooth parameters"
    return themed(figure, heading, x={"title": "number of the parameter"}, y={"title": f"value{unit}"})


def penalty_curve(fit: RegularisedFit, *, title: str = "L-curve") -> go.Figure:
    """Penalty over residual of the linearised problem for all weights, with the weights of both rules.

    Parameters
    ----------
    fit : RegularisedFit
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = go.Figure()
    x, y = positive(fit.residual_norms), positive(fit.penalty_norms)
    draw(figure, x, y, "all weights", LIGHT.series[0], 2, text=[f"μ = {weight:.3g}" for weight in fit.weights])
    marks = (("corner", fit.corner, "circle"), ("discrepancy principle", fit.discrepancy, "diamond"))
    for number, (name, weight, symbol) in enumerate(marks, 1):
        if np.isfinite(weight):
            place = [np.interp(np.log(weight), np.log(fit.weights), np.log(norms)) for norms in (x, y)]
            figure.add_scatter(
                x=[np.exp(place[0])], y=[np.exp(place[1])], name=name, text=[f"μ = {weight:.3g}"], mode="markers",
                marker={"color": LIGHT.series[number], "size": 11, "symbol": symbol},
            )  # fmt: skip
    across = {"title": "residual norm", **logarithmic(figure, "x")}
    return themed(figure, title, x=across, y={"title": "norm of the differences", **logarithmic(figure)})
