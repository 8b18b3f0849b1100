"""A system of components as the arrays of the kernels, its models in real and in complex numbers, typical sizes."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from dalembert.kernels.kernel import Compiled
from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.laws.friction_law import FORCE, NUMBERS
from dalembert.multibody.kernels.block_table import BlockModel, Blocks, Signals
from dalembert.multibody.kernels.callbacks import Callback, Failures
from dalembert.multibody.kernels.debugging import PLAIN
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.signal_values import EVALUATORS
from dalembert.multibody.model.structure import Structure

_MODELS = ("real", "complex_model", "unperturbed", "tangents")


@dataclass(frozen=True)
class Lowered:
    """A system as arrays. ``data`` (count, -); ``frames`` (bodies, -): initial frame of each body; ``rates``
    (bodies, rates): their stated rates, zero where none is stated; ``stated`` (bodies, rates): which rates the bodies
    state; ``x``, ``v`` (N + 1,): first unknowns and velocities, as placed: joints may not be closed yet; ``jumps``:
    times at which loads jump, s from the start of the motion; ``changes``: those at which nothing but the values of
    held tables changes; ``kinks`` (time, joint): times, from the same start, at which the velocity of a prescribed
    motion would jump; ``failures``: what functions of the user's raised; ``parts``: name of the component of each row.
    """

    structure: Structure
    bodies: dict[str, BaseBody]
    data: dict[Kind, np.ndarray]
    signal_data: np.ndarray
    knots: np.ndarray
    callbacks: tuple[Callback, ...]
    frames: np.ndarray
    rates: np.ndarray
    stated: np.ndarray
    x: np.ndarray
    v: np.ndarray
    jumps: tuple[float, ...]
    changes: frozenset[float]
    kinks: tuple[tuple[float, str], ...]
    failures: Failures = field(compare=False, repr=False)
    parts: dict[Kind, tuple[str, ...]] = field(compare=False, repr=False)

    @property
    def dimension(self) -> int:
        """Number of coordinates of a position: 2 in the plane, 3 in space."""
        return next(iter(self.bodies.values())).dimension

    @property
    def is_complex(self) -> bool:
        return any(np.iscomplexobj(array) for array in (self.x, self.v, self.signal_data, *self.data.values()))

    @property
    def dissipates(self) -> bool:
        """Whether a force of the model may depend on velocities."""
        return any(kind.dissipative(data) for kind, data in self.data.items())

    def kernels(self, derivatives: type | None = None) -> list[Compiled]:
        """Kernels of the components that every simulation needs, and those for ``derivatives`` in that arithmetic."""
        roles = [("residual", float), ("tangent", float if self.in_duals else complex), ("rates", float)]
        roles += [(role, derivatives) for role in ("residual", "rates") if derivatives]
        own = [kind.kernel(*role) for role in roles for kind in self.data if role[0] in kind.roles]
        evaluators = EVALUATORS[len(self.structure.signals) > 1]
        return [*own, *(evaluators[dtype] for dtype in {dtype: None for _, dtype in roles})]

    def model(self, dtype: type, *roles: str) -> BlockModel:
        """The arrays in real or in complex numbers, with the kernels of these roles."""
        numbers = {kind: np.ascontiguousarray(_cast(data, dtype)) for kind, data in self.data.items()}
        return self.model_of(dtype, numbers, np.ascontiguousarray(_cast(self.signal_data, dtype)), *roles)

    def model_of(self, dtype: type, numbers: dict[Kind, np.ndarray], signals: np.ndarray, *roles: str) -> BlockModel:
        """The model with these numbers of components and of signals, in the arithmetic ``dtype``."""
        address = "complex" if dtype is complex else "real"
        callbacks = np.array([getattr(entry, address) for entry in self.callbacks], dtype=np.int64)
        return BlockModel(
            Blocks(self.structure.index, self.structure.meta, numbers),
            Signals(self.structure.signals, self.knots, signals),
            callbacks,
            self.structure.size,
            self.structure.n,
            dtype,
            self.structure.reduction,
            roles or ("residual",),
        )

    @cached_property
    def in_duals(self) -> bool:
        """Whether its components take dual numbers: functions of users, and most kinds of users, take complex ones."""
        return all(kind.takes_duals for kind in self.data) and not self.callbacks and not PLAIN.get()

    @cached_property
    def real(self) -> BlockModel:
        """The model in real numbers, with tangents if it has them in dual numbers."""
        return self.model(float, "residual", *["tangent"] * self.in_duals)

    @cached_property
    def complex_model(self) -> BlockModel:
        """The model in complex numbers."""
        return self.model(complex, "residual")

    @cached_property
    def unperturbed(self) -> BlockModel:
        """The model in complex numbers without imaginary parts."""
        return self._unperturbed.complex_model if self.is_complex else self.complex_model

    @cached_property
    def tangents(self) -> BlockModel:
        """The model with tangents: that in real numbers, or one in complex numbers without imaginary parts."""
        return self.real if self.in_duals else self._unperturbed.model(complex, "tangent")

    def moved(self, **changes: Any) -> "Lowered":
        """The system in another state: ``frames``, ``rates``, ``x`` or ``v``, or in an equal structure."""
        kept = {name: vars(self)[name] for name in _MODELS if name in vars(self)}
        other = replace(self, **changes)
        vars(other).update(kept)
        return other

    @property
    def _unperturbed(self) -> "Lowered":
        data = {kind: np.real(array) for kind, array in self.data.items()}
        return replace(self, data=data, signal_data=np.real(self.signal_data))


def _cast(array: np.ndarray, dtype: type) -> np.ndarray:
    return np.real(array).astype(float) if dtype is float else array.astype(complex)


def scales(lowered: Lowered) -> np.ndarray:
    """Typical size of each unknown, (N + 1,): the mechanism's extent for positions, one for angles and gradients."""
    n, kinds, extent = lowered.structure.n, np.array(lowered.structure.kinds), _extent(lowered)
    scale = np.ones(lowered.structure.size + 1)
    scale[:n][np.isin(kinds, ("position", "displacement"))] = extent
    return scale


def slip_scale(lowered: Lowered) -> float:
    """Smallest rate over which dry friction changes, in parts of the scales, 1/s; infinity without dry friction."""
    least = np.inf
    for kind, data in lowered.data.items():
        if set(NUMBERS) <= set(kind.numbers):
            own = dict(zip(kind.numbers, np.real(data.T), strict=True))
            dry = own["coulomb"] + own["per_reaction"] + own["stribeck"] > 0
            scale = _extent(lowered) if kind.outputs == FORCE else 1.0
            least = min(least, np.min(own["slip"], where=dry, initial=np.inf) / scale)
    return float(least)


def _extent(lowered: Lowered) -> float:
    """Largest distance of positions, or length of a component, m; 1 for a point."""
    n, kinds = lowered.structure.n, np.array(lowered.structure.kinds)
    places = np.real(lowered.x)[:n][kinds == "position"].reshape(-1, lowered.dimension)
    lengths = (np.real(data[:, kind.length_columns]) for kind, data in lowered.data.items())
    extent = max(np.ptp(places, axis=0).max(initial=0.0), *(np.abs(entry).max(initial=0.0) for entry in lengths))
    return float(extent) if extent > 0 else 1.0
