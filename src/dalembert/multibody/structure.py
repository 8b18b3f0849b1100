"""The structure of a model: which unknowns each component couples, and where the entries of its matrices are kept."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import reverse_cuthill_mckee

from dalembert.multibody.kernels.linear import BAND, DENSE, Layout, padded
from dalembert.multibody.kernels.model import KINDS, Slots

_SMALL = 90  # unknowns up to which a kept dense inverse is faster than a kept band factorisation


@dataclass(frozen=True, eq=False)
class Structure:
    """What samples of an ensemble share.

    Parameters
    ----------
    n, size : int
        Coordinates; coordinates and multipliers.
    owners : tuple of str, length size
        Component of each unknown.
    first : mapping of body to its first coordinate
    kinds : tuple of str, length n
        Kind of each coordinate.
    index, meta : mapping of kind to int array (count, -)
    rows : mapping of joint or spring to its kind and row
    signals : int array (signals, 4)
    """

    n: int
    size: int
    owners: tuple[str, ...]
    first: dict[str, int]
    kinds: tuple[str, ...]
    index: dict[str, np.ndarray]
    meta: dict[str, np.ndarray]
    rows: dict[str, tuple[str, int]]
    signals: np.ndarray

    def same(self, other: "Structure") -> bool:
        """Whether the other structure fits the same compiled arrays."""
        return (
            (self.n, self.size, self.owners) == (other.n, other.size, other.owners)
            and np.array_equal(self.signals, other.signals)
            and all(
                np.array_equal(self.index[kind], other.index[kind])
                and np.array_equal(self.meta[kind], other.meta[kind])
                for kind in KINDS
            )
        )

    @cached_property
    def _couplings(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows and columns of all local matrix entries, kind after kind; absent slots give the number ``size``."""
        rows = [np.repeat(index[:, :, None], index.shape[1], axis=2).ravel() for index in self.index.values()]
        columns = [np.repeat(index[:, None, :], index.shape[1], axis=1).ravel() for index in self.index.values()]
        return np.concatenate(rows), np.concatenate(columns)

    def _slots(self, places: np.ndarray) -> Slots:
        """Places of all local entries, cut into (count, width, width) a kind."""
        cuts = np.cumsum([index.shape[0] * index.shape[1] ** 2 for index in self.index.values()])[:-1]
        parts = np.split(places, cuts)
        return Slots(
            *(part.reshape(-1, *2 * index.shape[1:]) for part, index in zip(parts, self.index.values(), strict=True))
        )

    @cached_property
    def coordinate_layout(self) -> tuple[Slots, np.ndarray, np.ndarray]:
        """Slots that give each local entry its own place, with the rows and columns of the places."""
        rows, columns = self._couplings
        return self._slots(np.arange(len(rows))), rows, columns

    @cached_property
    def entries(self) -> tuple[Slots, np.ndarray, np.ndarray]:
        """Slots of a list of the matrix's entries, each once, with their rows and columns."""
        rows, columns = self._couplings
        inside = (rows < self.size) & (columns < self.size)
        numbers, own = np.unique(rows[inside] * self.size + columns[inside], return_inverse=True)
        places = np.zeros(len(rows), dtype=np.int64)  # nothing is written for absent slots
        places[inside] = own
        return self._slots(places), numbers // self.size, numbers % self.size

    @cached_property
    def dense(self) -> tuple[Slots, Layout]:
        """Slots and layout of a dense matrix by columns."""
        rows, columns = self._couplings
        lead = padded(self.size)
        return self._slots(columns * lead + rows), Layout(DENSE, self.size, 0, lead, np.zeros(0, dtype=np.int64))

    @cached_property
    def band(self) -> tuple[Slots, Layout]:
        """Slots and layout of a band matrix after reordering (reverse Cuthill-McKee)."""
        rows, columns = self._couplings
        inside = (rows < self.size) & (columns < self.size)
        pattern = csr_matrix(
            (np.ones(inside.sum(), dtype=np.int8), (rows[inside], columns[inside])), shape=(self.size, self.size)
        )
        order = np.empty(self.size + 1, dtype=np.int64)
        order[reverse_cuthill_mckee(pattern, symmetric_mode=True)] = np.arange(self.size)
        order[self.size] = 0
        i, j = order[rows], order[columns]
        reach = padded(int(np.max(np.abs(i - j)[inside])))
        lead = 3 * reach + 2
        return self._slots(j * lead + 2 * reach + i - j), Layout(BAND, self.size, reach, lead, order[: self.size])

    @property
    def kept(self) -> tuple[Slots, Layout]:
        """Slots and layout for a factorisation that is kept over many solutions."""
        return self.dense if self.size <= _SMALL else self.fresh

    @cached_property
    def fresh(self) -> tuple[Slots, Layout]:
        """Slots and layout for a matrix that is factorised at each step."""
        return self.band if 2 * self.band[1].reach < self.size else self.dense
