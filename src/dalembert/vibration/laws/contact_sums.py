"""Fourier coefficients of the forces of contacts: plain sums of samples, or corrected at the events between them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from dalembert.kernels.blas import gemm
from dalembert.vibration.balance.fourier import Fourier
from dalembert.vibration.laws import event_sums_in_plane as in_plane
from dalembert.vibration.laws.event_sums import sums_and_slopes, sums_complex, sums_real
from dalembert.vibration.laws.friction_law import FRICTION, LOAD, TANGENTIAL
from dalembert.vibration.laws.friction_period import forces
from dalembert.vibration.laws.friction_tangent import Tangent, tangent_of
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
    if not (events and has_events(numbers, shape)):
        return PlainSums(numbers, shape, series)
    return (PlaneEventSums if shape.tangents == 2 else EventSums)(numbers, shape, series)


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

    numbers: np.ndarray
    shape: Shape
    series: Fourier

    def forces(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients of forces, and states; see :class:`ContactSums`."""
        series, numbers, kernel = self.series, self.numbers, sums_real
        if not displacements.dtype == numbers.dtype == float:
            kernel, displacements, numbers = sums_complex, displacements.astype(complex), numbers.astype(complex)
        place = np.ascontiguousarray(displacements)
        sampled, states, corrections = _results(place, series)
        kernel(
            place, numbers, *self.shape, self._orders, series.mean, series.waves, *self._room(place.dtype),
            np.zeros((2, 1, 0), place.dtype), sampled, states, corrections,
        )  # fmt: skip
        return _times(sampled, series.analysis) + corrections * self._weights, states

    def with_slopes(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of forces, states and Jacobians; see :class:`ContactSums`."""
        series, place = self.series, np.ascontiguousarray(displacements)
        contacts, columns, count = place.shape
        unknowns = columns * count
        sampled, states, corrections = _results(place, series)
        jacobians = np.empty((contacts, columns, count, unknowns))
        self._call(
            place, *self._room(float), np.empty((columns, series.samples, unknowns)),
            np.empty((columns, count, unknowns)), np.empty((3, unknowns)), sampled, states, corrections, jacobians,
        )  # fmt: skip
        force = _times(sampled, series.analysis) + corrections * self._weights
        return force, states, jacobians.reshape(contacts, unknowns, unknowns)

    def _room(self, dtype: np.dtype | type) -> tuple[np.ndarray, ...]:
        """Room for the signals' values at samples, the signals with a table of waves, and small arrays."""
        count = self.series.count
        return np.empty((3, self.series.samples, 3), dtype), np.empty((8, count), dtype), np.empty((4, 5, 3), dtype)

    @cached_property
    def _call(self) -> Callable[..., None]:
        series = self.series
        return sums_and_slopes.given(
            self.numbers, *self.shape, self._orders, series.mean, series.waves, series.analysis, gemm()
        )

    @cached_property
    def _orders(self) -> np.ndarray:
        return _orders(self.series)

    @cached_property
    def _weights(self) -> np.ndarray:
        return _weights(self.series)


@dataclass(frozen=True)
class PlaneEventSums:
    """Sums of samples, corrected at the events of :mod:`dalembert.vibration.laws.event_sums_in_plane`.

    Parameters
    ----------
    numbers : array, shape (contacts, 5)
    shape : Shape
        With two directions of slip, and sliders.
    series : Fourier
    """

    numbers: np.ndarray
    shape: Shape
    series: Fourier

    def forces(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients of forces, and states; see :class:`ContactSums`."""
        series, numbers, kernel = self.series, self.numbers, in_plane.sums_real
        if not displacements.dtype == numbers.dtype == float:
            kernel, displacements, numbers = (
                in_plane.sums_complex,
                displacements.astype(complex),
                numbers.astype(complex),
            )
        place = np.ascontiguousarray(displacements)
        sampled, states, corrections = _results(place, series)
        kernel(
            place, numbers, self.shape.normal, _orders(series), series.mean, series.waves, *self._room(place.dtype),
            np.empty((ROWS, 3), place.dtype), *self._vectors(place.dtype), sampled, states, corrections,
        )  # fmt: skip
        return _times(sampled, series.analysis) + corrections * _weights(series), states

    def with_slopes(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of forces, states and Jacobians; see :class:`ContactSums`."""
        series, place = self.series, np.ascontiguousarray(displacements)
        contacts, columns, count = place.shape
        unknowns = columns * count
        sampled, states, corrections = _results(place, series)
        jacobians = np.empty((contacts, columns, count, unknowns))
        self._call(
            place, *self._room(float), np.empty((ROWS, unknowns + 3)), np.empty((ROWS, 3)),
            *self._vectors(float), np.empty((columns, series.samples, unknowns + 2)),
            np.empty((columns, count, unknowns + 2)), np.empty((count, unknowns + 2)), sampled, states, corrections,
            jacobians,
        )  # fmt: skip
        force = _times(sampled, series.analysis) + corrections * _weights(series)
        return force, states, jacobians.reshape(contacts, unknowns, unknowns)

    def _room(self, dtype: np.dtype | type) -> tuple[np.ndarray, ...]:
        """Room for the signals, tables of waves, the signals' values, and the stages of a step."""
        count = self.series.count
        shapes = (3, count), (20, count), (35, 3), (7, 3)
        signals, tables, small, radau = (np.empty(shape, dtype) for shape in shapes)
        return signals, tables.reshape(4, 5, count), small.reshape(7, 5, 3), radau

    def _vectors(self, dtype: np.dtype | type) -> tuple[np.ndarray, np.ndarray]:
        return np.empty((4, 11), dtype), np.empty(11, complex)

    @cached_property
    def _call(self) -> Callable[..., None]:
        series = self.series
        return in_plane.sums_and_slopes.given(
            self.numbers, self.shape.normal, _orders(series), series.mean, series.waves, series.analysis, gemm()
        )


def _results(displacements: np.ndarray, series: Fourier) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Room for the forces at samples, the states and the corrections."""
    contacts, columns, _ = displacements.shape
    sampled = np.empty((contacts, columns, series.samples), displacements.dtype)
    return sampled, np.empty((contacts, series.samples), np.uint8), np.empty_like(displacements)


def _orders(series: Fourier) -> np.ndarray:
    return np.array(series.orders, dtype=np.int64)


def _weights(series: Fourier) -> np.ndarray:
    """From integrals over a period to coefficients."""
    weights = np.full(series.count, 1 / np.pi)
    weights[: series.mean] /= 2
    return weights


def _times(rows: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Rows (contacts, columns, numbers) times a transposed matrix: one product for several contacts is faster."""
    if len(rows) == 1:
        return rows @ matrix.T
    return (rows.reshape(-1, rows.shape[-1]) @ matrix.T).reshape(*rows.shape[:-1], len(matrix))
