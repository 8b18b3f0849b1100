"""Structures made of parts: combined, their nodes paired by geometry, and tied."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.sparse import block_diag, csc_array, issparse

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.structure.dofs import Dofs
from dalembert.structure.nodes import Nodes
from dalembert.structure.structure import MATRICES, Matrix, Structure, changed, known_nodes

Pairs = tuple[tuple[str, str], ...]


@takes_checked()
def combine(parts: Mapping[str, Structure]) -> Structure:
    """Combine several structures into one, without connections.

    Parameters
    ----------
    parts : mapping of str to Structure
        The node "7" of the part "plate" gets the name "plate/7", and so do sets of nodes.

    Returns
    -------
    Structure
        With sparse matrices, and with nodes if all parts have them.

    Examples
    --------
    >>> from dalembert.structure import lumped
    >>> pair = combine({"left": lumped({"a": 1.0}, []), "right": lumped({"a": 2.0}, [])})
    >>> pair.dofs.names, pair.mass.diagonal()
    (('left/a.x', 'right/a.x'), array([1., 2.]))
    """
    structures = list(parts.values())
    if not structures:
        raise InputError("combine: there are no parts; expected at least one")

    def joined(name: str) -> csc_array | None:
        matrices = [getattr(structure, name) for structure in structures]
        if all(structure is None for structure in matrices):
            return None
        blocks = [
            0 * structure.mass if matrix is None else matrix
            for structure, matrix in zip(structures, matrices, strict=True)
        ]
        return csc_array(block_diag([csc_array(structure) for structure in blocks], format="csc"))

    names = tuple(f"{part}/{name}" for part, structure in parts.items() for name in structure.dofs.names)
    inertia = np.concatenate([structure.inertia_of_base for structure in structures])
    matrices = {name: joined(name) for name in MATRICES}
    return Structure(dofs=Dofs(names), nodes=_nodes(parts), base_inertia=inertia, **matrices)


@takes_checked()
def pairs(structure: Structure, first: str, second: str, tolerance: float) -> Pairs:
    """Return pairs of nodes of one set and their nearest nodes of another, for contacts or ties.

    Parameters
    ----------
    structure : Structure
        With nodes.
    first, second : str
        Sets of nodes. Each node of the first gets a partner; nodes of the second may remain single.
    tolerance : float
        Largest distance of partners, m.

    Returns
    -------
    tuple of (node of the first set, node of the second)

    Raises
    ------
    InputError
        For an unknown set, a structure without nodes, or a node of the first set without a partner.
    """
    from scipy.spatial import KDTree

    nodes = known_nodes(structure, "pairs")
    ours, theirs = nodes.members(first), nodes.members(second)
    distances, nearest = KDTree(nodes.places[nodes.rows(theirs)]).query(nodes.places[nodes.rows(ours)])
    far = np.flatnonzero(distances > tolerance)
    if len(far):
        raise InputError(
            f"pairs: {len(far)} of the {len(ours)} nodes of {first!r} have no node of {second!r} within {tolerance:g} "
            f"m, node {ours[far[0]]!r} is {distances[far[0]]:.3g} m from the nearest; raise the tolerance, or use a "
            "set of fewer nodes"
        )
    values, counts = np.unique(nearest, return_counts=True)
    if counts.max(initial=1) > 1:
        raise InputError(
            f"pairs: the node {theirs[values[np.argmax(counts)]]!r} of {second!r} is nearest to {counts.max()} nodes "
            f"of {first!r}; expected one each; lower the tolerance, or swap the sets"
        )
    return tuple((str(node), str(theirs[other])) for node, other in zip(ours, np.ravel(nearest), strict=True))


@takes_checked()
def tie(structure: Structure, joined: Sequence[tuple[str, str]]) -> Structure:
    """Return the structure with each pair of nodes merged into one node.

    Parameters
    ----------
    structure : Structure
    joined : sequence of (kept node, node)
        The second one of each pair moves with the first, in every direction that both have, and leaves the structure;
        in sets of nodes, faces and elements the first takes its place.

    Raises
    ------
    InputError
        For an unknown node, or one that is tied twice.
    """
    keeper = {second: first for first, second in joined}
    if len(keeper) < len(joined) or set(keeper) & set(keeper.values()):
        raise InputError("tie: a node is the second of two pairs, or the second of one and the first of another")
    structure.rows([node for pair in joined for node in pair])
    targets = []
    for name in structure.dofs.names:
        node, _, direction = name.rpartition(".")
        targets.append(f"{keeper.get(node, node)}.{direction}")
    names = tuple(dict.fromkeys(targets))
    places = {name: place for place, name in enumerate(names)}
    columns = [places[target] for target in targets]
    ones = csc_array((np.ones(len(columns)), (np.arange(len(columns)), columns)), shape=(structure.size, len(names)))

    def tied(matrix: Matrix) -> Matrix:
        return ones.T @ (matrix if issparse(matrix) else csc_array(matrix)) @ ones

    nodes = structure.nodes
    if nodes is not None:
        sets = {
            name: tuple(dict.fromkeys(keeper.get(node, node) for node in members))
            for name, members in nodes.sets.items()
        }
        rows = {name: row for row, name in enumerate(nodes.names)}
        members = np.array([rows[keeper.get(name, name)] for name in nodes.names], dtype=int)
        cells = (None if rows is None else members[rows] for rows in (nodes.faces, nodes.elements))
        nodes = Nodes(nodes.names, nodes.places, sets, *cells)
    inertia = ones.T @ structure.inertia_of_base
    return replace(structure, dofs=Dofs(names), nodes=nodes, base_inertia=inertia, **changed(structure, tied))


def _nodes(parts: Mapping[str, Structure]) -> Nodes | None:
    if any(structure.nodes is None for structure in parts.values()):
        return None
    every = {part: structure.nodes for part, structure in parts.items() if structure.nodes is not None}
    starts = np.cumsum([0, *(len(nodes.names) for nodes in every.values())])
    cells = [
        [rows if rows is None else rows + start for rows in (nodes.faces, nodes.elements)]
        for nodes, start in zip(every.values(), starts, strict=False)
    ]
    return Nodes(
        tuple(f"{part}/{name}" for part, nodes in every.items() for name in nodes.names),
        np.vstack([nodes.places for nodes in every.values()]),
        {
            f"{part}/{name}": tuple(f"{part}/{node}" for node in members)
            for part, nodes in every.items()
            for name, members in nodes.sets.items()
        },
        *(_stacked(rows) for rows in zip(*cells, strict=True)),
    )


def _stacked(parts: Sequence[np.ndarray | None]) -> np.ndarray | None:
    """Faces or elements of all parts; None where they are of several kinds, or a part has none."""
    known = [part for part in parts if part is not None]
    kinds = {part.shape[1] for part in known}
    return np.vstack(known) if len(known) == len(parts) and len(kinds) == 1 else None
