"""A linear structure: its matrices and the names of their rows."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import issparse

from dalembert.errors import InputError
from dalembert.structure.dofs import Dofs

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

    def fixed(self, held: str | Sequence[str]) -> "Structure":
        """The structure with some of its degrees of freedom clamped: their rows and columns are taken out.

        Parameters
        ----------
        held : str or sequence of str
            Degrees of freedom, or nodes for all of theirs.
        """
        out = set(self.dofs.rows([held] if isinstance(held, str) else held))
        kept = [row for row in range(self.size) if row not in out]
        block = np.ix_(kept, kept)
        return Structure(
            self.mass[block],
            self.stiffness[block],
            Dofs(tuple(self.dofs.names[row] for row in kept)),
            None if self.damping is None else self.damping[block],
        )
