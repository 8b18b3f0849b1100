"""SciPy's trust-region least squares, with bounds and an exact jacobian."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from dalembert.optimize.minimum import Minimum, OnIteration, Progress, box, expect_reachable
from dalembert.settings import expect_at_least


@dataclass(frozen=True)
class LeastSquares:
    """Bounded nonlinear least squares by SciPy's trust-region reflective method.

    Parameters
    ----------
    trials : int
        Most residuals to compute.
    tolerance : float
        Ends when a step is shorter than this, relative to one unit a parameter.
    gain : float
        Ends when a step, going as foreseen, lowers the sum of squares by less than this fraction.

    Notes
    -----
    The solver works in u = 1 + (x − start)/scale. Its first trust radius is the length of its first point, so every
    parameter may move by about one ``scale`` at first, wherever the origin of x lies.

    Examples
    --------
    >>> import numpy as np
    >>> residual = lambda x: np.array([x[0] - 1.0, 10 * (x[1] - x[0] ** 2)])
    >>> jacobian = lambda x: np.array([[1.0, 0.0], [-20 * x[0], 10.0]])
    >>> LeastSquares().minimise(residual, jacobian, [-2, -2], [2, 2], [-1.2, 1.0]).x.round(12).tolist()
    [1.0, 1.0]
    """

    trials: int = 50
    tolerance: float = 1e-10
    gain: float = 1e-8

    def __post_init__(self) -> None:
        expect_at_least(self, 1, "trials")
        expect_reachable(self, "tolerance", "gain")

    def minimise(
        self,
        residual: Callable[[np.ndarray], np.ndarray],
        jacobian: Callable[[np.ndarray], np.ndarray],
        lower: ArrayLike,
        upper: ArrayLike,
        start: ArrayLike,
        *,
        scale: ArrayLike = 1.0,
        on_iteration: OnIteration | None = None,
    ) -> Minimum:
        """Least sum of squares near ``start``.

        Parameters
        ----------
        residual : callable
            (parameters,) to (residuals,); NaN or infinite where the sample failed, which shortens the step.
        jacobian : callable
            (parameters,) to (residuals, parameters); asked only where the residual was just computed.
        lower, upper, start, scale : array, shape (parameters,)
        on_iteration : callable, optional
            Called with a :class:`Progress` at the start and after each accepted step.
        """
        low, high = box(lower, upper)
        origin = np.clip(np.asarray(start, dtype=float), low, high)
        path = _Path(residual, jacobian, low, high, origin, np.broadcast_to(scale, origin.shape), on_iteration)
        try:
            if not np.all(np.isfinite(path.residual(path.one))):
                return path.minimum(False, "the first point could not be simulated", False)
            result = least_squares(
                path.residual,
                path.one,
                path.jacobian,  # pyright: ignore[reportArgumentType]
                bounds=(1 + (low - origin) / path.unit, 1 + (high - origin) / path.unit),
                method="trf",
                ftol=self.gain,
                xtol=self.tolerance,
                # An absolute threshold on the gradient would depend on the units of the data.
                gtol=None,  # pyright: ignore[reportArgumentType]
                max_nfev=self.trials,
            )
        except _Settled as settled:
            return path.minimum(True, str(settled), True)
        message = {
            0: f"stopped after {self.trials} trial points, not converged; allow more with LeastSquares(trials=...)",
            2: "converged: the sum of squares falls no more",
            3: "converged: the parameters move no more",
            4: "converged: neither parameters nor sum of squares move any more",
        }[result.status]
        return path.minimum(result.status > 0, message, result.status in (3, 4))


class _Settled(Exception):
    """Nothing is left to minimise, where SciPy would divide zero by zero; the message says why."""


class _Path:
    """Residual and jacobian as SciPy calls them, in u = 1 + (x − origin)/unit; counts, and keeps the best point."""

    def __init__(
        self,
        residual: Callable[[np.ndarray], np.ndarray],
        jacobian: Callable[[np.ndarray], np.ndarray],
        low: np.ndarray,
        high: np.ndarray,
        origin: np.ndarray,
        unit: np.ndarray,
        on_iteration: OnIteration | None,
    ) -> None:
        self._residual, self._jacobian, self.on_iteration = residual, jacobian, on_iteration
        self.low, self.high, self.origin, self.unit = low, high, origin, unit
        self.one = np.ones_like(origin)
        self.best, self.x, self.evaluations, self.iterations = np.inf, origin, 0, 0
        self.last: tuple[np.ndarray, np.ndarray] | None = None

    def place(self, u: np.ndarray) -> np.ndarray:
        return np.clip(self.origin + (u - 1) * self.unit, self.low, self.high)

    def residual(self, u: np.ndarray) -> np.ndarray:
        if self.last is not None and np.array_equal(self.last[0], u):  # SciPy asks again for the first point
            return self.last[1]
        value = self._residual(self.place(u))
        self.evaluations += 1
        self.last = (u.copy(), value)
        squares = float(value @ value)
        if squares < self.best:
            self.best, self.x = squares, self.place(u)
        if squares == 0:
            self.tell()
            raise _Settled("converged: the fit is perfect")
        return value

    def jacobian(self, u: np.ndarray) -> np.ndarray:
        self.tell()
        slopes = self._jacobian(self.place(u)) * self.unit
        if not slopes.any():
            raise _Settled("converged: the residual does not change with the parameters")
        return slopes

    def tell(self) -> None:
        if self.on_iteration is not None:
            self.on_iteration(Progress(self.iterations, self.evaluations, self.best, self.x))
        self.iterations += 1

    def minimum(self, success: bool, message: str, stationary: bool) -> Minimum:
        iterations = max(0, self.iterations - 1)
        return Minimum(self.x, self.best, success, message, iterations, self.evaluations, stationary)
