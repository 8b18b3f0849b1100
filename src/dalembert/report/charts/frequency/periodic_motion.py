"""One period of a motion in time."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw
from dalembert.report.charts.frequency.contacts import PHASE
from dalembert.report.charts.frequency.hysteresis import draw_loops
from dalembert.report.focus import foremost
from dalembert.report.look import plain, themed
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
