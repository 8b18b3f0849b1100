"""What the decay of the coefficients says about the part of a function that its surrogate leaves out."""

import numpy as np

# Ratio above which coefficients do not decay: what is left out is then taken as ten times the last of them.
SLOWEST = 0.9
SHORT = 6  # degrees below which no power of the decay is computed
# Powers of the degree up to which coefficients decay as those of a function that is not smooth. At least the first,
# at most the second, and between them the order divided by the third: smooth functions reach high orders with large
# powers only, and the power of a kink scatters.
SMOOTH, SMOOTHEST, EACH_POWER = 5.0, 9.0, 3.2
# Misfit of a geometric series, as a part of that of a power of the degree, below which the decay is geometric.
GEOMETRIC = 0.5
STEEPEST = 2.0  # largest power that such a decay is continued with
# Factor on what such coefficients would add: they oscillate, and interpolation adds an error of the same size.
CAUTION = 3.0
FLATTEST = 0.1  # smallest p − 1 in the sum of a power series


def by_total_degree(exponents: np.ndarray, coefficients: np.ndarray) -> list[np.ndarray]:
    """Sums of |coefficients| over the terms of each total degree: one array of shape (order + 1, outputs)."""
    return [_sums(exponents.sum(axis=1), coefficients)]


def by_direction(exponents: np.ndarray, coefficients: np.ndarray) -> list[np.ndarray]:
    """Sums of |coefficients| over the terms of each degree in one direction, an array for each direction."""
    return [_sums(exponents[:, k], coefficients) for k in range(exponents.shape[1])]


def _sums(degrees: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    shells = np.zeros((degrees.max(initial=0) + 1, coefficients.shape[1]))
    np.add.at(shells, degrees, np.abs(coefficients))
    return shells


def tail(shells: np.ndarray) -> np.ndarray:
    """Estimate what the degrees above the last one would add, shape (outputs,), from shells (order + 1, outputs). With
    a the sum of the last two shells (one of them may vanish by symmetry) and r their decay a degree, a r²/(1 − r²):
    what is left of a geometric series.
    """
    # Σ_{m≥1} a r^{2m} of pairs of shells two degrees apart.
    decay = _ratio(shells, len(shells) - 1)
    return _pair(shells, len(shells) - 1) * decay**2 / (1 - decay**2)


def power(shells: np.ndarray) -> np.ndarray:
    """Return p of a decay as degree^−p over the upper half of the degrees, shape (outputs,); infinite below ``SHORT``.
    From the largest shells of the third and the last quarter. A kink |x| has p = 2, a step p = 1, noise and waves that
    are not resolved p = 0, smooth functions a p that grows with the degree.
    """
    order = len(shells) - 1
    if order < SHORT:
        return np.full(shells.shape[1], np.inf)
    half, last = (order + 1) // 2, (3 * order + 3) // 4
    early, late = (part.max(axis=0) for part in (shells[half:last], shells[last:]))
    ratio = np.divide(early, late, out=np.full(shells.shape[1], np.inf), where=late > 0)
    return np.log(np.maximum(ratio, 1.0)) / np.log((last + order) / (half + last - 1))


def slow_tail(shells: np.ndarray) -> np.ndarray:
    """Estimate what the degrees above the last one would add to a function with a kink or a step, shape (outputs,). The
    shells are taken to continue as s (m/n)^−p, whose sum is s n/(p − 1): s is the largest of the upper half, moved to
    the last degree n. The coefficients of a kink oscillate, so that p may be too large: it is at most ``STEEPEST``.
    Zero where p is too large for a kink, or where the coefficients clearly decay geometrically, see :func:`tail`.
    """
    order, p = len(shells) - 1, power(shells)
    if order < SHORT:
        return np.zeros(shells.shape[1])
    degrees = np.arange((order + 1) // 2, order + 1)
    # Trefethen, Approximation Theory, chapter 7: a jump in the derivative number ν decays as degree^−(ν+1).
    taken = np.minimum(p, STEEPEST)
    last = np.max(shells[degrees] * (degrees[:, None] / order) ** taken, axis=0)
    kink = (p <= np.clip(order / EACH_POWER, SMOOTH, SMOOTHEST)) & (_misfit_ratio(shells) >= GEOMETRIC)
    return np.where(kink, CAUTION * last * order / np.maximum(taken - 1, FLATTEST), 0.0)


def slow_tails(directions: list[np.ndarray]) -> np.ndarray:
    """Return the sum of :func:`slow_tail` over the shells of all directions, shape (outputs,)."""
    return np.sum([slow_tail(shells) for shells in directions], axis=0)


def _misfit_ratio(shells: np.ndarray) -> np.ndarray:
    """Return the misfit of a geometric series over that of a power of the degree, shape (outputs,).

    Both by least squares in the logarithm of the larger of two neighbouring shells, as one may vanish by symmetry.
    """
    varying = np.maximum(shells[1:], np.finfo(float).eps * shells.max(axis=0) + np.finfo(float).tiny)
    logs = np.log(np.maximum(varying, np.concatenate([varying[:1], varying[:-1]])))
    degrees = np.arange(1.0, len(shells))
    geometric, algebraic = (_misfit(x, logs) for x in (degrees, np.log(degrees)))
    return np.divide(geometric, algebraic, out=np.ones(shells.shape[1]), where=algebraic > 0)


def _misfit(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the root of the sum of squares (outputs,) that a line through points x (n,), y (n, outputs) leaves."""
    x, y = (x - x.mean())[:, None], y - y.mean(axis=0)
    return np.linalg.norm(y - x * (np.sum(x * y, axis=0) / np.sum(x**2)), axis=0)


def needed_order(shells: np.ndarray, tolerance: np.ndarray) -> tuple[int, bool]:
    """Return the lowest order that leaves less than ``tolerance`` (outputs,) out, if the decay of the coefficients
    continues, and whether they decay at all. From degree p on, degree q is taken to decay by r (p/q)^α: α = 0 for a
    geometric series, as of a function with a pole, α = 1 for that of an entire function such as a sine; the last shells
    determine which. Where no decay is seen yet, twice the order is returned, as the next one to try.
    >>> needed_order(10.0 ** -np.arange(6)[:, None], np.array([1e-9]))
    (9, True)
    """
    order = len(shells) - 1
    left, ratio = tail(shells), _ratio(shells, order)
    if np.any(ratio[left > tolerance] >= SLOWEST):
        return 2 * max(order, 1), False
    power, reached = _power(shells, order), order
    while np.any(left > tolerance):
        reached += 1
        # The tail of the order before, times the decay of one degree more.
        left = left * ratio * (order / reached) ** power
    return reached, True


def _pair(shells: np.ndarray, degree: int) -> np.ndarray:
    """Sum of the shells of a degree and the one below it, the constant term left out."""
    return shells[max(degree - 1, 1) : degree + 1].sum(axis=0)


def _ratio(shells: np.ndarray, degree: int) -> np.ndarray:
    """Decay r a degree around ``degree``, shape (outputs,), at most ``SLOWEST``.

    An output whose shells grow by chance is assumed to decay as the largest shells of all outputs do.
    """
    if degree < 2:
        return np.full(shells.shape[1], SLOWEST)
    # Pairs two degrees apart share no shell; of the lowest degrees there are no two such pairs.
    reach = 2 if degree >= 4 else 1
    late, early = (_pair(shells, degree), _pair(shells, degree - reach)) if degree > 2 else (shells[2], shells[1])
    ratio = np.divide(late, early, out=np.where(late > 0, 1.0, 0.0), where=early > 0)
    pooled = late.max(initial=0) / early.max(initial=0) if early.any() else 1.0
    return np.minimum(np.minimum(ratio, pooled) ** (1 / reach), SLOWEST)


def _power(shells: np.ndarray, order: int) -> float:
    """α from 0 to 1: how fast the decay of the largest shells itself gets faster."""
    if order < 6:
        return 0.0
    largest = shells.max(axis=1, keepdims=True)
    late, early = (_ratio(largest, degree)[0] for degree in (order, order - 2))
    return float(np.clip(np.log(early / late) / np.log((order - 1) / (order - 3)), 0, 1)) if late > 0 else 0.0
