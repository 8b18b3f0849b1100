"""A surrogate of a function over a box."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError, SolveError
from dalembert.latin_hypercube import latin_hypercube
from dalembert.surrogate.basis import chebyshev, products
from dalembert.surrogate.polynomial import ChebyshevPolynomial
from dalembert.surrogate.runs import Function, Runs, failed
from dalembert.surrogate.scheme import Fitted, Scheme
from dalembert.surrogate.surrogate import Surrogate


def fit(
    function: Function,
    lower: ArrayLike,
    upper: ArrayLike,
    scheme: Scheme,
    *,
    seed: int = 0,
    held_out: int = 8,
    groups: ArrayLike | None = None,
    on_runs: Callable[[int], None] | None = None,
) -> Surrogate:
    """Chebyshev surrogate of a function over a box, all of its outputs at once.

    Parameters
    ----------
    function : callable
        Points (n, d) to outputs (n, outputs); a row of NaN marks a run that failed.
    lower, upper : array, shape (d,)
        The box, ``lower <= upper``. A direction without width costs no runs.
    scheme : TotalDegree, Tensor or Adaptive
    seed : int
        Of the held-out points.
    held_out : int
        Runs that the polynomial is tested by and not made from: a Latin hypercube in arccos η, so that they lie denser
        towards the sides, where surrogates err most.
    groups : array of int, shape (outputs,), optional
        Outputs with one number share one scale: the largest variation over the runs of an output of the group. One
        group of all if not given.
    on_runs : callable, optional
        Called with the number of runs so far, after each batch.

    Returns
    -------
    Surrogate

    Raises
    ------
    InputError
        For a box that is none, or a function that returns another shape.
    SolveError
        For failed runs that the scheme cannot do without.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.surrogate import Tensor, fit
    >>> wave = fit(lambda x: np.sin(x[:, :1] + x[:, 1:] ** 2), [0.0, 0.0], [1.0, 1.0], Tensor(8))
    >>> wave.runs, bool(wave.error[0] < 1e-5), bool(abs(wave([[0.5, 0.2]]) - np.sin(0.54)) < wave.error)
    (89, True, True)
    """
    low, high = _box(lower, upper)
    runs = Runs(function, low, high, on_runs)
    test = _held_out(runs, held_out if runs.directions else 0, seed)
    truth = runs(test) if len(test) else np.empty((0, 0))
    kept = ~failed(truth)

    def difference(exponents: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
        if not kept.any():
            return np.zeros(coefficients.shape[1])
        basis = products(chebyshev(test[kept], exponents.max(axis=0, initial=0)), exponents)
        return np.max(np.abs(basis @ coefficients - truth[kept]), axis=0)

    fitted = (
        scheme.fitted(runs, seed, difference, lambda: _scale(runs.values, groups))
        if runs.directions
        else _constant(runs)
    )
    ok = ~failed(runs.values)
    return Surrogate(
        _embedded(runs, fitted),
        scheme,
        fitted.tail,
        difference(fitted.exponents, fitted.coefficients),
        runs.points[ok],
        runs.values[ok],
        _scale(runs.values, groups),
        int(np.sum(~ok)),
    )


def _box(lower: ArrayLike, upper: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    low, high = np.array(lower, dtype=float, ndmin=1), np.array(upper, dtype=float, ndmin=1)
    if low.ndim != 1 or low.shape != high.shape or not np.all(np.isfinite(low) & np.isfinite(high) & (low <= high)):
        raise InputError(
            f"a box from {low.tolist()} to {high.tolist()} was given; "
            "expected two vectors of one length, finite, the lower one first"
        )
    return low, high


def _held_out(runs: Runs, number: int, seed: int) -> np.ndarray:
    """Coordinates of the held-out runs, shape (number, f)."""
    if number < 0:
        raise InputError(f"held_out is {number}; expected zero or more runs")
    if number == 0:
        return np.empty((0, runs.directions))
    return -np.cos(np.pi * latin_hypercube(runs.directions, number, np.random.default_rng((seed, 3))))


def _scale(values: np.ndarray, groups: ArrayLike | None) -> np.ndarray:
    """Largest variation of an output of each group over the runs, shape (outputs,); never below rounding."""
    values = values[~failed(values)]
    if not len(values):
        raise SolveError("all runs of a surrogate failed; keep the box away from where the model fails")
    group = np.zeros(values.shape[1], dtype=int) if groups is None else np.unique(groups, return_inverse=True)[1]
    if group.shape != values.shape[1:]:
        raise InputError(f"groups of shape {group.shape} were given; expected {values.shape[1:]}, one number an output")
    largest = np.zeros((2, group.max(initial=0) + 1))
    np.maximum.at(largest[0], group, np.ptp(values, axis=0))
    np.maximum.at(largest[1], group, np.max(np.abs(values), axis=0))
    return np.maximum(largest[0], 100 * np.finfo(float).eps * largest[1])[group]


def _constant(runs: Runs) -> Fitted:
    """The polynomial of a box without any width, from one run."""
    values = runs(np.empty((1, 0)))
    return Fitted(np.zeros((1, 0), dtype=int), values, np.zeros(values.shape[1]))


def _embedded(runs: Runs, fitted: Fitted) -> ChebyshevPolynomial:
    """The polynomial in all directions, constant in those without width."""
    exponents = np.zeros((len(fitted.exponents), len(runs.lower)), dtype=int)
    exponents[:, runs.free] = fitted.exponents
    return ChebyshevPolynomial(runs.lower, runs.upper, exponents, fitted.coefficients)
