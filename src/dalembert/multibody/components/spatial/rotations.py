"""Orientations as numbers, from the axes of a marker: exact in the real part, first order in the imaginary one."""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.kernels.elementary import angle_of, real, reciprocal, root


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
def roll_pitch_yaw(e1, e2, e3):
    """Angles about the fixed axes x, y, z in turn (z, y, x of the body); singular at a pitch of 90 degrees."""
    across = root(e1[0] * e1[0] + e1[1] * e1[1] + 1e-30)
    return angle_of(e3[2], e2[2]), angle_of(across, -e1[2]), angle_of(e1[0], e1[1])
