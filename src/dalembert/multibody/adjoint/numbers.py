"""The numbers of a model that parameters change, as one vector, and gradients by them."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.multibody.integrators.generalized_alpha.adjoint_sweep import Pulls
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.pullbacks import PULL, PULL_SIGNALS, SIGNAL_PULL
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.observe import Observer


def numbers_of(lowered: Lowered, observer: Observer) -> np.ndarray:
    """All numbers that a motion and its channels follow from, real or complex, (numbers,)."""
    points = [np.asarray(row.numbers(lowered)) for row in observer.rows if isinstance(row.source, tuple)]
    return np.concatenate([lowered.x, lowered.v, lowered.signal_data, *map(np.ravel, lowered.data.values()), *points])


@dataclass(frozen=True, eq=False)
class NumberGradient:
    """A gradient by all numbers, (numbers,), by parts; ``active`` are those that parameters change, (numbers,).

    Zero where a number is not active.
    """

    lowered: Lowered
    observer: Observer
    active: np.ndarray

    @cached_property
    def whole(self) -> np.ndarray:
        """The gradient in the order of :func:`numbers_of`."""
        return np.zeros(len(self.active))

    @cached_property
    def _ends(self) -> list[int]:
        own = self.lowered
        sizes = [len(own.x), len(own.v), len(own.signal_data), *(data.size for data in own.data.values())]
        points = [len(row.numbers(own)) for row in self.observer.rows if isinstance(row.source, tuple)]
        return [0, *np.cumsum([*sizes, *points]).tolist()]

    def _part(self, vector: np.ndarray, number: int) -> np.ndarray:
        return vector[self._ends[number] : self._ends[number + 1]]

    @property
    def x(self) -> np.ndarray:
        """By the initial unknowns, (N + 1,)."""
        return self._part(self.whole, 0)

    @property
    def v(self) -> np.ndarray:
        """By the initial velocities, (N + 1,)."""
        return self._part(self.whole, 1)

    @property
    def signals(self) -> np.ndarray:
        """By the data of signals."""
        return self._part(self.whole, 2)

    def kind(self, kind: Kind) -> np.ndarray:
        """By the numbers of the components of a kind, (count, -)."""
        return self._part(self.whole, self._number(kind)).reshape(self.lowered.data[kind].shape)

    def point(self, row: int) -> np.ndarray:
        """By the numbers of the point that a row of the observer reads."""
        return self._part(self.whole, self._point(row))

    def active_kind(self, kind: Kind) -> np.ndarray:
        """Which numbers of the components of a kind are active, (count, -)."""
        return self._part(self.active, self._number(kind)).reshape(self.lowered.data[kind].shape)

    def active_point(self, row: int) -> np.ndarray:
        """Which numbers of the point that a row of the observer reads are active."""
        return self._part(self.active, self._point(row))

    @cached_property
    def active_signals(self) -> np.ndarray:
        """Signals any of whose numbers are active."""
        active = self._part(self.active, 2)
        index = self.lowered.structure.signals
        return np.array([s for s, (_, first, count, _) in enumerate(index) if active[first : first + count].any()], int)

    def _number(self, kind: Kind) -> int:
        return 3 + list(self.lowered.data).index(kind)

    def _point(self, row: int) -> int:
        before = sum(isinstance(entry.source, tuple) for entry in self.observer.rows[:row])
        return 3 + len(self.lowered.data) + before


class NumberPulls:
    """What the sweep needs to collect the gradient by a model's active numbers; :meth:`collect` adds it up."""

    def __init__(self, gradient: NumberGradient, model: BlockModel) -> None:
        self._gradient = gradient
        self._kept: list[np.ndarray] = []
        lowered, signals = gradient.lowered, gradient.active_signals
        self.bars = np.zeros((len(lowered.structure.signals), 3))
        self._parts: dict[Kind, tuple[np.ndarray, np.ndarray]] = {}
        blocks = []
        for number, kind in enumerate(lowered.data):
            columns = np.ascontiguousarray(np.argwhere(gradient.active_kind(kind)))
            reads = readers(lowered.structure.meta[kind] if kind.integers else None, signals)
            if len(columns) + len(reads) and "pullback" in kind.roles:
                own = np.zeros(len(columns))
                self._parts[kind] = columns, own
                record = self._record(
                    PULL, columns=columns, column_count=len(columns), gradient=own, reads=reads, read_count=len(reads),
                    bars=self.bars,
                )  # fmt: skip
                blocks.append((model.block(number), kind.kernel("pullback", complex).address, record))
        self._signal_gradient = np.zeros(len(lowered.signal_data))
        table = np.array(blocks, dtype=np.int64).reshape(len(blocks), 3)
        record = self._record(
            SIGNAL_PULL, model=model.address, signals=signals, signal_count=len(signals),
            gradient=self._signal_gradient, bars=self.bars,
        )  # fmt: skip
        self.pulls = Pulls(table, PULL_SIGNALS.address if len(signals) else 0, record, self.bars)

    def _record(self, dtype: np.dtype, **fields: np.ndarray | int) -> int:
        record = np.zeros(1, dtype)
        self._kept.append(record)
        for name, value in fields.items():
            if isinstance(value, np.ndarray):
                assert value.flags.c_contiguous, name
                self._kept.append(value)
                value = value.ctypes.data
            record[name] = value
        return record.ctypes.data

    def collect(self) -> None:
        """Add what was collected to the gradient."""
        for kind, (columns, own) in self._parts.items():
            self._gradient.kind(kind)[*columns.T] += own
        self._gradient.signals[:] += self._signal_gradient


def readers(integers: np.ndarray | None, signals: np.ndarray) -> np.ndarray:
    """Components that may read one of the signals, with the signal, (-, 2): numbers of signals are among integers."""
    if integers is None or not len(signals):
        return np.zeros((0, 2), np.int64)
    rows = [(e, s) for e, own in enumerate(integers) for s in np.intersect1d(own, signals)]
    return np.array(rows, np.int64).reshape(len(rows), 2)


def kernels_of(kinds: Mapping[Kind, np.ndarray]) -> list:
    """Kernels that collect gradients by the numbers of these kinds."""
    return [kind.kernel("pullback", complex) for kind in kinds if "pullback" in kind.roles] + [PULL_SIGNALS]
