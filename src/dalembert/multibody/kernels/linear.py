"""Factorisation and solution of the linear systems: a dense inverse for small models, LAPACK's band solver for others.

A factorisation is kept over many solutions. Where a matrix is small, the product with its inverse is several times
faster than the triangular solutions, and the Newton iteration around it corrects its rounding.
"""

from typing import NamedTuple

import numpy as np
from numba.extending import get_cython_function_address

from dalembert.multibody.kernels.callback import call
from dalembert.multibody.kernels.compiled import compiled, inlined, kernel

DENSE, BAND = range(2)
#: Addresses of LAPACK's routines as SciPy carries them; data to the kernels, see `callback`.
LAPACK = np.array(
    [
        get_cython_function_address("scipy.linalg.cython_lapack", name)
        for name in ("dgetrf", "dgetri", "dgbtrf", "dgbtrs")
    ],
    dtype=np.int64,
)
_BLOCK = 32  # columns that dgetri treats at a time, for the size of its work array


class Layout(NamedTuple):
    """Where a matrix's entries are kept: kind, size N, bands below and above, place of each unknown in the band."""

    kind: int
    size: int
    lower: int
    upper: int
    order: np.ndarray


class Factors(NamedTuple):
    """A matrix (flat, by columns), its factorisation, and what LAPACK works with."""

    matrix: np.ndarray
    factored: np.ndarray
    pivots: np.ndarray
    numbers: np.ndarray
    buffer: np.ndarray
    letter: np.ndarray


@kernel
def lead(layout):
    """Length of a stored column."""
    return layout.size if layout.kind == DENSE else 2 * layout.lower + layout.upper + 1


@compiled
def storage(layout):
    """Room for a matrix and its factorisation."""
    size = layout.size
    entries = lead(layout) * size
    numbers = np.array([size, lead(layout), layout.lower, layout.upper, _BLOCK * size, 1, 0], dtype=np.int32)
    letter = np.array([ord("N")], dtype=np.uint8)
    return Factors(
        np.zeros(entries), np.zeros(entries), np.zeros(size, np.int32), numbers, np.zeros(_BLOCK * size), letter
    )


@kernel
def factorise(layout, lapack, factors):
    """Factorise (or invert) the matrix; whether it was regular."""
    for i in range(len(factors.matrix)):
        factors.factored[i] = factors.matrix[i]
    n = factors.numbers
    size, ld, lower, upper, room, info = n[0:1], n[1:2], n[2:3], n[3:4], n[4:5], n[6:7]
    if layout.kind == DENSE:
        call(lapack[0], size, size, factors.factored, ld, factors.pivots, info)
        if info[0] == 0:
            call(lapack[1], size, factors.factored, ld, factors.pivots, factors.buffer, room, info)
    else:
        call(lapack[2], size, size, lower, upper, factors.factored, ld, factors.pivots, info)
    return info[0] == 0


@inlined
def _multiply(matrix, size, given, answer):
    """Product of a square matrix by columns with a vector, four columns at a time."""
    for i in range(size):
        answer[i] = 0.0
    whole = size // 4 * 4
    for j in range(0, whole, 4):
        a, b, c, d = given[j], given[j + 1], given[j + 2], given[j + 3]
        k, l, m, n = j * size, (j + 1) * size, (j + 2) * size, (j + 3) * size  # noqa: E741 - the four columns in order
        for i in range(size):
            answer[i] += matrix[k + i] * a + matrix[l + i] * b + matrix[m + i] * c + matrix[n + i] * d
    for j in range(whole, size):
        a, k = given[j], j * size
        for i in range(size):
            answer[i] += matrix[k + i] * a


@kernel
def solve(layout, lapack, factors, given, answer):
    """Solve for the first N entries of ``given``, into those of ``answer``."""
    size = layout.size
    if layout.kind == DENSE:
        _multiply(factors.factored, size, given, answer)
        return
    n, order, buffer = factors.numbers, layout.order, factors.buffer
    for i in range(size):
        buffer[order[i]] = given[i]
    call(
        lapack[3], factors.letter, n[0:1], n[2:3], n[3:4], n[5:6], factors.factored, n[1:2], factors.pivots, buffer,
        n[0:1], n[6:7],
    )  # fmt: skip
    for i in range(size):
        answer[i] = buffer[order[i]]
