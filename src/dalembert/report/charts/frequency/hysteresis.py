"""Force over displacement of contacts and springs at one point of a curve."""

from collections.abc import Mapping, Sequence

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw
from dalembert.report.focus import foremost, of_contacts
from dalembert.report.look import plain, themed
from dalembert.report.prefixes import prefixed
from dalembert.report.quantities import labelled
from dalembert.vibration import FrequencyCurve

NOTHING = 1e-9
"""Energy, as part of the most that a coordinate takes, below which its loop is closed."""


def hysteresis(
    curve: FrequencyCurve,
    point: int,
    coordinates: Sequence[str] | None = None,
    *,
    title: str = "Hysteresis loops",
) -> go.Figure:
    """Force over relative displacement during a period, one loop a coordinate; its area is the energy of a period.

    Parameters
    ----------
    curve : FrequencyCurve
    point : int
        Number of the point.
    coordinates : sequence of str, optional
        Coordinates of elements, such as ``"foot.x"``; those of the contacts that take most energy if not given.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        For a coordinate that the curve does not have.
    """
    chosen = rubbing(curve, point) if coordinates is None else tuple(coordinates)
    return draw_loops({name: curve.loop(name, point) for name in chosen}, title)


def draw_loops(loops: Mapping[str, tuple[np.ndarray, np.ndarray]], title: str) -> go.Figure:
    """Forces over displacements, by the names of their coordinates."""
    (along, length), (up, force) = (
        prefixed(max((float(np.abs(loop[axis]).max()) for loop in loops.values()), default=0.0), unit)
        for axis, unit in enumerate(("m", "N"))
    )
    figure = go.Figure()
    for place, (name, (u, f)) in enumerate(loops.items()):
        draw(figure, along * u, up * f, plain(name), colour_of(place))
    x = labelled("relative displacement", length)
    return themed(figure, title, 400, x=x, y=labelled("force", force), showlegend=True)


def rubbing(curve: FrequencyCurve, point: int) -> tuple[str, ...]:
    """The coordinates of contacts that take most energy at a point; the first tangential ones where none takes any."""
    sizes = {name: float(curve.dissipated(name)[point]) for own in of_contacts(curve).values() for name in own}
    most = max(sizes.values(), default=0.0)
    moving = {name: size for name, size in sizes.items() if size > NOTHING * most}
    return foremost(moving or {own[0]: 0.0 for own in of_contacts(curve).values()})
