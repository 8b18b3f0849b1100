"""Channels by name: what can be read off a motion."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dalembert.errors import InputError, unknown
from dalembert.forward import Channel
from dalembert.multibody.kernels import joints as kernel
from dalembert.multibody.kernels import markers
from dalembert.multibody.kernels import observe as codes
from dalembert.multibody.kernels.compiled import compiled
from dalembert.multibody.kernels.model import Model, workspace
from dalembert.multibody.lowering import Lowered
from dalembert.multibody.system import System

_OF_POINT = {
    "x": (codes.X, "m"), "y": (codes.Y, "m"), "angle": (codes.ANGLE, "rad"),
    "vx": (codes.VX, "m/s"), "vy": (codes.VY, "m/s"), "rate": (codes.RATE, "rad/s"),
    "ax": (codes.AX, "m/s**2"), "ay": (codes.AY, "m/s**2"), "acceleration": (codes.ACCELERATION, "rad/s**2"),
}  # fmt: skip
_OF_JOINT = {
    "angle": (codes.ANGLE, "rad"), "rate": (codes.RATE, "rad/s"),
    "force_x": (codes.FORCE_X, "N"), "force_y": (codes.FORCE_Y, "N"), "torque": (codes.TORQUE, "N*m"),
}  # fmt: skip
_OF_SPRING = {"elongation": (codes.STRETCH, "m"), "force": (codes.TENSION, "N")}
_OF_SYSTEM = {
    "kinetic_energy": (codes.KINETIC, "J"), "potential_energy": (codes.POTENTIAL, "J"),
    "total_energy": (codes.TOTAL, "J"),
}  # fmt: skip
_DATA = 11
_META = 5
_Source = tuple[str, int] | tuple[str, str] | None


@dataclass(frozen=True)
class Observer:
    """Compiled channels of a structure; the rows of joints and springs are read from each sample's own arrays.

    Parameters
    ----------
    channels : tuple of Channel
    quantities : int array (channels,)
    index, meta : int array (channels, -)
    sources : tuple of (kind, row), (body, point) or None
        Where a channel finds its numbers in a sample.
    turning : array of bool (channels,)
        Angles that are known up to whole turns and made continuous.
    """

    channels: tuple[Channel, ...]
    quantities: np.ndarray
    index: np.ndarray
    meta: np.ndarray
    sources: tuple[_Source, ...]
    turning: np.ndarray

    def read(self, lowered: Lowered, model: Model, x: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Values (samples, channels) from states (samples, N + 1), real or complex."""
        data = np.zeros((len(self.channels), _DATA), dtype=x.dtype)
        for row, source in enumerate(self.sources):
            if source is not None:
                kind, place = source
                if isinstance(place, int):
                    own, first = lowered.data[kind][place][:_DATA], 0
                else:
                    own, first = np.array(lowered.bodies[kind].marker(place).data), 3
                data[row, first : first + len(own)] = own if np.iscomplexobj(x) else np.real(own)
        out = np.empty((len(x), len(self.channels)), dtype=x.dtype)
        _observe(model, self.quantities, self.index, self.meta, data, x, v, a, out)
        for column in np.flatnonzero(self.turning):
            angles = np.real(out[:, column])
            out[:, column] += np.unwrap(angles) - angles
        return out


@compiled
def _observe(model, quantities, index, meta, data, x, v, a, out):
    codes.observe(model, quantities, index, meta, data, x, v, a, workspace(model), out)


class _Row(NamedTuple):
    quantity: int
    unit: str
    index: list[int]
    meta: list[int]
    source: _Source


def observer(system: System, lowered: Lowered, names: list[str] | tuple[str, ...]) -> Observer:
    """Channels by name.

    Raises
    ------
    InputError
        For an unknown name, with the nearest ones.
    """
    rows = [_row(system, lowered, name) for name in names]
    return Observer(
        channels=tuple(Channel(name, row.unit) for name, row in zip(names, rows, strict=True)),
        quantities=np.array([row.quantity for row in rows], dtype=np.int64),
        index=np.array([row.index for row in rows], dtype=np.int64).reshape(-1, kernel.WIDTH),
        meta=np.array([row.meta for row in rows], dtype=np.int64).reshape(-1, _META),
        sources=tuple(row.source for row in rows),
        turning=np.array([row.quantity == codes.ANGLE and markers.NODE in row.meta[1:3] for row in rows], dtype=bool),
    )


def channel_names(system: System) -> tuple[str, ...]:
    """All channels that a system offers."""
    names = []
    for body in system.bodies:
        names += [
            f"{body.name}.{point}.{entry}" for point in body.point_names for entry in _point_quantities(body.turns)
        ]
    names += [f"{joint.name}.{entry}" for joint in system.joints for entry in _OF_JOINT]
    names += [f"{load.name}.{entry}" for load in system.loads if hasattr(load, "stiffness") for entry in _OF_SPRING]
    return (*names, *(f"system.{entry}" for entry in _OF_SYSTEM))


def _point_quantities(turns: bool) -> list[str]:
    return [
        name
        for name, (code, _) in _OF_POINT.items()
        if turns or code not in (codes.ANGLE, codes.RATE, codes.ACCELERATION)
    ]


def _row(system: System, lowered: Lowered, name: str) -> _Row:
    structure = lowered.structure
    owner, _, entry = name.rpartition(".")
    nothing = [structure.size] * kernel.WIDTH
    if owner == "system" and entry in _OF_SYSTEM:
        return _Row(*_OF_SYSTEM[entry], nothing, [0] * _META, None)
    if owner in structure.rows:
        kind, row = structure.rows[owner]
        known = _OF_JOINT if kind == "joints" else _OF_SPRING
        if entry in known:
            index = structure.index[kind][row].tolist()
            meta = structure.meta[kind][row].tolist()
            index = index + nothing[len(index) :]
            return _Row(*known[entry], index, meta, (kind, row))
    body_name, _, point = owner.rpartition(".")
    for body in system.bodies:
        if body.name == body_name and point in body.point_names and entry in _point_quantities(body.turns):
            marker = body.marker(point)
            first = structure.first[body.name]
            slots = [structure.size if k is None else first + k for k in marker.slots]
            index = [*nothing[:4], *slots, *nothing[8:]]
            return _Row(*_OF_POINT[entry], index, [0, markers.GROUND, marker.kind, 0, 0], (body.name, point))
    raise InputError(unknown("channel", name, channel_names(system)))
