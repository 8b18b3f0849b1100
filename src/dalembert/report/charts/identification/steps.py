"""How the steps of response sensitivity went."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.inverse import BandFit, Fit
from dalembert.report.charts.identification.l_curve import accounts
from dalembert.report.charts.logarithm import positive
from dalembert.report.look import LIGHT, themed


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
    own = accounts(fit)
    number = np.arange(1, len(own) + 1)
    figure = make_subplots(rows=3, cols=1, shared_xaxes=True, vertical_spacing=0.06)
    for row, name, key, colour, symbol in (
        (1, "residual before the step", "residual", LIGHT.series[0], "circle"),
        (2, "weight chosen", "chosen", LIGHT.series[1], "circle"),
        (2, "weight taken", "mu", LIGHT.ink, "circle-open"),
        (3, "agreement", "agreement", LIGHT.series[2], "circle"),
    ):
        values = np.array([getattr(step, key) for step in own], dtype=float)
        figure.add_scatter(
            x=number,
            y=values if row == 3 else positive(values),
            text=[f"{step.trials} tried" for step in own],
            name=name,
            mode="lines+markers",
            line={"color": colour, "width": 1.5},
            marker={"symbol": symbol, "size": 9 if symbol == "circle-open" else 6},
            row=row,
            col=1,
        )
    themed(figure, title, height=560)
    figure.add_hline(y=1, line={"color": LIGHT.muted, "dash": "dot"}, row=3, col=1)  # pyright: ignore[reportArgumentType]
    for row, label in enumerate(("residual", "weight μ", "agreement"), 1):
        kind = "linear" if row == 3 else "log"
        figure.update_yaxes(title=label, type=kind, rangemode="tozero" if row == 3 else "normal", row=row, col=1)
    return figure.update_xaxes(title="step", dtick=max(1, len(own) // 10), row=3, col=1)
