"""The cubic Hermite line, of beams and cables in the plane and of cables in space: its shape, inertia and weight.

Coordinates of one direction: (r1, r1', r2, r2') at slots (i, j, k, l); length ``h``, mass ``m``.

An element is stretched at Lobatto's three points, where a bent one leaves the strain at zero, so that it does not
lock; it is bent at Gauss' three points. Slopes of the line at a point, with the functions 1, 2 and 5 of r1 - r2, r1'
and r2': r' = S1 / h (r1 - r2) + S2 r1' + S5 r2', and r'' = C1 / h^2 (r1 - r2) + C2 / h r1' + C5 / h r2'.
"""

import numpy as np

from dalembert.kernels.kernel import inlined


def _slopes(xi: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, ...]:
    """Weights, and the functions of r' and of r'', at points of [-1, 1]."""
    xi = (xi + 1) / 2
    first = (6 * xi * (xi - 1), 1 - 4 * xi + 3 * xi**2, 3 * xi**2 - 2 * xi)
    second = (12 * xi - 6, 6 * xi - 4, 6 * xi - 2)
    return (weights / 2, *first, *second)


# Points of the stretch (A) and of the bending (B): weights, functions of r', and those of r'' (C).
AW, A1, A2, A5, _, _, _ = _slopes(np.array([-1.0, 0.0, 1.0]), np.array([1.0, 4.0, 1.0]) / 3)
BW, B1, B2, B5, C1, C2, C5 = _slopes(*np.polynomial.legendre.leggauss(3))


def line(nodes: np.ndarray, length: float, points: int) -> np.ndarray:
    """Positions (frames, elements x points + 1, 2 or 3) along elements of a length, m, with ``points`` parts each.

    ``nodes`` (frames, nodes, 2, 2 or 3): position and slope.
    """
    xi = np.linspace(0.0, 1.0, points + 1)[:, None]
    ends = 1 - 3 * xi**2 + 2 * xi**3, length * (xi - 2 * xi**2 + xi**3)
    others = 3 * xi**2 - 2 * xi**3, length * (xi**3 - xi**2)
    r, t = nodes[:, :, None, 0], nodes[:, :, None, 1]
    places = ends[0] * r[:, :-1] + ends[1] * t[:, :-1] + others[0] * r[:, 1:] + others[1] * t[:, 1:]
    inner = places[:, :, :-1].reshape(len(nodes), -1, nodes.shape[-1])
    return np.concatenate([inner, places[:, -1, -1:]], axis=1)


@inlined
def inertia(m, h, i, j, k, l, a, r):  # noqa: E741 - the four slots in order
    """Add the consistent mass matrix times ``a`` to ``r``, one direction."""
    h2 = h * h
    r[i] += m * (13 / 35 * a[i] + 11 / 210 * h * a[j] + 9 / 70 * a[k] - 13 / 420 * h * a[l])
    r[j] += m * (11 / 210 * h * a[i] + h2 / 105 * a[j] + 13 / 420 * h * a[k] - h2 / 140 * a[l])
    r[k] += m * (9 / 70 * a[i] + 13 / 420 * h * a[j] + 13 / 35 * a[k] - 11 / 210 * h * a[l])
    r[l] += m * (-13 / 420 * h * a[i] - h2 / 140 * a[j] - 11 / 210 * h * a[k] + h2 / 105 * a[l])


@inlined
def weight(m, h, g, i, j, k, l, r):  # noqa: E741 - the four slots in order
    """Subtract the weight ``m g`` of one direction from ``r``."""
    r[i] -= 0.5 * m * g
    r[j] -= m * g * h / 12
    r[k] -= 0.5 * m * g
    r[l] += m * g * h / 12


@inlined
def centre(h, i, j, k, l, x):  # noqa: E741 - the four slots in order
    """Mean of the line's coordinate, one direction: its centre of mass."""
    return 0.5 * (x[i] + x[k]) + h / 12 * (x[j] - x[l])


@inlined
def kinetic(m, h, i, j, k, l, v):  # noqa: E741 - the four slots in order
    """Half of the velocities' quadratic form with the consistent mass matrix, one direction."""
    square = 13 / 70 * (v[i] * v[i] + v[k] * v[k]) + h * h / 210 * (v[j] * v[j] + v[l] * v[l])
    ends = 9 / 70 * v[i] * v[k] - h * h / 140 * v[j] * v[l]
    mixed = 11 / 210 * (v[i] * v[j] - v[k] * v[l]) + 13 / 420 * (v[k] * v[j] - v[i] * v[l])
    return m * (square + ends + h * mixed)
