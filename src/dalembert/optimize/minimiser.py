"""Any minimiser of SciPy, by its name."""

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from inspect import signature
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import Checked
from dalembert.errors import InputError, require_known, unknown
from dalembert.intervals import corners
from dalembert.optimize.minimum import Minimum, Objective, OnIteration, Progress, misfits

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

BOUNDED = ("Nelder-Mead", "Powell", "L-BFGS-B", "TNC", "COBYLA", "COBYQA", "SLSQP", "trust-constr")
UNBOUNDED = ("CG", "BFGS", "Newton-CG")
GRADIENT = ("CG", "BFGS", "Newton-CG", "L-BFGS-B", "TNC", "SLSQP", "trust-constr")
GLOBAL = ("differential_evolution", "dual_annealing", "basinhopping", "shgo", "direct")
BATCHED = "differential_evolution"
NAMES = (*BOUNDED, *UNBOUNDED, *GLOBAL)
SET_HERE = {"func", "bounds", "rng", "x0", "args", "callback"}  # arguments of global minimisers that are no options
# How much worse than the worst a failed sample is told to be: SciPy interpolates, which no infinity survives.
FAILED = 10.0


@dataclass(frozen=True)
class Minimiser(Checked):
    """A minimiser of ``scipy.optimize``, local or global, by name.

    Parameters
    ----------
    name : str
        A method of ``scipy.optimize.minimize`` ("Nelder-Mead", "Powell", "L-BFGS-B" ...) or a global minimiser
        ("differential_evolution", "dual_annealing", "basinhopping", "shgo", "direct"); case does not matter.
    options : mapping
        For a method of ``minimize`` its ``options``; for a global minimiser its keyword arguments.

    Raises
    ------
    InputError
        For an unknown name, with the nearest ones; for options that the minimiser does not take.

    Examples
    --------
    >>> import numpy as np
    >>> bowl = lambda points: np.sum((points - 0.3) ** 2, axis=1)
    >>> Minimiser("nelder-mead").minimise(bowl, [-1, -1], [1, 1], seed=0).x.round(3).tolist()
    [0.3, 0.3]
    >>> Minimiser("nelder-meat")
    Traceback (most recent call last):
    dalembert.errors.InputError: unknown minimiser 'nelder-meat'; did you mean 'Nelder-Mead'?
    """

    name: str
    options: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        spelled = {name.lower(): name for name in NAMES}
        if self.name.lower() not in spelled:
            raise InputError(unknown("minimiser", self.name, NAMES))
        object.__setattr__(self, "name", spelled[self.name.lower()])
        if self.name in GLOBAL:
            import scipy.optimize as so

            taken = set(signature(getattr(so, self.name)).parameters) - SET_HERE
            for option in self.options:
                require_known("option", option, taken, f"Minimiser({self.name!r})")

    @property
    def batched(self) -> bool:
        """Whether it asks for the misfit of many points at once."""
        return self.name == BATCHED

    def minimise(
        self,
        objective: Objective,
        lower: ArrayLike,
        upper: ArrayLike,
        seed: int,
        *,
        start: ArrayLike | None = None,
        gradient: Callable[[np.ndarray], np.ndarray] | None = None,
        on_iteration: OnIteration | None = None,
    ) -> Minimum:
        """Smallest misfit found in the box.

        Parameters
        ----------
        objective : callable
            Batch (batch, parameters) to misfit (batch,); NaN marks a failed sample.
        lower, upper : array, shape (parameters,)
        seed : int
            For the methods that draw random numbers.
        start : array, shape (parameters,), optional
            Where local methods begin; the middle of the box if not given.
        gradient : callable, optional
            (parameters,) to (parameters,), for the local methods that use one; else SciPy differences.
        on_iteration : callable, optional
            Called with a :class:`Progress` at each improvement.
        """
        low, high = corners(lower, upper)
        x0 = (low + high) / 2 if start is None else np.clip(np.asarray(start, dtype=float), low, high)
        watched = _Watched(objective, low, high, on_iteration)
        result = self._global(watched, x0, seed) if self.name in GLOBAL else self._local(watched, x0, gradient)
        success = bool(np.isfinite(watched.best))
        said = result.message if isinstance(result.message, str) else "; ".join(result.message)
        message = said.rstrip(".") if success else "every sample failed"
        return Minimum(
            watched.x,
            watched.best,
            success and bool(result.success),
            message,
            result.get("nit", 0),
            watched.evaluations,
        )

    def _local(
        self, watched: "_Watched", x0: np.ndarray, gradient: Callable[[np.ndarray], np.ndarray] | None
    ) -> "OptimizeResult":
        import scipy.optimize as so

        bounds = so.Bounds(watched.low, watched.high)  # pyright: ignore[reportArgumentType]
        if self.name == "Newton-CG" and gradient is None:
            raise InputError("Minimiser('Newton-CG') needs a gradient of its objective; give gradient=, or use 'BFGS'")
        with warnings.catch_warnings():
            warnings.simplefilter("error", so.OptimizeWarning)
            warnings.filterwarnings("ignore", message="delta_grad == 0.0", category=UserWarning)  # trust-constr's end
            try:
                return so.minimize(
                    watched.one,
                    x0,
                    method=self.name,
                    jac=gradient if self.name in GRADIENT else None,
                    bounds=bounds if self.name in BOUNDED else None,
                    options=dict(self.options),
                )
            except so.OptimizeWarning as warning:  # SciPy only warns of an option that it does not know
                raise InputError(f"Minimiser({self.name!r}), options {dict(self.options)}: {warning}") from warning

    def _global(self, watched: "_Watched", x0: np.ndarray, seed: int) -> "OptimizeResult":
        import scipy.optimize as so

        bounds = so.Bounds(watched.low, watched.high)  # pyright: ignore[reportArgumentType]
        if self.batched:
            # Deferred updating evaluates a generation as one batch.
            settings = {"updating": "deferred", "vectorized": True, **self.options}
            return so.differential_evolution(watched.columns, bounds, rng=seed, **settings)
        if self.name == "dual_annealing":
            return so.dual_annealing(watched.one, bounds, rng=seed, x0=x0, **self.options)
        if self.name == "basinhopping":
            # Without bounds its local searches would leave the box.
            local = {"minimizer_kwargs": {"method": "L-BFGS-B", "bounds": bounds}, **self.options}
            return so.basinhopping(watched.one, x0, rng=seed, **local)
        return getattr(so, self.name)(watched.one, bounds, **self.options)


class _Watched:
    """The objective as SciPy calls it, counting and keeping the best point."""

    def __init__(self, objective: Objective, low: np.ndarray, high: np.ndarray, on_iteration: OnIteration | None):
        self.objective, self.low, self.high, self.on_iteration = objective, low, high, on_iteration
        self.evaluations, self.improvements, self.best, self.worst, self.x = 0, 0, np.inf, 1.0, (low + high) / 2

    def one(self, x: np.ndarray) -> float:
        """Misfit of one point (parameters,)."""
        return float(self.columns(np.asarray(x)[:, None])[0])

    def columns(self, points: np.ndarray) -> np.ndarray:
        """Misfit (batch,) of points given as columns (parameters, batch); a point outside the box has failed."""
        rows = np.atleast_2d(np.asarray(points, dtype=float).T)
        inside = np.all((rows >= self.low) & (rows <= self.high), axis=1)
        misfit = np.full(len(rows), np.inf)
        if inside.any():
            misfit[inside] = misfits(self.objective, rows[inside])
        self.evaluations += int(inside.sum())
        first = int(np.argmin(misfit))
        if misfit[first] < self.best:
            self.best, self.x = float(misfit[first]), rows[first].copy()
            self.improvements += 1
            if self.on_iteration is not None:
                self.on_iteration(Progress(self.improvements, self.evaluations, self.best, self.x))
        fine = np.isfinite(misfit)
        self.worst = max([self.worst, *np.abs(misfit[fine])])
        return np.where(fine, misfit, FAILED * self.worst)
