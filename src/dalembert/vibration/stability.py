"""Floquet exponents of periodic motions, and whether these are stable."""

from dataclasses import dataclass

import numpy as np

from dalembert.vibration.equations import Equations
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.hill import hill
from dalembert.vibration.newton import Solution
from dalembert.vibration.time_map import monodromy
from dalembert.vibration.uncondensed import Uncondensed

HILL, TIME_MAP, AUTOMATIC = "hill", "time map", "automatic"
NEUTRAL = 1e-8
"""Growth, in parts of ω, that is none: rounding of undamped motions."""
FEWEST = 512
"""Steps of the map over a period, if the motion does not have more samples."""
FORGOTTEN = 1e-12
"""Multiplier that is zero: what a slider that slips once in a period forgets."""


@dataclass(frozen=True)
class Exponents:
    """Floquet exponents of a periodic motion.

    Parameters
    ----------
    values : array, shape (exponents,), complex
        In parts of ω, those that grow fastest first.
    """

    values: np.ndarray

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
        return Exponents(problem.once(HILL, solution, lambda: hill(problem, solution)))
    return Exponents(problem.once(TIME_MAP, solution, lambda: _by_time_map(problem, solution)))


def _by_time_map(problem: Equations, solution: Solution) -> np.ndarray:
    balance = problem.balance(solution.samples)
    linear = balance.linear(solution.point.stiffness, solution.point.force, solution.unknowns)
    series = Fourier(problem.method.orders, max(FEWEST, solution.samples))
    # The map goes from sample to sample, and so do the states that it takes from the elements.
    system = Uncondensed(problem.lowered, problem.condensation, series, events=False)
    factors = np.linalg.eigvals(monodromy(system, linear, solution.unknowns, solution.omega)).astype(complex)
    values = np.log(factors[np.abs(factors) > FORGOTTEN]) / (2 * np.pi)
    return np.array(sorted(values, key=lambda value: (-value.real, abs(value.imag), value.imag)))
