"""Which rows and columns of a matrix each component couples, and where the entries are kept."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import reverse_cuthill_mckee

from dalembert.kernels.kernel import Compiled
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.linear import BAND_KERNELS, DENSE_KERNELS, Layout, band_layout, dense_layout, padded

_SMALL = 56  # unknowns up to which a kept dense inverse is at least as fast as a kept band factorisation


@dataclass(frozen=True, eq=False)
class Couplings:
    """The matrix of a system of equations.

    ``index`` (count, width): rows of each component; ``size`` where it has none; ``size``: of the matrix.
    """

    index: Mapping[Kind, np.ndarray]
    size: int
    _kept_alive: list[np.ndarray] = field(default_factory=list, init=False, repr=False)

    @cached_property
    def _pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows and columns of all local matrix entries, kind after kind; absent slots give the number ``size``."""
        rows = [np.repeat(index[:, :, None], index.shape[1], axis=2).ravel() for index in self.index.values()]
        columns = [np.repeat(index[:, None, :], index.shape[1], axis=1).ravel() for index in self.index.values()]
        return np.concatenate(rows), np.concatenate(columns)

    def _slots(self, places: np.ndarray) -> np.ndarray:
        """Addresses of the positions of all local entries, those of each block (count, width, width); kept alive."""
        places = np.ascontiguousarray(places)
        self._kept_alive.append(places)
        counts = [index.shape[0] * index.shape[1] ** 2 for index in self.index.values()]
        return places.ctypes.data + 8 * np.cumsum([0, *counts], dtype=np.int64)[: len(counts)]

    @cached_property
    def separate(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Slots that give each local entry its own place, with the rows and columns of the places."""
        rows, columns = self._pairs
        return self._slots(np.arange(len(rows))), rows, columns

    @cached_property
    def entries(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Slots of a list of the matrix's entries, each once, with their rows and columns."""
        rows, columns = self._pairs
        inside = (rows < self.size) & (columns < self.size)
        numbers, own = np.unique(rows[inside] * self.size + columns[inside], return_inverse=True)
        places = np.zeros(len(rows), dtype=np.int64)  # nothing is written for absent slots
        places[inside] = own
        return self._slots(places), numbers // self.size, numbers % self.size

    def places(self, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Places of entries in the matrix that is factorised at each step."""
        layout = self.fresh[1]
        if not self._is_banded:
            return columns * layout.lead + rows
        i, j = (self._reordered[0][own] for own in (rows, columns))
        return j * layout.lead + 2 * layout.reach + i - j

    @cached_property
    def dense(self) -> tuple[np.ndarray, Layout]:
        """Slots and layout of a dense matrix by columns."""
        rows, columns = self._pairs
        lead = padded(self.size)
        return self._slots(columns * lead + rows), dense_layout(self.size)

    @cached_property
    def _reordered(self) -> tuple[np.ndarray, int]:
        """Positions of unknowns and of the absent one in a band (reverse Cuthill-McKee), and the reach of the band."""
        rows, columns = self._pairs
        inside = (rows < self.size) & (columns < self.size)
        pattern = csr_matrix(
            (np.ones(inside.sum(), dtype=np.int8), (rows[inside], columns[inside])), shape=(self.size, self.size)
        )
        order = np.zeros(self.size + 1, dtype=np.int64)
        order[reverse_cuthill_mckee(pattern, symmetric_mode=True)] = np.arange(self.size)
        return order, padded(int(np.max(np.abs(order[rows] - order[columns])[inside])))

    @cached_property
    def band(self) -> tuple[np.ndarray, Layout]:
        """Slots and layout of a band matrix after reordering."""
        rows, columns = self._pairs
        order, reach = self._reordered
        i, j, layout = order[rows], order[columns], band_layout(order[: self.size], reach)
        return self._slots(j * layout.lead + 2 * reach + i - j), layout

    @property
    def _is_banded(self) -> bool:
        return 2 * self._reordered[1] < self.size

    @property
    def linear_kernels(self) -> list[Compiled]:
        """Kernels of the linear systems of both layouts."""
        dense = self.size <= _SMALL or not self._is_banded
        return [*DENSE_KERNELS * dense, *BAND_KERNELS * self._is_banded]

    @property
    def kept(self) -> tuple[np.ndarray, Layout]:
        """Slots and layout for a factorisation that is kept over many solutions."""
        return self.dense if self.size <= _SMALL else self.fresh

    @cached_property
    def fresh(self) -> tuple[np.ndarray, Layout]:
        """Slots and layout for a matrix that is factorised at each step."""
        return self.band if self._is_banded else self.dense
