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


@inlined
def mass_matrix(m, h, i, j, k, l, factor, matrix):  # noqa: E741 - the four slots in order
    """Add ``factor`` times the consistent mass matrix of one direction to the local ``matrix``."""
    c = factor * m
    matrix[i, i] += 13 / 35 * c
    matrix[k, k] += 13 / 35 * c
    matrix[j, j] += h * h / 105 * c
    matrix[l, l] += h * h / 105 * c
    _both(matrix, i, j, 11 / 210 * h * c)
    _both(matrix, i, k, 9 / 70 * c)
    _both(matrix, i, l, -13 / 420 * h * c)
    _both(matrix, j, k, 13 / 420 * h * c)
    _both(matrix, j, l, -h * h / 140 * c)
    _both(matrix, k, l, -11 / 210 * h * c)


@inlined
def _both(matrix, i, j, value):
    matrix[i, j] += value
    matrix[j, i] += value


@inlined
def spread(matrix, i, j, factor, block):
    """Add ``factor`` times a 2 x 2 ``block`` (xx, xy, yx, yy) between the vectors at slots i and j."""
    matrix[i, j] += factor * block[0]
    matrix[i, j + 1] += factor * block[1]
    matrix[i + 1, j] += factor * block[2]
    matrix[i + 1, j + 1] += factor * block[3]


@inlined
def mirror(matrix, slots):
    """Complete a symmetric local ``matrix`` of which, in the order of the slots, the upper half is filled."""
    for i in range(len(slots)):
        for j in range(i):
            matrix[slots[i], slots[j]] = matrix[slots[j], slots[i]]


@inlined
def oppose(matrix, k, width):
    """Rows and columns of the position at slot ``k``: those of the position at slot 0, their sign turned."""
    for j in range(width):
        matrix[k, j], matrix[k + 1, j] = -matrix[0, j], -matrix[1, j]
    for i in range(width):
        matrix[i, k], matrix[i, k + 1] = -matrix[i, 0], -matrix[i, 1]
