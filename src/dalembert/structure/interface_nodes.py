"""Interface nodes of a free body, which move nodes of its structure rigidly."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_array, lil_array

from dalembert.arguments import Checked
from dalembert.errors import InputError, shown, unknown
from dalembert.structure.dofs import Dofs
from dalembert.structure.eigenmodes import real_part
from dalembert.structure.free_body_rows import DIRECTIONS, Rows
from dalembert.structure.structure import Structure


@dataclass(frozen=True)
class InterfaceNode(Checked):
    """A node of a free body to which nodes of its structure are tied rigidly.

    Parameters
    ----------
    nodes : str or sequence of str
        Nodes of the structure, or sets of nodes.
    position : (float, float, float), optional
        In the axes of the structure, m; the mean of the nodes' positions if not given.
    """

    nodes: str | Sequence[str]
    position: tuple[float, float, float] | None = None

    IN_WORDS = "an InterfaceNode such as InterfaceNode('left')"


class Tie(NamedTuple):
    """Rows that an interface node moves, its place (3,) from the centre of mass, and their motion by it (rows, 6)."""

    rows: np.ndarray
    place: np.ndarray
    motion: np.ndarray


def ties_of(structure: Structure, interfaces: Mapping[str, InterfaceNode], rows: Rows, centre: np.ndarray) -> list[Tie]:
    """The ties of the interface nodes to the structure."""
    ties, owners = [], {}
    for name, interface in interfaces.items():
        members = np.array(_members(structure, interface, name), dtype=int)
        for row in members:
            if owners.setdefault(int(row), name) != name:
                raise InputError(
                    f"free_body_modes: the interface nodes {owners[int(row)]!r} and {name!r} share the node "
                    f"{structure.dofs.names[row].rpartition('.')[0]!r}; expected separate nodes"
                )
        places = np.unique(rows.places[members], axis=0)
        position = interface.position
        place = places.mean(axis=0) if position is None else np.array(position) - centre
        motion = Rows(*(entry[members] for entry in rows)).about(place).rigid
        extent = float(np.ptp(places, axis=0).max()) or 1.0
        if np.linalg.matrix_rank(motion / np.repeat([1.0, extent], 3), tol=1e-6) < 6:
            raise InputError(
                f"free_body_modes: the nodes of the interface node {name!r} lie on a line or at a point, and do not "
                "hold its rotation. Give it three nodes that are not on a line, or a node with rotations"
            )
        ties.append(Tie(members, place, motion))
    return ties


def _members(structure: Structure, interface: InterfaceNode, name: str) -> list[int]:
    """Rows of the nodes of an interface node; refuse names that are no nodes or sets, and none at all."""
    nodes = structure.nodes
    assert nodes is not None  # checked by the caller
    stated = [interface.nodes] if isinstance(interface.nodes, str) else list(interface.nodes)
    for entry in stated:
        if entry not in nodes.sets and not structure.dofs.has_node(entry):
            known = (*nodes.sets, *nodes.names)
            raise InputError(unknown("node or set of nodes", entry, known, f"free_body_modes: interface node {name!r}"))
    if not (rows := structure.rows(stated)):
        raise InputError(f"free_body_modes: the interface node {name!r} has no nodes of the structure; expected some")
    if interface.position is not None and not np.all(np.isfinite(interface.position)):
        raise InputError(
            f"free_body_modes: the position of the interface node {name!r} is {shown(interface.position)}; expected "
            "three finite numbers in m"
        )
    return rows


def rigid_motion(place: np.ndarray) -> np.ndarray:
    """Displacements and rotations of a node at a place by those of the origin, (6, 6)."""
    motion = np.eye(6)
    motion[:3, 3:] = np.cross(np.eye(3), place).T
    return motion


def rigid_coordinates(ties: Sequence[Tie], size: int, length: float) -> np.ndarray:
    """Rigid motions in interface coordinates and modes with these held, (size, 6), rotations times ``length``."""
    units = np.repeat([1.0, length], 3)
    motions = [rigid_motion(tie.place) * units[:, None] / units for tie in ties]
    return np.vstack([*motions, np.zeros((size - 6 * len(ties), 6))])


def tied(structure: Structure, ties: Sequence[Tie], length: float) -> tuple[Structure, csc_array]:
    """The structure with interface nodes in place of what is tied to them, and the motion of all rows by its own.

    Rotations of interface nodes are counted as displacements at a ``length``, so that all entries are of one size.
    """
    others = np.setdiff1d(np.arange(structure.size), np.concatenate([tie.rows for tie in ties]))
    if not len(others):
        raise InputError("free_body_modes: all nodes belong to interface nodes; leave some of them free to move")
    spread = lil_array((structure.size, len(others) + 6 * len(ties)))
    spread[others, np.arange(len(others))] = 1.0
    for number, tie in enumerate(ties):
        first = len(others) + 6 * number
        spread[tie.rows, first : first + 6] = tie.motion / np.repeat([1.0, length], 3)
    spread = csc_array(spread)
    names = [structure.dofs.names[row] for row in others]
    names += [f"interface {number}.{direction}" for number in range(len(ties)) for direction in DIRECTIONS]
    matrices = {
        name: spread.T @ (csc_array(real_part(getattr(structure, name))) @ spread) for name in ("mass", "stiffness")
    }
    return Structure(dofs=Dofs(tuple(names)), **matrices), spread
