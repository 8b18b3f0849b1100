"""Markers: the frames of bodies that joints, loads and observers hold on to.

A marker is known by its kind, the slot ``k`` of its first local coordinate, and the constants (sx, sy, phi):

======  =========================  ====================================================
kind    local coordinates          constants
======  =========================  ====================================================
GROUND  none                       position and angle
RIGID   x, y, theta                position in the body's frame, angle against its axes
MASS    x, y                       none: a point has no direction
NODE    x, y, gx, gy               phi: angle of the frame against the gradient (gx, gy)
======  =========================  ====================================================
"""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.kernels.elementary import angle_of, reciprocal, root, sin_cos

GROUND, RIGID, MASS, NODE = range(4)


@inlined
def position(kind, k, x, sx, sy):
    """Position of a marker."""
    if kind == GROUND:
        return sx, sy
    if kind == RIGID:
        s, c = sin_cos(x[k + 2])
        return x[k] + c * sx - s * sy, x[k + 1] + s * sx + c * sy
    return x[k], x[k + 1]


@inlined
def velocity(kind, k, x, v, sx, sy):
    """Velocity of a marker."""
    if kind == GROUND:
        return 0.0 * sx, 0.0 * sy
    if kind == RIGID:
        s, c = sin_cos(x[k + 2])
        return v[k] - v[k + 2] * (s * sx + c * sy), v[k + 1] + v[k + 2] * (c * sx - s * sy)
    return v[k], v[k + 1]


@inlined
def acceleration(kind, k, x, v, a, sx, sy):
    """Acceleration of a marker."""
    if kind == GROUND:
        return 0.0 * sx, 0.0 * sy
    if kind == RIGID:
        s, c = sin_cos(x[k + 2])
        ox, oy = c * sx - s * sy, s * sx + c * sy
        w2 = v[k + 2] * v[k + 2]
        return a[k] - a[k + 2] * oy - w2 * ox, a[k + 1] + a[k + 2] * ox - w2 * oy
    return a[k], a[k + 1]


@inlined
def direction(kind, k, x, phi):
    """Cosine and sine of a marker's angle."""
    if kind == NODE:
        gx, gy = x[k + 2], x[k + 3]
        scale = reciprocal(root(gx * gx + gy * gy))
        s, c = sin_cos(phi)
        return (gx * c - gy * s) * scale, (gx * s + gy * c) * scale
    if kind == RIGID:
        s, c = sin_cos(x[k + 2] + phi)
        return c, s
    s, c = sin_cos(phi)
    return c, s


@inlined
def angle(kind, k, x, phi):
    """Angle of a marker, unbounded for rigid bodies, within (-pi, pi] plus phi for nodes of beams."""
    if kind == NODE:
        return angle_of(x[k + 2], x[k + 3]) + phi
    if kind == RIGID:
        return x[k + 2] + phi
    return phi


@inlined
def spin(kind, k, x, v):
    """Angular velocity of a marker."""
    if kind == NODE:
        gx, gy = x[k + 2], x[k + 3]
        return (gx * v[k + 3] - gy * v[k + 2]) * reciprocal(gx * gx + gy * gy)
    if kind == RIGID:
        return v[k + 2]
    return 0.0 * v[0]


@inlined
def spin_rate(kind, k, x, v, a):
    """Angular acceleration of a marker."""
    if kind == NODE:
        gx, gy, ux, uy = x[k + 2], x[k + 3], v[k + 2], v[k + 3]
        square = reciprocal(gx * gx + gy * gy)
        turn = (gx * uy - gy * ux) * square
        stretch = (gx * ux + gy * uy) * square
        return (gx * a[k + 3] - gy * a[k + 2]) * square - 2.0 * turn * stretch
    if kind == RIGID:
        return a[k + 2]
    return 0.0 * v[0]


@inlined
def push(kind, k, x, sx, sy, fx, fy, r):
    """Add the generalised force of a force (fx, fy) at a marker to the local vector ``r``."""
    if kind == GROUND:
        return
    r[k] += fx
    r[k + 1] += fy
    if kind == RIGID:
        s, c = sin_cos(x[k + 2])
        r[k + 2] += (c * sx - s * sy) * fy - (s * sx + c * sy) * fx


@inlined
def twist(kind, k, x, torque, r):
    """Add the generalised force of a torque at a marker to the local vector ``r``."""
    if kind == RIGID:
        r[k + 2] += torque
    elif kind == NODE:
        gx, gy = x[k + 2], x[k + 3]
        share = torque * reciprocal(gx * gx + gy * gy)
        r[k + 2] -= gy * share
        r[k + 3] += gx * share
