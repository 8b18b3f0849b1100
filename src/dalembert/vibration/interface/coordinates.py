"""Exact split of coordinates: retained ones, which nonlinear elements move, and interior ones."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import qr, solve
from scipy.sparse import coo_array, csc_array, eye_array

DEPENDENT = 1e-10
"""Part of a row that must be left beside others for it to be independent of them."""


@dataclass(frozen=True)
class Coordinates:
    r"""Retained coordinates :math:`q = S x`, and :math:`x = T_q q + T_l x_l` with interior ones that x holds itself.
    ``rows`` (q,): which of the elements' rows are the retained coordinates; ``combination`` (elements' rows, q): all
    elements' rows from the retained ones; ``retained`` (n, q): T_q; ``interior`` (n, n - q): T_l.
    """

    rows: np.ndarray
    combination: np.ndarray
    retained: Any
    interior: Any


def coordinates(rows: Any, first: np.ndarray) -> Coordinates:
    """Return coordinates of a structure from the rows (elements' rows, n) that its elements see. ``first``: rows that
    are to be retained coordinates themselves; they must be independent.
    """
    count, n = rows.shape
    columns = np.flatnonzero(np.diff(rows.indptr))
    dense = rows[:, columns].toarray()
    order = [*first, *(row for row in range(count) if row not in set(first))]
    kept = np.array(_independent(dense, order), dtype=int)
    basis = dense[kept]
    combination = dense @ np.linalg.pinv(basis) if len(kept) else np.zeros((count, 0))
    combination[np.abs(combination) < DEPENDENT] = 0.0
    combination[kept] = np.eye(len(kept))
    if not len(kept):
        return Coordinates(kept, combination, csc_array((n, 0)), csc_array(eye_array(n)))
    # QR with column pivots chooses the degrees of freedom that the retained rows replace, so that their block is well
    # conditioned.
    pivots = qr(basis, mode="r", pivoting=True)[-1][: len(kept)]
    remaining = np.setdiff1d(np.arange(len(columns)), pivots)
    inverse = solve(basis[:, pivots], np.eye(len(kept)))
    free = np.setdiff1d(np.arange(n), columns[pivots])
    interior = coo_array((np.ones(len(free)), (free, np.arange(len(free)))), shape=(n, len(free)))
    retained = _placed(inverse, columns[pivots], np.arange(len(kept)), (n, len(kept)))
    slaved = _placed(
        -inverse @ basis[:, remaining], columns[pivots], np.searchsorted(free, columns[remaining]), (n, len(free))
    )
    return Coordinates(kept, combination, retained, csc_array(interior + slaved))


def _placed(block: np.ndarray, rows: np.ndarray, columns: np.ndarray, shape: tuple[int, int]) -> Any:
    result = csc_array(
        (block.ravel(), (np.repeat(rows, len(columns)), np.tile(columns, len(rows)))), shape=shape, dtype=float
    )
    result.eliminate_zeros()
    return result


def _independent(dense: np.ndarray, order: list[int]) -> list[int]:
    """Rows, in an order of preference, that are not combinations of those before (Gram and Schmidt, twice)."""
    kept: list[int] = []
    directions = np.zeros((min(dense.shape), dense.shape[1]))
    for row in order:
        if len(kept) == len(directions):
            break
        left = dense[row] / np.linalg.norm(dense[row])
        # Twice is enough (Kahan and Parlett): once loses orthogonality where a row is nearly dependent.
        for _ in range(2):
            left = left - directions[: len(kept)].T @ (directions[: len(kept)] @ left)
        size = np.linalg.norm(left)
        if size > DEPENDENT:
            directions[len(kept)] = left / size
            kept.append(row)
    return kept
