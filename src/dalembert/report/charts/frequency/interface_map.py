"""Contact states over an interface, where the contacts are."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.frequency.contacts import COLOURS
from dalembert.report.charts.frequency.film_controls import controls
from dalembert.report.look import LIGHT, plain, themed
from dalembert.report.player.playback import slowness
from dalembert.report.scene.scene import Film
from dalembert.report.scene.shape import SECONDS
from dalembert.report.scene.structure import edges
from dalembert.tables import prefixed
from dalembert.vibration import Deformation
from dalembert.vibration.laws.friction_law import STATES
from dalembert.vibration.paths.focus import state_shares

FRAMES = 32
SMALLEST, LARGEST = 9, 22
"""Diameters of contacts, by the energy that they take; half as large where there are many."""
MANY = 16


def interface_map(shape: Deformation, *, title: str | None = None) -> go.Figure:
    """Contacts from above: filled by their state at a phase of the period, ringed by the one they are in for longest.

    Larger ones take more energy from the motion.

    Parameters
    ----------
    shape : Deformation
        With contacts.
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure
    """
    wide = np.sort(np.argsort(-np.ptp(np.concatenate([shape.places, shape.contact_places]), axis=0), kind="stable")[:2])
    parts = state_shares(shape.states)
    longest = np.argmax([parts[state] for state in STATES], axis=0)
    energies = np.clip(np.asarray(shape.energies), 0.0, None)
    most = float(energies.max(initial=0.0))
    sizes = SMALLEST + (LARGEST - SMALLEST) * np.sqrt(energies / most if most > 0 else energies)
    sizes = sizes if len(sizes) <= MANY else sizes / 2
    factor, unit = prefixed(most, "J")
    phases = np.arange(FRAMES) * np.asarray(shape.states).shape[1] // FRAMES
    colours = np.array([COLOURS[state] for state in STATES])
    rings = np.array([LIGHT.muted, *colours[1:]])
    x, y = shape.contact_places[:, wide].T
    text = [
        f"{plain(name)}: stuck {100 * parts['stuck'][k]:.0f} %, slipping {100 * parts['slipping'][k]:.0f} %, separated "
        f"{100 * parts['separated'][k]:.0f} %, {factor * energies[k]:.3g} {unit}"
        for k, name in enumerate(shape.contacts)
    ]
    figure = go.Figure([outline(shape.places, shape.faces, wide), *_legend()])
    ring = {"width": 3 if len(sizes) <= MANY else 1.5, "color": rings[longest]}
    marker = {"size": sizes, "color": colours[shape.states[:, 0]], "line": ring, "opacity": 1}
    hover = {"text": text, "hovertemplate": "%{text}<extra></extra>"}
    figure.add_scatter(x=x, y=y, mode="markers", marker=marker, showlegend=False, **hover)
    last = len(STATES) + 1
    filled = [{"type": "scatter", "marker": {"color": colours[shape.states[:, phase]]}} for phase in phases]
    figure.frames = [go.Frame(name=str(number), traces=[last], data=[trace]) for number, trace in enumerate(filled)]
    points = np.concatenate([shape.places[:, wide], shape.contact_places[:, wide]])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.06 * float((high - low).max())
    across, up = (
        {"title": f"{'xyz'[axis]} (m)", "range": [low[place] - margin, high[place] + margin]}
        for place, axis in enumerate(wide)
    )
    across["constrain"] = "domain"
    up |= {"scaleanchor": "x", "scaleratio": 1}
    labels = [f"{360 * number / FRAMES:.0f}" for number in range(FRAMES)]
    film = Film(labels, SECONDS, "phase", "°", slowness(SECONDS * shape.frequency), endless=True)
    title = title or "Contact states over the interface"
    return themed(figure, title, 480, x=across, y=up, showlegend=True, **controls(film))


def outline(places: np.ndarray, faces: np.ndarray, wide: np.ndarray) -> go.Scatter:
    """The edges of a structure at rest, from above: along two of its axes, ``wide``."""
    ends = edges(places, faces)
    lines = np.full((len(ends), 3, 2), np.nan, dtype=np.float32)
    lines[:, :2] = places[ends][:, :, wide]
    x, y = lines.reshape(-1, 2).T
    line = {"color": LIGHT.grid, "width": 1.5}
    return go.Scatter(x=x, y=y, mode="lines", line=line, hoverinfo="skip", showlegend=False)


def _legend() -> list[go.Scatter]:
    """An entry for each state."""
    return [
        go.Scatter(x=[None], y=[None], name=state, mode="markers", marker={"size": 10, "color": COLOURS[state]})
        for state in STATES
    ]
