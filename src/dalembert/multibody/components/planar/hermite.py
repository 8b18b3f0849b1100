"""Inertia and weight of the cubic Hermite line, shared by the ANCF beam and the ANCF cable.

Coordinates of one direction: (r1, r1', r2, r2') at slots (i, j, k, l); length ``h``, mass ``m``.
"""

from dalembert.kernels.kernel import inlined


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
