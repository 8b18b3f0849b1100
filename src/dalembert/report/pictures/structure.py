"""The picture of a structure: its mesh with forces and contacts, or its masses and springs."""

from collections.abc import Container, Iterable, Sequence
from typing import Any

import numpy as np
from scipy.sparse import issparse

from dalembert.report.charts.frequency.shapes import edges
from dalembert.report.look import LIGHT
from dalembert.report.pictures.canvas import COLOURS, INK, SIZE, Canvas, between, moved
from dalembert.report.pictures.projection import Projection
from dalembert.vibration import FrictionContact, VibrationSystem

MOST_MASSES = 12
"""Of a structure that is drawn as masses and springs."""
MOST_FACES = 1200
"""Of a mesh whose lines are drawn."""
BOX = 17.0
"""Half of a mass, in pixels."""
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def structure_picture(
    system: VibrationSystem,
    label: str,
    size: tuple[int, int] = SIZE,
    *,
    choosable: bool = False,
    channels: Sequence[str] = (),
) -> str | None:
    """Return the SVG picture of a structure; None where neither its nodes nor few masses are known.

    Each part is a group ``<g class="ROLE" data-part="NAME">``; roles are body, spring, force, contact and
    channel.

    Parameters
    ----------
    system : VibrationSystem
    label : str
        For screen readers.
    size : (int, int)
        Pixels.
    choosable : bool
        Whether the parts are buttons.
    channels : sequence of str
        Degrees of freedom or nodes that are observed; they are marked.
    """
    nodes = system.structure.nodes
    if nodes is not None and len(nodes.names):
        return _mesh(system, label, size, choosable, channels)
    masses = list(dict.fromkeys(name.rpartition(".")[0] for name in system.structure.dofs.names))
    return _chain(system, masses, label, size, choosable, channels) if len(masses) <= MOST_MASSES else None


def node_of(name: str, known: Container[str]) -> str | None:
    """Return the node of a degree of freedom, a node, or a channel such as ``"tip.x harmonic 1"``; None if not known.

    >>> node_of("tip.x harmonic 1", ["tip"]), node_of("tip", ["tip"]), node_of("end.x", ["tip"])
    ('tip', 'tip', None)
    """
    dof = name.partition(" ")[0]
    return next((node for node in (dof, dof.rpartition(".")[0]) if node in known), None)


def ends_of(element: Any, known: Container[str]) -> list[str]:
    """Return the nodes that an element acts on."""
    ends = [getattr(element, "first", None), getattr(element, "second", None), *getattr(element, "dofs", ())]
    return [node for end in ends if end is not None and (node := node_of(end, known)) is not None]


def role_of(element: Any) -> str:
    """Return the role of an element in the drawing."""
    return "contact" if isinstance(element, FrictionContact) else "spring"


def _mesh(system: VibrationSystem, label: str, size: tuple[int, int], choosable: bool, channels: Sequence[str]) -> str:
    """Faces and edges of the structure; arrows of forces; contacts and springs at their nodes; observed nodes."""
    nodes = system.structure.nodes
    assert nodes is not None
    view, places = Projection.of(3), nodes.places
    canvas = Canvas.around(view(places), size, choosable)
    pixels, faces = canvas.at(view(places)), nodes.faces
    with canvas.part("structure", "body"):
        if faces is None or not len(faces):
            for pixel in pixels:
                canvas.circle(pixel, 1.5, COLOURS[0])
        else:
            _faces(canvas, view, places, faces)
    known = set(nodes.names)
    for element in system.elements:
        ends = ends_of(element, known)
        if ends:
            at = pixels[nodes.rows(ends)]
            with canvas.part(element.name, role_of(element)):
                canvas.stroke(at, COLOURS[1], 2)
                canvas.circle(at[0], 2.5, COLOURS[1])
    for channel in channels:
        if (node := node_of(channel, known)) is not None:
            with canvas.part(channel, "channel"):
                canvas.circle(pixels[nodes.rows([node])[0]], 8, "none", COLOURS[1])
    for force in system.forces:
        node, _, axis = force.dof.rpartition(".")
        if node in known and axis in AXES:
            head = pixels[nodes.rows([node])[0]]
            along = view(np.array([AXES[axis]]))[0] * (1, -1)
            with canvas.part(force.dof, "force"):
                canvas.arrow(head - 34 * along / np.linalg.norm(along), head, COLOURS[3])
    return canvas.svg(label)


def _faces(canvas: Canvas, view: Projection, places: np.ndarray, faces: np.ndarray) -> None:
    """Faces from the farthest to the nearest, those of one brightness in one path, then the sharp edges."""
    pixels, many = canvas.at(view(places)), len(faces) > MOST_FACES
    first, second, third = (places[faces[:, corner]] for corner in range(3))
    bright = view.brightness(np.cross(second - first, third - first))
    ordered = np.argsort(view.depth(places)[faces].mean(axis=1), kind="stable")
    corners = [_one_way(pixels[face]) for face in faces]
    for run in np.split(ordered, np.flatnonzero(np.diff(bright[ordered].round(1))) + 1):
        shade = between(COLOURS[0], "#ffffff", 0.3 + 0.35 * float(bright[run[0]]))
        shapes = [corners[face].round() if many else corners[face] for face in run]
        canvas.polygons(shapes, shade, shade if many else COLOURS[0], 0.5 if many else 0.25)
    sharp = edges(places, faces)
    lines = np.full((len(sharp), 3, 2), np.nan)
    lines[:, :2] = pixels[sharp]
    canvas.stroke(lines.reshape(-1, 2), COLOURS[0], 1.2)


def _one_way(corners: np.ndarray) -> np.ndarray:
    """Corners of a face, all faces in the same sense: shapes of one path would cancel where they overlap."""
    x, y = (corners - corners.mean(axis=0)).T
    return corners if float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) >= 0 else corners[::-1]


def _chain(
    system: VibrationSystem,
    masses: list[str],
    label: str,
    size: tuple[int, int],
    choosable: bool,
    channels: Sequence[str],
) -> str:
    """Masses in a row, springs between them and to the ground, forces on them and contacts below them."""
    zoom = 1.8 if len(masses) < 3 else 1.2
    width, height = (round(pixels / zoom) for pixels in size)
    canvas = Canvas(np.zeros(2), np.ones(2), (width, height), zoom, choosable)
    pitch = min(110.0, (width - 90.0) / len(masses))
    left = width / 2 - pitch * (len(masses) - 1) / 2 + 18
    at = {name: np.array([left + pitch * place, height / 2]) for place, name in enumerate(masses)}
    box = min(BOX, 0.3 * pitch)
    for first, second in _connections(system, masses):
        with canvas.part(f"{first} – {second or 'ground'}", "spring"):
            other = None if second is None else at[second]
            _spring(canvas, at[first], other, box, pitch, first == masses[0])
    for element in system.elements:
        own = [at[name] for name in ends_of(element, masses)]
        if own:
            with canvas.part(element.name, role_of(element)):
                _element(canvas, own[:2], isinstance(element, FrictionContact), box)
    for name, centre in at.items():
        with canvas.part(name, "body"):
            wide = max(box, 3.3 * len(name) + 3)
            corners = np.array([(-wide, -box), (wide, -box), (wide, box), (-wide, box)])
            canvas.polygons([centre + corners], between(COLOURS[0], "#ffffff", 0.55), COLOURS[0], 1.5)
            canvas.text(moved(centre, 0, 4), name, LIGHT.ink)
    for channel in channels:
        if (node := node_of(channel, masses)) is not None:
            with canvas.part(channel, "channel"):
                canvas.circle(moved(at[node], 0, -box), 5, "none", COLOURS[1])
    for dof in dict.fromkeys(force.dof for force in system.forces):
        if (node := node_of(dof, masses)) is not None:
            centre = at[node]
            with canvas.part(dof, "force"):
                canvas.arrow(moved(centre, box + 4, -box / 2), moved(centre, box + 34, -box / 2), COLOURS[3])
    return canvas.svg(label)


def _spring(
    canvas: Canvas, first: np.ndarray, second: np.ndarray | None, box: float, pitch: float, leftmost: bool
) -> None:
    """A zigzag to the wall or to the next mass; an arc above the masses to one farther away."""
    if second is None:
        away = np.array([-1.0, 0.0] if leftmost else [0.0, -1.0])
        wall, along = first + (box + 44) * away, away[::-1]
        canvas.spring(wall, first)
        canvas.stroke(np.array([wall - 16 * along, wall + 16 * along]), INK, 1.5)
        for step in (-12, -4, 4, 12):
            canvas.stroke(np.array([wall + step * along, wall + (step + 5) * along + 5 * away]), INK, 1)
    elif second[0] - first[0] < 1.5 * pitch:
        canvas.spring(first, second)
    else:
        canvas.stroke(_arc(moved(first, 0, -box), moved(second, 0, -box), -1), COLOURS[2], 1.5)


def _element(canvas: Canvas, ends: list[np.ndarray], rubs: bool, box: float) -> None:
    """Hatching below a mass that rubs on the ground, an arc between two masses, a zigzag for any other element."""
    if len(ends) == 2:
        canvas.stroke(_arc(moved(ends[0], 0, box), moved(ends[1], 0, box), 1), COLOURS[1 if rubs else 2], 2)
    elif ends and rubs:
        x, y = moved(ends[0], 0, box + 3)
        canvas.stroke(np.array([[x - box - 8, y], [x + box + 8, y]]), COLOURS[1], 2.5)
        for step in np.arange(-box - 4, box + 9, 7):
            canvas.stroke(np.array([[x + step, y], [x + step - 5, y + 6]]), COLOURS[1], 1)
    elif ends:
        x, y = moved(ends[0], 0, box)
        canvas.spring(np.array([x, y]), np.array([x, y + 38]))
        canvas.stroke(np.array([[x - 14, y + 38], [x + 14, y + 38]]), INK, 1.5)


def _arc(first: np.ndarray, second: np.ndarray, side: int) -> np.ndarray:
    """An arc below (1) or above (-1) two pixels."""
    shares = np.linspace(0.0, 1.0, 17)[:, None]
    high = side * min(44.0, 0.3 * float(np.linalg.norm(second - first)))
    return (1 - shares) * first + shares * second + 4 * shares * (1 - shares) * np.array([0.0, high])


def _connections(system: VibrationSystem, masses: list[str]) -> Iterable[tuple[str, str | None]]:
    """Pairs of masses with stiffness between them, and masses with stiffness to the ground."""
    stiffness = system.structure.stiffness
    signed = np.real(stiffness.toarray() if issparse(stiffness) else np.asarray(stiffness))
    dense = np.abs(signed)
    owners = [masses.index(name.rpartition(".")[0]) for name in system.structure.dofs.names]
    for row, own in enumerate(masses):
        rows = [k for k, owner in enumerate(owners) if owner == row]
        if np.abs(signed[rows].sum(axis=1)).max() > 1e-9 * dense.max(initial=1e-300):
            yield own, None
        for column in range(row + 1, len(masses)):
            if dense[np.ix_(rows, [k for k, owner in enumerate(owners) if owner == column])].any():
                yield own, masses[column]
