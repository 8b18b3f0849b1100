"""One period of a motion in time."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.focus import foremost
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.prefixes import prefixed
from dalembert.report.quantities import labelled
from dalembert.units import unit_of
from dalembert.vibration import PeriodicMotion


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
    lines = {plain(dof): motion.displacements[:, column] for dof, column in zip(chosen, columns, strict=True)}
    figure = _lines(360 * motion.frequency * motion.times, {name: factor * y for name, y in lines.items()})
    themed(figure, title, height=400)
    figure.update_xaxes(title="phase of the period (°)", dtick=90, range=[0, 360])
    return figure.update_yaxes(title=labelled("displacement", unit)).update_layout(showlegend=True)


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
    along, length = prefixed(float(np.abs(u[:, columns]).max()), "m")
    up, force = prefixed(float(np.abs(f[:, columns]).max()), "N")
    figure = go.Figure()
    for place, (name, column) in enumerate(zip(chosen, columns, strict=True)):
        line = {"color": LIGHT.series[place % len(LIGHT.series)], "width": 2}
        figure.add_scatter(x=along * u[:, column], y=up * f[:, column], name=plain(name), mode="lines", line=line)
    themed(figure, title, height=400)
    figure.update_xaxes(title=labelled("relative displacement", length))
    return figure.update_yaxes(title=labelled("force", force)).update_layout(showlegend=True)


def _lines(x: np.ndarray, series: dict[str, np.ndarray]) -> go.Figure:
    figure = go.Figure()
    for place, (name, y) in enumerate(series.items()):
        line = {"color": LIGHT.series[place % len(LIGHT.series)], "width": 2}
        figure.add_scatter(x=x, y=y, name=name, mode="lines", line=line)
    return figure
