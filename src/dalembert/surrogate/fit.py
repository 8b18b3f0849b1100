"""A surrogate of a function over a box."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError, SolveError
from dalembert.intervals import corners
from dalembert.surrogate.held_out import held_out_runs
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
    held_out: int | None = None,
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
    held_out : int, optional
        Runs that the polynomial is tested by and not made from: a Latin hypercube in arccos η, so that they are denser
        near the sides, where surrogates are worst. Ten, or two for each direction with a width if that is more, if it
        is not given.
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
    (91, True, True)
    """
    runs = Runs(function, *corners(lower, upper, flat=True), on_runs)
    test = held_out_runs(runs, held_out, seed)
    fitted = scheme.fitted(runs, seed, test, lambda: _scale(runs, groups)) if runs.directions else _constant(runs)
    ok = ~failed(runs.values)
    # Constant in directions without a width.
    exponents = np.zeros((len(fitted.exponents), len(runs.lower)), dtype=int)
    exponents[:, runs.free] = fitted.exponents
    return Surrogate(
        ChebyshevPolynomial(runs.lower, runs.upper, exponents, fitted.coefficients),
        scheme,
        fitted.tail,
        test.difference(fitted.exponents, fitted.coefficients),
        runs.points[ok],
        runs.values[ok],
        _scale(runs, groups),
        int(np.sum(~ok)),
        len(test.eta),
        fitted.ended,
    )


def _scale(runs: Runs, groups: ArrayLike | None) -> np.ndarray:
    """Largest variation of an output of each group over the runs, shape (outputs,); never below rounding."""
    if runs.range is None:
        raise SolveError(
            "all runs of the model for a surrogate failed; choose bounds of the parameters within which the model runs"
        )
    # Relative to the variation, not to the size: an offset of an output asks for no accuracy.
    low, high = runs.range
    group = np.zeros(len(low), dtype=int) if groups is None else np.unique(groups, return_inverse=True)[1]
    if group.shape != low.shape:
        raise InputError(f"groups of shape {group.shape} were given; expected {low.shape}, one number an output")
    largest = np.zeros((2, group.max(initial=0) + 1))
    np.maximum.at(largest[0], group, high - low)
    np.maximum.at(largest[1], group, np.maximum(np.abs(low), np.abs(high)))
    return np.maximum(largest[0], 100 * np.finfo(float).eps * largest[1])[group]


def _constant(runs: Runs) -> Fitted:
    """The polynomial of a box without any width, from one run."""
    values = runs(np.empty((1, 0)))
    return Fitted(np.zeros((1, 0), dtype=int), values, np.zeros(values.shape[1]))
