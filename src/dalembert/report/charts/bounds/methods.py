"""Methods that bound a response, compared: how far each lies from the reference, and what it cost."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw, logarithmic, positive
from dalembert.report.charts.identification.responses import FEW
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.thinning import thinned
from dalembert.tables import labelled
from dalembert.uncertainty import Comparison

KINDS = {
    "inner bound": (LIGHT.series[0], "circle"),
    "estimate": (LIGHT.series[1], "square"),
    "enclosure of the surrogate": (LIGHT.series[2], "diamond"),
}


def methods(comparison: Comparison, *, title: str = "Error against runs") -> go.Figure:
    """Largest distance of each method's bounds from the reference, over the runs of the model that it took.

    A method that gives the same bounds as the reference has no place on a logarithmic axis and is left out.

    Parameters
    ----------
    comparison : Comparison
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = go.Figure()
    for kind, (colour, symbol) in KINDS.items():
        rows_here = [row for row in comparison.rows if row.kind == kind and row.method != comparison.reference]
        figure.add_scatter(
            x=[row.runs for row in rows_here],
            y=positive(np.array([row.largest for row in rows_here])),
            name=kind,
            mode="markers+text",
            text=[plain(row.method) for row in rows_here],
            textposition="top center",
            cliponaxis=False,
            marker={"size": 11, "color": colour, "symbol": symbol},
            showlegend=bool(rows_here),
        )
    x = {"title": "runs of the model", **logarithmic(figure, "x")}
    return themed(figure, title, 400, x=x, y={"title": "largest error", **logarithmic(figure)})


def differences(comparison: Comparison, *, title: str = "Distance from the reference") -> go.Figure:
    """Largest distance of any bound from the reference at each sample, one line a method, on a logarithmic scale.

    Where a bound is that of the reference there is a gap.

    Parameters
    ----------
    comparison : Comparison
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure, known = go.Figure(), comparison.reference_result
    along = known.coordinate
    for place, result in enumerate(result for result in comparison.results if result is not known):
        apart = positive(np.maximum(np.abs(result.lower - known.lower), np.abs(result.upper - known.upper)).max(axis=1))
        x, y = thinned(along.values, apart)
        mode = "lines+markers" if len(x) <= FEW else "lines"
        draw(figure, x, y, plain(result.method), colour_of(place), 1.5, mode=mode, marker_size=4)
    y = {"title": "distance", **logarithmic(figure)}
    return themed(figure, title, 400, x=labelled(along.name, along.unit), y=y, showlegend=True)
