"""Search of the largest amplitude along a path of solutions."""

from dataclasses import dataclass

import numpy as np

from dalembert.vibration.balance.arc_length import PathTangent, direction_at, zero_between
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.fourier import synthesis
from dalembert.vibration.paths.amplitudes import Amplitude

WIDTH = 0.1
"""Change of ω, as part of itself, that counts as much along the path as the whole motion."""
FIRST, LONGEST, SHORTEST = 0.02, 0.3, 1e-6
"""Steps along the path, as part of the motion."""
BEYOND = 1.5
"""Step that is to pass the peak, as part of the way to it by the curvature at the peak before."""
MOST_STEPS = 60
NARROW = 1e-6
"""Length along the path to which a peak is found."""


@dataclass(frozen=True)
class Peak:
    """A peak at a value of the parameter, and the curvature of the logarithm of the amplitude along the path."""

    value: float
    problem: Equations
    solution: Solution
    amplitude: float = float("nan")
    bend: float = float("nan")


def upwards(solution: Solution) -> np.ndarray:
    direction = np.zeros(solution.unknowns.size + 1)
    direction[-1] = 1.0
    return direction


@dataclass(frozen=True)
class PeakSearch:
    """Search of the largest amplitude of the measured degree of freedom along a path."""

    size: Amplitude

    def search(self, problem: Equations, solution: Solution, bend: float) -> tuple[Peak | None, int]:
        """Return the peak next to a solution, and the number of solutions."""
        width = WIDTH * solution.omega
        direction = direction_at(solution, upwards(solution), width)
        rise = self._rise(problem, solution, direction, PathTangent(solution, direction, width).size)
        if rise < 0:
            rise, direction = -rise, -direction
        length = FIRST if np.isnan(bend) else float(np.clip(BEYOND * abs(rise / bend), SHORTEST, LONGEST))
        for count in range(1, MOST_STEPS + 1):
            path = PathTangent(solution, direction, width)
            ahead, onward = path.step(problem, length)
            if onward is None:
                length /= 4
                if length < SHORTEST:
                    return None, count
                continue
            beyond = self._rise(problem, ahead, onward, path.size)
            # The slope of the amplitude changes its sign within this step: Brent's method narrows it.
            if beyond < 0:
                peak, spent = self._narrowed(problem, path, ahead, (rise, beyond), length)
                return peak, count + spent
            solution, direction, rise = ahead, direction_at(ahead, onward, width), beyond
            length = min(LONGEST, 2 * length)
        return None, MOST_STEPS

    def _narrowed(
        self, problem: Equations, path: PathTangent, ahead: Solution, rises: tuple[float, float], length: float
    ) -> tuple[Peak | None, int]:
        """Return the peak between the ends of a step: a zero of the slope of the amplitude."""

        def rise(part: float) -> tuple[Solution, float]:
            solution, onward = path.step(problem, part)
            value = float("nan") if onward is None else self._rise(problem, solution, onward, path.size)
            return solution, value

        tried = {0.0: (path.known, rises[0]), length: (ahead, rises[1])}
        solution = zero_between(rise, length, tried, NARROW)
        if solution is None:
            return None, len(tried) - 2
        amplitude = float(self.size.of(problem.measured @ solution.unknowns))
        return Peak(np.nan, problem, solution, amplitude, (rises[1] - rises[0]) / length), len(tried) - 2

    def _rise(self, problem: Equations, solution: Solution, direction: np.ndarray, size: float) -> float:
        """Derivative of the logarithm of the amplitude along the path: ∇a · dU/a."""
        change = direction[:-1].reshape(solution.unknowns.shape) * size
        motion = problem.measured @ solution.unknowns
        return float(_gradient(self.size, motion) @ (problem.measured @ change)) / float(self.size.of(motion))


def _gradient(size: Amplitude, motion: np.ndarray) -> np.ndarray:
    """Derivative of an amplitude by the coefficients; of a peak at its own instant, not at the nearest sample."""
    if size.kind != "peak":
        return size.slope(motion)
    angle = size.instant(motion)
    orders = np.array([h for h in size.orders for _ in range(1 if h == 0 else 2)])
    for _ in range(3):
        waves = synthesis(size.orders, np.array([angle]))[0]
        # A peak lies at x'(τ) = 0: three steps of Newton from the nearest sample take its instant to rounding.
        turned = synthesis(size.orders, np.array([angle + 1e-30j]))[0].imag / 1e-30
        angle -= float(turned @ motion) / float(-(orders**2 * waves) @ motion)
    waves = synthesis(size.orders, np.array([angle]))[0]
    return np.sign(waves @ motion) * waves  # of two opposite peaks of one size, the sign of the one at this instant
