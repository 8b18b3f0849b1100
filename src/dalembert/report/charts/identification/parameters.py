"""Identified parameters within their bounds."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import Fit
from dalembert.parameters import Parameters
from dalembert.report.digits import shown
from dalembert.report.look import LIGHT, plain, themed

ON_BOUND = 1e-6
"""Part of the way between the bounds within which a value counts as on one."""


def parameters(fit: Fit, *, title: str = "Parameters within their bounds") -> go.Figure:
    """Each value where it lies between its bounds, with two standard deviations; a value on a bound is a diamond.

    Where the logarithm of a parameter is searched, the way between its bounds is logarithmic too.

    Parameters
    ----------
    fit : Fit
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    box = fit.parameters
    deviations = np.asarray(fit.deviations, dtype=float)
    spread = np.where(np.isfinite(deviations), 2 * deviations, 0.0)
    place, low, high = (
        placed(box, box.clip(values)) for values in (fit.values, fit.values - spread, fit.values + spread)
    )
    stuck = on_bound(fit)
    texts = [
        f"{shown(value, deviation)} {plain(item.unit)}".strip()
        for item, value, deviation in zip(box, fit.values, fit.deviations, strict=True)
    ]
    names = [plain(name) for name in box.names]
    track = {"color": LIGHT.grid, "width": 8}
    figure = go.Figure(
        [
            go.Scatter(x=[0, 1], y=[name, name], mode="lines", line=track, hoverinfo="skip", showlegend=False)
            for name in names
        ]
    )
    figure.add_trace(
        go.Scatter(
            x=place,
            y=names,
            error_x={
                "array": high - place,
                "arrayminus": place - low,
                "symmetric": False,
                "thickness": 2,
                "width": 6,
                "color": LIGHT.ink,
            },
            mode="markers+text",
            text=texts,
            textposition=[
                f"top {side}" for side in np.select([place < 0.25, place > 0.75], ["right", "left"], "center")
            ],
            cliponaxis=False,
            marker={
                "size": 11,
                "symbol": ["diamond" if at else "circle" for at in stuck],
                "color": [LIGHT.series[1] if at else LIGHT.series[0] for at in stuck],
            },
            showlegend=False,
        )
    )
    themed(figure, title, height=110 + 56 * len(box))
    figure.update_xaxes(range=[-0.1, 1.1], showgrid=False, tickvals=[0, 0.5, 1], ticktext=["lower", "middle", "upper"])
    return figure.update_yaxes(range=[len(box) - 0.5, -0.7], showgrid=False).update_layout(margin_t=56)


def on_bound(fit: Fit) -> np.ndarray:
    """Mask (parameters,) of the values that lie on a bound."""
    place = placed(fit.parameters, fit.values)
    return (place <= ON_BOUND) | (place >= 1 - ON_BOUND)


def placed(box: Parameters, values: np.ndarray) -> np.ndarray:
    """How far on the way from its lower to its upper bound each value lies, shape (parameters,)."""
    logarithmic = np.array([item.logarithmic for item in box], dtype=bool)
    low, at, high = (np.where(logarithmic, _log(each, logarithmic), each) for each in (box.lower, values, box.upper))
    return (at - low) / (high - low)


def _log(values: np.ndarray, where: np.ndarray) -> np.ndarray:
    return np.log(np.where(where, values, 1.0))
