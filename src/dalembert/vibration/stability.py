"""Floquet exponents of periodic motions, and whether these are stable."""

from dataclasses import dataclass

import numpy as np

from dalembert.vibration.equations import Equations
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.hill import hill
from dalembert.vibration.newton import Solution
from dalembert.vibration.springs import BilinearStop, Gap
from dalembert.vibration.time_map import monodromy
from dalembert.vibration.uncondensed import Uncondensed

HILL, TIME_MAP, AUTOMATIC = "hill", "time map", "automatic"
NEUTRAL = 1e-8
"""Growth, in parts of ω, that is none: rounding of undamped motions."""
SPLIT = 1e-6
"""Exponent of a free motion, in parts of ω, that is rounding: the root of that of the equations."""
FEWEST = 512
"""Steps of the map over a period, if the motion does not have more samples."""
TRUNCATED = 0.02 / (2 * np.pi)
"""Error of Hill's method in parts of ω where a stop is touched, whose stiffness has harmonics beyond those kept.

Measured: of 166 points of two masses with a stop, judged so with 21 harmonics, one has the wrong label; its largest
multiplier is 1.006.
"""
FORGOTTEN = 1e-12
"""Multiplier that is zero: what a slider that slips once in a period forgets."""


@dataclass(frozen=True)
class Exponents:
    """Floquet exponents of a periodic motion.

    Parameters
    ----------
    values : array, shape (exponents,), complex
        In parts of ω, those that grow fastest first.
    error : float
        Of their real parts, in parts of ω.
    """

    values: np.ndarray
    error: float = 0.0

    @property
    def judged(self) -> bool:
        """Whether the fastest growth is beyond its error."""
        return bool(abs(np.max(np.real(self.values), initial=-np.inf)) >= self.error)

    @property
    def unstable(self) -> int:
        """How many grow."""
        return int(np.sum(np.real(self.values) > NEUTRAL))


def remembers(problem: Equations) -> bool:
    """Whether contacts with friction make the motion depend on its past, which Hill's method does not see."""
    return bool(problem.lowered.blocks)


def exponents(problem: Equations, solution: Solution, way: str = AUTOMATIC) -> Exponents:
    """Floquet exponents at a solution: by Hill's method, or by the time map where there are contacts with friction."""
    if way == HILL or (way == AUTOMATIC and not remembers(problem)):
        values = problem.once(HILL, solution, lambda: hill(problem, solution))
        return Exponents(_held(problem, values), TRUNCATED if _touches(problem, solution) else 0.0)
    return Exponents(_held(problem, problem.once(TIME_MAP, solution, lambda: _by_time_map(problem, solution))))


def _held(problem: Equations, values: np.ndarray) -> np.ndarray:
    """Exponents with those of free motions, of place and of speed, at zero: rounding splits such pairs."""
    nearest = np.argsort(np.abs(values))[: 2 * problem.condensation.free.shape[1]]
    result = values.copy()
    result[nearest[np.abs(values[nearest]) < SPLIT]] = 0.0
    return result


def _touches(problem: Equations, solution: Solution) -> bool:
    """Whether a stop acts at some time."""
    stops = [rows for rows, element in problem.lowered.springs if isinstance(element, Gap | BilinearStop)]
    return bool(stops) and bool(np.any(solution.evaluation.forces[np.concatenate(stops)]))


def _by_time_map(problem: Equations, solution: Solution) -> np.ndarray:
    balance = problem.balance(solution.samples)
    linear = balance.linear(solution.point.stiffness, solution.point.force, solution.unknowns)
    series = Fourier(problem.method.orders, max(FEWEST, solution.samples))
    # The map goes from sample to sample, and so do the states that it takes from the elements.
    system = Uncondensed(problem.lowered, problem.condensation, series, events=False)
    factors = np.linalg.eigvals(monodromy(system, linear, solution.unknowns, solution.omega)).astype(complex)
    values = np.log(factors[np.abs(factors) > FORGOTTEN]) / (2 * np.pi)
    return np.array(sorted(values, key=lambda value: (-value.real, abs(value.imag), value.imag)))
