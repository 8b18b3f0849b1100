"""Channels by name: what can be read off a motion."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from dalembert.errors import InputError, unknown
from dalembert.forward import Channel
from dalembert.kernels.kernel import Compiled
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.histories import outputs_history
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.records import BLOCK
from dalembert.multibody.model.evaluate import energies, energy_kernels
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.model.turns import CountedAngle, turn_kernels

_OF_SYSTEM = {"kinetic_energy": (1.0, 0.0), "potential_energy": (0.0, 1.0), "total_energy": (1.0, 1.0)}

_NO_TURNS: Mapping[CountedAngle, np.ndarray] = {}


@dataclass(frozen=True)
class _Row:
    """A channel: the ``output`` of a component or point of a ``kind``, or weights of both energies of the system.

    ``source``: the component's row in the structure, or the body and point whose marker is read.
    """

    unit: str
    kind: Kind | None = None
    output: int = 0
    index: tuple[int, ...] = ()
    integers: tuple[int, ...] = ()
    source: int | tuple[str, str] = 0
    weights: tuple[float, float] = (0.0, 0.0)

    @cached_property
    def angle(self) -> CountedAngle | None:
        """The angle that it is, if it is one that is known up to whole turns."""
        if self.kind is None or self.output not in self.kind.turning(self.integers):
            return None
        return CountedAngle(self.kind, self.source, self.output)

    def numbers(self, lowered: Lowered) -> np.ndarray:
        """The numbers of the component in a sample."""
        if isinstance(self.source, tuple):
            body, point = self.source
            return np.array(lowered.bodies[body].point_numbers(point))
        assert self.kind is not None
        return lowered.data[self.kind][self.source]


@dataclass(frozen=True)
class Observer:
    """Channels of a structure; the numbers of components are read from each sample's arrays."""

    channels: tuple[Channel, ...]
    rows: tuple[_Row, ...]

    def kernels(self, lowered: Lowered, derivatives: bool) -> list[Compiled]:
        """Kernels that read the channels, and those that differentiate them."""
        kinds, types = dict.fromkeys(row.kind for row in self.rows), (float, complex)[: 1 + derivatives]
        own = [kind.kernel("outputs", dtype) for dtype in types for kind in kinds if kind is not None]
        energies_too = energy_kernels(lowered, derivatives) if None in kinds else []
        return [*[outputs_history] * bool(own), *own, *energies_too, *turn_kernels(self.counted)]

    @cached_property
    def counted(self) -> tuple[CountedAngle, ...]:
        """Angles among the channels that are known up to whole turns."""
        return tuple(dict.fromkeys(row.angle for row in self.rows if row.angle))

    @property
    def turning(self) -> list[int]:
        """The first channel of each of these angles."""
        angles = [row.angle for row in self.rows]
        return [angles.index(angle) for angle in self.counted]

    def read(
        self, lowered: Lowered, model: BlockModel, states: Sequence[np.ndarray], times: np.ndarray,
        turns: Mapping[CountedAngle, np.ndarray] = _NO_TURNS,
    ) -> np.ndarray:  # fmt: skip
        """Values (samples, channels) from states x, v and a (samples, N + 1), real or complex, at times in s.

        ``turns`` (samples,) of angles are whole turns that the integration counted.
        """
        x, v, a = map(np.ascontiguousarray, states[:3])
        out = np.empty((len(x), len(self.channels)), dtype=x.dtype)
        for kind in dict.fromkeys(row.kind for row in self.rows):
            columns = [column for column, row in enumerate(self.rows) if row.kind is kind]
            if kind is None:
                still = np.zeros(len(x))
                weights = np.array([self.rows[column].weights for column in columns])
                out[:, columns] = energies(model, x, v, still, still)[:, :2] @ weights.T
            else:
                rows = [self.rows[column] for column in columns]
                numbers = np.array([row.numbers(lowered) for row in rows])
                numbers = np.ascontiguousarray(numbers if model.dtype is complex else np.real(numbers), model.dtype)
                block = OutputBlock(kind, *columns_of(rows), numbers)
                values = block.read(model, (x, v, a), times if kind.observes_inputs else times[:0])
                for place, column in enumerate(columns):
                    row = self.rows[column]
                    out[:, column] = values[:, place, row.output]
                    if (angle := row.angle) is not None and angle in turns:
                        out[:, column] += 2.0 * np.pi * turns[angle]
        return out


def columns_of(rows: Sequence[_Row]) -> tuple[np.ndarray, np.ndarray]:
    """Unknowns (rows, width) and integers (rows, -) of channels of one kind."""
    index = np.array([row.index for row in rows], dtype=np.int64)
    return index, np.array([row.integers or (0,) for row in rows], dtype=np.int64)


class OutputBlock:
    """Components of one kind whose outputs are read: unknowns (count, width), integers and numbers (count, -)."""

    def __init__(self, kind: Kind, index: np.ndarray, integers: np.ndarray, numbers: np.ndarray) -> None:
        self.kind, self._arrays = kind, (index, integers, numbers)
        self.kernel: Any = kind.kernel("outputs", complex if np.iscomplexobj(numbers) else float)
        block = self._words = np.zeros(1, BLOCK)
        block["count"], block["index"], block["integers"] = len(index), index.ctypes.data, integers.ctypes.data
        block["numbers"], block["outputs"] = numbers.ctypes.data, self.kernel.address

    @property
    def address(self) -> int:
        """Address of the block."""
        return self._words.ctypes.data

    def read(self, model: BlockModel, states: Sequence[np.ndarray], stamps: np.ndarray) -> np.ndarray:
        """Outputs (samples, components, outputs) of contiguous states (samples, -); without stamps no signals."""
        x, places = states[0], [array.ctypes.data for array in states]
        own, stamps = self.address, np.ascontiguousarray(stamps, dtype=float)
        call = model.call().set(last=x.shape[1] - 1)
        out = np.zeros((len(x), len(self._arrays[0]), len(self.kind.outputs)), dtype=x.dtype)
        outputs_history(
            model.address, call.address, own, *places, x.strides[0], stamps, beside(stamps, -1),
            out.ctypes.data, out.strides[0], len(x),
        )  # fmt: skip
        return out


def beside(times: np.ndarray, side: int) -> np.ndarray:
    """Times a little before (-1) or after (1) the given ones: on which side of a jump of a load they stand."""
    return np.maximum(times + side * 1e-9 * times[-1], 0.0) if len(times) else times


def observer(system: BaseSystem, lowered: Lowered, names: Sequence[str]) -> Observer:
    """Channels by name."""
    rows = tuple(_row(system, lowered, name) for name in names)
    return Observer(tuple(Channel(name, row.unit) for name, row in zip(names, rows, strict=True)), rows)


def channel_units(system: BaseSystem) -> dict[str, str]:
    """All channels that a system offers, with their units."""
    units = dict.fromkeys((f"system.{entry}" for entry in _OF_SYSTEM), "J")
    of_components = {
        f"{component.name}.{entry}": unit
        for component in (*system.joints, *system.loads)
        for entry, unit in component.kind.outputs
    }
    of_parts = {
        f"{joint.name}.{part}.{entry}": unit
        for joint in system.joints
        for part, kind in joint.parts.items()
        for entry, unit in kind.outputs
    }
    of_points = {
        f"{body.name}.{point}.{entry}": unit
        for body in system.bodies
        for point in body.point_names
        for entry, unit in body.point_outputs
    }
    return {**of_points, **of_components, **of_parts, **units}


def channel_names(system: BaseSystem) -> tuple[str, ...]:
    """All channels that a system offers."""
    return tuple(channel_units(system))


def _row(system: BaseSystem, lowered: Lowered, name: str) -> _Row:
    structure = lowered.structure
    owner, _, entry = name.rpartition(".")
    if owner == "system" and entry in _OF_SYSTEM:
        return _Row("J", weights=_OF_SYSTEM[entry])
    if owner in structure.rows:
        kind, row = structure.rows[owner]
        index, integers = structure.index[kind][row], structure.meta[kind][row]
        for output, (known, unit) in enumerate(kind.outputs):
            if known == entry:
                return _Row(unit, kind, output, tuple(index.tolist()), tuple(integers.tolist()), row)
    body_name, _, point = owner.rpartition(".")
    for body in system.bodies:
        units = dict(body.point_outputs)
        if body.name == body_name and point in body.point_names and entry in units:
            index, integers = body.point_index(point, structure.first[body.name], structure.size)
            output = [known for known, _ in body.sensor.outputs].index(entry)
            return _Row(units[entry], body.sensor, output, index, integers, (body_name, point))
    raise InputError(unknown("channel", name, channel_names(system)))
