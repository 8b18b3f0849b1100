r"""Equations for a further unknown: a harmonic of a degree of freedom has an amplitude, or a phase.

With the first harmonic of the response :math:`X = g^T U + b`, which is linear in the unknowns,
:math:`|X| / A - 1 = 0` holds an amplitude A, and :math:`\mathrm{Re}\,(X \bar{e}) / |X| = 0` a phase a quarter of a
period from the unit phasor e.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.vibration.balance.newton import Point
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.condensation import Condensation
from dalembert.vibration.interface.condensed_structure import CondensedStructure


@dataclass(frozen=True)
class ResponseRow:
    """The first harmonic of a degree of freedom of a condensed structure. ``row``: of the structure."""

    condensation: Condensation
    series: Fourier
    row: int

    def phasor(self, unknowns: np.ndarray, point: CondensedStructure) -> complex:
        """X, at unknowns (q, coefficients)."""
        # X = S (q - i q_s) + T x_l with x_l = Z_ll⁻¹ f_l - Y q: g = S - T Y, b = T Z_ll⁻¹ f_l.
        retained = unknowns[:, self._column] - 1j * unknowns[:, self._column + 1]
        return complex(self._gains(point) @ retained + self._interior @ point.free[self._place])

    def by_load(self, point: CondensedStructure, load: float) -> complex:
        """∂X/∂p of the part p of the varying forces, which is ``load``: the interior with q held is linear in p."""
        return complex(self._interior @ point.free[self._place]) / load

    def by_omega(self, unknowns: np.ndarray, point: CondensedStructure) -> complex:
        """∂X/∂ω where the retained coordinates are held."""
        # g and b depend on ω by the interior alone: S and T are constant.
        slope = self.condensation.interior_slope(point, self.series.phasors(unknowns))
        return complex(self._interior @ slope[self._place])

    def slope(self, shape: tuple[int, ...], direction: complex, point: CondensedStructure) -> np.ndarray:
        """Derivatives of Re(X d̄) with a constant direction d by the unknowns, (q, coefficients)."""
        # X = Σ g (U_c - i U_s): by U_c it is Re(d̄ g), by U_s Im(d̄ g).
        turned = np.conj(direction) * self._gains(point)
        result = np.zeros(shape)
        result[:, self._column], result[:, self._column + 1] = turned.real, turned.imag
        return result

    def _gains(self, point: CondensedStructure) -> np.ndarray:
        """g, (q,): retained coordinates move it themselves, and by the interior that follows them."""
        return self.condensation.retained[self.row] - self._interior @ point.follow[self._place]

    @cached_property
    def _place(self) -> int:
        return self.series.orders.index(1)

    @cached_property
    def _column(self) -> int:
        return int(self.series.cosines[self._place])

    @cached_property
    def _interior(self) -> np.ndarray:
        back = self.condensation.back
        return back[self.row] if isinstance(back, np.ndarray) else back[[self.row]].toarray()[0]


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
        assert isinstance(point, CondensedStructure)
        return abs(self.response.phasor(unknowns, point)) / self.amplitude - 1

    def slope(self, unknowns: np.ndarray, omega: float, point: Point) -> np.ndarray:
        """Return its derivatives by the scaled unknowns and the scaled load."""
        assert isinstance(point, CondensedStructure)
        # d|X| = Re(dX d̄) with the direction d = X/|X|; where X is zero no direction is better than another.
        phasor = self.response.phasor(unknowns, point)
        direction = phasor / (abs(phasor) or 1.0)
        by_unknowns = self.response.slope(unknowns.shape, direction, point) * (self.size / self.amplitude)
        by_load = (np.conj(direction) * self.response.by_load(point, omega)).real * (self.width / self.amplitude)
        return np.append(by_unknowns, by_load)

    def numbers(self) -> list[np.ndarray]:
        """Return all that it depends on."""
        return [np.array([self.response.row, self.amplitude, self.frequency, self.size, self.width])]


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
        assert isinstance(point, CondensedStructure)
        phasor = self.response.phasor(unknowns, point)
        return (phasor * np.conj(self._ahead(omega)[0])).real / (abs(phasor) or 1.0)

    def leads(self, unknowns: np.ndarray, omega: float, point: CondensedStructure) -> bool:
        """Return True if X is ahead of e, not behind it."""
        return bool((self.response.phasor(unknowns, point) * np.conj(self._ahead(omega)[0])).imag > 0)

    def slope(self, unknowns: np.ndarray, omega: float, point: Point) -> np.ndarray:
        """Return its derivatives by the scaled unknowns and the scaled ω."""
        assert isinstance(point, CondensedStructure)
        response, (ahead, ahead_slope) = self.response, self._ahead(omega)
        phasor = response.phasor(unknowns, point)
        # d (Re(X ē) / |X|) = Re(dX c̄) + Re(X ē') / |X| with c = (e - X Re(X ē) / |X|²) / |X|.
        size = abs(phasor) or 1.0
        along = (ahead - phasor * (phasor * np.conj(ahead)).real / size**2) / size
        by_omega = (np.conj(along) * response.by_omega(unknowns, point)).real
        by_omega += (phasor * np.conj(ahead_slope)).real / size
        return np.append(response.slope(unknowns.shape, along, point) * self.size, by_omega * self.width)

    def numbers(self) -> list[np.ndarray]:
        """Return all that it depends on, beside the system."""
        return [np.array([self.response.row, self.phase, self.size, self.width])]

    def _ahead(self, omega: float) -> tuple[complex, complex]:
        """The unit phasor e a quarter of a period ahead of the asked phase, and its derivative by ω."""
        force, slope = self.force(omega)
        ahead = force / abs(force) * np.exp(1j * (self.phase + np.pi / 2))
        # d(F/|F|) = i Im(dF/F) F/|F|
        return ahead, 1j * (slope / force).imag * ahead
