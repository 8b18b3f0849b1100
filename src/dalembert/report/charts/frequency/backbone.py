"""A nonlinear mode: its frequency and damping over its amplitude."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.report.charts.logarithm import logarithmic
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.prefixes import prefixed
from dalembert.report.quantities import labelled
from dalembert.units import unit_of
from dalembert.vibration import Backbone

DECADES = 30
"""Ratio of the largest amplitude to the smallest above which its axis is logarithmic."""


def backbone(mode: Backbone, *, title: str | None = None) -> go.Figure:
    """Frequency and damping ratio of a nonlinear mode over its amplitude; gaps where it was not found.

    Parameters
    ----------
    mode : Backbone
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure
    """
    amplitudes = np.asarray(mode.amplitudes)
    factor, unit = prefixed(float(amplitudes.max()), unit_of(mode.dof))
    figure = make_subplots(rows=2, shared_xaxes=True, vertical_spacing=0.06)
    for row, name, values, colour in (
        (1, "frequency", np.asarray(mode.frequencies), LIGHT.series[0]),
        (2, "damping ratio", 100 * np.asarray(mode.damping), LIGHT.series[1]),
    ):
        figure.add_scatter(
            x=factor * amplitudes,
            y=np.where(mode.converged, values, np.nan),
            name=name,
            mode="lines+markers" if len(amplitudes) <= 60 else "lines",
            line={"color": colour, "width": 2},
            marker={"size": 5},
            row=row,
            col=1,
        )
    themed(figure, title or f"Mode {mode.mode} over its amplitude", height=480)
    figure.update_yaxes(title_text="frequency (Hz)", row=1)
    figure.update_yaxes(title_text="damping ratio (%)", rangemode="tozero", row=2)
    if amplitudes.max() > DECADES * amplitudes.min():
        figure.update_xaxes(**logarithmic(figure, "x"))
    figure.update_xaxes(title_text=labelled(f"amplitude of {plain(mode.dof)}, first harmonic", unit), row=2)
    return figure.update_layout(showlegend=False)


def backbone_line(mode: Backbone, dof: str, kind: str, factor: float) -> go.Scatter:
    """The line through the peaks of forced responses: amplitude of a degree of freedom over the mode's frequency."""
    return go.Scatter(
        x=mode.frequencies,
        y=factor * np.where(mode.converged, mode.amplitude(dof, kind), np.nan),
        name=f"{plain(dof)}, mode {mode.mode} without force",
        mode="lines",
        line={"color": LIGHT.ink, "width": 1.5, "dash": "dot"},
        hovertemplate="%{x:.6g} Hz, %{y:.5g}",
    )
