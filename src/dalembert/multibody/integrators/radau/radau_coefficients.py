"""Coefficients of the Radau IIA methods, from the definition of collocation."""

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from scipy.special import roots_jacobi

from dalembert.kernels.words import Complexes, Reals, Reals2


class Coefficients(NamedTuple):
    """Of the method with s stages, of order 2 s - 1. ``c`` (s,) of the stages, ``a`` (s, s), the weights of their
    rates, and its inverse. ``t`` brings the inverse to the real block form A^-1 T = T diag(g, [a, -b; b, a], ...), with
    g = ``real`` and the ``pairs`` a + ib; ``back`` is the inverse of T. ``start`` (s,) extrapolates what is known at
    the stages to the start of the step; the stages are predicted by those of the step before and by the last ``more``
    of the step earlier (measured).
    """

    c: Reals
    a: Reals2
    inverse: Reals2
    t: Reals2
    back: Reals2
    real: float
    pairs: Complexes
    start: Reals
    more: int


@cache
def coefficients(stages: int) -> Coefficients:
    """Return the coefficients for an odd number of stages. The stages stand at the zeros of the Jacobi polynomial of
    the weight 1 - x, and at the end; their weights integrate the polynomials up to degree s - 1 exactly, by Legendre's,
    which lose no digits (Hairer and Wanner 1996, IV.5).
    """
    points = np.append(roots_jacobi(stages - 1, 1.0, 0.0)[0], 1.0)
    values = legendre.legvander(points, stages - 1)
    integrals = np.column_stack([legendre.legval(points, legendre.legint(row, lbnd=-1)) for row in np.eye(stages)])
    a = 0.5 * np.linalg.solve(values.T, integrals.T).T
    inverse = np.linalg.inv(a)
    eigen: Any = np.linalg.eig(inverse)
    numbers, vectors = eigen
    own = int(np.argmin(np.abs(numbers.imag)))
    upper = np.flatnonzero(numbers.imag > 1e-9)
    parts = [part for pair in upper for part in (vectors[:, pair].real, -vectors[:, pair].imag)]
    t = np.column_stack([vectors[:, own].real, *parts])
    start = np.linalg.solve(values.T, legendre.legvander(np.array([-1.0]), stages - 1)[0])
    return Coefficients(
        0.5 * (points + 1.0), np.ascontiguousarray(a), inverse, np.ascontiguousarray(t), np.linalg.inv(t),
        float(numbers[own].real), np.ascontiguousarray(numbers[upper]), start, max(1, 6 - stages),
    )  # fmt: skip
