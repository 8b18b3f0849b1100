"""Responses over frequency for several values of a parameter, their envelope, and their peaks over the parameter."""

from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from dalembert.report.charts.logarithm import logarithmic, positive
from dalembert.report.digits import shown
from dalembert.report.focus import size_label, unit_of
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.needs_frequency import CurveFamilyLike
from dalembert.report.prefixes import prefixed
from dalembert.report.quantities import labelled
from dalembert.report.thin import thin

WIDE = 300
"""Ratio of the largest amplitude to the smallest above which the axis is logarithmic."""
DECADES = 100
"""Ratio of the largest value to the smallest above which the axis of the parameter is logarithmic."""


def curve_family(family: CurveFamilyLike, dof: str, *, kind: str = "peak", title: str | None = None) -> go.Figure:
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
    found = [place for place, curve in enumerate(family.curves) if curve is not None]
    coloured = _coloured(family, found, best)
    for place in sorted(found, key=lambda place: place in coloured):
        curve, value = family.curves[place], float(family.values[place])
        assert curve is not None
        size = np.where(curve.converged, factor * curve.amplitude(dof, kind), np.nan)
        kept = thin(size)
        figure.add_scatter(
            x=curve.frequencies[kept],
            y=size[kept],
            name=value_text(family, value) + (", smallest peak" if value == best else ""),
            mode="lines",
            line={"color": coloured.get(place, LIGHT.muted), "width": 3 if value == best else 1.5},
            opacity=1 if place in coloured else 0.5,
            showlegend=place in coloured,
            hovertemplate="%{x:.6g} Hz, %{y:.5g}",
        )
    for name, size in (("smallest of all", envelope.smallest), ("largest of all", envelope.largest)):
        figure.add_scatter(
            x=envelope.frequencies,
            y=factor * size,
            name=name,
            mode="lines",
            line={"color": LIGHT.ink, "width": 1.2, "dash": "dot" if name.startswith("smallest") else "dash"},
        )
    themed(figure, title or f"{plain(dof)} over {plain(family.parameter)}", height=480)
    figure.update_xaxes(title="frequency (Hz)")
    wide = np.nanmax(envelope.largest) > WIDE * np.nanmin(positive(envelope.smallest))
    axis: dict[str, Any] = logarithmic(figure) if wide else {"rangemode": "tozero"}
    return figure.update_yaxes(title=labelled(size_label(kind), unit), **axis).update_layout(showlegend=True)


def family_peaks(family: CurveFamilyLike, dof: str, *, kind: str = "peak", title: str | None = None) -> go.Figure:
    """Height of the resonance peak over the parameter, the smallest marked; below, its frequency.

    Parameters
    ----------
    family : CurveFamily
    dof : str
    kind : str
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a degree of freedom that was not observed, another kind, or a family without curves.
    """
    peaks, values, best = family.peaks(dof, kind), np.asarray(family.values), family.best(dof, kind)
    order = np.argsort(values, kind="stable")
    heights, frequencies = (np.array([getattr(p, name) for p in peaks]) for name in ("amplitude", "frequency"))
    factor, unit = prefixed(float(np.nanmax(heights)), unit_of(dof))
    figure = make_subplots(rows=2, shared_xaxes=True, row_heights=[0.62, 0.38], vertical_spacing=0.06)
    for row, name, y, colour in (
        (1, "peak", factor * heights, LIGHT.series[0]),
        (2, "its frequency", frequencies, LIGHT.series[2]),
    ):
        figure.add_scatter(
            x=values[order],
            y=y[order],
            name=name,
            mode="lines+markers",
            line={"color": colour, "width": 2},
            marker={"size": 6},
            row=row,
            col=1,
        )
    lowest = values == best
    figure.add_scatter(
        x=values[lowest],
        y=factor * heights[lowest],
        name=f"smallest, at {value_text(family, best)}",
        mode="markers",
        marker={"color": LIGHT.series[1], "size": 13, "symbol": "circle-open", "line": {"width": 3}},
        row=1,
        col=1,
    )
    themed(figure, title or f"Peak of {plain(dof)} over {plain(family.parameter)}", height=460)
    figure.update_yaxes(title_text=labelled(size_label(kind), unit), rangemode="tozero", row=1)
    figure.update_yaxes(title_text="frequency (Hz)", row=2)
    if values.min() > 0 and values.max() > DECADES * values.min():
        figure.update_xaxes(type="log", dtick=1)
    return figure.update_xaxes(title_text=labelled(plain(family.parameter), plain(family.unit)), row=2).update_layout(
        showlegend=True
    )


def value_text(family: CurveFamilyLike, value: float) -> str:
    """A value of the parameter with its unit."""
    return f"{shown(value)} {plain(family.unit)}".rstrip()


def _coloured(family: CurveFamilyLike, found: list[int], best: float) -> dict[int, str]:
    """Places of the curves in colour, and their colours."""
    if len(found) <= len(LIGHT.series):
        return dict(zip(found, LIGHT.series, strict=False))
    lowest = next(place for place in found if family.values[place] == best)
    return dict(zip(dict.fromkeys([found[0], found[-1], lowest]), LIGHT.series, strict=False))
