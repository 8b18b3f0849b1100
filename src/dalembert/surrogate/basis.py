"""Chebyshev polynomials of one variable, products of them, and powers of two that scale their coefficients."""

from itertools import product
from math import comb

import numpy as np


def chebyshev(eta: np.ndarray, degrees: np.ndarray, derivative: int = 0) -> list[np.ndarray]:
    """Return T_0 … T_m of each coordinate of ``eta`` (n, d), or their first or second derivatives: a list of d arrays
    of shape (n, m_k + 1), by the highest degrees m_k in ``degrees`` (d,). By the recurrences T_{m+1} = 2η T_m − T_{m−1}
    and its derivatives, T'_{m+1} = 2 T_m + 2η T'_m − T'_{m−1} and so on.
    """
    return [_ladder(eta[:, k], int(degree), derivative) for k, degree in enumerate(degrees)]


def _ladder(x: np.ndarray, degree: int, derivative: int) -> np.ndarray:
    below = None if derivative == 0 else _ladder(x, degree, derivative - 1)
    ladder = np.zeros((degree + 1, len(x)))
    if derivative == 0:
        ladder[0] = 1.0
    if degree > 0:
        ladder[1] = x if derivative == 0 else float(derivative == 1)
    for m in range(1, degree):
        ladder[m + 1] = 2 * x * ladder[m] - ladder[m - 1]
        if below is not None:
            # d^i: T⁽ⁱ⁾_{m+1} = 2η T⁽ⁱ⁾_m + 2 i T⁽ⁱ⁻¹⁾_m − T⁽ⁱ⁾_{m−1}.
            ladder[m + 1] += 2 * derivative * below.T[m]
    return ladder.T


def products(factors: list[np.ndarray], exponents: np.ndarray) -> np.ndarray:
    """Π_k factors[k][:, e_tk], shape (n, terms), for exponents of shape (terms, d)."""
    rows = len(factors[0]) if factors else 1
    values = np.ones((rows, len(exponents)))
    for k, factor in enumerate(factors):
        values *= factor[:, exponents[:, k]]
    return values


def roots(number: int) -> np.ndarray:
    """Return the roots of T_number in [−1, 1], ascending and symmetric to the last bit, shape (number,).
    >>> roots(2).round(6).tolist()
    [-0.707107, 0.707107]
    """
    # As a sine about the middle: −x and x are the same to the last bit, which cos is not.
    return np.sin(np.pi * (2 * np.arange(number) + 1 - number) / (2 * number))


def total_degree(directions: int, order: int) -> np.ndarray:
    """Return exponents of terms of total degree at most ``order``, by growing degree: (order + d)!/(order! d!) rows.
    >>> total_degree(2, 1).tolist()
    [[0, 0], [0, 1], [1, 0]]
    """
    rows = [row for total in range(order + 1) for row in _summing(directions, total)]
    return np.array(rows, dtype=int).reshape(len(rows), directions)


def _summing(directions: int, total: int) -> list[tuple[int, ...]]:
    """Rows of ``directions`` numbers from zero that sum to ``total``."""
    if directions == 0:
        return [()] if total == 0 else []
    return [(first, *rest) for first in range(total + 1) for rest in _summing(directions - 1, total - first)]


def terms_of(directions: int, order: int) -> int:
    """Return the number of terms of total degree at most ``order``, (order + d)!/(order! d!)."""
    return comb(order + directions, directions)


def full_tensor(orders: tuple[int, ...]) -> np.ndarray:
    """Exponents of all terms up to an order in each direction, shape (Π (order_k + 1), d)."""
    return np.array(list(product(*(range(order + 1) for order in orders))), dtype=int).reshape(-1, len(orders))


def powers_of_two(*tables: np.ndarray) -> np.ndarray:
    """Return the exponent of the largest magnitude of each column of tables (rows, outputs), as integers (outputs,).
    Numbers x 2^-exponent are below 1, so that the sum of their squares is finite; the scaling does not round.
    >>> powers_of_two(np.array([[3.0, 0.0], [-1.0, 0.0]])), powers_of_two(np.array([[1e200]]))
    (array([2, 0]), array([665]))
    """
    largest = np.max([np.abs(table).max(axis=0, initial=0.0) for table in tables], axis=0)
    return np.frexp(largest)[1].astype(int)
