"""Responses over frequency for several values of a parameter, and their envelope."""

from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import HOVER, draw, logarithmic, positive
from dalembert.report.charts.frequency.resonance_peaks import value_text
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.prefixes import prefixed
from dalembert.report.quantities import labelled, size_label
from dalembert.report.thin import thinned
from dalembert.units import unit_of
from dalembert.vibration import CurveFamily

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
    found = [place for place, curve in enumerate(family.curves) if curve is not None]
    coloured = _coloured(family, found, best)
    for place in sorted(found, key=lambda place: place in coloured):
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


def _coloured(family: CurveFamily, found: list[int], best: float) -> dict[int, str]:
    """Places of the curves in colour, and their colours."""
    if len(found) <= len(LIGHT.series):
        return dict(zip(found, LIGHT.series, strict=False))
    lowest = next(place for place in found if family.values[place] == best)
    return dict(zip(dict.fromkeys([found[0], found[-1], lowest]), LIGHT.series, strict=False))
