"""Sobol indices of a function from its Chebyshev surrogate, in closed form."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.surrogate.basis import powers_of_two
from dalembert.surrogate.orthonormal import OrthonormalExpansion, Rule, orthonormal
from dalembert.surrogate.surrogate import Surrogate

NOTHING = 1e-12  # a standard deviation that is rounding, over the mean
SURE = 3.0  # standard errors of the means over checks that the ends of the indices include


@dataclass(frozen=True, eq=False)
class Checks:
    """Runs at random points of the inputs' distribution that compare the function with its surrogate.

    Parameters
    ----------
    eta : array, shape (n, d)
        Coordinates in [−1, 1].
    errors : array, shape (n, outputs)
        Function less surrogate.
    """

    eta: np.ndarray
    errors: np.ndarray


@dataclass(frozen=True, eq=False)
class SobolIndices:
    """Parts of the variance of each output, or of each group of outputs, that come from the inputs.

    Parameters
    ----------
    mean, variance : array, shape (outputs,)
        Of a group, sums over its outputs; infinite above 1.8e308, where the indices still hold.
    first, total : array, shape (d, outputs)
        Var E[f | x_k]/Var f, and 1 − Var E[f | all but x_k]/Var f. NaN where the variance is zero.
    first_ends, total_ends : array, shape (2, d, outputs)
        Lower and upper ends that follow from the error of the surrogate.
    """

    mean: np.ndarray
    variance: np.ndarray
    first: np.ndarray
    total: np.ndarray
    first_ends: np.ndarray
    total_ends: np.ndarray

    @property
    def uncertainty(self) -> np.ndarray:
        """Largest distance of an index to an end of its interval, shape (outputs,)."""
        pairs = ((self.first, self.first_ends), (self.total, self.total_ends))
        return np.max([np.abs(ends - indices).max(axis=(0, 1), initial=0.0) for indices, ends in pairs], axis=0)


def sobol_indices(
    surrogate: Surrogate,
    *,
    rules: Sequence[Rule] = (),
    groups: ArrayLike | None = None,
    checks: Checks | None = None,
) -> SobolIndices:
    """Return the Sobol indices of a function from its surrogate, with the intervals that the surrogate's error leaves.

    Parameters
    ----------
    surrogate : Surrogate
        As :func:`~dalembert.surrogate.fit` returns it.
    rules : sequence of Rule, of length d
        Integrals over the distribution of each input in [−1, 1], all independent; uniform if not given.
    groups : array of int, shape (outputs,), optional
        Number of the group of each output, from 0, for indices of groups: sums of parts over sums of variances.
    checks : Checks, optional
        Narrower intervals where the function is not smooth.

    Returns
    -------
    SobolIndices

    Notes
    -----
    In polynomials that are orthonormal for the inputs, f = Σ_α c_α p_α and Var f = Σ_{α≠0} c_α². The first-order index
    of x_k has the terms with α_k > 0 alone, the total index all terms with α_k > 0 (Sudret, Global sensitivity analysis
    using polynomial chaos expansions, 2008).

    A part V_u of the variance is the square of a projection P_u f. With f = s + e, s the surrogate,
    V_u(f) = V_u(s) + 2 E[P_u s · e] + ‖P_u e‖². Without checks ``|e| ≤ ε`` over the box bounds the root of V_u:
    √V_u(s) ± ε. With checks the middle term is their mean ± 3 standard errors, and the last one is at most E[e²]. The
    narrower one of both counts. An index V_u/(V_u + V_rest) has its ends where V_u and V_rest have theirs.

    Examples
    --------
    >>> from dalembert.surrogate import Tensor, fit, sobol_indices
    >>> found = sobol_indices(fit(lambda x: x[:, :1] + 2 * x[:, 1:], [0.0, 0.0], [1.0, 1.0], Tensor(3)))
    >>> found.first[:, 0].round(6).tolist(), found.variance.round(6).tolist()
    ([0.2, 0.8], [0.416667])
    """
    expansion = orthonormal(surrogate.polynomial, rules)
    outputs = len(surrogate.error)
    number = np.arange(outputs) if groups is None else np.asarray(groups)
    member = (number[:, None] == np.arange(number.max(initial=-1) + 1)).astype(float)
    active = expansion.exponents > 0
    varying = np.asarray(active.any(axis=1))
    masks = [*(active & (active.sum(axis=1) == 1)[:, None]).T, *active.T]  # of the first-order, then the total indices
    mean = expansion.coefficients[~varying].sum(axis=0)
    error = np.asarray(surrogate.error, dtype=float)
    if checks is not None:
        error = np.maximum(error, np.abs(checks.errors).max(axis=0))
    # Indices do not change with the scale of a group. The squares of large outputs would overflow.
    powers = powers_of_two(expansion.coefficients, error[None])
    of_group = np.max(np.where(member > 0, powers[:, None], np.iinfo(int).min), axis=0, initial=np.iinfo(int).min)
    scale = -of_group[number]
    expansion = replace(expansion, coefficients=np.ldexp(expansion.coefficients, scale))
    error = np.ldexp(error, scale)
    if checks is not None:
        checks = Checks(checks.eta, np.ldexp(checks.errors, scale))
    # Parseval: Var f = Σ c_α² over the terms that vary; what is rounding of the mean is none.
    squares = expansion.coefficients**2
    squares[:, squares[varying].sum(axis=0) <= (NOTHING * np.ldexp(mean, scale)) ** 2] = 0.0
    summed = squares @ member
    variance, parts = summed[varying].sum(axis=0), np.array([summed[mask].sum(axis=0) for mask in masks])
    norm = np.sqrt(error**2 @ member)
    part, rest = _by_norm(parts, norm), _by_norm(np.maximum(variance - parts, 0.0), norm)
    if checks is not None:
        checked = _by_checks(expansion, masks, varying, member, checks)
        part, rest = (_narrower(of, *mine) for of, mine in zip((part, rest), checked, strict=True))
    # V_u/(V_u + V_rest) rises with V_u and falls with V_rest: its ends are at opposite corners.
    ends = _ends(part, rest).reshape(2, 2, -1, len(variance))
    with np.errstate(invalid="ignore", divide="ignore"):
        first, total = (parts / variance).reshape(2, -1, len(variance))
    with np.errstate(over="ignore"):  # infinite where it is no number of 64 bits
        mean, variance = mean @ member, np.ldexp(variance, 2 * of_group)
    return SobolIndices(mean, variance, first, total, ends[:, 0], ends[:, 1])


@dataclass(frozen=True, eq=False)
class _Range:
    """Parts of the variance by the surrogate, and their ends: all of shape (masks, groups)."""

    value: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


def _by_norm(parts: np.ndarray, error: np.ndarray) -> _Range:
    """Parts whose roots are right within an error (groups,)."""
    root = np.sqrt(parts)
    return _Range(parts, np.maximum(root - error, 0.0) ** 2, (root + error) ** 2)


def _narrower(known: _Range, change: np.ndarray, radius: np.ndarray, most: np.ndarray) -> _Range:
    """Range that is narrowed by V_u(s) + 2 (change ± radius) + what is between 0 and ``most``."""
    # V_u(f) = V_u(s) + 2 E[P_u s e] + ‖P_u e‖², the last term between 0 and E[e²].
    lower = np.maximum(known.lower, known.value + 2 * (change - radius))
    upper = np.minimum(known.upper, known.value + 2 * (change + radius) + most)
    return _Range(known.value, np.minimum(lower, known.value), np.maximum(upper, known.value))


def _by_checks(
    expansion: OrthonormalExpansion, masks: list[np.ndarray], varying: np.ndarray, member: np.ndarray, checks: Checks
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """E[P_u s · e] of the parts and of what is left, each with its error and with E[e²] at most."""
    count = len(checks.eta)
    each = np.empty((len(masks), count, member.shape[1]))
    total = np.empty(each.shape[1:])
    for rows, table in expansion.tables(checks.eta):
        errors = checks.errors[rows]
        for number, mask in enumerate(masks):
            each[number, rows] = (table[:, mask] @ expansion.coefficients[mask] * errors) @ member
        total[rows] = (table[:, varying] @ expansion.coefficients[varying] * errors) @ member
    squares = checks.errors**2 @ member
    most = squares.mean(axis=0) + _standard_error(squares)
    return tuple((part.mean(axis=-2), _standard_error(part), most) for part in (each, total - each))  # type: ignore[return-value]


def _standard_error(values: np.ndarray) -> np.ndarray:
    """Of the mean over the second axis from the end, as often as it is included."""
    count = values.shape[-2]
    return SURE * values.std(axis=-2, ddof=1) / np.sqrt(count)


def _ends(part: _Range, rest: _Range) -> np.ndarray:
    """Lower and upper ends of indices, shape (2, masks, groups); 0 and 1 where nothing is known."""
    with np.errstate(invalid="ignore", divide="ignore"):
        lower, upper = part.lower / (part.lower + rest.upper), part.upper / (part.upper + rest.lower)
    return np.stack([np.nan_to_num(lower, nan=0.0), np.nan_to_num(upper, nan=1.0)])
