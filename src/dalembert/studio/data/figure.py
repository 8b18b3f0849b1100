"""The columns of a data file over the times, one below the other."""

from collections.abc import Sequence

import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.look import plain, themed
from dalembert.report.quantities import labelled
from dalembert.studio.data.examined import Curve, Examined
from dalembert.studio.runs.figures import on_any_page

MOST = 12
"""Columns that are drawn; those that are used come first."""
HEIGHT, AXES = 110, 70
"""Pixels of each column, and of what is around them."""
FEW = 200
"""Points up to which each is drawn as a circle."""


def drawn_columns(examined: Examined) -> Sequence[Curve]:
    """The columns that are drawn: no times, and those that are used first."""
    used = tuple(examined.choices.channels.values())
    others = [curve for curve in examined.curves if curve.key != examined.choices.time]
    return sorted(others, key=lambda curve: curve.key not in used)[:MOST]


def columns_figure(examined: Examined) -> go.Figure:
    """Return the figure of the columns; outliers of those that are used are marked."""
    curves = drawn_columns(examined)
    figure = stacked(*[1.0] * max(1, len(curves)), spacing=0.25 / max(1, len(curves)))
    for row, curve in enumerate(curves, 1):
        mode = "lines+markers" if len(curve.values) <= FEW else "lines"
        draw(figure, curve.along, curve.values, plain(str(curve.key)), colour_of(0), 1.5, row=row, mode=mode)
        figure.update_traces(selector={"mode": "lines+markers"}, marker_size=4)
        if curve.far.size:
            style = {"symbol": "circle-open", "size": 11, "color": colour_of(1), "line_width": 2}
            figure.add_scatter(
                x=curve.far[0], y=curve.far[1], mode="markers", marker=style, row=row, col=1, name="outliers"
            )
    for row, curve in enumerate(curves, 1):
        title = labelled(plain(str(curve.key)), "" if curve.unit.source == "file" else curve.unit.name)
        place = {"xref": "x domain", "yref": "y domain", "x": 0.0, "y": 1.0, "xanchor": "left", "yanchor": "bottom"}
        figure.add_annotation(text=title, showarrow=False, row=row, col=1, **place)
    themed(figure, "", height=HEIGHT * max(1, len(curves)) + AXES, showlegend=False, hovermode="x")
    numbered = examined.choices.time is None and examined.choices.rate is None
    along = "row" if numbered else labelled("time", "s")
    figure.update_xaxes(title={"text": along, "font_size": 13}, row=max(1, len(curves)), col=1)
    return on_any_page(figure)
