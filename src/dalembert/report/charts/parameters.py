"""Identified parameters within their bounds."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.digits import shown
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.needs import FitLike

ON_BOUND = 1e-6
"""Fraction of the range within which a value counts as on its bound."""


def parameters(fit: FitLike, *, title: str = "Parameters within their bounds") -> go.Figure:
    """Each value where it lies between its bounds, with two standard deviations; a value on a bound is a diamond.

    Parameters
    ----------
    fit : FitLike
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    box = fit.parameters
    width = box.upper - box.lower
    place, spread = (fit.values - box.lower) / width, 2 * np.asarray(fit.deviations, dtype=float) / width
    stuck = on_bound(fit)
    texts = [
        f"{shown(value, deviation)} {plain(item.unit)}".strip()
        for item, value, deviation in zip(box, fit.values, fit.deviations, strict=True)
    ]
    bar = np.where(np.isfinite(spread), spread, 0.0)
    right = np.minimum(bar, 1 - place.clip(None, 1))
    left = np.minimum(bar, place.clip(0, None))
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
                "array": right,
                "arrayminus": left,
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


def on_bound(fit: FitLike) -> np.ndarray:
    """Mask (parameters,) of the values that lie on a bound."""
    box = fit.parameters
    near = ON_BOUND * (box.upper - box.lower)
    return (fit.values <= box.lower + near) | (fit.values >= box.upper - near)
