r"""From the decay of a mode to its periodic motion, by the friction law that both have in common.

A decaying motion differs from a periodic one. It is slower by a part of order :math:`\zeta^2`. Friction depends on the
amplitude of the last reversal. The energy that is lost comes from the stored energy. These differences are of second
order, and amount to 10 % of the damping of a joint that has a tenth of the stiffness. They follow from the law, and the
law follows from the decay itself:

With a modal mass of 1, elastic stiffness, viscous damping :math:`c` and sliders in parallel (an Iwan model; Masing's
rules), of stiffness :math:`\kappa_i` that slip at :math:`x_i`, the motion :math:`a \cos\varphi` with the decrement
:math:`\delta = \sigma/\omega` and :math:`\cos\theta = 1 - 2 x/a` of a slider that slips has

.. math::
    K &= (\theta - \tfrac12 \sin 2\theta)/\pi, \qquad D = 4 x (a - x), \\
    L &= \tfrac2\pi \int_0^\theta \left[(\tfrac\pi2 - \varphi) \cos\varphi - \tfrac\pi2\right] \cos\varphi
    \,\mathrm d\varphi,

the stiffness in phase, the energy lost in a period, and by how much, for each :math:`\delta`, the decay changes the
stiffness: from one reversal to the next, the branch of the hysteresis belongs to the mean of both amplitudes, about a
centre that is not 0. One that sticks has 1, 0 and 0. So

.. math::
    \omega^2 &= k(a) + \sum \kappa_i (K_i + \delta L_i) + \ddot a/a - c \sigma, \\
    2 \pi \delta a^2 \left(k + \tfrac14 \frac{\mathrm d k}{\mathrm d \ln a} + \sum_{x_i > a} \kappa_i \right)
    &= \pi c a^2\, \omega_0^2/\omega + \sum \kappa_i D_i.

:math:`\omega_0` is the frequency of the periodic motion. The bracket times a is the slope of the energy: only sliders
that stick store it. Both are linear in k, c and
:math:`\kappa_i \ge 0`, which follow by least squares with bounds. The elastic part is a polynomial in :math:`a^2`; its
energy is that of the action :math:`\omega a^2/2`. Springs that stiffen and sliders that slip may cancel each other: of
all laws that explain the decay within its noise, the method takes that with the least sliders and nonlinear springs.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import nnls

from dalembert.inverse.decays.sensors import Phasors

SLIDERS = 60
"""Sliders of the law, whose slips lie between a third of the least amplitude and the largest."""
ELASTIC = 3
"""Terms of the elastic stiffness: 1, a², a⁴."""
ROUNDS = 4
ACCURACY = np.array([1e-5, 1e-3])
"""Relative deviations of frequency and decay rate below which the law need not follow them: its own accuracy."""
PENALTIES = 10.0 ** np.arange(6, -1.5, -0.5)
"""Weights of the squares of stiffnesses over the mean square of ω, from that of a linear oscillator on."""
ENOUGH = 1.1
"""Misfit over the least one, or over that of the noise, up to which a larger penalty is taken."""


@dataclass(frozen=True)
class EquivalentLaw:
    """An oscillator of modal mass 1 that decays like a mode.

    ``amplitudes`` (points,) that it was fitted to; ``slips``, ``stiffnesses`` (sliders,): by the unit of the amplitude
    and 1/s²; ``elastic`` (3,): stiffnesses of 1, a² and a⁴ at the largest amplitude, 1/s²; ``viscous``: c, 1/s.
    ``misfits`` (points, 2): of frequency and decay rate, in deviations.
    """

    amplitudes: np.ndarray
    slips: np.ndarray
    stiffnesses: np.ndarray
    elastic: np.ndarray
    viscous: float
    misfits: np.ndarray

    @cached_property
    def _curves(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Logarithms of amplitudes, with frequencies ω and decay rates σ of the decay, (grid,) each."""
        sizes = np.geomspace(self.amplitudes.min() / 10, 3 * self.amplitudes.max(), 400)
        terms = _Terms.of(sizes, self.slips, self.amplitudes.max())
        omega, sigma = terms.rates(self)
        return np.log(sizes), omega, sigma

    def slopes(self, amplitudes: ArrayLike) -> Phasors:
        """−σ + iω of the decay at amplitudes, 1/s."""
        return self.slopes_at(np.log(amplitudes))

    def slopes_at(self, places: ArrayLike) -> Phasors:
        """The same at logarithms of amplitudes."""
        logs, omega, sigma = self._curves
        points = np.asarray(places, dtype=float)
        return -np.interp(points, logs, sigma) + 1j * np.interp(points, logs, omega)

    def periodic(self, amplitudes: np.ndarray, slopes: Phasors) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies ω and damping ratios (points,) of periodic motions, from −σ + iω of a decay at amplitudes."""
        omega, sigma = slopes.imag, -slopes.real
        terms = _Terms.of(amplitudes, self.slips, self.amplitudes.max())
        rate = -self.slopes(amplitudes).real
        squares = omega**2 - terms.acceleration(self) + rate * self.viscous
        squares -= rate / omega * (terms.lag @ self.stiffnesses)
        return np.sqrt(squares), sigma / np.sqrt(squares) * terms.energy_slope(self) / squares


@dataclass(frozen=True)
class _Terms:
    """What stiffnesses are multiplied by at amplitudes: (points, sliders) and (points, terms)."""

    sizes: np.ndarray
    in_phase: np.ndarray
    lost: np.ndarray
    stuck: np.ndarray
    lag: np.ndarray
    elastic: np.ndarray
    stored: np.ndarray

    @classmethod
    def of(cls, sizes: np.ndarray, slips: np.ndarray, largest: float) -> "_Terms":
        a, x = sizes[:, None], slips[None, :]
        slipping = a > x
        theta = np.arccos(np.clip(1 - 2 * x / np.maximum(a, x), -1, 1))
        # ∫ (π/2 - φ) cos²φ - π/2 cos φ from 0 to θ.
        quadratic = (np.pi / 2) * (theta / 2 + np.sin(2 * theta) / 4)
        quadratic -= theta**2 / 4 + theta * np.sin(2 * theta) / 4 + (np.cos(2 * theta) - 1) / 8
        powers = 2 * np.arange(ELASTIC)
        elastic = (a / largest) ** powers
        return cls(
            sizes,
            in_phase=np.where(slipping, (theta - 0.5 * np.sin(2 * theta)) / np.pi, 1.0),
            lost=np.where(slipping, 4 * x * (a - x), 0.0) / (np.pi * a**2),
            stuck=np.where(slipping, 0.0, 1.0),
            lag=np.where(slipping, (2 / np.pi) * (quadratic - np.pi / 2 * np.sin(theta)), 0.0),
            elastic=elastic,
            stored=elastic * (1 + powers / 4),
        )

    def energy_slope(self, law: EquivalentLaw) -> np.ndarray:
        """Slope of the stored energy over the amplitude."""
        return self.stored @ law.elastic + self.stuck @ law.stiffnesses

    def rates(self, law: EquivalentLaw) -> tuple[np.ndarray, np.ndarray]:
        """ω and σ of the decay, (points,) each."""
        stiffness = self.elastic @ law.elastic + self.in_phase @ law.stiffnesses
        omega = np.sqrt(np.maximum(stiffness, np.finfo(float).tiny))
        sigma = np.zeros(len(omega))
        for _ in range(ROUNDS):
            lost = law.viscous * stiffness / omega + self.lost @ law.stiffnesses
            sigma = lost * omega / (2 * self.energy_slope(law))
            # ä/a = σ² - dσ/dt with dσ/dt = -σ dσ/d ln a.
            acceleration = sigma**2 + sigma * np.gradient(sigma, np.log(self.sizes))
            squares = stiffness + sigma / omega * (self.lag @ law.stiffnesses) + acceleration - law.viscous * sigma
            omega = np.sqrt(np.maximum(squares, np.finfo(float).tiny))
        return omega, sigma

    def acceleration(self, law: EquivalentLaw) -> np.ndarray:
        """ä/a, (points,), by the decay rates of the law."""
        logs, _, sigma = law._curves
        change = np.gradient(sigma, logs)
        rates = np.interp(np.log(self.sizes), logs, sigma)
        return rates**2 + rates * np.interp(np.log(self.sizes), logs, change)

    def fit(
        self, law: EquivalentLaw, omega: np.ndarray, sigma: np.ndarray, scales: np.ndarray, penalty: float
    ) -> EquivalentLaw:
        """The law by least squares, with terms of second order from a law before."""
        acceleration = self.acceleration(law) if law.viscous or law.stiffnesses.any() else np.zeros(len(omega))
        decrement = sigma / omega
        mean = float(np.mean(omega**2))
        stiffness = np.column_stack([self.elastic, -sigma, self.in_phase + decrement[:, None] * self.lag])
        energy = np.column_stack(
            [
                -2 * decrement[:, None] * self.stored,
                (omega**2 + sigma**2) / omega,
                self.lost - 2 * decrement[:, None] * self.stuck,
            ]
        )
        matrix = np.vstack([stiffness * scales[:, :1], energy * scales[:, 1:]])
        right = np.concatenate([(omega**2 - acceleration) * scales[:, 0], np.zeros(len(omega))])
        # Unknowns in parts of the mean square of ω, c in parts of its root; nonlinear springs of both signs.
        units = np.full(matrix.shape[1], mean)
        units[ELASTIC] = np.sqrt(mean)
        weights = np.sqrt(penalty) * np.eye(len(units))
        weights[0] = weights[ELASTIC] = 0.0
        design = np.vstack([matrix * units, weights])
        both = np.column_stack([design, -design[:, 1:ELASTIC]])
        numbers = nnls(both, np.concatenate([right, np.zeros(len(units))]), maxiter=50 * both.shape[1])[0]
        result = numbers[: len(units)].copy()
        result[1:ELASTIC] -= numbers[len(units) :]
        result = result * units
        misfits = np.column_stack([omega**2 - acceleration - stiffness @ result, -(energy @ result)]) * scales
        return EquivalentLaw(
            law.amplitudes, law.slips, result[ELASTIC + 1 :], result[:ELASTIC], float(result[ELASTIC]), misfits
        )


def equivalent_law(amplitudes: np.ndarray, slopes: Phasors, deviations: np.ndarray) -> EquivalentLaw:
    """The law of a decay from amplitudes and −σ + iω, (points,), with the deviations (points, 2) of σ and ω."""
    omega, sigma = slopes.imag, -slopes.real
    errors = np.maximum(deviations[:, ::-1], ACCURACY * np.abs(np.stack([omega, sigma], axis=1)))
    # An error of ω changes ω² by 2ω times it, one of σ the energy by 2ω.
    scales = 1 / (2 * omega[:, None] * errors)
    slips = np.geomspace(amplitudes.min() / 3, amplitudes.max(), SLIDERS)
    terms = _Terms.of(amplitudes, slips, amplitudes.max())
    mean = float(np.mean(omega**2))
    none = EquivalentLaw(amplitudes, slips, np.zeros(SLIDERS), np.array([mean, 0, 0]), 0.0, np.zeros((0, 2)))
    fitted = {}
    for penalty in PENALTIES:
        law = none
        for _ in range(ROUNDS):
            law = terms.fit(law, omega, sigma, scales, penalty)
        fitted[penalty] = law
    sizes = {penalty: float(np.sqrt(np.mean(law.misfits**2))) for penalty, law in fitted.items()}
    enough = ENOUGH * max(min(sizes.values()), 1.0)
    return fitted[next(penalty for penalty in PENALTIES if sizes[penalty] <= enough)]
