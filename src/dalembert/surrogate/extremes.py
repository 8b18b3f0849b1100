"""Compiled: smallest and largest values of each output of a polynomial on boxes, by Newton's method from a scan."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Integers, Reals, Reals2, Reals3, Reals4
from dalembert.surrogate.polynomial import Rows

ITERATIONS, DAMPINGS = 60, 40
CONVERGED = 1e-15  # a step that promises less than this part of the sum of |coefficients| is not taken


class ExtremesWorkspace(NamedTuple):
    """Workspace for a box, in d directions, and for starts in it. ``eta``, ``gradient``, ``step``, ``trial``,
    ``trial_gradient`` (d,): a point and the gradient there, a step, where it leads and the gradient there; ``free``
    (d,): 0 where a side of the box holds the direction, else 1; ``hessian``, ``factor`` (d, d); ``tables`` (3, d,
    largest degree + 1, at least 2): Chebyshev polynomials and their derivatives at a point; ``signed`` (rows, longest):
    coefficients of an output, or of its negative for the largest value; ``best``, ``places`` (starts,): lowest values
    of a scan, and where they are.
    """

    eta: Reals
    gradient: Reals
    step: Reals
    trial: Reals
    trial_gradient: Reals
    free: Integers
    hessian: Reals2
    factor: Reals2
    tables: Reals3
    signed: Reals2
    best: Reals
    places: Integers


def scratch(rows: Rows, starts: int) -> ExtremesWorkspace:
    """Workspace for a number of starts."""
    size = len(rows.degrees)
    return ExtremesWorkspace(
        *np.empty((5, size)),  # from ``eta`` to ``trial_gradient``
        free=np.empty(size, dtype=np.int64),
        hessian=np.empty((size, size)),
        factor=np.empty((size, size)),
        tables=np.zeros((3, size, max(2, int(rows.degrees.max()) + 1))),
        signed=np.empty(rows.coefficients.shape[1:]),
        best=np.empty(starts),
        places=np.empty(starts, dtype=np.int64),
    )


@inner
def _ladders(eta, degrees, tables):
    """Fills tables[derivative, k, m] with T_m(η_k) and its first two derivatives."""
    for k in range(len(eta)):
        x = eta[k]
        tables[:, k, :2] = 0.0
        tables[0, k, 0] = 1.0
        if degrees[k] > 0:
            tables[0, k, 1], tables[1, k, 1] = x, 1.0
        for m in range(1, degrees[k]):
            tables[0, k, m + 1] = 2 * x * tables[0, k, m] - tables[0, k, m - 1]
            tables[1, k, m + 1] = 2 * tables[0, k, m] + 2 * x * tables[1, k, m] - tables[1, k, m - 1]
            tables[2, k, m + 1] = 4 * tables[1, k, m] + 2 * x * tables[2, k, m] - tables[2, k, m - 1]


@inner
def _along(coefficients, row, length, tables, derivative, inner):
    """Sum of a row's coefficients times the Chebyshev polynomials of the inner direction, or their derivatives."""
    total = 0.0
    for m in range(length):
        total += coefficients[row, m] * tables[derivative, inner, m]
    return total


@inner
def _value_and_gradient(rows, tables, coefficients, gradient):
    """Value, and the gradient with respect to η in place; a row multiplies only the directions that it depends on."""
    inner, exponents, active, counts, lengths = rows.inner, rows.exponents, rows.active, rows.counts, rows.lengths
    gradient[:] = 0.0
    value = 0.0
    for r in range(len(coefficients)):
        along = _along(coefficients, r, lengths[r], tables, 0, inner)
        slope = _along(coefficients, r, lengths[r], tables, 1, inner)
        for i in range(counts[r]):
            factor = tables[0, active[r, i], exponents[r, i]]
            product = along * tables[1, active[r, i], exponents[r, i]]
            for j in range(counts[r]):
                if j != i:
                    product *= tables[0, active[r, j], exponents[r, j]]
            gradient[active[r, i]] += product
            slope *= factor
        for i in range(counts[r]):
            along *= tables[0, active[r, i], exponents[r, i]]
        value += along
        gradient[inner] += slope
    return value


@inner
def _hessian(rows, tables, coefficients, hessian):
    """Second derivatives with respect to η, in place."""
    inner, exponents, active, counts, lengths = rows.inner, rows.exponents, rows.active, rows.counts, rows.lengths
    hessian[:] = 0.0
    for r in range(len(coefficients)):
        along = _along(coefficients, r, lengths[r], tables, 0, inner)
        slope = _along(coefficients, r, lengths[r], tables, 1, inner)
        curvature = _along(coefficients, r, lengths[r], tables, 2, inner)
        for i in range(counts[r]):
            mixed = slope
            for m in range(counts[r]):
                mixed *= tables[int(m == i), active[r, m], exponents[r, m]]
            hessian[active[r, i], inner] += mixed
            for j in range(i + 1):
                product = along
                for m in range(counts[r]):
                    product *= tables[(m == i) + (m == j), active[r, m], exponents[r, m]]
                hessian[active[r, i], active[r, j]] += product
            curvature *= tables[0, active[r, i], exponents[r, i]]
        hessian[inner, inner] += curvature
    for j in range(inner):
        hessian[inner, j] = hessian[j, inner]


@inner
def _step(hessian, gradient, free, damping, factor, step):
    """Solves (H + damping) step = −gradient in the free directions by Cholesky; whether H + damping is definite."""
    size = len(gradient)
    step[:] = 0.0
    for i in range(size):
        if not free[i]:
            continue
        for j in range(i + 1):
            if not free[j]:
                continue
            rest = hessian[i, j] + (damping if i == j else 0.0)
            for m in range(j):
                if free[m]:
                    rest -= factor[i, m] * factor[j, m]
            if i != j:
                factor[i, j] = rest / factor[j, j]
            # Not definite up to rounding: Cholesky fails, and the caller damps more.
            elif rest <= 1e-14 * (abs(hessian[i, i]) + damping):
                return False
            else:
                factor[i, i] = np.sqrt(rest)
        rest = -gradient[i]
        for m in range(i):
            if free[m]:
                rest -= factor[i, m] * step[m]
        step[i] = rest / factor[i, i]
    for i in range(size - 1, -1, -1):
        if free[i]:
            for m in range(i + 1, size):
                if free[m]:
                    step[i] -= factor[m, i] * step[m]
            step[i] /= factor[i, i]
    return True


@inner
def _minimum(rows, low, high, small, scratch):
    """Local minimum in a box by Newton's method projected onto it; η in place, the value returned."""
    eta, gradient, step, trial, trial_gradient = (
        scratch.eta,
        scratch.gradient,
        scratch.step,
        scratch.trial,
        scratch.trial_gradient,
    )
    size, coefficients, hessian, free, tables = len(eta), scratch.signed, scratch.hessian, scratch.free, scratch.tables
    _ladders(eta, rows.degrees, tables)
    value = _value_and_gradient(rows, tables, coefficients, gradient)
    for _ in range(ITERATIONS):
        reach = 0.0
        for k in range(size):
            # Σ |∂f| · way to the side downhill: no point of the box is lower than that by the linear model.
            inward = (high[k] - eta[k]) if gradient[k] < 0 else (eta[k] - low[k])
            free[k] = inward > 0
            reach += abs(gradient[k]) * inward
        if reach <= small:
            break
        _hessian(rows, tables, coefficients, hessian)
        size_of_hessian = 0.0
        for k in range(size):
            size_of_hessian = max(size_of_hessian, abs(hessian[k, k]))
        # Newton first; where H is not definite or the clipped step does not descend, Levenberg's damping grows.
        damping, lower = 0.0, value
        for _ in range(DAMPINGS):
            promised = 0.0
            clipped = False
            if _step(hessian, gradient, free, damping, scratch.factor, step):
                for k in range(size):
                    trial[k] = min(max(eta[k] + step[k], low[k]), high[k])
                    promised -= gradient[k] * (trial[k] - eta[k])
                    clipped |= trial[k] != eta[k] + step[k]
                if promised > small:
                    _ladders(trial, rows.degrees, tables)
                    lower = _value_and_gradient(rows, tables, coefficients, trial_gradient)
                # Armijo's condition with the descent that the gradient promises along the clipped step.
                if lower < value - 1e-4 * promised or (promised <= small and not clipped):
                    break
            damping = max(4 * damping, 0.1 * size_of_hessian, reach)
        if not lower < value:
            break
        value = lower
        for k in range(size):
            eta[k], gradient[k] = trial[k], trial_gradient[k]
    return value


@inner
def _lowest_valleys(values, sides, sign, best, places):
    """Places of the lowest points of a scan that no neighbour along an axis is below; how many."""
    count = 0
    for g in range(len(values)):
        value = sign * values[g]
        if count == len(best) and value >= best[count - 1]:
            continue
        stride = 1
        valley = True
        for k in range(len(sides) - 1, -1, -1):
            here = (g // stride) % sides[k]
            if (here > 0 and sign * values[g - stride] < value) or (
                here < sides[k] - 1 and sign * values[g + stride] <= value
            ):
                valley = False
                break
            stride *= sides[k]
        if valley:
            place = min(count, len(best) - 1)
            while place > 0 and best[place - 1] > value:
                best[place], places[place] = best[place - 1], places[place - 1]
                place -= 1
            best[place], places[place] = value, g
            count = min(count + 1, len(best))
    return count


@inner
def _signed(coefficients, sign, signed):
    """Set the signed coefficients; the sum of their sizes."""
    total = 0.0
    for r in range(coefficients.shape[0]):
        for m in range(coefficients.shape[1]):
            signed[r, m] = sign * coefficients[r, m]
            total += abs(signed[r, m])
    return total


@kernel
def extremes(
    values: Reals3, grid: Reals2, sides: Integers, low: Reals2, high: Reals2, rows: Rows, bounds: Reals3,
    at: Reals4, scratch: ExtremesWorkspace,
) -> None:  # fmt: skip
    """Refine the extremes of a scan; all in coordinates η of the polynomial, with terms ``rows``. ``values``
    (boxes, outputs, points): at the points of the scan; ``grid`` (points, d): these points relative to each box, in
    [0, 1]; ``sides`` (d,): points of the scan in each direction, the last one fastest, (0,) if they form no grid;
    ``low``, ``high`` (boxes, d). ``bounds`` (2, boxes, outputs) and ``at`` (2, boxes, outputs, d): filled with the
    smallest and the largest values, and where they are. The starts of ``scratch`` are the most points that are refined.
    """
    eta, size = scratch.eta, low.shape[1]
    for b in range(len(low)):
        for o in range(len(rows.coefficients)):
            for side in range(2):
                sign = 1.0 - 2.0 * side
                small = CONVERGED * _signed(rows.coefficients[o], sign, scratch.signed)
                lowest = np.inf
                # Several valleys: that of the extreme need not have the lowest point of the scan.
                for start in range(_lowest_valleys(values[b, o], sides, sign, scratch.best, scratch.places)):
                    for k in range(size):
                        part = grid[scratch.places[start], k]
                        eta[k] = high[b, k] if part == 1 else low[b, k] + part * (high[b, k] - low[b, k])
                    value = _minimum(rows, low[b], high[b], small, scratch)
                    if value < lowest:
                        lowest = value
                        for k in range(size):
                            at[side, b, o, k] = eta[k]
                bounds[side, b, o] = sign * lowest
