"""Floquet exponents of periodic motions, and whether these are stable."""

from dataclasses import dataclass

import numpy as np

from dalembert.vibration.balance.arc_length import ACROSS_FOLD, MANY_ROWS
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.balance.receptance_balance import ReceptanceBalance
from dalembert.vibration.balance.uncondensed import Uncondensed
from dalembert.vibration.fourier import Fourier, in_orders
from dalembert.vibration.interface.receptances import ReceptancePoint
from dalembert.vibration.stability.hill import hill
from dalembert.vibration.stability.modal_map import MOST_ROWS, active_rows, modal_map
from dalembert.vibration.stability.time_map import monodromy
from dalembert.vibration.system.requirements import require_viscous

HILL, TIME_MAP, AUTO = "hill", "time map", "auto"
NEUTRAL = 1e-8
"""Growth, in parts of ω, that is none: rounding of undamped motions."""
SPLIT = 1e-6
"""Exponent of a free motion, in parts of ω, that is rounding: the root of that of the equations."""
REAL = 1e-3
"""Imaginary part of an exponent, as part of ω and beside a half or none of it, that is none."""
FEWEST = 512
"""Steps of the map over a period, if the motion does not have more samples."""
FINER = "hill with twice the harmonics"
LARGEST = 600
"""Most unknowns of Hill's method with twice the harmonics: some seconds a point."""
TRUNCATED = 0.15 / (2 * np.pi)
"""Error of Hill's method in parts of ω where a stop is touched and twice the harmonics are too many.

Measured: two masses with a stop and 5 harmonics, whose labels are wrong up to multipliers of exp(0.144).
"""
SHIFTED = 0.1
"""Largest real exponent, in parts of ω, whose sign more harmonics or the steps of a map may have changed."""
FORGOTTEN = 1e-12
"""Multiplier that is zero: what a slider that slips once in a period forgets."""


@dataclass(frozen=True)
class Exponents:
    """Floquet exponents of a periodic motion. ``values`` (exponents,), complex: in parts of ω, those that grow fastest
    first; ``error``: of their real parts, in parts of ω; infinite where it is not known; ``unjudged``: ACROSS_FOLD if
    they belong to a motion on the other side of a fold, MANY_ROWS if they were not computed; ``signed``: whether their
    number of real ones that grow is that of the determinant of the balance.
    """

    values: np.ndarray
    error: float = 0.0
    unjudged: str = ""
    signed: bool = False

    @property
    def judged(self) -> bool:
        """Whether the sign of the fastest growth is known, and belongs to the motion."""
        growth = np.real(self.values)
        if self.unjudged:
            return False
        if not growth.size or abs(growth[0]) >= self.error:
            return True
        # Next to a fold the fastest exponent is real, and smaller than its error: the determinant has its sign.
        within = np.abs(growth) < self.error
        return self.signed and int(within.sum()) == 1 and bool(real_ones(self.values[:1])[0])

    @property
    def unstable(self) -> int:
        """Number of exponents that grow."""
        return int(np.sum(np.real(self.values) > NEUTRAL))


def remembers(problem: Equations) -> bool:
    """Whether the motion depends on its past, or forces on velocities, which Hill's method does not see."""
    return bool(problem.lowered.blocks) or any(block.remembers for block in problem.lowered.laws)


def exponents(problem: Equations, solution: Solution, way: str = AUTO) -> Exponents:
    """Return Floquet exponents at a solution: by Hill's method, or by the time map where there are contacts with
    friction. The stiffness of a stop switches, so that its harmonics fall slowly. Where one is touched, the exponents
    are those with twice the harmonics, and their change is the error.
    """
    if way == TIME_MAP or (way == AUTO and (problem.by_receptances or remembers(problem))):
        # Hill's matrix lacks the memory of sliders: multipliers of 2.7 for a motion whose largest is 0.94 (three masses
        # with sliders, cubic springs and a stop, at 1.63 rad/s).
        of_map = _by_modes if problem.by_receptances else _by_time_map
        values = problem.once(TIME_MAP, solution, lambda: of_map(problem, solution))
        if np.isnan(values).any():
            return Exponents(np.zeros(0), unjudged=MANY_ROWS)
        values = _held(problem, values)
        return _on_side(problem, solution, values, 0.0)
    values = _held(problem, problem.once(HILL, solution, lambda: hill(problem, solution)))
    stops = [block.rows.ravel() for block in problem.lowered.laws if block.element.switches]
    if not stops or not np.any(solution.evaluation.forces[np.concatenate(stops)]):
        return Exponents(values)
    method = problem.method.refined()
    if method is None or problem.lowered.structure.size * (2 * method.highest + 1) > LARGEST:
        return Exponents(values, TRUNCATED)
    # A map over a period with the stop's exact events was tried and was less accurate: the motion was truncated and its
    # disturbance was not. Hill's method truncates both alike.
    finer = problem.once(FINER, solution, lambda: _finer(Equations(problem.lowered, method), problem, solution))
    if not finer.size:
        return Exponents(values, np.inf)
    finer = _held(problem, finer)
    return _on_side(problem, solution, finer, _change(values, finer))


def _on_side(problem: Equations, solution: Solution, values: np.ndarray, error: float) -> Exponents:
    r"""Return exponents on the side of a fold on which the motion is.

    With all harmonics, the determinant of the balance has the sign of :math:`\det(1 - \Phi)`, where Φ is the map of
    disturbances over a period: each real multiplier above 1 changes it. Exponents with more harmonics than the balance,
    or by the steps of a map, pass zero at another place. Between both, the real one next to zero has the other sign.
    """
    real = real_ones(values)
    growing = int(np.sum((np.real(values) > NEUTRAL) & real))
    sign = _sign(problem, solution)
    if sign * (-1) ** growing >= 0:
        return Exponents(values, error, signed=bool(sign))
    nearest = int(np.argmin(np.where(real, np.abs(np.real(values)), np.inf))) if real.any() else -1
    if nearest < 0 or abs(np.real(values[nearest])) > SHIFTED:
        return Exponents(values, error, ACROSS_FOLD)
    turned = values.copy()
    turned[nearest] = complex(-np.real(values[nearest]), np.imag(values[nearest]))
    return Exponents(sorted_by_growth(turned), error, signed=True)


def real_ones(values: np.ndarray) -> np.ndarray:
    """Return which exponents have real positive multipliers, (exponents,): whole imaginary parts, in parts of ω."""
    return np.abs(np.imag(values) - np.round(np.imag(values))) < REAL


def sorted_by_growth(values: np.ndarray) -> np.ndarray:
    """Return exponents, the fastest growing first."""
    return np.array(sorted(values, key=lambda value: (-value.real, abs(value.imag), value.imag)))


def _sign(problem: Equations, solution: Solution) -> float:
    """Return the sign of the determinant of the balance, with even harmonics too.

    Odd harmonics alone do not contain disturbances that break the symmetry, which have multipliers too.
    """
    every = problem.with_even
    if every is problem:
        return solution.tangent.sign
    unknowns = in_orders(solution.unknowns, problem.method.orders, every.method.orders)
    return every.placed(unknowns, solution.omega, solution.samples).tangent.sign


def _held(problem: Equations, values: np.ndarray) -> np.ndarray:
    """Return exponents with the pairs of free motions (position and velocity) at zero: rounding splits such pairs."""
    if problem.by_receptances:
        return values
    # Position and velocity along a free motion are a Jordan block of two zeros: rounding splits it by the root of eps.
    nearest = np.argsort(np.abs(values))[: 2 * problem.condensation.free.shape[1]]
    result = values.copy()
    result[nearest[np.abs(values[nearest]) < SPLIT]] = 0.0
    return result


def _change(values: np.ndarray, finer: np.ndarray) -> float:
    """Return the difference of the growth of the fastest exponent of each to the nearest exponent of the other.

    Next to each other in the plane: beside a fold or a crossing the fastest ones of both are not the same exponent.
    """
    pairs = (complex(finer[0]), values), (complex(values[0]), finer)
    return max(abs(value.real - float(np.real(spectrum)[_nearest(value, spectrum)])) for value, spectrum in pairs)


def _nearest(value: complex, spectrum: np.ndarray) -> int:
    """Return the number of the nearest exponent, up to copies and conjugates."""
    turns = np.minimum(abs(np.imag(spectrum) % 1 - value.imag % 1), abs(np.imag(spectrum) % 1 - -value.imag % 1))
    return int(np.argmin(np.hypot(np.real(spectrum) - value.real, np.minimum(turns, 1 - turns))))


def _finer(finer: Equations, problem: Equations, solution: Solution) -> np.ndarray:
    """Return the exponents with more harmonics, by Hill's method; none if the motion is not converged (near a fold)."""
    begin = in_orders(solution.unknowns, problem.method.orders, finer.method.orders)
    samples = max(finer.method.first_samples, solution.samples)
    better = finer.solve(begin, solution.omega, samples)
    return hill(finer, better) if better.converged else np.zeros(0, dtype=complex)


def _by_time_map(problem: Equations, solution: Solution) -> np.ndarray:
    point = solution.condensed
    linear = problem.stiffness_balance(solution.samples).linear(point.stiffness, point.force, solution.unknowns)
    series = Fourier(problem.method.orders, max(FEWEST, solution.samples))
    # The map goes from sample to sample, and so do the states that it takes from the elements.
    speed = problem.lowered.spin(solution.omega)[0]
    system = Uncondensed(problem.lowered, problem.condensation, series, events=False, speed=speed)
    return _exponents(monodromy(system, linear, solution.unknowns, solution.omega))


def _by_modes(problem: Equations, solution: Solution) -> np.ndarray:
    """Return the same by receptances; NaN where the active elements have too many rows."""
    require_viscous(problem.lowered.structure, "stability and Floquet multipliers")
    balance, point = problem.balance(solution.samples), solution.point
    assert isinstance(balance, ReceptanceBalance)
    assert isinstance(point, ReceptancePoint)
    lowered = balance.active(point, solution.unknowns)
    if len(active_rows(lowered)) > MOST_ROWS:
        return np.full(1, complex(np.nan))
    series = Fourier(problem.method.orders, max(FEWEST, solution.samples))
    return _exponents(modal_map(lowered, point, series, solution.unknowns, lowered.spin(solution.omega)[0]))


def _exponents(period: np.ndarray) -> np.ndarray:
    """Return exponents in parts of ω from the map over a period: the logarithm of the multipliers by 2π."""
    # Forgotten states have multiplier zero, and no exponent.
    factors = np.linalg.eigvals(period).astype(complex)
    return sorted_by_growth(np.log(factors[np.abs(factors) > FORGOTTEN]) / (2 * np.pi))
