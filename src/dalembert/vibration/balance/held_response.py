r"""Equations for a further unknown: a harmonic of a degree of freedom has an amplitude, or a phase.

The degree of freedom is a row of the equations, so that the first harmonic of its motion :math:`X = w^T U` is linear in
the unknowns. :math:`|X| / A - 1 = 0` holds an amplitude A, and :math:`\mathrm{Re}\,(X \bar{e}) / |X| = 0` a phase a
quarter of a period from the unit phasor e.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.vibration.balance.newton import Point
from dalembert.vibration.fourier import Fourier


@dataclass(frozen=True)
class ResponseRow:
    """The first harmonic of a degree of freedom. ``weights`` (q,): of the unknowns in its displacement."""

    series: Fourier
    weights: np.ndarray

    def phasor(self, unknowns: np.ndarray) -> complex:
        """X, at unknowns (q, coefficients)."""
        return complex(self.weights @ (unknowns[:, self._column] - 1j * unknowns[:, self._column + 1]))

    def slope(self, shape: tuple[int, ...], direction: complex) -> np.ndarray:
        """Derivatives of Re(X d̄) with a constant direction d by the unknowns, (q, coefficients)."""
        # X = Σ w (U_c - i U_s): by U_c it is w Re(d), by U_s -w Im(d).
        result = np.zeros(shape)
        result[:, self._column], result[:, self._column + 1] = (
            direction.real * self.weights,
            -direction.imag * self.weights,
        )
        return result

    @cached_property
    def _column(self) -> int:
        return int(self.series.cosines[self.series.orders.index(1)])


@dataclass(frozen=True)
class AmplitudeHeld:
    """The amplitude of a harmonic at ``frequency``, rad/s; the further unknown is the part of the varying forces."""

    response: ResponseRow
    amplitude: float
    frequency: float
    size: float
    width: float

    def distance(self, unknowns: np.ndarray, omega: float, point: Point) -> float:
        """Return |X| / A - 1."""
        return abs(self.response.phasor(unknowns)) / self.amplitude - 1

    def slope(self, unknowns: np.ndarray, omega: float, point: Point) -> np.ndarray:
        """Return its derivatives by the scaled unknowns and the scaled load."""
        # d|X| = Re(dX d̄) with the direction d = X/|X|; where X is zero no direction is better than another.
        phasor = self.response.phasor(unknowns)
        direction = phasor / (abs(phasor) or 1.0)
        return np.append(self.response.slope(unknowns.shape, direction) * (self.size / self.amplitude), 0.0)

    def numbers(self) -> list[np.ndarray]:
        """Return all that it depends on."""
        return [self.response.weights, np.array([self.amplitude, self.frequency, self.size, self.width])]


@dataclass(frozen=True)
class PhaseHeld:
    """The phase of a harmonic relative to that of a force; the further unknown is ω. ``force``: its phasor at ω, and
    its derivative; ``phase``: rad.
    """

    response: ResponseRow
    force: Callable[[float], tuple[complex, complex]]
    phase: float
    size: float
    width: float

    def distance(self, unknowns: np.ndarray, omega: float, point: Point) -> float:
        """Return Re(X ē) / |X|."""
        phasor = self.response.phasor(unknowns)
        return (phasor * np.conj(self._ahead(omega)[0])).real / (abs(phasor) or 1.0)

    def leads(self, unknowns: np.ndarray, omega: float) -> bool:
        """Return True if X is ahead of e, not behind it."""
        return bool((self.response.phasor(unknowns) * np.conj(self._ahead(omega)[0])).imag > 0)

    def slope(self, unknowns: np.ndarray, omega: float, point: Point) -> np.ndarray:
        """Return its derivatives by the scaled unknowns and the scaled ω."""
        response, (ahead, ahead_slope) = self.response, self._ahead(omega)
        phasor = response.phasor(unknowns)
        # d (Re(X ē) / |X|) = Re(dX c̄) + Re(X ē') / |X| with c = (e - X Re(X ē) / |X|²) / |X|.
        size = abs(phasor) or 1.0
        along = (ahead - phasor * (phasor * np.conj(ahead)).real / size**2) / size
        by_omega = (phasor * np.conj(ahead_slope)).real / size
        return np.append(response.slope(unknowns.shape, along) * self.size, by_omega * self.width)

    def numbers(self) -> list[np.ndarray]:
        """Return all that it depends on, beside the system."""
        return [self.response.weights, np.array([self.phase, self.size, self.width])]

    def _ahead(self, omega: float) -> tuple[complex, complex]:
        """The unit phasor e a quarter of a period ahead of the asked phase, and its derivative by ω."""
        force, slope = self.force(omega)
        ahead = force / abs(force) * np.exp(1j * (self.phase + np.pi / 2))
        # d(F/|F|) = i Im(dF/F) F/|F|
        return ahead, 1j * (slope / force).imag * ahead
