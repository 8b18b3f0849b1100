"""Fourier coefficients of the forces of contacts: plain sums of samples, or corrected at the events between them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from dalembert.kernels.blas import gemm
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.laws import event_sums_in_plane as in_plane
from dalembert.vibration.laws.event_sums import sums_and_slopes, sums_complex, sums_real
from dalembert.vibration.laws.friction_law import FRICTION, LOAD, TANGENTIAL
from dalembert.vibration.laws.friction_period import forces_complex, forces_real
from dalembert.vibration.laws.friction_tangent import forces_and_slopes
from dalembert.vibration.laws.slip_in_plane import ROWS


class Shape(NamedTuple):
    """What the contacts of a block have in common: numbers of directions, and whether their sliders remember."""

    tangents: int
    normal: bool
    memory: bool

    @property
    def columns(self) -> int:
        return self.tangents + self.normal


def contact_sums(numbers: np.ndarray, shape: Shape, series: Fourier, events: bool) -> "ContactSums":
    """Return the sums for contacts: corrected ones if asked for, and if their events can be found.

    ``numbers`` (contacts, 5): as :mod:`dalembert.vibration.laws.friction_law` takes them.
    """
    return sums_for(numbers, shape, events)(numbers, shape, series)


def sums_for(numbers: np.ndarray, shape: Shape, events: bool) -> "type[PlainSums | EventSums]":
    """Return the class of the sums for contacts; its ``kernels`` are what they call."""
    if not events or shape.tangents < 2:
        return EventSums if events else PlainSums
    # In two directions the force's direction comes from the motion of sliders, which must have a place and a limit.
    real = np.real(numbers)
    limited = (real[:, FRICTION] > 0) & (shape.normal | (real[:, LOAD] > 0)) & (real[:, TANGENTIAL] > 0)
    return PlaneEventSums if shape.memory and np.all(limited) else PlainSums


@dataclass(frozen=True)
class _Sums:
    """Forces of the contacts of a block, with ``numbers`` (contacts, 5), from their displacements
    (contacts, columns, coefficients). ``forces`` returns coefficients of forces, as those of displacements, and states
    (contacts, samples); complex numbers too. ``with_slopes`` returns the same, and Jacobians (contacts, columns ·
    coefficients, columns · coefficients).
    """

    kernels: ClassVar[tuple[Any, Any, Any]]

    numbers: np.ndarray
    shape: Shape
    series: Fourier

    def _forces_in(self, displacements: np.ndarray) -> tuple[Any, np.ndarray, np.ndarray]:
        """The kernel of forces alone, displacements and numbers; complex where one of them is."""
        if displacements.dtype == self.numbers.dtype == float:
            return self.kernels[1], np.ascontiguousarray(displacements), self.numbers
        return self.kernels[2], np.ascontiguousarray(displacements, complex), self.numbers.astype(complex, copy=False)


@dataclass(frozen=True)
class PlainSums(_Sums):
    """Sums of samples. A sample that changes its state makes a kink."""

    kernels = (forces_and_slopes, forces_real, forces_complex)

    def forces(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients of forces, and states; see :class:`ContactSums`."""
        force, states = self.at_samples(_times(displacements, self.series.synthesis))
        return _times(force, self.series.analysis), states

    def with_slopes(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of forces, states and Jacobians; see :class:`ContactSums`."""
        force, states, jacobians = self.tangent(_times(displacements, self.series.synthesis))
        return _times(force, self.series.analysis), states, jacobians

    def at_samples(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Forces like displacements (contacts, columns, samples), and states (contacts, samples).

        Normal forces are N - N0. Forces are complex where displacements or numbers are.
        """
        kernel, displacements, numbers = self._forces_in(displacements)
        result, states = np.empty_like(displacements), np.empty(displacements.shape[::2], dtype=np.uint8)
        kernel(displacements, numbers, *self.shape, result, states)
        return result, states

    def tangent(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forces and states as :meth:`at_samples`, and Jacobians of the coefficients as :meth:`with_slopes`."""
        (contacts, columns, samples), count, tangents = displacements.shape, self.series.count, self.shape.tangents
        unknowns = columns * count
        result, states = np.empty_like(displacements), np.empty((contacts, samples), dtype=np.uint8)
        jacobians = np.zeros((contacts, columns, count, unknowns))
        scratch = np.empty(samples * (columns * unknowns + tangents**2) + tangents * (count + unknowns))
        self._call(displacements, result, states, jacobians, scratch)
        return result, states, jacobians.reshape(contacts, unknowns, unknowns)

    @cached_property
    def _call(self) -> Callable[..., None]:
        return self.kernels[0].given(self.numbers, *self.shape, self.series.synthesis, self.series.analysis, gemm())


@dataclass(frozen=True)
class EventSums(_Sums):
    """Sums of samples, corrected at the events of :mod:`dalembert.vibration.laws.event_sums`.

    The contacts have one direction of slip, or none.
    """

    kernels = (sums_and_slopes, sums_real, sums_complex)

    def forces(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients of forces, and states; see :class:`ContactSums`."""
        kernel, place, numbers = self._forces_in(displacements)
        results = self._results(place)
        kernel(place, numbers, *self._given, *self._workspace(place.dtype.type), *results)
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

    def _workspace(self, dtype: type) -> tuple[np.ndarray, ...]:
        """Workspace: values at samples, the signals with a table of waves, small arrays; no derivatives."""
        return *self._signals(dtype), np.zeros((2, 1, 0), dtype)

    def _room_for_slopes(self, columns: int, unknowns: int) -> tuple[np.ndarray, ...]:
        """The same, and workspace for the derivatives at samples, of corrections, and of three numbers."""
        shapes = (columns, self.series.samples, unknowns), (columns, self.series.count, unknowns), (3, unknowns)
        return *self._signals(float), *map(np.empty, shapes)

    def _signals(self, dtype: type) -> tuple[np.ndarray, ...]:
        return tuple(
            np.empty(shape, dtype) for shape in ((self.series.samples, 3, 3), (8, self.series.count), (3, 5, 3))
        )

    def _results(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Workspace for the forces at samples, the states and the corrections."""
        contacts, columns, _ = displacements.shape
        sampled = np.empty((contacts, columns, self.series.samples), displacements.dtype)
        return sampled, np.empty((contacts, self.series.samples), np.uint8), np.empty_like(displacements)

    def _coefficients(self, results: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
        """Coefficients of the forces: the sums of samples, and the corrections as integrals over a period."""
        sampled, _, corrections = results
        # Corrections are integrals ∫ λ c dτ; coefficients are these by π, the mean by 2π.
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

    kernels = (in_plane.sums_and_slopes, in_plane.sums_real, in_plane.sums_complex)

    @property
    def _given(self) -> tuple[Any, ...]:
        return self.shape.normal, *self._waves

    def _workspace(self, dtype: type) -> tuple[np.ndarray, ...]:
        """Workspace for the signals, waves, values and stages, gradients of the slider alone, and vectors."""
        return *self._signals(dtype), np.empty((ROWS, 3), dtype), np.empty((4, 11), dtype), np.empty(11, complex)

    def _room_for_slopes(self, columns: int, unknowns: int) -> tuple[np.ndarray, ...]:
        samples, count, width = self.series.samples, self.series.count, unknowns + 2
        shapes = (columns, samples, width), (columns, count, width), (count, width)
        *signals, few, vectors, seeds = self._workspace(float)
        return *signals, np.empty((ROWS, width + 1)), few, vectors, seeds, *map(np.empty, shapes)

    def _signals(self, dtype: type) -> tuple[np.ndarray, ...]:
        count, samples = self.series.count, self.series.samples
        # Behind those of one step: waves and values at the stages of all intervals, values at samples, what is known.
        own = (3, count), (4, 5, count), (7, 5, 3), (9, 3)
        shapes = *own, (3 * samples, 3, count), (3 * samples, 3, 3), (samples, 3, 3)
        return *(np.empty(shape, dtype) for shape in shapes), np.zeros((2, samples), np.int64)


ContactSums = PlainSums | EventSums


def _times(rows: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Rows (contacts, columns, numbers) times a transposed matrix: one product for several contacts is faster."""
    # Many small products cost more in calls than in arithmetic; with one contact the copy would.
    if len(rows) == 1:
        return rows @ matrix.T
    return (rows.reshape(-1, rows.shape[-1]) @ matrix.T).reshape(*rows.shape[:-1], len(matrix))
