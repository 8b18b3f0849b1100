"""Differences between models, and where in the data they come from."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import ModelComparison
from dalembert.report.charts.drawing import colour_of
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.thinning import thinned


def model_differences(comparison: ModelComparison, *, title: str = "Predictive densities of the models") -> go.Figure:
    """Difference of the log predictive density of each model to the best one, with two standard deviations.

    Parameters
    ----------
    found : ModelComparison
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    rows = np.arange(len(comparison.models))
    figure = go.Figure()
    figure.add_vline(0.0, line={"color": LIGHT.muted, "width": 1})
    figure.add_scatter(
        x=comparison.difference,
        y=rows,
        error_x={"array": 2 * comparison.difference_deviation, "width": 4},
        mode="markers",
        marker={"color": LIGHT.series[0], "size": 9},
        name="difference",
    )
    axis = {
        "tickvals": rows.tolist(),
        "ticktext": [plain(name) for name in comparison.models],
        "autorange": "reversed",
        "showgrid": False,
    }
    return themed(figure, title, 170 + 38 * len(rows), x="difference to the best model (elpd)", y=axis)


def difference_by_group(comparison: ModelComparison, *, title: str = "Where the models differ") -> go.Figure:
    """Sum of the differences to the best model over the groups that were left out, in the order of the data.

    Parameters
    ----------
    found : ModelComparison
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = go.Figure()
    groups = np.arange(1, comparison.densities.shape[1] + 1)
    for place, name in enumerate(comparison.models[1:], start=1):
        x, y = thinned(groups, np.cumsum(comparison.densities[place] - comparison.densities[0]))
        figure.add_scatter(x=x, y=y, mode="lines", name=plain(name), line={"color": colour_of(place), "width": 2})
    return themed(figure, title, x="group", y="sum of differences (elpd)", showlegend=True)
