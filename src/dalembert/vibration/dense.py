"""Compiled: small dense matrices and vectors."""

import numpy as np

from dalembert.kernels.blas import applied
from dalembert.kernels.kernel import inner

LARGE = 1000
"""Entries of a matrix above which the BLAS is faster than loops."""


@inner
def dot(x, y):
    """Scalar product; several sums beside each other, so that one need not wait for the other."""
    n = len(x)
    whole = n - n % 4
    first, second, third, fourth = 0.0, 0.0, 0.0, 0.0
    for i in range(0, whole, 4):
        first += x[i] * y[i]
        second += x[i + 1] * y[i + 1]
        third += x[i + 2] * y[i + 2]
        fourth += x[i + 3] * y[i + 3]
    for i in range(whole, n):
        first += x[i] * y[i]
    return (first + second) + (third + fourth)


@inner
def apply(gemv, matrix, x, y):
    """Set y to matrix x; large matrices by the BLAS, at the address ``gemv``."""
    if matrix.size > LARGE:
        applied(gemv, matrix, x, y)
        return
    for i in range(len(y)):
        y[i] = dot(matrix[i], x)


@inner
def assign(target, source):
    """Copy a vector."""
    for i in range(len(target)):
        target[i] = source[i]


@inner
def size_of(x):
    """Largest entry of a vector without its sign; NaN where one is."""
    size = 0.0
    for i in range(len(x)):
        entry = abs(x[i])
        if np.isnan(entry):
            return entry
        size = max(size, entry)
    return size


@inner
def _swap(matrix, i, k):
    for j in range(matrix.shape[1]):
        matrix[i, j], matrix[k, j] = matrix[k, j], matrix[i, j]


@inner
def _scale(row, factor, first):
    for j in range(first, len(row)):
        row[j] *= factor


@inner
def _subtract(row, factor, other, first):
    for j in range(first, len(row)):
        row[j] -= factor * other[j]


@inner
def invert(matrix, inverse):
    """Set the inverse, by Gauss and Jordan with pivots from rows; the matrix is overwritten. Not finite if singular."""
    n = len(matrix)
    for i in range(n):
        for j in range(n):
            inverse[i, j] = 1.0 if i == j else 0.0
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        if pivot != k:
            _swap(matrix, k, pivot)
            _swap(inverse, k, pivot)
        factor = 1.0 / matrix[k, k]
        _scale(matrix[k], factor, k)
        _scale(inverse[k], factor, 0)
        for i in range(n):
            factor = matrix[i, k]
            if i != k and factor != 0.0:
                _subtract(matrix[i], factor, matrix[k], k)
                _subtract(inverse[i], factor, inverse[k], 0)
