"""Responses over frequency for several values of a parameter, and their peaks."""

from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.quantities import size_label
from dalembert.report.charts.drawing import HOVER, draw, logarithmic, positive, stacked
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.thinning import thinned
from dalembert.tables import labelled, prefixed, shown
from dalembert.units import unit_of
from dalembert.vibration import CurveFamily, ResonanceTrack

WIDE = 300
"""Ratio of the largest amplitude to the smallest above which the axis is logarithmic."""


def curve_family(family: CurveFamily, dof: str, *, kind: str = "peak", title: str | None = None) -> go.Figure:
    """Amplitude over frequency for each value of the parameter, and the envelope of all.

    Of more values than there are colours, those in colour are the first, the last and the one with the smallest peak.

    Parameters
    ----------
    family : CurveFamily
    dof : str
        A degree of freedom.
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
    best, envelope = family.best(dof, kind), family.envelope(dof, kind)
    factor, unit = prefixed(float(np.nanmax(envelope.largest, initial=0.0)), unit_of(dof))
    figure = go.Figure()
    places = [place for place, curve in enumerate(family.curves) if curve is not None]
    coloured = _coloured(family, places, best)
    for place in sorted(places, key=lambda place: place in coloured):
        curve, value = family.curves[place], float(family.values[place])
        assert curve is not None
        size = np.where(curve.converged, factor * curve.amplitude(dof, kind), np.nan)
        name = value_text(family, value) + (", smallest peak" if value == best else "")
        colour, width = coloured.get(place, LIGHT.muted), 3 if value == best else 1.5
        style = {"opacity": 1 if place in coloured else 0.5, "showlegend": place in coloured, "hovertemplate": HOVER}
        draw(figure, *thinned(curve.frequencies, size), name, colour, width, **style)
    for word, size, dash in (("smallest", envelope.smallest, "dot"), ("largest", envelope.largest, "dash")):
        draw(figure, envelope.frequencies, factor * size, f"{word} of all", LIGHT.ink, 1.2, line_dash=dash)
    wide = np.nanmax(envelope.largest) > WIDE * np.nanmin(positive(envelope.smallest))
    axis: dict[str, Any] = logarithmic(figure) if wide else {"rangemode": "tozero"}
    y = {"title": labelled(size_label(kind), unit), **axis}
    title = title or f"{plain(dof)} over {plain(family.parameter)}"
    return themed(figure, title, 480, x="frequency (Hz)", y=y, showlegend=True)


def _coloured(family: CurveFamily, places: list[int], best: float) -> dict[int, str]:
    """Places of the curves in colour, and their colours."""
    if len(places) <= len(LIGHT.series):
        return dict(zip(places, LIGHT.series, strict=False))
    lowest = next(place for place in places if family.values[place] == best)
    return dict(zip(dict.fromkeys([places[0], places[-1], lowest]), LIGHT.series, strict=False))


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
