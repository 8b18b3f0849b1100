r"""Free decays in a window of time: oscillators whose frequency and decay rate vary slowly.

In a window about :math:`t_c`, with :math:`x = (t - t_c)/\tau` from −1 to 1, each mode is the displacement

.. math:: u_j = \mathrm{Re}\, c_j e^{\rho(x)}, \quad \rho = \sum_{d=1}^{p} r_d x^d, \quad \dot\rho = -\sigma + i\omega,

with the amplitude :math:`c_j` at each sensor j. A sensor of velocities or accelerations sees its derivatives by time,
with the same coefficients: :math:`\mathrm{D}\,(P e^\rho) = (P' + P \rho')\, e^\rho`. Harmonics of the first mode, and a
mean and a slope of each sensor, are free besides. The linear numbers are eliminated (variable projection; Golub and
Pereyra, "The differentiation of pseudo-inverses and nonlinear least squares problems", SIAM J. Numer. Anal. 10, 1973).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import polynomial
from scipy.linalg import solve_triangular

from dalembert.inverse.decays.sensors import Phasors, Sensors

LARGEST = 50.0
"""Logarithm of the largest growth within a window: fits beyond it do not converge."""
STEPS = 30
"""Gauss–Newton steps of a fit at most."""
SETTLED, ROUGHLY = 1e-6, 1e-2
"""Largest change of a coefficient, rad or neper, at which a fit ends: of the first mode, and of others."""
OTHERS = 2
"""Largest degree of the polynomials of other modes than the first."""
FARTHEST = 1.0
"""Largest change of a coefficient in a step, rad or neper."""
RISE = 1e-4
"""Relative rise of the misfit that a step may make: how harmonics follow the first one is not differentiated."""
HALVINGS = 6
HARMONICS = (2, 3, 5)
"""Harmonics of the first mode whose amplitudes are free in a window."""


@dataclass(frozen=True)
class Window:
    """Samples of a window: ``times`` (samples,) from its middle, s; ``values`` (samples, channels)."""

    times: np.ndarray
    values: np.ndarray
    half: float

    @cached_property
    def places(self) -> np.ndarray:
        """From −1 to 1, (samples,)."""
        return self.times / self.half

    def terms(self, exponent: Phasors, order: int, degree: int) -> Iterator[Phasors]:
        """Yield D^order (x^d e^ρ) for d = 0 to the degree, (samples,), with D the derivative by time."""
        places, rate = self.places, polynomial.polyder(exponent)
        rho = polynomial.polyval(places, exponent)
        growth = np.exp(np.clip(rho.real, -LARGEST, LARGEST) + 1j * rho.imag)
        for power in range(degree + 1):
            factor = np.zeros(power + 1, dtype=complex)
            factor[power] = 1.0
            for _ in range(order):
                factor = polynomial.polyadd(polynomial.polyder(factor), polynomial.polymul(factor, rate)) / self.half
            yield polynomial.polyval(places, factor) * growth

    def columns(
        self, exponents: Phasors, terms: list[list[Phasors]], harmonics: tuple[int, ...]
    ) -> Iterator[np.ndarray]:
        """Yield the columns of the linear numbers: modes, harmonics of the first with a slope, mean and drift."""
        places = self.places
        for mode in terms:
            yield mode[0].real
            yield -mode[0].imag
        rho = polynomial.polyval(places, exponents[0])
        for harmonic in harmonics:
            wave = np.exp(np.clip(rho.real, -LARGEST, LARGEST) + 1j * harmonic * rho.imag)
            for factor in (1.0, places):
                yield factor * wave.real
                yield factor * wave.imag
        yield np.ones_like(places)
        yield places


@dataclass(frozen=True)
class WindowFit:
    """Modes that were fitted in a window.

    ``exponents`` (modes, degree + 1): coefficients r_d of ρ over x, the constant 0. ``amplitudes`` (modes, channels):
    complex displacements at the middle. ``residuals`` (samples, channels). ``gains`` (coefficients, channels,
    samples): by which the noise of a sample changes the coefficients, real and imaginary part of each in turn.
    ``bases``: orthonormal columns of the linear numbers for each group of channels; ``tangents`` (channels,
    coefficients, samples): orthonormal rows of what the coefficients change besides. ``converged``.
    """

    window: Window
    exponents: Phasors
    amplitudes: Phasors
    residuals: np.ndarray
    gains: np.ndarray
    bases: dict[int, np.ndarray]
    tangents: np.ndarray
    converged: bool

    def slope_weights(self, place: float) -> np.ndarray:
        """Weights (2, coefficients) that make −σ and ω of the first mode, 1/s, at a place x from coefficients of ρ."""
        degree = self.exponents.shape[1] - 1
        rates = np.arange(1, degree + 1) * place ** np.arange(degree) / self.window.half
        weights = np.zeros((2, len(self.gains)))
        weights[0, 0 : 2 * degree : 2] = rates
        weights[1, 1 : 2 * degree : 2] = rates
        return weights

    def slope_gains(self, place: float) -> np.ndarray:
        """By which the noise of each sample changes −σ and ω of the first mode, (2, channels, samples)."""
        return np.tensordot(self.slope_weights(place), self.gains, 1)

    def slope(self, place: float, mode: int = 0) -> complex:
        """−σ + iω at a place, 1/s."""
        return complex(polynomial.polyval(place, polynomial.polyder(self.exponents[mode])) / self.window.half)

    def at(self, place: float, mode: int = 0) -> Phasors:
        """Complex displacements (channels,) at a place."""
        return self.amplitudes[mode] * np.exp(polynomial.polyval(place, self.exponents[mode]))

    @property
    def freedom(self) -> float:
        """Samples less the numbers that are fitted to each channel."""
        linear = next(iter(self.bases.values())).shape[1]
        samples, channels = self.residuals.shape
        return max(samples - linear - len(self.gains) / channels, 1.0)

    def misfit_over(self, mode: int) -> float:
        """Squares of the residuals over those of the amplitude of a mode."""
        return float(np.sum(self.residuals**2) / np.sum(np.abs(self.amplitudes[mode]) ** 2))

    def best_place(self, deviations: np.ndarray) -> float:
        """The place at which frequency and decay rate together have the least variance, near the middle of the energy.

        There a slope of the frequency does not disturb the frequency: a decay has most of its information before the
        middle of the window.
        """
        places, degree = np.linspace(-0.5, 0.5, 101), self.exponents.shape[1] - 1
        rates = np.arange(1, degree + 1) * places[:, None] ** np.arange(degree)
        weighted = (self.gains[: 2 * degree] * deviations[None, :, None]).reshape(2 * degree, -1)
        covariance = weighted @ weighted.T
        both = covariance[::2, ::2] + covariance[1::2, 1::2]
        return float(places[np.argmin(np.einsum("pi,ij,pj->p", rates, both, rates))])


def fit_window(
    window: Window, exponents: Phasors, sensors: Sensors, harmonics: tuple[int, ...] = HARMONICS
) -> WindowFit:
    """Fit decaying modes to a window from a first guess of their exponents (modes, degree + 1)."""
    at = _Trial.of(window, exponents, sensors, harmonics)
    for _ in range(STEPS):
        step = at.step()
        if np.abs(step[0]).max() < SETTLED and np.abs(step[1:]).max(initial=0.0) < ROUGHLY:
            return at.result(True)
        best = at.shortened(step)
        if best is None:
            break
        at = best
    return at.result(False)


@dataclass(frozen=True)
class _Trial:
    """The model at exponents. ``projected`` (channels, coefficients, samples): derivatives without what linear numbers
    take up, over the deviation of the noise, as the residuals are.
    """

    window: Window
    exponents: Phasors
    sensors: Sensors
    harmonics: tuple[int, ...]
    amplitudes: Phasors
    residuals: np.ndarray
    projected: np.ndarray
    bases: dict[int, np.ndarray]

    @classmethod
    def of(cls, window: Window, exponents: Phasors, sensors: Sensors, harmonics: tuple[int, ...]) -> "_Trial":
        modes, degrees = len(exponents), _degrees(exponents)
        samples, channels = window.values.shape
        amplitudes = np.zeros((modes, channels), dtype=complex)
        residuals = np.empty((samples, channels))
        projected = np.empty((channels, 2 * sum(degrees), samples))
        bases = {}
        for order, members in sensors.groups.items():
            terms = [
                list(window.terms(exponent, order, degree)) for exponent, degree in zip(exponents, degrees, strict=True)
            ]
            columns = np.stack(list(window.columns(exponents, terms, harmonics)), axis=1)
            basis, triangle = np.linalg.qr(columns)
            numbers = solve_triangular(triangle, basis.T @ window.values[:, members])
            residuals[:, members] = window.values[:, members] - columns @ numbers
            bases[order] = basis
            for place, channel in enumerate(members):
                phasors = numbers[0 : 2 * modes : 2, place] + 1j * numbers[1 : 2 * modes : 2, place]
                amplitudes[:, channel] = phasors
                waves = [size * term for size, mode in zip(phasors, terms, strict=True) for term in mode[1:]]
                slopes = np.stack([part for wave in waves for part in (wave.real, -wave.imag)])
                slopes -= (slopes @ basis) @ basis.T
                projected[channel] = slopes / sensors.deviations[channel]
        return cls(window, exponents, sensors, harmonics, amplitudes, residuals, projected, bases)

    @cached_property
    def misfit(self) -> float:
        return float(np.sum((self.residuals / self.sensors.deviations) ** 2))

    @cached_property
    def _factors(self) -> tuple[np.ndarray, np.ndarray]:
        # Derivatives of all channels below each other, (channels · samples, coefficients).
        return np.linalg.qr(self.projected.transpose(0, 2, 1).reshape(-1, self.projected.shape[1]))

    @cached_property
    def _pseudo_inverse(self) -> np.ndarray:
        basis, triangle = self._factors
        return solve_triangular(triangle, basis.T)

    def step(self) -> np.ndarray:
        """The Gauss–Newton step of the exponents (modes, degree + 1)."""
        weighted = (self.residuals / self.sensors.deviations).T.ravel()
        numbers = self._pseudo_inverse @ weighted
        numbers /= max(np.abs(numbers).max() / FARTHEST, 1.0)
        step, first = np.zeros_like(self.exponents), 0
        for mode, degree in enumerate(_degrees(self.exponents)):
            step[mode, 1 : degree + 1] = (numbers[first::2] + 1j * numbers[first + 1 :: 2])[:degree]
            first += 2 * degree
        return step

    def shortened(self, step: Phasors) -> "_Trial | None":
        """The trial after a step, or after a part of it that does not raise the misfit."""
        for halving in range(HALVINGS):
            trial = _Trial.of(self.window, self.exponents + 0.5**halving * step, self.sensors, self.harmonics)
            if trial.misfit <= self.misfit * (1 + RISE):
                return trial
        return None

    def result(self, converged: bool) -> WindowFit:
        samples, channels = self.residuals.shape
        gains = self._pseudo_inverse.reshape(-1, channels, samples) / self.sensors.deviations[:, None]
        tangents = self._factors[0].T.reshape(-1, channels, samples).transpose(1, 0, 2)
        return WindowFit(
            self.window, self.exponents, self.amplitudes, self.residuals, gains, self.bases, tangents, converged
        )


def _degrees(exponents: np.ndarray) -> list[int]:
    """Degree of the polynomial of each mode."""
    degree = exponents.shape[1] - 1
    return [degree, *[min(degree, OTHERS)] * (len(exponents) - 1)]
