"""SciPy's trust-region least squares, with bounds and an exact jacobian."""

from dataclasses import dataclass

import numpy as np

from dalembert.arguments import limited
from dalembert.optimize.minimum import Minimum, Progress, reachable
from dalembert.optimize.stopping import WINDOW, Stopped, Stopping
from dalembert.optimize.sum_of_squares import SquaresMinimiser, SumOfSquares
from dalembert.optimize.valley import follow_valley

LEAST_GAIN = 1e-14
"""Fraction of the sum of squares. A step that gains less ends a descent, whatever is foreseen."""

COARSE = 1e-3
"""Fraction of the sum of squares. With this ``gain`` a descent is one of many, of which the best continues: progress is
judged sooner. With a larger one it only leads to another descent, and one step that gains less ends it."""

ROUNDING = 1e-14
"""Columns of the jacobian below this part of the largest are rounding."""

LARGEST = 1e150
"""A sample with larger residuals has failed: their squares overflow."""

SMOOTH = 1e-8
"""Fraction of the sum of squares. Where the linear model foresees a larger fall although the parameters move no more,
the residuals are rough."""

TRIALS = 100
"""Residuals at most, for each parameter and one more. Descents without progress stop long before."""


@dataclass(frozen=True)
class LeastSquares(SquaresMinimiser):
    """Bounded nonlinear least squares by SciPy's trust-region reflective method.

    Parameters
    ----------
    trials : int, optional
        Most residuals to compute; 100 (1 + parameters) if not given.
    tolerance : float
        Ends when a step is shorter than this, relative to one unit a parameter.
    gain : float
        Ends when the linear model within the bounds foresees a fall of the sum of squares by less than this fraction,
        or when a step that goes as foreseen lowers it by less than the smaller of this and 1e-14. Above 1e-3 one step
        that lowers it by less than ``gain`` is enough.

    Notes
    -----
    The solver works in u = 1 + (x − start)/scale, with a trust region in the shape of the jacobian's columns: a
    parameter may move the farther, the less the residuals depend on it. The first trust radius is that of the first
    point, so every parameter may move by about one ``scale`` at first, wherever the origin of x lies.

    A descent also ends when 10 trial points for each parameter, or 4 with a ``gain`` from 1e-3 on, and at least 20,
    lowered the sum of squares by less than 2 %, and the foreseen fall did not shrink tenfold either: the residuals are
    rough then, the jacobian is wrong, or the descent follows a long curved valley. If the foreseen fall is below
    0.01 %, the minimum is reached up to the roughness. Otherwise, with a ``gain`` below 1e-3, steps with geodesic
    acceleration follow the valley, judged by the same rule. If they come no further, the descent has not converged.

    Examples
    --------
    >>> import numpy as np
    >>> residual = lambda x: np.array([x[0] - 1.0, 10 * (x[1] - x[0] ** 2)])
    >>> jacobian = lambda x: np.array([[1.0, 0.0], [-20 * x[0], 10.0]])
    >>> LeastSquares().minimise(residual, jacobian, [-2, -2], [2, 2], [-1.2, 1.0]).x.round(12).tolist()
    [1.0, 1.0]
    """

    trials: int | None = limited(None, least=1)
    tolerance: float = reachable(1e-10)
    gain: float = reachable(1e-13)

    def descend(self, problem: SumOfSquares, start: np.ndarray) -> Minimum:
        window = max(WINDOW, (10 if self.gain < COARSE else 4) * len(start))
        most = TRIALS * (1 + len(start)) if self.trials is None else self.trials
        path = _Path(problem, start, Stopping(self.gain, window), most)
        found = self._trust_region(path)
        if found.success or self.gain >= COARSE or not np.isfinite(found.fitness):
            return found
        path.stopping = Stopping(self.gain, window)
        try:
            follow_valley(path, path.x, path.stopping, self.tolerance)
        except Stopped as stopped:
            return path.minimum(stopped)

    def _trust_region(self, path: "_Path") -> Minimum:
        from scipy.optimize import least_squares  # what does not minimise starts without it

        problem, start = path.problem, path.origin
        try:
            if not np.all(np.isfinite(path.residual(path.one))):
                return path.minimum(Stopped("the first point could not be simulated", success=False))
            result = least_squares(
                path.residual,
                path.one,
                path.jacobian,  # pyright: ignore[reportArgumentType]
                bounds=(1 + (problem.low - start) / problem.unit, 1 + (problem.high - start) / problem.unit),
                method="trf",
                x_scale="jac",
                # A larger one would end a descent along a curved valley, where steps are short.
                ftol=self.gain if self.gain > COARSE else min(LEAST_GAIN, self.gain),
                xtol=self.tolerance,
                # An absolute threshold on the gradient would depend on the units of the data.
                gtol=None,  # pyright: ignore[reportArgumentType]
                max_nfev=path.most,
            )
        except Stopped as stopped:
            return path.minimum(stopped)
        if result.status == 0:
            return path.minimum(path.spent())
        if result.status == 2:
            return path.minimum(Stopped("converged: the sum of squares falls no more"))
        return path.minimum(path.stopping.at_rest(max(SMOOTH, self.gain)))


@dataclass(eq=False)
class _Path:
    """Residual and jacobian as SciPy calls them, in u = 1 + (x − origin)/unit; counts, and keeps the best point."""

    problem: SumOfSquares
    origin: np.ndarray
    stopping: Stopping
    most: int
    best: float = np.inf
    evaluations: int = 0
    iterations: int = 0

    def __post_init__(self) -> None:
        self.x, self.one = self.origin, np.ones_like(self.origin)
        self.last = (np.full_like(self.origin, np.nan), self.origin)
        self.seen = np.zeros(len(self.origin), dtype=bool)

    def place(self, u: np.ndarray) -> np.ndarray:
        return np.clip(self.origin + (u - 1) * self.problem.unit, self.problem.low, self.problem.high)

    def residual(self, u: np.ndarray) -> np.ndarray:
        if np.array_equal(self.last[0], u):  # SciPy asks again for the first point
            return self.last[1]
        value = self.residual_at(self.place(u))
        self.last = (u.copy(), value)
        self.stopping.tried(self.best)
        return value

    def residual_at(self, x: np.ndarray) -> np.ndarray:
        if self.evaluations >= self.most:
            raise self.spent()
        value = self.problem.residual(x)
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
        slopes = self.slopes_at(x)
        self.stopping.at(self.last[1], slopes, (problem.low - x) / problem.unit, (problem.high - x) / problem.unit)
        return np.where(_significant(slopes), slopes, 0.0)  # in such units a parameter would move far for nothing

    def slopes_at(self, x: np.ndarray) -> np.ndarray:
        self.tell()
        slopes = self.problem.jacobian(x) * self.problem.unit
        if not slopes.any():
            raise Stopped("converged: the residual does not change with the parameters", stationary=True)
        # On a plateau a column falls below the rounding of others that it stood above before: no minimum is there.
        self.seen |= _significant(slopes)
        slopes[:, ~self.seen] = 0.0
        return slopes

    def tell(self) -> None:
        self.problem.on_iteration(Progress(self.iterations, self.evaluations, self.best, self.x))
        self.iterations += 1

    def spent(self) -> Stopped:
        allow = "not converged; allow more with LeastSquares(trials=...)"
        return Stopped(f"stopped after {self.most} trial points, {allow}", success=False)

    def minimum(self, end: Stopped) -> Minimum:
        iterations = max(0, self.iterations - 1)
        return Minimum(
            self.x, self.best, end.success, str(end), iterations, self.evaluations, end.stationary, end.rough
        )


def _significant(slopes: np.ndarray) -> np.ndarray:
    """Return the mask (parameters,) of the columns of slopes (values, parameters) that are not rounding."""
    size = np.linalg.norm(slopes, axis=0)
    return size >= ROUNDING * size.max()
