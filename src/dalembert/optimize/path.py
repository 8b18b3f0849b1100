"""The way of a descent of least squares: residuals and slopes at its points, counted and judged."""

from dataclasses import dataclass

import numpy as np

from dalembert.optimize.identifiable_part import creeps, identifiable_part
from dalembert.optimize.minimum import Minimum, Progress
from dalembert.optimize.stopping import Stopped, Stopping
from dalembert.optimize.sum_of_squares import SumOfSquares

ROUNDING = 1e-14  # columns of the jacobian below this part of the largest are rounding
LARGEST = 1e150  # a sample with larger residuals has failed: their squares overflow


class Creeps(Exception):
    """A descent creeps along directions that are not identifiable, from a point with its residual and slopes on."""

    def __init__(self, x: np.ndarray, residual: np.ndarray, slopes: np.ndarray) -> None:
        super().__init__()
        self.x, self.residual, self.slopes = x, residual, slopes


@dataclass(eq=False)
class SearchPath:
    """Residual and jacobian as SciPy calls them, in u = 1 + (x − origin)/unit; counts, and keeps the best point."""

    problem: SumOfSquares
    origin: np.ndarray
    stopping: Stopping
    most: int
    method: str
    best: float = np.inf
    evaluations: int = 0
    iterations: int = 0

    def __post_init__(self) -> None:
        self.x, self.one = self.origin, np.ones_like(self.origin)
        self.last = (np.full_like(self.origin, np.nan), self.origin)
        self.seen = np.zeros(len(self.origin), dtype=bool)
        self.before = np.inf

    def place(self, u: np.ndarray) -> np.ndarray:
        return np.clip(self.origin + (u - 1) * self.problem.unit, self.problem.low, self.problem.high)

    def residual(self, u: np.ndarray) -> np.ndarray:
        if np.array_equal(self.last[0], u):  # SciPy asks again for the first point
            return self.last[1]
        value = self.residual_at(self.place(u))
        self.last = (u.copy(), value)
        self.stopping.tried(self.best)
        return value

    def residual_at(self, x: np.ndarray, *, ahead: bool = False) -> np.ndarray:
        if self.evaluations >= self.most:
            raise self.spent()
        # Trial points that only look ahead need no slopes; a model may compute them with less effort.
        value = self.problem.ahead(x) if ahead else self.problem.residual(x)
        self.evaluations += 1
        if not np.all(np.abs(value) < LARGEST):
            value = np.full_like(value, np.nan)
        squares = float(value @ value)
        if squares < self.best:
            self.best, self.x = squares, x
        if squares == 0:
            self.tell()
            raise Stopped("converged: the fit is perfect", stationary=True)
        return value

    def jacobian(self, u: np.ndarray) -> np.ndarray:
        x, problem = self.place(u), self.problem
        slopes, residual, before = self.slopes_at(x), self.last[1], self.before
        self.before = float(residual @ residual)
        if creeps(before, self.before, self.stopping.foreseen):
            fall = before - self.before
            if identifiable_part(problem, x, residual, slopes, fall).final:
                raise Creeps(x, residual, slopes)
        self.stopping.at(residual, slopes, (problem.low - x) / problem.unit, (problem.high - x) / problem.unit)
        return np.where(significant(slopes), slopes, 0.0)  # in such units a parameter would move far for nothing

    def slopes_at(self, x: np.ndarray) -> np.ndarray:
        self.tell()
        slopes = self.problem.jacobian(x) * self.problem.unit
        if not slopes.any():
            raise Stopped("converged: the residual does not change with the parameters", stationary=True)
        # On a plateau a column falls below the rounding of others that it stood above before: no minimum is there.
        self.seen |= significant(slopes)
        slopes[:, ~self.seen] = 0.0
        return slopes

    def tell(self) -> None:
        self.problem.on_iteration(Progress(self.iterations, self.evaluations, self.best, self.x))
        self.iterations += 1

    def spent(self) -> Stopped:
        advice = f"allow more with {self.method}(trials=...)"
        return Stopped(f"stopped after {self.most} trial points, not converged; {advice}", success=False)

    def minimum(self, end: Stopped) -> Minimum:
        iterations = max(0, self.iterations - 1)
        return Minimum(
            self.x, self.best, end.success, str(end), iterations, self.evaluations, end.stationary, end.rough
        )


def significant(slopes: np.ndarray) -> np.ndarray:
    """Return the mask (parameters,) of the columns of slopes (values, parameters) that are not rounding."""
    size = np.linalg.norm(slopes, axis=0)
    return size >= ROUNDING * size.max()
