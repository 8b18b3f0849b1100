"""Fourier coefficients of the forces of contacts: plain sums of samples, or corrected at the events between them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from dalembert.kernels.blas import gemm
from dalembert.vibration.event_sums import sums_and_slopes, sums_complex, sums_real
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.friction_period import forces
from dalembert.vibration.friction_tangent import Tangent, tangent_of


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
    """Return the sums for contacts: corrected ones if asked for, and if they slip in one direction.

    Parameters
    ----------
    numbers : array, shape (contacts, 5)
        As :mod:`dalembert.vibration.friction_law` takes them.
    shape : Shape
    series : Fourier
    events : bool
    """
    return EventSums(numbers, shape, series) if events and shape.tangents < 2 else PlainSums(numbers, shape, series)


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
        return force @ self.series.analysis.T, states

    def with_slopes(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of forces, states and Jacobians; see :class:`ContactSums`."""
        force, states, jacobians = self._tangent(self._sampled(displacements))
        return force @ self.series.analysis.T, states, jacobians

    def _sampled(self, displacements: np.ndarray) -> np.ndarray:
        return np.ascontiguousarray(displacements @ self.series.synthesis.T)

    @cached_property
    def _tangent(self) -> Tangent:
        return tangent_of(self.numbers, *self.shape, self.series.synthesis, self.series.analysis)


@dataclass(frozen=True)
class EventSums:
    """Sums of samples, corrected at the events of :mod:`dalembert.vibration.event_sums`.

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
        sampled, states, corrections = self._results(place)
        kernel(
            place, numbers, *self.shape, self._orders, series.mean, series.waves, *self._room(place.dtype),
            np.zeros((2, 1, 0), place.dtype), sampled, states, corrections,
        )  # fmt: skip
        return sampled @ series.analysis.T + corrections * self._weights, states

    def with_slopes(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of forces, states and Jacobians; see :class:`ContactSums`."""
        series, place = self.series, np.ascontiguousarray(displacements)
        contacts, columns, count = place.shape
        unknowns = columns * count
        sampled, states, corrections = self._results(place)
        jacobians = np.empty((contacts, columns, count, unknowns))
        self._call(
            place, *self._room(float), np.empty((columns, series.samples, unknowns)),
            np.empty((columns, count, unknowns)), np.empty((3, unknowns)), sampled, states, corrections, jacobians,
        )  # fmt: skip
        force = sampled @ series.analysis.T + corrections * self._weights
        return force, states, jacobians.reshape(contacts, unknowns, unknowns)

    def _results(self, displacements: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Room for the forces at samples, the states and the corrections."""
        contacts, columns, _ = displacements.shape
        sampled = np.empty((contacts, columns, self.series.samples), displacements.dtype)
        return sampled, np.empty((contacts, self.series.samples), np.uint8), np.empty_like(displacements)

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
        return np.array(self.series.orders, dtype=np.int64)

    @cached_property
    def _weights(self) -> np.ndarray:
        """From integrals over a period to coefficients."""
        weights = np.full(self.series.count, 1 / np.pi)
        weights[: self.series.mean] /= 2
        return weights
