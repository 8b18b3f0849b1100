"""Geometry of beam elements in kernels: rotations of nodes, strains, and forces that pass from these to the nodes.

The formulas are those at the top of :mod:`beam_element`. A node has its origin and three directors.
"""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.spatial_markers import SLOTS
from dalembert.multibody.components.spatial.vectors import add_at, at, combined, cross, dot, minus, plus, times
from dalembert.multibody.kernels.elementary import reciprocal, root


@inlined
def directors_of(x, i):
    """Directors of node i."""
    return at(x, SLOTS * i + 3), at(x, SLOTS * i + 6), at(x, SLOTS * i + 9)


@inlined
def products(x, i, middle):
    """T_kl = m_k . d_l of the directors of node i and of the middle one, by columns."""
    m1, m2, m3 = directors_of(x, middle)
    a1, a2, a3 = directors_of(x, i)
    return (
        (dot(m1, a1), dot(m2, a1), dot(m3, a1)),
        (dot(m1, a2), dot(m2, a2), dot(m3, a2)),
        (dot(m1, a3), dot(m2, a3), dot(m3, a3)),
    )


@inlined
def rotation_of(t):
    """Rotation by its products T: its axis times tan(angle / 2), 1 / |(1, g)|, 1 / (1 + tr T)."""
    # The trace is 1 + 2 cos(angle): no root of a difference, and no branch below half a turn.
    factor = reciprocal(1.0 + t[0][0] + t[1][1] + t[2][2])
    g = times(factor, (t[1][2] - t[2][1], t[2][0] - t[0][2], t[0][1] - t[1][0]))
    return g, reciprocal(root(1.0 + dot(g, g))), factor


@inlined
def on_products(t, force):
    """Pass the force (F0, F) on the quaternion of a node to its products T, by columns."""
    g, p0, factor = rotation_of(t)
    f = force[1], force[2], force[3]
    # Of the normalisation P = (1, g) / |(1, g)|, then of g = factor times differences of products.
    inner_part = p0 * p0 * p0 * (force[0] + dot(f, g))
    s = times(factor, minus(times(p0, f), times(inner_part, g)))
    e = -dot(s, g)
    return (e, s[2], -s[1]), (-s[2], e, s[0]), (s[1], -s[0], e)


@inlined
def on_directors(x, i, middle, y, r):
    """Pass forces on the products of node i to its directors and to those of the middle node."""
    m1, m2, m3 = directors_of(x, middle)
    a1, a2, a3 = directors_of(x, i)
    k, m, (y1, y2, y3) = SLOTS * i, SLOTS * middle, y
    add_at(r, k + 3, combined(y1, m1, m2, m3))
    add_at(r, k + 6, combined(y2, m1, m2, m3))
    add_at(r, k + 9, combined(y3, m1, m2, m3))
    add_at(r, m + 3, combined((y1[0], y2[0], y3[0]), a1, a2, a3))
    add_at(r, m + 6, combined((y1[1], y2[1], y3[1]), a1, a2, a3))
    add_at(r, m + 9, combined((y1[2], y2[2], y3[2]), a1, a2, a3))


@inlined
def weighed(weights, quaternions):
    """Sum of quaternions, four numbers each, with weights: scalar and vector."""
    scalar, vector = weights[0] * quaternions[0], times(weights[0], at(quaternions, 1))
    for i in range(1, len(weights)):
        scalar += weights[i] * quaternions[4 * i]
        vector = plus(vector, times(weights[i], at(quaternions, 4 * i + 1)))
    return scalar, vector


@inlined
def line_sum(weights, x, slot):
    """Sum of vectors of the nodes at a slot, with weights."""
    total = times(weights[0], at(x, slot))
    for i in range(1, len(weights)):
        total = plus(total, times(weights[i], at(x, SLOTS * i + slot)))
    return total


@inlined
def strains_of(rho, p0, p, q0, q):
    """Force strains Gamma, curvatures K, 1 / sigma, and P0 rho x p + (rho x p) x p."""
    inverse, once = reciprocal(p0 * p0 + dot(p, p)), cross(rho, p)
    turned = plus(times(p0, once), cross(once, p))
    curved = minus(minus(times(p0, q), times(q0, p)), cross(p, q))
    return plus(rho, times(2.0 * inverse, turned)), times(2.0 * inverse, curved), inverse, turned


@inlined
def strain_rates(rho, p0, p, q0, q, drho, dp0, dp, dq0, dq, inverse, turned, kappa):
    """Time derivatives of Gamma and K."""
    shrink = 2.0 * inverse * (p0 * dp0 + dot(p, dp))  # sigma' / sigma
    once, rate = cross(rho, p), plus(cross(drho, p), cross(rho, dp))
    turning = plus(plus(times(dp0, once), times(p0, rate)), plus(cross(rate, p), cross(once, dp)))
    gamma = plus(drho, times(2.0 * inverse, minus(turning, times(shrink, turned))))
    curving = minus(plus(times(dp0, q), times(p0, dq)), plus(times(dq0, p), times(q0, dp)))
    curving = minus(curving, plus(cross(dp, q), cross(p, dq)))
    return gamma, minus(times(2.0 * inverse, curving), times(shrink, kappa))


@inlined
def full_product(c, u, v):
    """Both halves of C (u, v), with the upper triangle of C by rows."""
    return (
        (
            c[0] * u[0] + c[1] * u[1] + c[2] * u[2] + c[3] * v[0] + c[4] * v[1] + c[5] * v[2],
            c[1] * u[0] + c[6] * u[1] + c[7] * u[2] + c[8] * v[0] + c[9] * v[1] + c[10] * v[2],
            c[2] * u[0] + c[7] * u[1] + c[11] * u[2] + c[12] * v[0] + c[13] * v[1] + c[14] * v[2],
        ),
        (
            c[3] * u[0] + c[8] * u[1] + c[12] * u[2] + c[15] * v[0] + c[16] * v[1] + c[17] * v[2],
            c[4] * u[0] + c[9] * u[1] + c[13] * u[2] + c[16] * v[0] + c[18] * v[1] + c[19] * v[2],
            c[5] * u[0] + c[10] * u[1] + c[14] * u[2] + c[17] * v[0] + c[19] * v[1] + c[20] * v[2],
        ),
    )


@inlined
def in_middle_frame(x, line, middle):
    """A vector in the middle node's frame."""
    m1, m2, m3 = directors_of(x, middle)
    return dot(m1, line), dot(m2, line), dot(m3, line)


@inlined
def add_to_quaternions(p0, p, q0, q, rho, inverse, gamma, kappa, n, m, across, forces, values, slopes):
    """Pass stress resultants at a point to the quaternions of the nodes; the force on rho, R(P) n."""
    # Derivatives of (n, m) . e by the quaternion (P0, p) and by its slope (Q0, q): see the top of the file.
    along, twice, work = dot(n, rho), 2.0 * inverse, dot(n, gamma) + dot(m, kappa)
    first = twice * (p0 * along + dot(n, cross(rho, p)) + dot(q, m) - work * p0)
    second = plus(times(-(along + work), p), times(dot(p, n), rho))
    second = plus(plus(second, times(dot(p, rho), n)), times(p0, cross(n, rho)))
    second = times(twice, plus(second, minus(cross(m, q), times(q0, m))))
    third, fourth = -twice * dot(p, m), times(twice, plus(times(p0, m), cross(p, m)))
    for i in range(len(values)):
        a, b = values[i], across * slopes[i]
        forces[4 * i] += a * first + b * third
        add_at(forces, 4 * i + 1, plus(times(a, second), times(b, fourth)))
    once = cross(n, p)
    return plus(n, times(twice, minus(cross(once, p), times(p0, once))))


@inlined
def add_to_line(x, c, line, across, r, slopes, middle):
    """Pass a force c in the middle node's frame to the line, and the line's tangent to the middle directors."""
    m1, m2, m3 = directors_of(x, middle)
    force = combined(c, m1, m2, m3)
    for i in range(len(slopes)):
        add_at(r, SLOTS * i, times(across * slopes[i], force))
    add_at(r, SLOTS * middle + 3, times(c[0], line))
    add_at(r, SLOTS * middle + 6, times(c[1], line))
    add_at(r, SLOTS * middle + 9, times(c[2], line))


@inlined
def fill_quaternion(t, i, quaternions):
    """The quaternion of node i by its products with the middle node."""
    g, p0, _ = rotation_of(t)
    quaternions[4 * i] = p0
    quaternions[4 * i + 1], quaternions[4 * i + 2], quaternions[4 * i + 3] = times(p0, g)
