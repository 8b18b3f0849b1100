"""Height and frequency of a resonance peak over a parameter."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import draw, stacked
from dalembert.report.digits import shown
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.prefixes import prefixed
from dalembert.report.quantities import labelled, size_label
from dalembert.units import unit_of
from dalembert.vibration import CurveFamily, ResonanceTrack

DECADES = 100
"""Ratio of the largest value to the smallest above which the axis of the parameter is logarithmic."""


def family_peaks(family: CurveFamily, dof: str, *, kind: str = "peak", title: str | None = None) -> go.Figure:
    """Height of the resonance peak over the parameter, the smallest marked; below, its frequency.

    Parameters
    ----------
    family : CurveFamily
    dof : str
    kind : str
        ``"peak"``, ``"rms"``, or ``"harmonic 1"`` and so on.
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a degree of freedom that was not observed, another kind, or a family without curves.
    """
    peaks, order = family.peaks(dof, kind), np.argsort(family.values, kind="stable")
    heights, frequencies = (
        np.array([getattr(peak, name) for peak in peaks], dtype=float)[order] for name in ("amplitude", "frequency")
    )
    return _drawn(family, np.asarray(family.values)[order], heights, frequencies, dof, kind, title)


def resonance_track(track: ResonanceTrack, *, title: str | None = None) -> go.Figure:
    """Height of a resonance peak over the parameter, the smallest marked; below, its frequency; gaps where it was lost.

    Parameters
    ----------
    track : ResonanceTrack
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure
    """
    values, heights, frequencies = (np.asarray(array) for array in (track.values, track.amplitudes, track.frequencies))
    return _drawn(track, values, heights, frequencies, track.dof, track.kind, title)


def value_text(over: CurveFamily | ResonanceTrack, value: float) -> str:
    """A value of the parameter with its unit."""
    return f"{shown(float(value))} {plain(over.unit)}".rstrip()


def _drawn(
    over: CurveFamily | ResonanceTrack,
    values: np.ndarray,
    heights: np.ndarray,
    frequencies: np.ndarray,
    dof: str,
    kind: str,
    title: str | None,
) -> go.Figure:
    factor, unit = prefixed(float(np.nanmax(heights, initial=0.0)), unit_of(dof))
    figure, style = stacked(0.62, 0.38), {"mode": "lines+markers", "marker_size": 6}
    draw(figure, values, factor * heights, "peak", LIGHT.series[0], row=1, **style)
    draw(figure, values, frequencies, "its frequency", LIGHT.series[2], row=2, **style)
    if np.isfinite(heights).any():
        lowest = int(np.nanargmin(heights))
        x, y, name = values[[lowest]], factor * heights[[lowest]], f"smallest, at {value_text(over, values[lowest])}"
        marker = {"color": LIGHT.series[1], "size": 13, "symbol": "circle-open", "line": {"width": 3}}
        figure.add_scatter(x=x, y=y, name=name, mode="markers", marker=marker, row=1, col=1)
    by = "" if kind == "peak" else f", by its {size_label(kind)}"
    if values.min() > 0 and values.max() > DECADES * values.min():
        figure.update_xaxes(type="log", dtick=1)
    y = ({"title": labelled("peak", unit), "rangemode": "tozero"}, "frequency (Hz)")
    title = title or f"Peak of {plain(dof)} over {plain(over.parameter)}{by}"
    return themed(figure, title, 460, x=labelled(plain(over.parameter), plain(over.unit)), y=y, showlegend=True)
