"""A nonlinear mode: its frequency and damping over its amplitude."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import HOVER, draw, logarithmic, stacked
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import labelled, prefixed
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
    figure = stacked(1, 1)
    mode_of_lines = "lines+markers" if len(amplitudes) <= 60 else "lines"
    for row, name, values, colour in (
        (1, "frequency", np.asarray(mode.frequencies), LIGHT.series[0]),
        (2, "damping ratio", 100 * np.asarray(mode.damping), LIGHT.series[1]),
    ):
        y = np.where(mode.converged, values, np.nan)
        draw(figure, factor * amplitudes, y, name, colour, row=row, mode=mode_of_lines, marker_size=5)
    if amplitudes.max() > DECADES * amplitudes.min():
        figure.update_xaxes(**logarithmic(figure, "x"))
    x = labelled(f"amplitude of {plain(mode.dof)}, first harmonic", unit)
    y = ("frequency (Hz)", {"title": "damping ratio (%)", "rangemode": "tozero"})
    return themed(figure, title or f"Mode {mode.mode} over its amplitude", 480, x=x, y=y, showlegend=False)


def backbone_line(mode: Backbone, dof: str, kind: str, factor: float) -> go.Scatter:
    """The line through the peaks of forced responses: amplitude of a degree of freedom over the mode's frequency."""
    return go.Scatter(
        x=mode.frequencies,
        y=factor * np.where(mode.converged, mode.amplitude(dof, kind), np.nan),
        name=f"{plain(dof)}, mode {mode.mode} without force",
        mode="lines",
        line={"color": LIGHT.ink, "width": 1.5, "dash": "dot"},
        hovertemplate=HOVER,
    )
