"""A surrogate made better around a box, from true runs that lie there."""

from dataclasses import replace

import numpy as np

from dalembert.inverse.bands.candidate import Candidate
from dalembert.surrogate import ChebyshevPolynomial
from dalembert.surrogate.basis import chebyshev, products, terms_of, total_degree

AROUND = 0.5  # runs count that are no farther from the box than this part of its radius
THIN = 0.02  # nor than this part of the polynomial's box; in directions narrower than that a correction is constant
HIGHEST = 2  # largest total degree of a correction
TAKEN = 10.0  # weight of runs where the surrogate takes its bounds


def corrected(
    polynomial: ChebyshevPolynomial, at: Candidate, points: np.ndarray, values: np.ndarray, taken: int
) -> ChebyshevPolynomial:
    """The polynomial plus the least squares, over true runs near the box ``at``, of what it lacks there. A correction
    of low total degree, the highest that leaves two runs a term, takes away most of what a polynomial of high order
    lacks on a box much smaller than its own. ``points`` (runs, d); ``values`` (runs, outputs); ``taken``: the last of
    the runs, at points where bounds are taken: they weigh more.
    """
    width, thin = at.upper - at.lower, THIN * (polynomial.upper - polynomial.lower)
    margin = np.maximum(AROUND * width / 2, thin)
    near = np.all((at.lower - margin <= points) & (points <= at.upper + margin), axis=1)
    free = np.flatnonzero(width > thin)
    order = 0
    while order < HIGHEST and 2 * terms_of(len(free), order + 1) <= near.sum():
        order += 1
    exponents = np.zeros((terms_of(len(free), order), len(at.lower)), dtype=int)
    exponents[:, free] = total_degree(len(free), order)
    basis = products(chebyshev(polynomial.eta(points[near]), exponents.max(axis=0)), exponents)
    weight = np.where(np.arange(len(points)) < len(points) - taken, 1.0, TAKEN)[near, None]
    coefficients = np.linalg.lstsq(weight * basis, weight * (values[near] - polynomial(points[near])), rcond=1e-10)[0]
    table = {tuple(row): column for row, column in zip(polynomial.exponents, polynomial.coefficients, strict=True)}
    for row, column in zip(exponents, coefficients, strict=True):
        table[tuple(row)] = table.get(tuple(row), 0.0) + column
    return replace(polynomial, exponents=np.array(list(table)), coefficients=np.array(list(table.values())))
