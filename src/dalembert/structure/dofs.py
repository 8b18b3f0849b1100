"""Names of degrees of freedom."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from dalembert.argument_readers import names_of
from dalembert.errors import InputError, unknown
from dalembert.units import OF_DIRECTION

DIRECTIONS = tuple(OF_DIRECTION)
"""Displacements, rotations, the twist ∂²w/∂x∂y of a plate, and a modal coordinate."""


@dataclass(frozen=True)
class Dofs:
    """Degrees of freedom by name, ``NODE.DIRECTION``.

    Directions are x, y and z (m), rx, ry and rz (rad), rxy for the twist ∂²w/∂x∂y of a plate (1/m) and q for the
    coordinate of a mode.

    Parameters
    ----------
    names : tuple of str
        In the order of the rows of the matrices.

    Raises
    ------
    InputError
        For a name that is not of this form, or that comes twice.

    Examples
    --------
    >>> dofs = Dofs(("a.x", "a.y", "b.x"))
    >>> dofs.index("a.y"), dofs.index("b")
    (1, 2)
    """

    IN_WORDS = "Dofs, such as Dofs(('A.x', 'B.x'))"

    names: tuple[str, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", names_of(self.names, "Dofs", "names"))
        for name in self.names:
            if name.rpartition(".")[2] not in DIRECTIONS or not name.rpartition(".")[0]:
                raise InputError(
                    f"Dofs: a degree of freedom is called {name!r}; expected NODE.DIRECTION with one of the directions "
                    f"{', '.join(DIRECTIONS)}, such as 'A.x'"
                )
        if len(self._places) < len(self.names):
            twice = next(name for name in self.names if self.names.count(name) > 1)
            raise InputError(f"Dofs: the name {twice!r} is given twice; expected a name for each degree of freedom")

    def __len__(self) -> int:
        return len(self.names)

    def index(self, name: str, where: str = "") -> int:
        """Return the row of a degree of freedom. A node that has only one may be named alone.

        Parameters
        ----------
        name : str
        where : str
            What needs it, for errors.

        Raises
        ------
        InputError
            For an unknown name, with the nearest ones.
        """
        if name in self._places:
            return self._places[name]
        rows = self._of_node.get(name, [])
        if len(rows) == 1:
            return rows[0]
        if rows:
            raise InputError(
                f"{where}{': ' * bool(where)}the node {name!r} has the degrees of freedom "
                f"{', '.join(self.names[row] for row in rows)}; name one"
            )
        raise InputError(unknown("degree of freedom", name, self.names, where))

    def rows(self, names: Iterable[str]) -> list[int]:
        """Return the rows of several degrees of freedom. A node alone means all that it has.

        Raises
        ------
        InputError
            For an unknown name, with the nearest ones.
        """
        return [row for name in names for row in self._of_node.get(name) or [self.index(name)]]

    def has_node(self, name: str) -> bool:
        """Whether a node has degrees of freedom here."""
        return name in self._of_node

    @cached_property
    def _places(self) -> dict[str, int]:
        return {name: row for row, name in enumerate(self.names)}

    @cached_property
    def _of_node(self) -> dict[str, list[int]]:
        rows: dict[str, list[int]] = {}
        for row, name in enumerate(self.names):
            rows.setdefault(name.rpartition(".")[0], []).append(row)
        return rows
