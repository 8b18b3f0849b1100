"""Periodic motions by integration in time."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.quantities import size_label
from dalembert.report.charts.drawing import HOVER, colour_of, draw
from dalembert.report.charts.frequency.contacts import PHASE, draw_loops
from dalembert.report.look import plain, themed
from dalembert.tables import labelled, prefixed
from dalembert.units import unit_of
from dalembert.vibration import FrequencyCurve, PeriodicMotion, TimeComparison
from dalembert.vibration.paths.focus import foremost


def periodic_motion(motion: PeriodicMotion, *, title: str = "A period in time") -> go.Figure:
    """Displacements of the degrees of freedom that move most over the phase of the period.

    Parameters
    ----------
    motion : PeriodicMotion
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    sizes = dict(zip(motion.dofs, np.ptp(motion.displacements, axis=0).tolist(), strict=True))
    unit = unit_of(motion.dofs[0])
    chosen = foremost({dof: size for dof, size in sizes.items() if unit_of(dof) == unit})
    columns = [motion.dofs.index(dof) for dof in chosen]
    factor, unit = prefixed(float(np.abs(motion.displacements[:, columns]).max()), unit)
    figure, phases = go.Figure(), 360 * motion.frequency * motion.times
    for place, (dof, column) in enumerate(zip(chosen, columns, strict=True)):
        draw(figure, phases, factor * motion.displacements[:, column], plain(dof), colour_of(place))
    return themed(figure, title, 400, x=PHASE, y=labelled("displacement", unit), showlegend=True)


def loops_in_time(motion: PeriodicMotion, *, title: str = "Hysteresis loops in time") -> go.Figure:
    """Force over relative displacement of the contacts and springs that take most energy in the period.

    Parameters
    ----------
    motion : PeriodicMotion
        With contacts or springs.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    u, f = (np.concatenate([array, array[:1]]) for array in (motion.relative, motion.forces))
    work = np.abs(np.sum((f[1:] + f[:-1]) / 2 * np.diff(u, axis=0), axis=0))
    chosen = foremost(dict(zip(motion.coordinates, work.tolist(), strict=True)))
    columns = [motion.coordinates.index(name) for name in chosen]
    return draw_loops({name: (u[:, k], f[:, k]) for name, k in zip(chosen, columns, strict=True)}, title)


def time_comparison(
    comparison: TimeComparison,
    curve: FrequencyCurve | None = None,
    dofs: Sequence[str] | None = None,
    *,
    title: str = "Comparison with time integration",
) -> go.Figure:
    """Amplitudes in time as crosses, by harmonic balance as circles, on the curve if it is given.

    Parameters
    ----------
    comparison : TimeComparison
    curve : FrequencyCurve, optional
    dofs : sequence of str, optional
        Degrees of freedom to draw; those that move most if not given.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    chosen = comparison.movers() if not dofs else tuple(dofs)
    columns = [comparison.dofs.index(dof) for dof in chosen]
    most = float(np.nanmax(comparison.time[:, columns], initial=0.0))
    if curve is not None:
        most = max(most, *(float(np.nanmax(curve.amplitude(dof, comparison.kind), initial=0.0)) for dof in chosen))
    units = {unit_of(dof) for dof in chosen}
    factor, unit = prefixed(most, units.pop()) if len(units) == 1 else (1.0, "")
    figure = go.Figure()
    for place, (dof, column) in enumerate(zip(chosen, columns, strict=True)):
        name, colour = plain(dof), colour_of(place)
        shared: dict[str, Any] = {"legendgroup": name, "hovertemplate": HOVER}
        if curve is not None:
            size = factor * np.where(curve.converged, curve.amplitude(dof, comparison.kind), np.nan)
            draw(figure, curve.frequencies, size, name, colour, **shared)
        for word, values, symbol in (
            ("harmonic balance", comparison.balance, "circle-open"),
            ("in time", comparison.time, "x-thin"),
        ):
            marker = {"symbol": symbol, "size": 9, "color": colour, "line": {"width": 2, "color": colour}}
            style = {"name": f"{name}, {word}", "mode": "markers", "marker": marker, **shared}
            figure.add_scatter(x=comparison.frequencies, y=factor * values[:, column], **style)
    y = {"title": labelled(size_label(comparison.kind), unit), "rangemode": "tozero"}
    return themed(figure, title, 440, x="frequency (Hz)", y=y, showlegend=True)
