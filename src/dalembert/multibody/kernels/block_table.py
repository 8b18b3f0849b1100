"""Models as kernels see them: tables of blocks, made by NumPy, kept alive by Python, known by their address."""

import ctypes
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np

from dalembert.kernels.duals import ENTRIES, Dual
from dalembert.kernels.kernel import BlockKernel
from dalembert.kernels.lanes import Lanes, lane_zeros
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.nodes import CHANGE, RESTORE, SPREAD
from dalembert.multibody.kernels.records import BLOCK, CALL, MODEL
from dalembert.multibody.kernels.reduction import Reduction
from dalembert.multibody.kernels.signal_values import EVALUATORS

MEANS = {"residual": "mean", "energy": "mean_power", "tangent": "mean_tangent"}
"""Roles of the middle of a step, by those that they take the place of."""


@cache
def c_function(address: int) -> Callable[[int, int], None]:
    """The kernel of a block at an address, for calls from Python."""
    return ctypes.CFUNCTYPE(None, ctypes.c_int64, ctypes.c_int64)(address)


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
class BlockModel:
    """A whole model in real numbers, in complex ones as a direction of differentiation, in dual ones with up to eight
    directions, or in lanes of eight samples. ``size``: unknowns; ``coordinates``: unknowns that are no multipliers;
    ``reduction``: rows of the reduced system; ``roles``: kernels that it needs at once; ``averages``: whether residuals
    and powers are those of the middle of a step, for the kinds that have them.
    """

    blocks: Blocks
    signals: Signals
    callbacks: np.ndarray
    size: int
    coordinates: int
    dtype: type
    reduction: Reduction
    roles: tuple[str, ...] = ("residual",)
    averages: bool = False
    _evaluator: BlockKernel = field(init=False, repr=False)
    _words: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray] = field(init=False, repr=False)
    _kernels: list[Any] = field(default_factory=list, init=False, repr=False)  # kept alive

    def __post_init__(self) -> None:
        head, own = np.zeros(1, MODEL), self.reduction
        full = self._table(self.blocks.index, self.blocks.index)
        reduced = self._table(own.index, own.index) if own.nodes else full
        nodes = self._table(own.nodes, own.nodes)
        table = head[0]
        table["blocks"], table["block_count"] = full.ctypes.data, len(self.blocks.index)
        table["reduced"], table["reduced_count"] = reduced.ctypes.data, len(own.index)
        table["nodes"], table["node_count"] = nodes.ctypes.data, len(own.nodes)
        table["rows"] = own.rows.ctypes.data
        table["signal_count"], table["signal_index"] = len(self.signals.index), self.signals.index.ctypes.data
        table["knots"], table["signal_data"] = self.signals.knots.ctypes.data, self.signals.data.ctypes.data
        table["knot_count"], table["number_count"] = len(self.signals.knots), len(self.signals.data)
        table["callbacks"], table["callback_count"] = self.callbacks.ctypes.data, len(self.callbacks)
        if self.dtype is not Lanes:  # whose signals are those of each lane
            evaluator = EVALUATORS[len(self.signals.index) > 1][self.dtype]
            table["evaluate"] = evaluator.address
            object.__setattr__(self, "_evaluator", evaluator)
        object.__setattr__(self, "_words", (head, full, reduced, nodes))
        self.need(*self.roles)

    def _table(self, kinds: Iterable[Kind], rows: Mapping[Kind, np.ndarray]) -> np.ndarray:
        """Blocks of kinds with the rows of their residuals, without kernels."""
        kinds = list(kinds)
        table = np.zeros(max(len(kinds), 1), BLOCK)
        for block, kind in zip(table, kinds, strict=False):
            # Kernels see addresses only: columns that NumPy took by their numbers may stand one behind the other.
            own = (self.blocks.index[kind], rows[kind], self.blocks.integers[kind], self.blocks.numbers[kind])
            assert all(array.flags.c_contiguous for array in own), kind.name
            block["count"], block["joins"] = len(self.blocks.index[kind]), kind.multipliers > 0
            block["index"], block["rows"] = self.blocks.index[kind].ctypes.data, rows[kind].ctypes.data
            block["row_count"] = rows[kind].shape[1]
            block["integers"] = self.blocks.integers[kind].ctypes.data
            block["numbers"] = self.blocks.numbers[kind].ctypes.data
        return table

    def need(self, *roles: str) -> "BlockModel":
        """Load the kernels of these roles, and hand the model back."""
        for block, kind in zip(self._words[1], self.blocks.index, strict=False):
            # Kernels are loaded by role when they are first needed: loading, or even compiling, is most of a cold
            # start.
            for role in kind.roles.intersection(roles):
                if block[role] == 0:
                    mean = MEANS.get(role, "") if self.averages else ""
                    kernel = kind.kernel(mean if kind.has(mean) else role, self.dtype)
                    self._kernels.append(kernel)
                    block[role] = kernel.address
        return self

    def averaged(self, means: bool) -> "BlockModel":
        """Load what a step is computed by that keeps the energy: with ``means`` mean forces, where kinds have them, and
        constraint forces of the middle of the step. Hand the model back.
        """
        head = self._words[0]
        if head["middle"][0] == 0:
            middle = self
            if means:
                roles = (*self.roles, *["energy"] * ("residual" in self.roles))
                middle = replace(self, averages=True, roles=tuple(role for role in MEANS if role in roles))
                self._kernels.append(middle)
            head["middle"] = middle.address
        return self

    def reduced(self, spreads: bool = False) -> "BlockModel":
        """Load the kernels of the reduced system and of its nodes, with those that spread derivatives if wanted."""
        if self.reduction.nodes:
            head = self._words[0]
            for block, kind in zip(self._words[2], self.reduction.index, strict=False):
                for role in self.roles:
                    block[role] = self._load(kind, role, self.dtype)
            # Nodes change in steps, which are of real numbers or in lanes; their derivatives are restored and spread.
            whole = {"change": (CHANGE[self.dtype], self.dtype)} if self.dtype in CHANGE else {}
            whole |= {"spread": (SPREAD, float)} if spreads else {}
            for role, (kernel, dtype) in {**whole, "restore": (RESTORE[self.dtype], self.dtype)}.items():
                head[role] = kernel.address
                for node, kind in zip(self._words[3], self.reduction.nodes, strict=False):
                    node[role] = self._load(kind, role, dtype)
        return self

    def _load(self, kind: Kind, role: str, dtype: type) -> int:
        kernel = kind.kernel(role, dtype)
        self._kernels.append(kernel)
        return kernel.address

    @property
    def address(self) -> int:
        """Address of the table."""
        return self._words[0].ctypes.data

    def block(self, number: int) -> int:
        """Address of a block by its number among the kinds."""
        return self._words[1][number : number + 1].ctypes.data

    def evaluate(self, call: "Call", t: float, within: float) -> None:
        """Evaluate the signals of a call."""
        c_function(self._evaluator.address)(call.set(t=t, within=within).address, self.address)

    def each(self, role: str, call: "Call", slots: np.ndarray | None = None, only: Kind | None = None) -> None:
        """Call the kernels of a role, block by block, or those of one kind."""
        self.need(role)
        for k, (block, kind) in enumerate(zip(self._words[1], self.blocks.index, strict=False)):
            if role in kind.roles and only in (None, kind):
                if slots is not None:
                    call.set(slots=slots[k])
                c_function(int(block[role]))(call.address, self.block(k))

    def call(self) -> "Call":
        """A call in the arithmetic of the model."""
        return Call(self.size, self.coordinates, len(self.signals.index), self.dtype, self.callbacks)


class Call:
    """The record of a call, with room for the signals."""

    def __init__(
        self, size: int, coordinates: int, signals: int, dtype: type, callbacks: np.ndarray | None = None
    ) -> None:
        # One call serves a model in real numbers and its directions in complex ones, so that it has room for both.
        if dtype is Lanes:
            self.signals = lane_zeros(signals, 3)
        elif dtype is Dual:
            self.signals = np.zeros((signals, 3, ENTRIES))
        else:
            self.signals = np.zeros(6 * signals).view(dtype)[: 3 * signals].reshape(signals, 3)
        self._callbacks = np.zeros(1, np.int64) if callbacks is None else callbacks
        self._words = np.zeros(1, CALL)
        own = self._words[0]
        own["last"], own["coordinates"] = own["last_row"], own["increments"] = size, coordinates
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


def addresses(models: Iterable[BlockModel]) -> np.ndarray:
    """Addresses of models, which the caller keeps alive."""
    return np.array([model.address for model in models], dtype=np.int64)
