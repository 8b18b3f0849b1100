"""Orientations as numbers, from the axes of a marker: exact in the real part, first order in the imaginary one."""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.vectors import cross, dot, plus, times
from dalembert.multibody.kernels.elementary import angle_of, real, reciprocal, root, sin_cos


@inlined
def quaternion(e1, e2, e3):
    """Quaternion, the scalar first and not negative; by the largest of its entries (Shepperd 1978)."""
    t1, t2, t3 = real(e1[0]), real(e2[1]), real(e3[2])
    if t1 + t2 + t3 >= max(t1, t2, t3):
        w = 0.5 * root(1.0 + e1[0] + e2[1] + e3[2])
        f = 0.25 * reciprocal(w)
        return w, f * (e2[2] - e3[1]), f * (e3[0] - e1[2]), f * (e1[1] - e2[0])
    if t1 >= max(t2, t3):
        x = 0.5 * root(1.0 + e1[0] - e2[1] - e3[2])
        f = 0.25 * reciprocal(x)
        w, y, z = f * (e2[2] - e3[1]), f * (e2[0] + e1[1]), f * (e3[0] + e1[2])
    elif t2 >= t3:
        y = 0.5 * root(1.0 - e1[0] + e2[1] - e3[2])
        f = 0.25 * reciprocal(y)
        w, x, z = f * (e3[0] - e1[2]), f * (e2[0] + e1[1]), f * (e3[1] + e2[2])
    else:
        z = 0.5 * root(1.0 - e1[0] - e2[1] + e3[2])
        f = 0.25 * reciprocal(z)
        w, x, y = f * (e1[1] - e2[0]), f * (e3[0] + e1[2]), f * (e3[1] + e2[2])
    sign = -1.0 if real(w) < 0.0 else 1.0
    return sign * w, sign * x, sign * y, sign * z


@inlined
def rotation_vector(e1, e2, e3):
    """Axis times angle, the angle within [0, pi]; its direction changes where the angle passes pi."""
    w, x, y, z = quaternion(e1, e2, e3)
    square = x * x + y * y + z * z
    if real(square) < 1e-16:  # 2 arctan(s / w) / s for small s = |(x, y, z)|, to rounding
        factor = 2.0 - (2.0 / 3.0) * square
    else:
        s = root(square)
        factor = 2.0 * angle_of(w, s) * reciprocal(s)
    return factor * x, factor * y, factor * z


@inlined
def _bend(vector):
    """The factor c = (1 - a/2 cot a/2) / a^2 of the rotation vector's differential, with its length a < 2 pi.

    Below a = 1/2 the difference loses digits; there it is the series sum_k |B_2k| a^(2k-2) / (2k)! with Bernoulli's
    numbers B.
    """
    square = dot(vector, vector)
    if real(square) < 0.25:
        c = 691.0 / 1307674368000.0 + square / 74724249600.0
        c = 1.0 / 47900160.0 + square * c
        c = 1.0 / 30240.0 + square * (1.0 / 1209600.0 + square * c)
        return 1.0 / 12.0 + square * (1.0 / 720.0 + square * c)
    half = 0.5 * root(square)
    s, cosine = sin_cos(half)
    return (1.0 - half * cosine * reciprocal(s)) * reciprocal(square)


@inlined
def vector_rate(vector, spin):
    """Rate of a rotation vector p by the angular velocity w in the fixed axes, w - p x w / 2 + c p x (p x w)."""
    across = cross(vector, spin)
    return plus(spin, plus(times(-0.5, across), times(_bend(vector), cross(vector, across))))


@inlined
def vector_torque(vector, torque):
    """Torque in the fixed axes that does the work of t on a rotation vector p, t + p x t / 2 + c p x (p x t)."""
    across = cross(vector, torque)
    return plus(torque, plus(times(0.5, across), times(_bend(vector), cross(vector, across))))


@inlined
def _entry(e1, e2, e3, row, column):
    """Entry of the matrix with these columns."""
    axis = e1
    if column == 1:
        axis = e2
    elif column == 2:
        axis = e3
    value = axis[0]
    if row == 1:
        value = axis[1]
    elif row == 2:
        value = axis[2]
    return value


@inlined
def euler_angles(e1, e2, e3, i, j, k):
    """Angles of successive rotations about the axes i, j and k, each turned by those before: R = R_i R_j R_k.

    With three different axes and e = 1 where they are in the order of (x, y, z), else -1: R_ik = e sin b,
    R_jk = -e sin a cos b, R_kk = cos a cos b, R_ij = -e cos b sin c, R_ii = cos b cos c. With k = i and the other
    axis l: R_ii = cos b, R_ji = sin a sin b, R_li = -e cos a sin b, R_ij = sin b sin c, R_il = e sin b cos c.
    """
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    own = _entry(e1, e2, e3, i, i)
    if i != k:
        across = _entry(e1, e2, e3, i, j)
        first = angle_of(_entry(e1, e2, e3, k, k), -sign * _entry(e1, e2, e3, j, k))
        second = angle_of(root(own * own + across * across + 1e-30), sign * _entry(e1, e2, e3, i, k))
        third = angle_of(own, -sign * across)
    else:
        last = 3 - i - j
        across, along = _entry(e1, e2, e3, i, j), _entry(e1, e2, e3, i, last)
        first = angle_of(-sign * _entry(e1, e2, e3, last, i), _entry(e1, e2, e3, j, i))
        second = angle_of(own, root(across * across + along * along + 1e-30))
        third = angle_of(sign * along, across)
    return first, second, third
