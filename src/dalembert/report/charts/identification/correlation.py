"""Which parameters the data cannot tell apart."""

import numpy as np
import plotly.graph_objects as go

from dalembert.inverse import BandFit, Fit
from dalembert.report.look import LIGHT, plain, themed

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
    figure = go.Figure(
        go.Heatmap(
            z=matrix,
            x=names,
            y=names,
            zmin=-1,
            zmax=1,
            colorscale=[[0, LIGHT.series[1]], [0.5, LIGHT.surface], [1, LIGHT.series[0]]],
            xgap=2,
            ygap=2,
            colorbar={"thickness": 12, "outlinewidth": 0, "tickvals": [-1, -0.5, 0, 0.5, 1]},
            hovertemplate="%{y}, %{x}: %{z:.4f}<extra></extra>",
        )
    )
    if len(names) <= MOST_TEXTS:
        figure.update_layout(
            annotations=[_number(row, column, entry) for (row, column), entry in np.ndenumerate(matrix)]
        )
    themed(figure, title, height=min(200 + 48 * len(names), 720))
    figure.update_xaxes(showgrid=False, showline=False, ticks="", constrain="domain")
    figure.update_yaxes(showgrid=False, showline=False, ticks="", autorange="reversed", scaleanchor="x")
    return figure.update_layout(margin_t=56)


def unknowns(fit: Fit | BandFit) -> tuple[str, ...]:
    """Names of what was identified: parameters, or the middles and radii of their intervals."""
    return fit.unknowns if isinstance(fit, BandFit) else fit.parameters.names


def _number(row: int, column: int, entry: float) -> go.layout.Annotation:
    """The entry in its square, in the colour that can be read there."""
    colour = LIGHT.surface if abs(entry) > 0.5 else LIGHT.ink
    text = "–" if np.isnan(entry) else f"{entry:.2f}".replace("-", "−")
    return go.layout.Annotation(x=column, y=row, text=text, showarrow=False, font={"color": colour})
