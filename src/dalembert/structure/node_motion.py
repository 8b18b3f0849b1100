"""Motion of nodes from that of degrees of freedom, for drawing."""

import numpy as np

from dalembert.errors import InputError
from dalembert.structure.craig_bampton import ReducedStructure
from dalembert.structure.nodes import Nodes
from dalembert.structure.structure import Structure

AXES = ("x", "y", "z")


def node_motion(structure: Structure, motion: np.ndarray) -> np.ndarray:
    """Displacements of all nodes along x, y and z; 0 where a node has no such degree of freedom, since it is clamped.

    Parameters
    ----------
    structure : Structure
        With nodes; a reduced one gives back the motion of the full one.
    motion : array, shape (Structure.size, ...)
        Of the structure's degrees of freedom.

    Returns
    -------
    array, shape (nodes, 3, ...)

    Raises
    ------
    InputError
        For a structure that does not say where its nodes are.

    Examples
    --------
    >>> from dalembert.structure import Dofs
    >>> nodes = Nodes(("a", "b"), np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
    >>> bar = Structure(np.eye(2), np.eye(2), Dofs(("b.z", "b.x")), nodes=nodes)
    >>> node_motion(bar, np.array([3.0, 4.0])).tolist()
    [[0.0, 0.0, 0.0], [4.0, 0.0, 3.0]]
    """
    nodes = known_nodes(structure)
    dofs = structure.dofs
    if isinstance(structure, ReducedStructure):
        dofs, motion = structure.full_dofs, structure.expand(motion)
    places = {name: row for row, name in enumerate(nodes.names)}
    result = np.zeros((len(nodes.names), len(AXES), *np.shape(motion)[1:]))
    for row, name in enumerate(dofs.names):
        node, _, axis = name.rpartition(".")
        if axis in AXES and node in places:
            result[places[node], AXES.index(axis)] = motion[row]
    return result


def known_nodes(structure: Structure) -> Nodes:
    """Return the nodes of a structure. Refuse a structure without positions of nodes."""
    if structure.nodes is None:
        raise InputError(
            "the structure does not say where its nodes are, so its motion cannot be drawn; give it nodes=Nodes(...)"
        )
    return structure.nodes
