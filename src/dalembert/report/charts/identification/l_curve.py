"""How much regularisation each step of response sensitivity chose."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import BandFit, Fit
from dalembert.optimize.minimum import RegularisedStep
from dalembert.report.charts.identification.starts import ranked
from dalembert.report.charts.logarithm import logarithmic, positive
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
        told = number == (bent[-1] if bent else len(steps))
        figure.add_scatter(
            x=positive(np.asarray(step.residual_norms, dtype=float)),
            y=positive(np.asarray(step.step_norms, dtype=float)),
            text=[f"μ = {weight:.3g}" for weight in step.weights],
            name=f"step {number}",
            mode="lines",
            line={"color": LIGHT.series[0] if told else LIGHT.muted, "width": 2.5 if told else 1},
            opacity=1 if told else 0.6,
            showlegend=told,
        )
    for name, key, marker in (
        ("chosen", "chosen", {"color": LIGHT.series[1], "size": 9}),
        ("taken", "mu", {"color": LIGHT.ink, "size": 13, "symbol": "circle-open"}),
    ):
        places = [_at(step, getattr(step, key)) for step in steps]
        figure.add_scatter(
            x=positive(np.array([place[0] for place in places])),
            y=positive(np.array([place[1] for place in places])),
            text=[f"step {number}: μ = {getattr(step, key):.3g}" for number, step in enumerate(steps, 1)],
            name=name,
            mode="markers",
            marker=marker,
        )
    themed(figure, title)
    figure.update_xaxes(title="residual that the linear model leaves", **logarithmic(figure, "x"))
    return figure.update_yaxes(title="length of the step", **logarithmic(figure))


def accounts(fit: Fit | BandFit) -> list[RegularisedStep]:
    """Accounts of the steps of the best start that has several of them, or of the best that has any."""
    best: list[RegularisedStep] = []
    for start in ranked(fit):
        steps = [step.regularised for step in fit.history if step.start == start]
        own = [step for step in steps if step is not None]
        if len(own) > 1:
            return own
        best = best or own
    return best


def _at(step: RegularisedStep, weight: float) -> tuple[float, float]:
    """Where a weight stands on the L-curve, between its points or at its ends."""
    along = np.log(weight), np.log(step.weights)
    return tuple(  # pyright: ignore[reportReturnType]
        float(np.exp(np.interp(*along, np.log(np.maximum(norms, 1e-300)))))
        for norms in (step.residual_norms, step.step_norms)
    )
