"""The scene of a structure: its mesh with forces and contacts, or a row of masses and springs."""

from collections.abc import Container, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import issparse

from dalembert.report.scene.scene import Label, Primitive, Scene, readable

if TYPE_CHECKING:
    from dalembert.vibration import VibrationSystem

MOST_MASSES = 12
"""Masses of a row."""
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
SHARP = 0.8
"""Cosine of the angle between the normals of two faces below which their common edge is drawn."""


def structure_scene(system: "VibrationSystem", channels: Sequence[str] = ()) -> Scene | None:
    """Return the scene of a structure; None where neither positions of nodes nor few masses are known.

    ``channels`` are degrees of freedom or nodes that are observed.
    """
    nodes = system.structure.nodes
    if nodes is not None and len(nodes.names):
        return _mesh(system, channels)
    masses = list(dict.fromkeys(name.rpartition(".")[0] for name in system.structure.dofs.names))
    return _row(system, masses, channels) if len(masses) <= MOST_MASSES else None


def _mesh(system: "VibrationSystem", channels: Sequence[str]) -> Scene:
    """Faces and sharp edges of a structure, or its nodes; contacts, springs, observed nodes and forces at nodes."""
    nodes = system.structure.nodes
    assert nodes is not None
    places, known, labels = nodes.places, set(nodes.names), []
    if nodes.faces is None or not len(nodes.faces):
        shapes = [Primitive("points", "body", "structure", places[None], 0)]
    else:
        sharp = places[edges(places, nodes.faces)].reshape(1, -1, 3)
        shapes = [
            Primitive("mesh", "body", "structure", places[None], 0, nodes.faces),
            Primitive("edges", "body", "structure", sharp),
        ]
    for element in system.elements:
        ends, role = ends_of(element, known), role_of(element)
        if ends:
            at = places[nodes.rows(ends)]
            shapes += [Primitive("dashes", role, element.name, at[None, :2], 1)] * (len(at) > 1)
            shapes.append(Primitive("dot", role, element.name, at[None, :1], 1))
            labels.append(Label(role, element.name, at[0], element.name))
    for channel in channels:
        if (node := node_of(channel, known)) is not None:
            at = places[nodes.rows([node])]
            shapes.append(Primitive("ring", "channel", channel, at[None], 1))
            labels.append(Label("channel", channel, at[0], channel, 1))
    for dof in _forced(system):
        node, _, axis = dof.rpartition(".")
        if node in known and axis in AXES:
            at = places[nodes.rows([node])]
            shapes.append(Primitive("arrow", "force", dof, at[None], 3, along=np.array(AXES[axis])))
            labels.append(Label("force", dof, at[0], dof))
    return Scene(tuple(shapes), readable(labels))


def _row(system: "VibrationSystem", masses: list[str], channels: Sequence[str]) -> Scene:
    """Springs between masses and to the ground (one point), elements, masses, observed masses and forces on masses."""
    at = {name: np.array([float(number), 0.0]) for number, name in enumerate(masses)}
    shapes = []
    for first, second in _connections(system, masses):
        points = np.array([at[name] for name in (first, second) if name is not None])
        shapes.append(Primitive("spring", "spring", f"{first} – {second or 'ground'}", points[None], 2))
    for element in system.elements:
        if ends := ends_of(element, masses):
            role, points = role_of(element), np.array([at[name] for name in ends[:2]])
            shapes.append(Primitive("element", role, element.name, points[None], 1 if role == "contact" else 2))
    shapes += [Primitive("mass", "body", name, centre[None, None], 0) for name, centre in at.items()]
    for channel in channels:
        if (node := node_of(channel, masses)) is not None:
            shapes.append(Primitive("ring", "channel", channel, at[node][None, None], 1))
    for dof in _forced(system):
        if (node := node_of(dof, masses)) is not None:
            shapes.append(Primitive("arrow", "force", dof, at[node][None, None], 3))
    return Scene(tuple(shapes), to_scale=False)


def _forced(system: "VibrationSystem") -> list[str]:
    """Degrees of freedom on which forces act, each once."""
    return list(dict.fromkeys(dof for force in system.forces for dof in force.dofs))


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
    """Return the role of an element in the scene."""
    from dalembert.vibration import FrictionContact

    return "contact" if isinstance(element, FrictionContact) else "spring"


def _connections(system: "VibrationSystem", masses: list[str]) -> Iterator[tuple[str, str | None]]:
    """Pairs of masses with stiffness between them, and masses with stiffness to the ground."""
    stiffness = system.structure.stiffness
    signed = np.real(stiffness.toarray() if issparse(stiffness) else np.asarray(stiffness))
    dense = np.abs(signed)
    owners = [masses.index(name.rpartition(".")[0]) for name in system.structure.dofs.names]
    for row, mass in enumerate(masses):
        rows = [k for k, owner in enumerate(owners) if owner == row]
        if np.abs(signed[rows].sum(axis=1)).max() > 1e-9 * dense.max(initial=1e-300):
            yield mass, None
        for column in range(row + 1, len(masses)):
            if dense[np.ix_(rows, [k for k, owner in enumerate(owners) if owner == column])].any():
                yield mass, masses[column]


def edges(places: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return ends (edges, 2) of the edges of one face alone, and of those where two faces meet at an angle.
    >>> corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]])
    >>> len(edges(corners, np.array([[0, 1, 2, 3], [1, 4, 5, 2]])))  # not the one between them
    6
    """
    if not len(faces):
        return np.zeros((0, 2), dtype=int)
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    first, second, third = (places[faces[:, corner]] for corner in (0, 1, 2))
    normals = np.cross(second - first, third - first)
    normals = np.repeat(normals / np.linalg.norm(normals, axis=1, keepdims=True), faces.shape[1], axis=0)
    ends, numbers, counts = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(numbers.ravel(), kind="stable")
    begins = np.cumsum(counts) - counts
    drawn = counts != 2
    pairs = np.flatnonzero(counts == 2)
    first, second = (normals[order[begins[pairs] + place]] for place in (0, 1))
    # Neighbouring faces may be numbered in opposite senses, so only the axes of their normals count.
    drawn[pairs] = np.abs(np.einsum("ij,ij->i", first, second)) < SHARP
    return ends[drawn]
