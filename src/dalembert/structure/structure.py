"""A linear structure: its matrices, the names of their rows, and where its nodes are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.sparse import issparse

from dalembert.errors import InputError
from dalembert.structure.damping import Modal, Rayleigh
from dalembert.structure.dofs import Dofs
from dalembert.structure.nodes import Nodes

Matrix = Any
"""A NumPy array or a SciPy sparse array, (n, n), real, or complex with a complex step as its imaginary part."""

ASYMMETRY = 1e-8
"""Largest difference from its transpose, as part of the largest entry, that is taken for rounding."""


@dataclass(frozen=True, eq=False)
class Structure:
    r"""A linear structure :math:`M \ddot x + C \dot x + K x = f`.

    Parameters
    ----------
    mass, stiffness : array or sparse array, shape (n, n)
        kg and N/m where all unknowns are displacements; symmetric. Imaginary parts are directions of derivatives.
    dofs : Dofs
        Names of the n rows.
    damping : array or sparse array, shape (n, n), optional
        N s/m; none if not given.
    nodes : Nodes, optional
        Where the nodes are, and their sets.

    Raises
    ------
    InputError
        For matrices whose sizes do not fit, or that are not symmetric or not finite.

    Examples
    --------
    >>> import numpy as np
    >>> pair = Structure(np.eye(2), np.array([[2.0, -1.0], [-1.0, 1.0]]), Dofs(("a.x", "b.x")))
    >>> pair.size, pair.fixed(["b"]).stiffness.tolist()
    (2, [[2.0]])
    """

    mass: Matrix
    stiffness: Matrix
    dofs: Dofs
    damping: Matrix | None = None
    nodes: Nodes | None = None

    def __post_init__(self) -> None:
        for name in ("mass", "stiffness", "damping"):
            matrix = getattr(self, name)
            if matrix is None:
                continue
            if not issparse(matrix):
                matrix = np.asarray(matrix)
                object.__setattr__(self, name, matrix)
            if matrix.shape != (self.size, self.size):
                raise InputError(
                    f"Structure: the {name} matrix has shape {matrix.shape}; expected {(self.size, self.size)}, "
                    f"a row for each of the {self.size} degrees of freedom"
                )
            entries = matrix.data if issparse(matrix) else matrix
            if not np.all(np.isfinite(entries)):
                raise InputError(f"Structure: the {name} matrix has entries that are not finite numbers")
            off = abs(matrix - matrix.T).max()
            if off > ASYMMETRY * abs(matrix).max():
                raise InputError(
                    f"Structure: the {name} matrix is not symmetric, it differs from its transpose by up to {off:.3g}; "
                    "expected a symmetric one"
                )

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return len(self.dofs)

    def rows(self, names: str | Sequence[str]) -> list[int]:
        """Rows of degrees of freedom, of all those of nodes, or of all those of sets of nodes.

        Nodes of a set that have none left, since they are clamped, are passed over.

        Raises
        ------
        InputError
            For an unknown name, with the nearest ones.
        """
        sets = self.nodes.sets if self.nodes else {}
        names = [names] if isinstance(names, str) else names
        single = [
            name for given in names for name in (filter(self.dofs.has_node, sets[given]) if given in sets else [given])
        ]
        return list(dict.fromkeys(self.dofs.rows(single)))

    def fixed(self, held: str | Sequence[str]) -> Structure:
        """The structure with some of its degrees of freedom clamped: their rows and columns are taken out.

        Parameters
        ----------
        held : str or sequence of str
            Degrees of freedom, nodes for all of theirs, or sets of nodes.
        """
        out = np.ones(self.size, dtype=bool)
        out[self.rows(held)] = False
        kept = np.flatnonzero(out)
        return replace(
            self,
            mass=block(self.mass, kept),
            stiffness=block(self.stiffness, kept),
            dofs=Dofs(tuple(self.dofs.names[row] for row in kept)),
            damping=None if self.damping is None else block(self.damping, kept),
        )

    def with_damping(self, damping: Rayleigh | Modal | Matrix) -> Structure:
        """The structure with another damping in place of its own.

        Parameters
        ----------
        damping : Rayleigh, Modal, or array or sparse array of shape (n, n)

        Examples
        --------
        >>> bob = Structure(np.array([[2.0]]), np.array([[8.0]]), Dofs(("bob.x",)))
        >>> bob.with_damping(Modal(0.01)).damping.round(12).tolist()  # 2 · 0.01 · sqrt(2 · 8)
        [[0.08]]
        """
        matrix = damping.matrix(self.mass, self.stiffness) if isinstance(damping, (Rayleigh, Modal)) else damping
        return replace(self, damping=matrix)


def block(matrix: Matrix, rows: np.ndarray, columns: np.ndarray | None = None) -> Matrix:
    """Some rows and columns (the same ones if not given) of a dense or sparse matrix."""
    columns = rows if columns is None else columns
    return matrix.tocsc()[:, columns].tocsr()[rows].tocsc() if issparse(matrix) else matrix[np.ix_(rows, columns)]
