"""Curvature of a line r, and its part of a stiffness matrix: shared by the ANCF cable and the structural beam.

With t = r' and c = r'', kappa = (t x c)/|t|^2. Both are sums of an element's vectors, with factors ``s`` and ``c``.
"""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.planar import hermite
from dalembert.multibody.kernels.elementary import reciprocal


@inlined
def curvature(tx, ty, cx, cy):
    """Curvature, and its derivatives by r' = (tx, ty); those by r'' are (-ty, tx) over the square, the last value."""
    square = reciprocal(tx * tx + ty * ty)
    kappa = (tx * cy - ty * cx) * square
    return kappa, (cy - 2 * kappa * tx) * square, -(cx + 2 * kappa * ty) * square, square


@inlined
def spread_stiffness(matrix, slots, s, c, w, moment, tx, ty, cx, cy):
    """Add w k_z k_z^T + moment k_zz for z = (t, c), in the upper half of the three vectors at ``slots``.

    With p = (c_y, -c_x) and g = |t|: k_t = p / g^2 - 2 k t / g^2, k_c = (-t_y, t_x) / g^2,
    k_tt = -2 (p t^T + t p^T + k g^2 I) / g^4 + 8 k t t^T / g^4 and k_tc = [[0, 1], [-1, 0]] / g^2 - 2 t k_c^T / g^2.
    """
    kappa, px, py, square = curvature(tx, ty, cx, cy)
    qx, qy = -ty * square, tx * square
    two, fourth = 2 * kappa * square, square * square
    eight, turn, lift = 8 * kappa * fourth, moment * square, 2 * moment * square
    mixed = w * px * py + moment * (2 * (cx * tx - cy * ty) * fourth + eight * tx * ty)
    tt = (
        w * px * px + moment * (-4 * cy * tx * fourth - two + eight * tx * tx),
        mixed,
        mixed,
        w * py * py + moment * (4 * cx * ty * fourth - two + eight * ty * ty),
    )
    tc = (
        w * px * qx - lift * tx * qx,
        w * px * qy - lift * tx * qy + turn,
        w * py * qx - lift * ty * qx - turn,
        w * py * qy - lift * ty * qy,
    )
    cc = w * qx * qx, w * qx * qy, w * qx * qy, w * qy * qy
    for i in range(3):
        for j in range(i, 3):
            a, b, d, f = s[i] * s[j], s[i] * c[j], c[i] * s[j], c[i] * c[j]
            block = (
                a * tt[0] + (b + d) * tc[0] + f * cc[0],
                a * tt[1] + b * tc[1] + d * tc[2] + f * cc[1],
                a * tt[2] + b * tc[2] + d * tc[1] + f * cc[2],
                a * tt[3] + (b + d) * tc[3] + f * cc[3],
            )
            hermite.spread(matrix, slots[i], slots[j], 1.0, block)
