"""A system of components as the arrays of the kernels, and its models in real and in complex numbers."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from dalembert.kernels.kernel import Compiled
from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.kernels.block_table import Blocks, Model, Signals
from dalembert.multibody.kernels.callbacks import Callback, Failures
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.signal_values import evaluators
from dalembert.multibody.model.structure import Structure


@dataclass(frozen=True)
class Lowered:
    """A system as arrays.

    Parameters
    ----------
    structure : Structure
    bodies : mapping of name to BaseBody
    data : mapping of kind to array (count, -)
    signal_data, knots : array
    callbacks : tuple of Callback
    frames : array, shape (bodies, -)
        Initial frame of each body.
    rates : array, shape (bodies, rates)
        Their stated rates, zero where none is stated.
    stated : array of bool, shape (bodies, rates)
        Which rates the bodies state.
    x, v : array, shape (N + 1,)
        First unknowns and velocities, as placed: joints may not be closed yet.
    jumps : tuple of float
        Times, s, at which loads jump; these and those of kinks are measured from the start of the motion.
    changes : frozenset of float
        Those of the jumps at which nothing but the values of held tables changes.
    kinks : tuple of (time, joint)
        Times, s, at which the velocity of a prescribed motion would jump.
    failures : Failures
        What functions of the user's raised.
    parts : mapping of kind to tuple of str
        Name of the component that each row belongs to.
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

    def kernels(self, derivatives: bool) -> list[Compiled]:
        """Kernels of the components that every simulation needs, and those for derivatives along directions."""
        roles = [("residual", float), ("tangent", complex), ("rates", float)]
        roles += [("residual", complex), ("rates", complex)] * derivatives
        own = [kind.kernel(*role) for role in roles for kind in self.data if kind.has(role[0])]
        return [*own, *evaluators(self.structure.signals).values()]

    def model(self, dtype: type, *roles: str) -> Model:
        """The arrays in real or in complex numbers, with the kernels of these roles."""
        numbers = {kind: np.ascontiguousarray(_cast(data, dtype)) for kind, data in self.data.items()}
        address = "complex" if dtype is complex else "real"
        callbacks = np.array([getattr(entry, address) for entry in self.callbacks], dtype=np.int64)
        data = np.ascontiguousarray(_cast(self.signal_data, dtype))
        return Model(
            Blocks(self.structure.index, self.structure.meta, numbers),
            Signals(self.structure.signals, self.knots, data),
            callbacks,
            self.structure.size,
            self.structure.n,
            dtype,
            self.structure.reduction,
            roles or ("residual",),
        )

    @cached_property
    def real(self) -> Model:
        """The model in real numbers."""
        return self.model(float)

    @cached_property
    def complex_model(self) -> Model:
        """The model in complex numbers."""
        return self.model(complex, "residual", "tangent")

    @cached_property
    def unperturbed(self) -> Model:
        """The model in complex numbers without imaginary parts."""
        return self._unperturbed.complex_model if self.is_complex else self.complex_model

    @cached_property
    def tangents(self) -> Model:
        """The model in complex numbers without imaginary parts, for tangents alone."""
        return self._unperturbed.model(complex, "tangent")

    @property
    def _unperturbed(self) -> "Lowered":
        data = {kind: np.real(array) for kind, array in self.data.items()}
        return replace(self, data=data, signal_data=np.real(self.signal_data))


def _cast(array: np.ndarray, dtype: type) -> np.ndarray:
    return np.real(array).astype(float) if dtype is float else array.astype(complex)
