"""A response over frequency: its curve, its harmonics, and the points that were found."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from scipy.ndimage import binary_dilation

from dalembert.quantities import size_label
from dalembert.report.charts.drawing import HOVER, colour_of, draw, logarithmic, positive, stacked
from dalembert.report.charts.frequency.backbone import backbone_line
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.thinning import thinned
from dalembert.tables import labelled, prefixed
from dalembert.units import unit_of
from dalembert.vibration import Backbone, FrequencyCurve
from dalembert.vibration.paths.focus import by_order, marked, movers, unstable

SYMBOLS = {"fold": "diamond", "torus": "circle-open", "period doubling": "square-open", "branch point": "star"}
WIDE = 300
"""Ratio of the largest amplitude to the smallest above which the axis is logarithmic."""
FEW = 60
"""Points up to which each is marked."""


def frequency_curve(
    curve: FrequencyCurve,
    dofs: Sequence[str] | None = None,
    *,
    kind: str = "peak",
    mode: Backbone | None = None,
    branches: Mapping[str, FrequencyCurve] | None = None,
    title: str = "Forced response",
) -> go.Figure:
    """Amplitude over frequency along the path; dashed where it is unstable, with folds and points that were not found.

    Parameters
    ----------
    curve : FrequencyCurve
    dofs : sequence of str, optional
        Degrees of freedom to draw; those that move most if not given.
    kind : str
        ``"peak"``, ``"rms"``, or ``"harmonic 1"`` and so on.
    mode : Backbone, optional
        A nonlinear mode, drawn as the line through the peaks of the degree of freedom that moves most.
    branches : mapping of str to FrequencyCurve, optional
        Other branches by their names, of the degree of freedom that moves most.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a degree of freedom that was not observed, or another kind.
    """
    chosen = tuple(dofs or movers(curve))
    sizes = {dof: curve.amplitude(dof, kind) for dof in chosen}
    factor, unit = scale(sizes)
    figure = go.Figure()
    for place, (dof, size) in enumerate(sizes.items()):
        _path(figure, curve, dof, factor * size, colour_of(place))
    most = max(sizes, key=lambda dof: float(np.nanmax(sizes[dof], initial=0.0)))
    for place, (name, branch) in enumerate((branches or {}).items(), len(sizes)):
        # Behind a period doubling, the harmonics of the force are every second one of the branch.
        periods = [each.provenance["method"].get("periods", 1) for each in (branch, curve)]
        order = kind.removeprefix("harmonic ")
        same = f"harmonic {int(order) * periods[0] // periods[1]}" if order != kind else kind
        _path(figure, branch, name, factor * branch.amplitude(most, same), colour_of(place))
    for event, points in marked(curve).items():
        x = np.tile(curve.frequencies[points], len(sizes))
        y = np.concatenate([factor * size[points] for size in sizes.values()])
        marker = {"symbol": SYMBOLS.get(event, "x"), "size": 9, "color": LIGHT.ink}
        figure.add_scatter(x=x, y=y, name=event, mode="markers", marker=marker)
    _lost(figure, curve, {dof: factor * size for dof, size in sizes.items()})
    if mode is not None:
        figure.add_trace(backbone_line(mode, most, kind, factor))
    y = {"title": labelled(size_label(kind), unit), **_axis(figure)}
    return themed(figure, title, 440, x="frequency (Hz)", y=y, showlegend=True)


def scale(sizes: Mapping[str, np.ndarray]) -> tuple[float, str]:
    """Factor and unit for amplitudes by degree of freedom; no unit where they have several."""
    units = {unit_of(dof) for dof in sizes}
    most = max((float(np.nanmax(size, initial=0.0)) for size in sizes.values()), default=0.0)
    return prefixed(most, units.pop()) if len(units) == 1 else (1.0, "")


def _path(figure: go.Figure, curve: FrequencyCurve, dof: str, size: np.ndarray, colour: str) -> None:
    """One degree of freedom: solid, and dashed where it is unstable; the two meet."""
    bad = unstable(curve)
    touched = binary_dilation(bad)  # and the neighbours
    amplitudes = np.where(curve.converged, size, np.nan)
    few = "lines+markers" if len(size) <= FEW else "lines"
    style = {"legendgroup": plain(dof), "mode": few, "marker_size": 4, "hovertemplate": HOVER}
    for suffix, here, dash in (("", ~bad, None), (", unstable", touched, "dash")):
        if here.any():
            x, y = thinned(curve.frequencies, np.where(here, amplitudes, np.nan))
            draw(figure, x, y, f"{plain(dof)}{suffix}", colour, line_dash=dash, **style)


def _lost(figure: go.Figure, curve: FrequencyCurve, sizes: Mapping[str, np.ndarray]) -> None:
    """Crosses where points were not found, on the straight line between their neighbours."""
    converged, points = np.flatnonzero(curve.converged), np.flatnonzero(~curve.converged)
    if not len(points) or not len(converged):
        return
    x = np.tile(curve.frequencies[points], len(sizes))
    y = np.concatenate([np.interp(points, converged, size[converged]) for size in sizes.values()])
    marker = {"symbol": "x-thin", "size": 8, "line": {"width": 2, "color": LIGHT.series[1]}}
    figure.add_scatter(x=x, y=y, name="not found", mode="markers", marker=marker, hovertemplate="%{x:.6g} Hz")


def _axis(figure: go.Figure) -> dict:
    """Linear from zero, or logarithmic where a curve spans a wide range."""
    traces: Any = figure.data
    values = positive(np.concatenate([np.asarray(trace.y, dtype=float) for trace in traces]))
    if np.any(np.isfinite(values)) and np.nanmax(values) > WIDE * np.nanmin(values):
        return logarithmic(figure)
    return {"rangemode": "tozero"}


NOTHING = 1e-6
"""Size of a harmonic, as part of the largest, below which it is left out."""


def harmonic_content(curve: FrequencyCurve, dof: str, *, title: str | None = None) -> go.Figure:
    """Amplitude of each harmonic of a degree of freedom over frequency, on a logarithmic scale.

    Harmonics that never reach a millionth of the largest are left out.

    Parameters
    ----------
    curve : FrequencyCurve
    dof : str
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a degree of freedom that was not observed.
    """
    sizes = {order: np.where(curve.converged, size, np.nan) for order, size in by_order(curve, dof).items()}
    most = max(float(np.nanmax(size, initial=0.0)) for size in sizes.values())
    factor, unit = prefixed(most, unit_of(dof))
    figure = go.Figure()
    for place, (order, size) in enumerate(sizes.items()):
        if not np.nanmax(size, initial=0.0) > NOTHING * most:
            continue
        y = factor * np.where(size > NOTHING * most, positive(size), np.nan)
        name, width = "mean" if order == 0 else f"harmonic {order}", 2 if order == 1 else 1.5
        dash = ("solid", "dash", "dot")[min(place // len(LIGHT.series), 2)]
        draw(figure, curve.frequencies, y, name, colour_of(place), width, line_dash=dash)
    y = {"title": labelled("amplitude", unit), **logarithmic(figure)}
    return themed(figure, title or f"Harmonics of {plain(dof)}", 400, x="frequency (Hz)", y=y, showlegend=True)


def load_factors(curve: FrequencyCurve, *, title: str = "Factor of the forces") -> go.Figure:
    """Factor of the varying forces that holds an amplitude, over frequency.

    Parameters
    ----------
    curve : FrequencyCurve
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = go.Figure()
    line = {"color": LIGHT.series[0]}
    figure.add_scatter(x=curve.frequencies, y=curve.load_factors, mode="lines", line=line, name="factor")
    return themed(figure, title, 320, x="frequency (Hz)", y={"title": "factor", "rangemode": "tozero"})


def points_found(curve: FrequencyCurve, *, title: str = "How the points were found") -> go.Figure:
    """Newton iterations of each point; below, what is left unbalanced and what twice as many samples would change.

    Parameters
    ----------
    curve : FrequencyCurve
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = stacked(1, 1)
    for row, name, values, colour in (
        (1, "Newton iterations", curve.iterations, LIGHT.ink),
        (2, "left unbalanced", positive(np.asarray(curve.residuals, dtype=float)), LIGHT.series[0]),
        (2, "change with twice the samples", positive(np.asarray(curve.sampling_errors, dtype=float)), LIGHT.series[1]),
    ):
        marker = {"color": colour, "size": 4}
        figure.add_scatter(x=curve.frequencies, y=values, name=name, mode="markers", marker=marker, row=row, col=1)
    y = ({"title": "iterations", "rangemode": "tozero"}, {"title": "part of the forces", "type": "log"})
    return themed(figure, title, 480, x="frequency (Hz)", y=y, showlegend=True)
