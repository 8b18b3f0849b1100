"""Whitening: each standardised residual less its prediction from those before it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from scipy.sparse import csr_array

LONGEST = 50
"""Most values that one is predicted from, where gaps follow each other closely."""


class Whitening(Protocol):
    """What makes the standardised residuals z (values,) of a series independent. Row i of the matrix A is
    (z_i − Σ_j a_j z_{i−j}) / d_i, with the best prediction from the values before and the standard deviation d_i that
    it leaves, so that A C Aᵀ is the identity for the correlation C of z.
    """

    def matrix(self, values: Mapping[str, np.ndarray]) -> "csr_array":
        """Return A, shape (values, values), lower triangular with the diagonal 1/d, for values of the parameters."""
        ...


@dataclass(frozen=True, eq=False)
class DecayWhitening:
    """Whitening of noise with the correlation exp(−Δt/τ): each value is predicted from the one before."""

    intervals: np.ndarray  # (values − 1,): Δt

    def matrix(self, values: Mapping[str, np.ndarray]) -> "csr_array":
        from scipy.sparse import csr_array, diags_array

        factors = np.exp(-self.intervals / values["time"])
        size = np.sqrt(1 - factors**2)
        diagonal = np.concatenate([np.ones(1, dtype=size.dtype), 1 / size])
        below: Any = [0, -1]
        return csr_array(diags_array([diagonal, -factors / size], offsets=below, shape=(len(diagonal),) * 2))


@dataclass(frozen=True, eq=False)
class GridWhitening:
    """Whitening of an autoregressive process of order m on an even grid, with gaps. A value is predicted from those
    back to the last m places without a gap: what lies before adds nothing. Rows with the same lags to these values
    share one solution of the Yule–Walker equations.
    """

    grid: np.ndarray  # (values,): place of each value
    order: int
    # correlations: ``correlations(values, number)`` returns the autocorrelations at lags of 0 and more places, shape
    # (number,)
    correlations: Callable[[Mapping[str, np.ndarray], int], np.ndarray]

    @cached_property
    def _groups(self) -> Sequence[tuple[np.ndarray, np.ndarray]]:
        """Lags to the values that one is predicted from, nearest first, and the rows that have these."""
        groups: dict[tuple[int, ...], list[int]] = {}
        run, complete = 0, 0  # places without a gap up to a value, and where the last m of them begin
        for row, place in enumerate(self.grid.tolist()):
            begin = max(complete, row - LONGEST)
            groups.setdefault(tuple((place - self.grid[begin:row][::-1]).tolist()), []).append(row)
            run = run + 1 if row and place == self.grid[row - 1] + 1 else 1
            complete = row - self.order + 1 if run >= self.order else complete
        return [(np.array(lags, dtype=int), np.array(rows)) for lags, rows in groups.items()]

    @cached_property
    def _layout(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Order of the entries by row and column, columns and starts of rows."""
        from scipy.sparse import coo_array

        rows = [np.repeat(group_rows, 1 + len(lags)) for lags, group_rows in self._groups]
        columns = [(group_rows[:, None] - np.arange(1 + len(lags))).ravel() for lags, group_rows in self._groups]
        where = np.concatenate(rows), np.concatenate(columns)
        entries = coo_array((np.arange(1.0, 1 + len(where[0])), where), shape=(len(self.grid),) * 2).tocsr()
        return entries.data.astype(int) - 1, entries.indices, entries.indptr

    def matrix(self, values: Mapping[str, np.ndarray]) -> "csr_array":
        from scipy.sparse import csr_array

        most = max((int(lags[-1]) for lags, _ in self._groups if len(lags)), default=0)
        known = self.correlations(values, most + 1)
        entries = [np.tile(_row(known, lags), len(rows)) for lags, rows in self._groups]
        order, columns, starts = self._layout
        return csr_array((np.concatenate(entries)[order], columns, starts), shape=(len(self.grid),) * 2)


def _row(correlations: np.ndarray, lags: np.ndarray) -> np.ndarray:
    """Return 1/d and −a/d, shape (1 + lags,), of the best prediction from values at some lags.

    NaN where these values determine each other, so that the process has no density.
    """
    if not len(lags):
        return np.ones(1, dtype=correlations.dtype)
    here = correlations[lags]
    try:
        weights = np.linalg.solve(correlations[np.abs(lags[:, None] - lags)], here)
    except np.linalg.LinAlgError:
        return np.full(1 + len(lags), np.nan, dtype=correlations.dtype)
    return np.concatenate([[1.0], -weights]) / np.sqrt(1 - weights @ here)


def correlations_of(partials: Sequence[np.ndarray], number: int) -> np.ndarray:
    """Return autocorrelations (number,) of a process with these partial autocorrelations, by Durbin's recursion."""
    row, variance = np.zeros(0), 1.0
    known: list = [1.0]
    for partial in partials:
        known.append(row @ np.array(known[:0:-1]) + partial * variance)
        row, variance = np.append(row - partial * row[::-1], partial), variance * (1 - partial**2)
    while len(known) < number:
        known.append(row @ np.array(known[: -len(row) - 1 : -1]))
    return np.array(known[:number])
