"""Fourier coefficients of the forces of contacts: plain sums of samples, or corrected at the events between them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np

from dalembert.kernels.blas import gemm
from dalembert.vibration.balance.fourier import Fourier
from dalembert.vibration.laws import event_sums_in_plane as in_plane
from dalembert.vibration.laws.event_sums import sums_and_slopes, sums_complex, sums_real
from dalembert.vibration.laws.friction_law import FRICTION, LOAD, TANGENTIAL
from dalembert.vibration.laws.friction_period import forces, forces_complex, forces_real
from dalembert.vibration.laws.friction_tangent import Tangent, forces_and_slopes, tangent_of
from dalembert.vibration.laws.slip_in_plane import ROWS


class Shape(NamedTuple):
    """What the contacts of a block have in common: numbers of directions, and whether their sliders remember."""

    tangents: int
    normal: bool
    memory: bool

    @property
    def columns(self) -> int:
        return self.tangents + self.normal


class ContactSums(Protocol):
    """Forces of the contacts of a block from their displacements (contacts, columns, coefficients)."""

    def forces(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients of forces, as those of displacements, and states (contacts, samples); complex numbers too."""
        ...

    def with_slopes(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The same, and Jacobians (contacts, columns · coefficients, columns · coefficients)."""
        ...


def contact_sums(numbers: np.ndarray, shape: Shape, series: Fourier, events: bool) -> ContactSums:
    """Return the sums for contacts: corrected ones if asked for, and if their events can be found.

    Parameters
    ----------
    numbers : array, shape (contacts, 5)
        As :mod:`dalembert.vibration.laws.friction_law` takes them.
    shape : Shape
    series : Fourier
    events : bool
    """
    return sums_for(numbers, shape, events)(numbers, shape, series)


def sums_for(numbers: np.ndarray, shape: Shape, events: bool) -> "type[PlainSums | EventSums]":
    """Return the class of the sums for contacts; its ``kernels`` are what they call.

    These are for Jacobians, for forces alone, and for derivatives with respect to parameters.
    """
    if not (events and has_events(numbers, shape)):
        return PlainSums
    return PlaneEventSums if shape.tangents == 2 else EventSums


def has_events(numbers: np.ndarray, shape: Shape) -> bool:
    """Return True if the sums for contacts can be corrected at events.

    In two directions of slip, sliders must have a place and a limit: the force's direction comes from their motion.
    """
    if shape.tangents < 2:
        return True
    real = np.real(numbers)
    limited = (real[:, FRICTION] > 0) & (shape.normal | (real[:, LOAD] > 0))
    return shape.memory and bool(np.all(limited & (real[:, TANGENTIAL] > 0)))


@dataclass(frozen=True)
class PlainSums:
    """Sums of samples. A sample that changes its state makes a kink.

    Parameters
    ----------
    numbers : array, shape (contacts, 5)
    shape : Shape
    series : Fourier
    """

    kernels: ClassVar = (forces_and_slopes, forces_real, forces_complex)

    numbers: np.ndarray
    shape: Shape
    series: Fourier

    def forces(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients of forces, and states; see :class:`ContactSums`."""
        force, states = forces(self._sampled(displacements), self.numbers, *self.shape)
        return _times(force, self.series.analysis), states

    def with_slopes(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of forces, states and Jacobians; see :class:`ContactSums`."""
        force, states, jacobians = self._tangent(self._sampled(displacements))
        return _times(force, self.series.analysis), states, jacobians

    def _sampled(self, displacements: np.ndarray) -> np.ndarray:
        return _times(displacements, self.series.synthesis)

    @cached_property
    def _tangent(self) -> Tangent:
        return tangent_of(self.numbers, *self.shape, self.series.synthesis, self.series.analysis)


@dataclass(frozen=True)
class EventSums:
    """Sums of samples, corrected at the events of :mod:`dalembert.vibration.laws.event_sums`.

    Parameters
    ----------
    numbers : array, shape (contacts, 5)
    shape : Shape
        With one direction of slip, or none.
    series : Fourier
    """

    kernels: ClassVar = (sums_and_slopes, sums_real, sums_complex)

    numbers: np.ndarray
    shape: Shape
    series: Fourier

    def forces(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients of forces, and states; see :class:`ContactSums`."""
        real = displacements.dtype == self.numbers.dtype == float
        dtype, kernel = (float, self.kernels[1]) if real else (complex, self.kernels[2])
        place = np.ascontiguousarray(displacements, dtype)
        results = self._results(place)
        kernel(place, self.numbers.astype(dtype, copy=False), *self._given, *self._room(dtype), *results)
        return self._coefficients(results), results[1]

    def with_slopes(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of forces, states and Jacobians; see :class:`ContactSums`."""
        place = np.ascontiguousarray(displacements)
        contacts, columns, count = place.shape
        unknowns, results = columns * count, self._results(place)
        jacobians = np.empty((contacts, columns, count, unknowns))
        self._call(place, *self._room_for_slopes(columns, unknowns), *results, jacobians)
        return self._coefficients(results), results[1], jacobians.reshape(contacts, unknowns, unknowns)

    @property
    def _given(self) -> tuple[Any, ...]:
        """Arguments that all displacements share: the shape of the contacts, and the series."""
        return *self.shape, *self._waves

    def _room(self, dtype: type) -> tuple[np.ndarray, ...]:
        """Room for the signals' values at samples, the signals with a table of waves, small arrays; no derivatives."""
        return *self._signals(dtype), np.zeros((2, 1, 0), dtype)

    def _room_for_slopes(self, columns: int, unknowns: int) -> tuple[np.ndarray, ...]:
        """The same, and room for the derivatives at samples, of corrections, and of three numbers."""
        shapes = (columns, self.series.samples, unknowns), (columns, self.series.count, unknowns), (3, unknowns)
        return *self._signals(float), *map(np.empty, shapes)

    def _signals(self, dtype: type) -> tuple[np.ndarray, ...]:
        return tuple(np.empty(own, dtype) for own in ((self.series.samples, 3, 3), (8, self.series.count), (3, 5, 3)))

    def _results(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Room for the forces at samples, the states and the corrections."""
        contacts, columns, _ = displacements.shape
        sampled = np.empty((contacts, columns, self.series.samples), displacements.dtype)
        return sampled, np.empty((contacts, self.series.samples), np.uint8), np.empty_like(displacements)

    def _coefficients(self, results: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
        """Coefficients of the forces: the sums of samples, and the corrections as integrals over a period."""
        sampled, _, corrections = results
        return _times(sampled, self.series.analysis) + corrections * self._weights

    @cached_property
    def _call(self) -> Callable[..., None]:
        return self.kernels[0].given(self.numbers, *self._given, self.series.analysis, gemm())

    @cached_property
    def _waves(self) -> tuple[np.ndarray, int, np.ndarray]:
        series = self.series
        return np.array(series.orders, dtype=np.int64), series.mean, series.waves

    @cached_property
    def _weights(self) -> np.ndarray:
        """From integrals over a period to coefficients."""
        weights = np.full(self.series.count, 1 / np.pi)
        weights[: self.series.mean] /= 2
        return weights


@dataclass(frozen=True)
class PlaneEventSums(EventSums):
    """Sums of contacts with two directions of slip, see :mod:`dalembert.vibration.laws.event_sums_in_plane`."""

    kernels: ClassVar = (in_plane.sums_and_slopes, in_plane.sums_real, in_plane.sums_complex)

    @property
    def _given(self) -> tuple[Any, ...]:
        return self.shape.normal, *self._waves

    def _room(self, dtype: type) -> tuple[np.ndarray, ...]:
        """Room for the signals, tables of waves, values and stages, gradients of the slider alone, and vectors."""
        return *self._signals(dtype), np.empty((ROWS, 3), dtype), np.empty((4, 11), dtype), np.empty(11, complex)

    def _room_for_slopes(self, columns: int, unknowns: int) -> tuple[np.ndarray, ...]:
        samples, count, width = self.series.samples, self.series.count, unknowns + 2
        shapes = (columns, samples, width), (columns, count, width), (count, width)
        *signals, few, vectors, seeds = self._room(float)
        return *signals, np.empty((ROWS, width + 1)), few, vectors, seeds, *map(np.empty, shapes)

    def _signals(self, dtype: type) -> tuple[np.ndarray, ...]:
        count = self.series.count
        return tuple(np.empty(own, dtype) for own in ((3, count), (4, 5, count), (7, 5, 3), (7, 3)))


def _times(rows: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Rows (contacts, columns, numbers) times a transposed matrix: one product for several contacts is faster."""
    if len(rows) == 1:
        return rows @ matrix.T
    return (rows.reshape(-1, rows.shape[-1]) @ matrix.T).reshape(*rows.shape[:-1], len(matrix))
