"""Positions of the nodes of a structure, and named sets of nodes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType

import numpy as np

from dalembert.errors import InputError, unknown


@dataclass(frozen=True, eq=False)
class Nodes:
    """Names, places and sets of the nodes of a structure.

    Parameters
    ----------
    names : tuple of str
        As in the names of the degrees of freedom, ``NODE.DIRECTION``.
    places : array, shape (nodes, 3)
        m.
    sets : mapping of str to tuple of str, optional
        Names of nodes by the name of their set.
    faces : array of int, shape (faces, 3 or 4), optional
        Rows of ``places``, triangles or quadrilaterals, to draw the structure.
    elements : array of int, shape (elements, 10, 20 or 27), optional
        Rows of ``places`` of the nodes of tetrahedra or bricks, for strains; in the order of scikit-fem.

    Raises
    ------
    InputError
        For places that do not fit the names, a set with an unknown node, or elements of another kind.

    Examples
    --------
    >>> nodes = Nodes(("a", "b"), np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), {"end": ("b",)})
    >>> nodes.nearest((0.9, 0.1)), nodes.members("end")
    ('b', ('b',))
    """

    IN_WORDS = "Nodes"

    names: tuple[str, ...]
    places: np.ndarray
    sets: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    faces: np.ndarray | None = None
    elements: np.ndarray | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", tuple(map(str, self.names)))  # not those of NumPy, which print their type
        places = np.asarray(self.places, dtype=float)
        if places.shape != (len(self.names), 3):
            raise InputError(
                f"Nodes: the places have shape {places.shape}; expected {(len(self.names), 3)}, "
                f"x, y and z of each of the {len(self.names)} nodes"
            )
        object.__setattr__(self, "places", places)
        object.__setattr__(
            self, "sets", MappingProxyType({name: tuple(map(str, members)) for name, members in self.sets.items()})
        )
        for name, members in self.sets.items():
            for node in members:
                if node not in self._rows:
                    raise InputError(unknown("node", node, self.names, f"Nodes: set {name!r}"))
        if self.elements is not None and np.shape(self.elements)[1:] not in ((10,), (20,), (27,)):
            raise InputError(
                f"Nodes: the elements have shape {np.shape(self.elements)}; expected 10, 20 or 27 nodes of each. Leave "
                "out elements of other kinds"
            )

    def nearest(self, place: Sequence[float]) -> str:
        """Name of the node nearest to a place (x, y) or (x, y, z) in m; the first one where several are."""
        gap = self.places[:, : len(place)] - np.asarray(place)
        return self.names[int(np.argmin(np.einsum("ij,ij->i", gap, gap)))]

    def members(self, name: str) -> tuple[str, ...]:
        """The nodes of a set.

        Raises
        ------
        InputError
            For an unknown set, with the nearest names.
        """
        if name not in self.sets:
            raise InputError(unknown("node set", name, self.sets))
        return self.sets[name]

    def rows(self, names: Sequence[str]) -> np.ndarray:
        """Rows of ``places`` of some nodes.

        Raises
        ------
        InputError
            For an unknown node.
        """
        for name in names:
            if name not in self._rows:
                raise InputError(unknown("node", name, self.names))
        return np.array([self._rows[name] for name in names], dtype=int)

    @cached_property
    def _rows(self) -> dict[str, int]:
        return {name: row for row, name in enumerate(self.names)}
