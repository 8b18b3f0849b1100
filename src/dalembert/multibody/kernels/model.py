"""Models as kernels see them: tables of blocks, made by NumPy, kept alive by Python, known by their address."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.records import BLOCK, CALL, MODEL
from dalembert.multibody.kernels.signals import EVALUATE

#: Fields of a block that hold kernels, which are compiled when they are first needed.
ROLES = ("residual", "rates", "energy", "outputs")


@dataclass(frozen=True)
class Blocks:
    """Components of each kind: unknowns (count, width), integers (count, -), numbers (count, -)."""

    index: Mapping[Kind, np.ndarray]
    integers: Mapping[Kind, np.ndarray]
    numbers: Mapping[Kind, np.ndarray]


@dataclass(frozen=True)
class Signals:
    """Functions of time, see :mod:`signals`."""

    index: np.ndarray
    knots: np.ndarray
    data: np.ndarray


@dataclass(frozen=True, eq=False)
class Model:
    """A whole model in real numbers, or in complex ones as a direction of differentiation.

    Parameters
    ----------
    blocks : Blocks
    signals : Signals
    callbacks : int array
    size : int
        Unknowns.
    coordinates : int
        Unknowns that are no multipliers.
    dtype : float or complex
    """

    blocks: Blocks
    signals: Signals
    callbacks: np.ndarray
    size: int
    coordinates: int
    dtype: type
    _words: tuple[np.ndarray, np.ndarray] = field(init=False, repr=False)
    _kernels: list[Any] = field(default_factory=list, init=False, repr=False)  # kept alive

    def __post_init__(self) -> None:
        kinds = list(self.blocks.index)
        rows, head = np.zeros(max(len(kinds), 1), BLOCK), np.zeros(1, MODEL)
        for row, kind in zip(rows, kinds, strict=False):
            row["count"] = len(self.blocks.index[kind])
            row["index"] = self.blocks.index[kind].ctypes.data
            row["integers"] = self.blocks.integers[kind].ctypes.data
            row["numbers"] = self.blocks.numbers[kind].ctypes.data
            row["joins"] = kind.multipliers > 0
        own = head[0]
        own["blocks"], own["block_count"] = rows.ctypes.data, len(kinds)
        own["signal_count"], own["signal_index"] = len(self.signals.index), self.signals.index.ctypes.data
        own["knots"], own["signal_data"] = self.signals.knots.ctypes.data, self.signals.data.ctypes.data
        own["knot_count"], own["number_count"] = len(self.signals.knots), len(self.signals.data)
        own["callbacks"], own["callback_count"] = self.callbacks.ctypes.data, len(self.callbacks)
        own["evaluate"] = EVALUATE[self.dtype].address
        object.__setattr__(self, "_words", (head, rows))
        self.need("residual")

    def need(self, *roles: str) -> "Model":
        """Load the kernels of these roles, and hand the model back."""
        for row, kind in zip(self._words[1], self.blocks.index, strict=False):
            for role in roles:
                if row[role] == 0 and kind.has(role):
                    kernel = kind.kernel(role, self.dtype)
                    self._kernels.append(kernel)
                    row[role] = kernel.address
        return self

    @property
    def address(self) -> int:
        """Address of the table."""
        return self._words[0].ctypes.data

    def evaluate(self, call: "Call", t: float, within: float) -> None:
        """Evaluate the signals of a call."""
        EVALUATE[self.dtype](call.set(t=t, within=within).address, self.address)

    def each(self, role: str, call: "Call", slots: np.ndarray | None = None) -> None:
        """Call the kernels of a role, block by block."""
        self.need(role)
        for k, kind in enumerate(self.blocks.index):
            if kind.has(role):
                if slots is not None:
                    call.set(slots=slots[k])
                kernel: Any = kind.kernel(role, self.dtype)
                kernel(call.address, self._words[1][k : k + 1].ctypes.data)

    def call(self) -> "Call":
        """A call in the arithmetic of the model."""
        return Call(self.size, self.coordinates, len(self.signals.index), self.dtype, self.callbacks)


class Call:
    """The record of a call, with room for the signals."""

    def __init__(
        self, size: int, coordinates: int, signals: int, dtype: type, callbacks: np.ndarray | None = None
    ) -> None:
        self.signals = np.zeros((signals, 3), dtype)
        self._callbacks = np.zeros(1, np.int64) if callbacks is None else callbacks
        self._words = np.zeros(1, CALL)
        own = self._words[0]
        own["last"], own["coordinates"] = size, coordinates
        own["signals"], own["signal_count"] = self.signals.ctypes.data, signals
        own["callbacks"], own["callback_count"] = self._callbacks.ctypes.data, len(self._callbacks)

    @property
    def address(self) -> int:
        return self._words.ctypes.data

    def set(self, **fields: Any) -> "Call":
        """Write fields of the record; contiguous arrays by their addresses."""
        for name, value in fields.items():
            if isinstance(value, np.ndarray):
                assert value.flags.c_contiguous, name
                value = value.ctypes.data
            self._words[name][0] = value
        return self


def addresses(models: Iterable[Model]) -> np.ndarray:
    """Addresses of models, which the caller keeps alive."""
    return np.array([model.address for model in models], dtype=np.int64)
