"""Which combinations of parameters the data tell, and which they do not."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.logarithm import logarithmic, positive
from dalembert.report.digits import shown
from dalembert.report.look import LIGHT, plain, themed


def singular_values(
    values: np.ndarray, directions: np.ndarray, names: Sequence[str], *, title: str = "Singular values"
) -> go.Figure:
    """Singular values of the scaled, weighted jacobian on a logarithmic scale, one row a combination of parameters.

    Parameters
    ----------
    values : array, shape (parameters,)
        Singular values; a small one belongs to a combination that the data hardly determine.
    directions : array, shape (parameters, parameters)
        Row k is the combination of scaled parameters that belongs to value k.
    names : sequence of str
        Parameters.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    values = np.asarray(values, dtype=float)
    figure = go.Figure(
        go.Scatter(
            x=positive(values),
            y=[combination(row, names) for row in np.asarray(directions, dtype=float)],
            text=[shown(value, digits=3) for value in values],
            mode="markers+text",
            textposition="top center",
            cliponaxis=False,
            marker={"color": LIGHT.series[0], "size": 11},
        )
    )
    themed(figure, title, height=150 + 48 * len(values))
    figure.update_xaxes(title="singular value", **logarithmic(figure, "x"))
    return figure.update_yaxes(range=[len(values) - 0.5, -0.7]).update_layout(margin_t=56)


def combination(row: np.ndarray, names: Sequence[str], most: int = 3) -> str:
    """A direction in words, its largest parts first.

    Examples
    --------
    >>> combination(np.array([0.6, -0.8, 0.01]), ["a", "b", "c"])
    '−0.80 b + 0.60 a'
    """
    large = [place for place in np.argsort(-np.abs(row))[:most] if abs(row[place]) > 0.05]
    parts = [f"{'−' if row[place] < 0 else '+'} {abs(row[place]):.2f} {plain(names[place])}" for place in large]
    return " ".join(parts).removeprefix("+ ").replace("− ", "−", 1 if parts and parts[0].startswith("−") else 0)
