"""Which parameters the data determine: combinations of them, and their correlation."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import BandFit, Fit
from dalembert.report.charts.drawing import logarithmic, positive
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import shown

MOST_TEXTS = 12


def correlation(fit: Fit | BandFit, *, title: str = "Correlation of the estimates") -> go.Figure:
    """Heat map of the correlation matrix (parameters, parameters), from −1 to 1.

    Parameters
    ----------
    fit : Fit or BandFit
        Intervals identified from bands have two unknowns a parameter, a middle and a radius.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    matrix = np.asarray(fit.correlation, dtype=float)
    names = [plain(name) for name in unknowns(fit)]
    look = {
        "colorscale": [[0, LIGHT.series[1]], [0.5, LIGHT.surface], [1, LIGHT.series[0]]],
        "colorbar": {"thickness": 12, "outlinewidth": 0, "tickvals": [-1, -0.5, 0, 0.5, 1]},
        "hovertemplate": "%{y}, %{x}: %{z:.4f}<extra></extra>",
    }
    figure = go.Figure(go.Heatmap(z=matrix, x=names, y=names, zmin=-1, zmax=1, xgap=2, ygap=2, **look))
    if len(names) <= MOST_TEXTS:
        figure.layout.annotations = [_number(row, column, entry) for (row, column), entry in np.ndenumerate(matrix)]
    axis = {"showgrid": False, "showline": False, "ticks": ""}
    x, y = {**axis, "constrain": "domain"}, {**axis, "autorange": "reversed", "scaleanchor": "x"}
    return themed(figure, title, min(200 + 48 * len(names), 720), x=x, y=y, margin_t=56)


def unknowns(fit: Fit | BandFit) -> tuple[str, ...]:
    """Names of what was identified: parameters, or the middles and radii of their intervals."""
    return fit.unknowns if isinstance(fit, BandFit) else fit.parameters.names


def _number(row: int, column: int, entry: float) -> go.layout.Annotation:
    """The entry in its square, in the colour that can be read there."""
    colour = LIGHT.surface if abs(entry) > 0.5 else LIGHT.ink
    text = "–" if np.isnan(entry) else f"{entry:.2f}".replace("-", "−")
    return go.layout.Annotation(x=column, y=row, text=text, showarrow=False, font={"color": colour})


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
    rows = [combination(row, names) for row in np.asarray(directions, dtype=float)]
    figure = labelled_points(positive(values), rows, [shown(value, digits=3) for value in values], "top center", 11)
    x, y = {"title": "singular value", **logarithmic(figure, "x")}, {"range": [len(values) - 0.5, -0.7]}
    return themed(figure, title, 150 + 48 * len(values), x=x, y=y, margin_t=56)


def labelled_points(x: np.ndarray, rows: Sequence[str], texts: Sequence[str], at: str, size: int) -> go.Figure:
    """A figure of points, one a row, with texts beside them."""
    marker = {"color": LIGHT.series[0], "size": size}
    style = {"mode": "markers+text", "textposition": at, "cliponaxis": False, "marker": marker}
    return go.Figure(go.Scatter(x=x, y=rows, text=texts, **style))


def combination(row: np.ndarray, names: Sequence[str], most: int = 3) -> str:
    """Return a direction in words, its largest parts first, ``most`` at most.
    >>> combination(np.array([0.6, -0.8, 0.01]), ["a", "b", "c"])
    '−0.80 b + 0.60 a'
    """
    large = [place for place in np.argsort(-np.abs(row))[:most] if abs(row[place]) > 0.05]
    parts = [f"{'−' if row[place] < 0 else '+'} {abs(row[place]):.2f} {plain(names[place])}" for place in large]
    return " ".join(parts).removeprefix("+ ").replace("− ", "−", 1 if parts and parts[0].startswith("−") else 0)
