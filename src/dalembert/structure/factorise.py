"""Linear systems with the matrices of a structure."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve
from scipy.sparse import issparse
from scipy.sparse.linalg import splu

from dalembert.errors import SolveError

BLOCK = 32
"""Columns that are solved for together."""
SINGULAR = 1e-13
"""Ratio of the smallest to the largest pivot below which a matrix counts as singular."""


def factorise(
    matrix: Any, what: str, advice: str = "; clamp it", positive: bool = False
) -> Callable[[np.ndarray], np.ndarray]:
    """Return the solution of ``matrix @ x = b`` as a function of b, of shape (n,) or (n, columns). ``matrix`` (n, n):
    symmetric, as rows and columns are reordered together to keep the factors sparse; ``what``, ``advice``: its name in
    the error, and the end of that sentence; ``positive``: whether a matrix that is not positive definite is refused.
    """
    singular = f"{what} is singular: the structure, or a part of it, moves without being held{advice}"
    if not issparse(matrix):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LinAlgWarning)
            factors = lu_factor(matrix)
        _refuse_singular(np.diag(factors[0]), singular)
        if positive and np.linalg.eigvalsh(matrix)[0] < 0:
            raise SolveError(f"{what} is not positive definite, since a spring has a negative stiffness")
        return lambda b: lu_solve(factors, b)
    try:
        lu = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:
        raise SolveError(singular) from None
    pivots = lu.U.diagonal()
    _refuse_singular(pivots, singular)
    # Without exchanges of rows, the signs of the pivots are those of the eigenvalues (Sylvester).
    if positive and pivots.min() < 0:
        raise SolveError(f"{what} is not positive definite, since a spring has a negative stiffness")

    def solve(b: np.ndarray) -> np.ndarray:
        if b.ndim == 1 or not b.shape[1]:
            return lu.solve(b)
        # Blocks of columns whose entries lie side by side: 17,277 degrees of freedom took 15 ms a column alone, 5.6 in
        # blocks. Rows side by side took longer than columns alone.
        parts = [lu.solve(np.asfortranarray(b[:, first : first + BLOCK])) for first in range(0, b.shape[1], BLOCK)]
        return np.concatenate(parts, axis=1)

    return solve


def _refuse_singular(pivots: np.ndarray, sentence: str) -> None:
    sizes = np.abs(pivots)
    if sizes.size and sizes.min() <= SINGULAR * sizes.max():
        raise SolveError(sentence)
