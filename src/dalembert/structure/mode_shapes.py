"""Motion of nodes from that of degrees of freedom, and mode shapes, for drawing."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from dalembert.contents import Contents
from dalembert.errors import InputError
from dalembert.results import Result
from dalembert.structure.craig_bampton import ReducedStructure
from dalembert.structure.eigenmodes import EigenModes
from dalembert.structure.structure import Structure, known_nodes
from dalembert.tables import MOST_FACTS, Table, shown

if TYPE_CHECKING:
    from xarray import Dataset

AXES = ("x", "y", "z")


@dataclass(frozen=True, eq=False)
class ModeShapes(Result):
    """Free vibrations of a structure at its nodes, as :func:`mode_shapes` returns them.

    Parameters
    ----------
    frequencies : array, shape (modes,)
        Hz.
    places : array, shape (nodes, 3)
        m.
    faces : array of int, shape (faces, 3 or 4)
        Rows of ``places``; none where the structure has none.
    shapes : array, shape (modes, nodes, 3)
        The largest displacement of each is 1.
    """

    FORMAT: ClassVar[str] = "dalembert mode shapes 1"
    TITLE: ClassVar[str] = "Modes"

    frequencies: np.ndarray
    places: np.ndarray
    faces: np.ndarray
    shapes: np.ndarray

    @property
    def success(self) -> bool:
        """True: what cannot be found is an error."""
        return True

    @property
    def status(self) -> str:
        """How many modes there are, in a sentence."""
        return f"{len(self.frequencies)} natural frequencies and shapes of the undamped structure."

    def key_values(self) -> dict[str, str]:
        lowest = enumerate(self.frequencies[:MOST_FACTS].tolist(), start=1)
        return {f"mode {number}": f"{shown(frequency)} Hz" for number, frequency in lowest}

    def tables(self) -> tuple[Table, ...]:
        """Return the frequencies."""
        columns = {"mode": range(1, len(self.frequencies) + 1), "frequency (Hz)": self.frequencies}
        return (Table.of("modes", "Natural frequencies", columns),)

    def contents(self) -> Contents:
        variables = {
            "frequencies": (("mode",), self.frequencies, {"units": "Hz"}),
            "places": (("node", "axis"), self.places, {"units": "m"}),
            "faces": (("face", "corner"), self.faces),
            "shapes": (("mode", "node", "axis"), self.shapes),
        }
        return Contents(variables, attributes={"format": self.FORMAT})

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> "ModeShapes":
        """The shapes that :meth:`to_xarray` turned into a dataset."""
        return cls(*(dataset[name].values for name in ("frequencies", "places", "faces", "shapes")))


def mode_shapes(structure: Structure, modes: EigenModes) -> ModeShapes:
    """Shapes of modes at the nodes of a structure.

    Parameters
    ----------
    structure : Structure
        With nodes; of a reduced one the nodes of the full one.
    modes : EigenModes
        Of the structure.

    Raises
    ------
    InputError
        For a structure that does not say where its nodes are, and for complex shapes.

    Examples
    --------
    >>> from dalembert.structure import Material, eigenmodes, plate
    >>> square = plate((0.4, 0.4), 2e-3, Material(210e9, 0.3, 7800.0), (4, 4)).fixed("edge")
    >>> shown = mode_shapes(square, eigenmodes(square, 2))
    >>> shown.shapes.shape, float(abs(shown.shapes).max())
    ((2, 25, 3), 1.0)
    """
    if np.iscomplexobj(modes.shapes):
        raise InputError(
            "mode_shapes: the shapes are complex; expected those of the undamped structure, which `eigenmodes` finds, "
            "whose nodes move in phase"
        )
    nodes, motion = known_nodes(structure, "mode_shapes"), node_motion(structure, modes.shapes)
    kept, faces = drawn_nodes(motion, nodes.faces)
    shapes = np.moveaxis(motion[kept], -1, 0)
    largest = np.linalg.norm(shapes, axis=2).max(axis=1)
    return ModeShapes(modes.frequencies, nodes.places[kept], faces, shapes / largest[:, None, None])


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
    >>> from dalembert.structure import Dofs, Nodes
    >>> nodes = Nodes(("a", "b"), np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
    >>> bar = Structure(np.eye(2), np.eye(2), Dofs(("b.z", "b.x")), nodes=nodes)
    >>> node_motion(bar, np.array([3.0, 4.0])).tolist()
    [[0.0, 0.0, 0.0], [4.0, 0.0, 3.0]]
    """
    nodes = known_nodes(structure, "node_motion")
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


def drawn_nodes(motion: np.ndarray, faces: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows of the nodes to draw, corners of faces or all that move if there are none, and the faces.

    ``motion`` (nodes, 3, ...); ``faces`` (faces, 3 or 4).
    """
    if faces is not None and len(faces):
        kept, corners = np.unique(faces, return_inverse=True)
        return kept, corners.reshape(faces.shape)
    moving = np.any(motion.reshape(len(motion), -1) != 0, axis=1)
    return np.flatnonzero(moving), np.zeros((0, 4), dtype=int)
