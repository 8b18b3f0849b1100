"""SciPy's trust-region least squares, with bounds and an exact jacobian."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from dalembert.errors import InputError
from dalembert.optimize.minimum import Minimum, OnIteration, Progress, box


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
        if self.trials < 1:
            raise InputError(f"LeastSquares: trials is {self.trials}; expected at least 1")
        for name in ("tolerance", "gain"):
            if not np.finfo(float).eps < getattr(self, name) < 1:
                raise InputError(f"LeastSquares: {name} is {getattr(self, name)}; expected a number from 3e-16 to 1")

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
        unit = np.broadcast_to(np.asarray(scale, dtype=float), origin.shape)
        best, x_best, evaluations, iterations = np.inf, origin, 0, 0

        def place(u: np.ndarray) -> np.ndarray:
            return np.clip(origin + (u - 1) * unit, low, high)

        def fun(u: np.ndarray) -> np.ndarray:
            nonlocal evaluations, best, x_best
            evaluations += 1
            value = residual(place(u))
            squares = value @ value
            if squares < best:
                best, x_best = float(squares), place(u)
            return value

        def jac(u: np.ndarray) -> np.ndarray:
            nonlocal iterations
            if on_iteration is not None:
                on_iteration(Progress(iterations, evaluations, best, x_best))
            iterations += 1
            return jacobian(place(u)) * unit

        one = np.ones_like(origin)
        first = fun(one)
        if not np.all(np.isfinite(first)):
            return Minimum(origin, np.inf, False, "the first point could not be simulated", 0, evaluations)
        result = least_squares(
            lambda u: first if evaluations == 1 and np.array_equal(u, one) else fun(u),
            one,
            jac,  # pyright: ignore[reportArgumentType]
            bounds=(1 + (low - origin) / unit, 1 + (high - origin) / unit),
            method="trf",
            ftol=self.gain,
            xtol=self.tolerance,
            # An absolute threshold on the gradient would depend on the units of the data.
            gtol=None,  # pyright: ignore[reportArgumentType]
            max_nfev=self.trials,
        )
        message = {
            0: f"stopped after {self.trials} trial points, not converged; allow more with LeastSquares(trials=...)",
            2: "converged: the sum of squares falls no more",
            3: "converged: the parameters move no more",
            4: "converged: neither parameters nor sum of squares move any more",
        }[result.status]
        stationary = result.status in (3, 4)
        return Minimum(x_best, best, result.status > 0, message, max(0, iterations - 1), evaluations, stationary)
