"""What contacts do: their states, their energy, and their hysteresis loops."""

from collections.abc import Mapping, Sequence

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.drawing import colour_of, draw
from dalembert.report.look import LIGHT, plain, themed
from dalembert.tables import labelled, prefixed
from dalembert.vibration import FrequencyCurve
from dalembert.vibration.laws.friction_law import STATES
from dalembert.vibration.paths.focus import dissipation_of, foremost, of_contacts

COLOURS = {"separated": LIGHT.grid, "stuck": LIGHT.series[0], "slipping": LIGHT.series[1]}
PHASE = {"title": "phase of the period (°)", "dtick": 90, "range": [0, 360]}
NAMED = 40
"""Contacts up to which each has its name beside its row."""


def contact_states(curve: FrequencyCurve, point: int, *, title: str = "Contact states over a period") -> go.Figure:
    """State of each contact, a row, over the phase of a period at one point of a curve.

    Parameters
    ----------
    curve : FrequencyCurve
    point : int
        Number of the point.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    states = np.asarray(curve.states[point])
    steps = [
        [place, COLOURS[state]] for k, state in enumerate(STATES) for place in (k / len(STATES), (k + 1) / len(STATES))
    ]
    figure = go.Figure(
        go.Heatmap(
            z=states,
            x=(np.arange(states.shape[1]) + 0.5) * 360 / states.shape[1],
            y=[plain(name) for name in curve.contacts],
            zmin=-0.5,
            zmax=len(STATES) - 0.5,
            colorscale=steps,
            ygap=2 if len(states) <= NAMED else 0,
            showscale=False,
            text=[[STATES[state] for state in row] for row in states],
            hovertemplate="%{y}, %{x:.0f}°: %{text}<extra></extra>",
        )
    )
    for state in STATES:
        marker = {"symbol": "square", "size": 11, "color": COLOURS[state]}
        figure.add_scatter(x=[None], y=[None], name=state, mode="markers", marker=marker)
    y = {"showgrid": False, "ticks": "", "autorange": "reversed", "showticklabels": len(states) <= NAMED}
    height = min(220 + 22 * len(states), 720)
    return themed(figure, title, height, x={**PHASE, "showgrid": False}, y={**y, "automargin": True}, showlegend=True)


def contact_shares(curve: FrequencyCurve, *, title: str = "Contact states over frequency") -> go.Figure:
    """Draw the share of the period in which contacts are stuck, slipping and separated, over frequency.

    The share is the mean over all contacts. A contact without friction is either stuck or separated. Points that are
    not converged are left out.

    Parameters
    ----------
    curve : FrequencyCurve
        With at least one contact.
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    figure = go.Figure()
    for number, state in enumerate(STATES):
        share = np.mean(np.asarray(curve.states) == number, axis=(1, 2))
        if not share.any():
            continue
        colour = LIGHT.muted if state == "separated" else COLOURS[state]
        draw(figure, curve.frequencies, np.where(curve.converged, 100 * share, np.nan), state, colour)
    y = {"title": "part of the period (%)", "range": [-2, 102]}
    return themed(figure, title, 360, x="frequency (Hz)", y=y, showlegend=True)


def dissipation(curve: FrequencyCurve, *, title: str = "Friction energy of a period") -> go.Figure:
    """Energy dissipated in a period by each contact, of many those that take most, and by all together.

    Parameters
    ----------
    curve : FrequencyCurve
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    energies, figure = dissipation_of(curve), go.Figure()
    total = np.sum(list(energies.values()), axis=0)
    factor, unit = prefixed(float(np.nanmax(total, initial=0.0)), "J")
    kept = foremost({name: float(np.nanmax(energy, initial=0.0)) for name, energy in energies.items()})
    for name, colour in zip(kept, LIGHT.series, strict=False):
        draw(figure, curve.frequencies, factor * energies[name], plain(name), colour)
    if len(energies) > 1:
        draw(figure, curve.frequencies, factor * total, f"all {len(energies)} contacts", LIGHT.ink)
    y = {"title": labelled("energy of a period", unit), "rangemode": "tozero"}
    return themed(figure, title, 360, x="frequency (Hz)", y=y, showlegend=True)


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
    sizes = {name: float(curve.dissipated(name)[point]) for names in of_contacts(curve).values() for name in names}
    most = max(sizes.values(), default=0.0)
    moving = {name: size for name, size in sizes.items() if size > NOTHING * most}
    return foremost(moving or {names[0]: 0.0 for names in of_contacts(curve).values()})
