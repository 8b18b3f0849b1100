"""Holonomic joints between two markers.

Local unknowns: coordinates of marker a (slots 0-3) and b (4-7), multipliers (8-10). The residual holds the constraint
forces, which are the transposed constraint jacobian times the multipliers, and the constraints themselves.

Data: (sx, sy, phi) of a and of b, then `parameter`: the length of a distance joint, the angle between the frames of a
fixed or prismatic joint, then the axis angle of a prismatic joint against the frame of a.
Meta: joint kind, marker kinds of a and b, signal of a prescribed motion, 1 where a node's angle must be wrapped.
"""

from dalembert.multibody.kernels.compiled import inlined, kernel
from dalembert.multibody.kernels.dual import root, sin_cos, wrapped
from dalembert.multibody.kernels.markers import (
    RIGID,
    acceleration,
    angle,
    direction,
    position,
    push,
    spin,
    spin_rate,
    twist,
    velocity,
)

WIDTH = 11
MULTIPLIERS = 8  # slot of the first one
REVOLUTE, FIXED, PRISMATIC, DISTANCE, MOTION_X, MOTION_Y, MOTION_ANGLE = range(7)


@inlined
def separation(x, data, meta, e):
    """Position of b against a."""
    ax, ay = position(meta[e, 1], 0, x, data[e, 0], data[e, 1])
    bx, by = position(meta[e, 2], 4, x, data[e, 3], data[e, 4])
    return bx - ax, by - ay


@inlined
def separation_rate(x, v, data, meta, e):
    """Velocity of b against a."""
    ax, ay = velocity(meta[e, 1], 0, x, v, data[e, 0], data[e, 1])
    bx, by = velocity(meta[e, 2], 4, x, v, data[e, 3], data[e, 4])
    return bx - ax, by - ay


@inlined
def relative_angle(x, data, meta, e):
    """Angle of b against a."""
    return angle(meta[e, 2], 4, x, data[e, 5]) - angle(meta[e, 1], 0, x, data[e, 2])


@inlined
def relative_spin(x, v, meta, e):
    """Angular velocity of b against a."""
    return spin(meta[e, 2], 4, x, v) - spin(meta[e, 1], 0, x, v)


@inlined
def push_pair(x, data, meta, e, fx, fy, r):
    """Force (fx, fy) on b and its opposite on a."""
    push(meta[e, 2], 4, x, data[e, 3], data[e, 4], fx, fy, r)
    push(meta[e, 1], 0, x, data[e, 0], data[e, 1], -fx, -fy, r)


@inlined
def twist_pair(x, meta, e, torque, r):
    """Torque on b and its opposite on a."""
    twist(meta[e, 2], 4, x, torque, r)
    twist(meta[e, 1], 0, x, -torque, r)


@inlined
def axis(x, data, meta, e):
    """Unit vector of a prismatic joint's axis, which turns with a."""
    return direction(meta[e, 1], 0, x, data[e, 2] + data[e, 7])


@inlined
def joins_points(data, meta, e):
    """Whether a joint pins points that do not turn about a body's centre, so that its tangent is constant."""
    return meta[e, 0] == REVOLUTE and meta[e, 1] != RIGID and meta[e, 2] != RIGID


@inlined
def residual(x, v, a, signals, callbacks, data, meta, e, r):
    """Constraint forces in the coordinates' slots, constraints in the multipliers' slots."""
    for i in range(WIDTH):
        r[i] = 0.0
    kind = meta[e, 0]
    l0, l1 = x[8], x[9]
    dx, dy = separation(x, data, meta, e)
    if kind == REVOLUTE or kind == FIXED:
        push_pair(x, data, meta, e, l0, l1, r)
        r[8], r[9] = dx, dy
    if kind == PRISMATIC:
        c, s = axis(x, data, meta, e)
        push_pair(x, data, meta, e, -s * l0, c * l0, r)
        twist(meta[e, 1], 0, x, -l0 * (c * dx + s * dy), r)
        r[8] = c * dy - s * dx
    if kind == FIXED or kind == PRISMATIC:
        slot = 10 if kind == FIXED else 9
        sine, cosine = sin_cos(relative_angle(x, data, meta, e) - data[e, 6])
        twist_pair(x, meta, e, cosine * x[slot], r)
        r[slot] = sine
    if kind == DISTANCE:
        length = data[e, 6]
        push_pair(x, data, meta, e, l0 * dx / length, l0 * dy / length, r)
        r[8] = 0.5 * ((dx * dx + dy * dy) / length - length)
    if kind == MOTION_X:
        push_pair(x, data, meta, e, l0, 0.0 * l0, r)
        r[8] = dx - signals[meta[e, 3], 0]
    if kind == MOTION_Y:
        push_pair(x, data, meta, e, 0.0 * l0, l0, r)
        r[8] = dy - signals[meta[e, 3], 0]
    if kind == MOTION_ANGLE:
        twist_pair(x, meta, e, l0, r)
        gap = relative_angle(x, data, meta, e) - signals[meta[e, 3], 0]
        r[8] = wrapped(gap) if meta[e, 4] == 1 else gap


@kernel
def rates(x, v, a, signals, data, meta, e, out):
    """First and second time derivatives of the constraints, into the first and the last three of ``out`` (6,)."""
    kind = meta[e, 0]
    dx, dy = separation(x, data, meta, e)
    ux, uy = separation_rate(x, v, data, meta, e)
    ax, ay = acceleration(meta[e, 1], 0, x, v, a, data[e, 0], data[e, 1])
    bx, by = acceleration(meta[e, 2], 4, x, v, a, data[e, 3], data[e, 4])
    wx, wy = bx - ax, by - ay
    turn = relative_spin(x, v, meta, e)
    swing = spin_rate(meta[e, 2], 4, x, v, a) - spin_rate(meta[e, 1], 0, x, v, a)
    if kind == REVOLUTE or kind == FIXED:
        out[0], out[1] = ux, uy
        out[3], out[4] = wx, wy
    if kind == PRISMATIC:
        c, s = axis(x, data, meta, e)
        along, across, along_rate = c * dx + s * dy, c * dy - s * dx, c * ux + s * uy
        own, own_rate = spin(meta[e, 1], 0, x, v), spin_rate(meta[e, 1], 0, x, v, a)
        out[0] = c * uy - s * ux - own * along
        out[3] = c * wy - s * wx - 2 * own * along_rate - own_rate * along - own * own * across
    if kind == FIXED or kind == PRISMATIC:
        row = 2 if kind == FIXED else 1
        sine, cosine = sin_cos(relative_angle(x, data, meta, e) - data[e, 6])
        out[row] = cosine * turn
        out[3 + row] = cosine * swing - sine * turn * turn
    if kind == DISTANCE:
        out[0] = (dx * ux + dy * uy) / data[e, 6]
        out[3] = (ux * ux + uy * uy + dx * wx + dy * wy) / data[e, 6]
    if kind >= MOTION_X:
        signal = meta[e, 3]
        first = ux if kind == MOTION_X else (uy if kind == MOTION_Y else turn)
        out[0] = first - signals[signal, 1]
        last = wx if kind == MOTION_X else (wy if kind == MOTION_Y else swing)
        out[3] = last - signals[signal, 2]


@kernel
def energy(x, v, signals, callbacks, data, meta, e):
    """No energy; the power that a prescribed motion feeds in."""
    zero = 0.0 * data[e, 0]
    power = zero
    if meta[e, 0] >= MOTION_X:
        power = -x[8] * signals[meta[e, 3], 1]
    return zero, zero, power


@kernel
def reaction(x, data, meta, e):
    """Force (fx, fy) and torque that the joint exerts on b."""
    kind = meta[e, 0]
    zero = 0.0 * x[8]
    if kind == REVOLUTE:
        return -x[8], -x[9], zero
    if kind == FIXED:
        return -x[8], -x[9], -x[10]
    if kind == PRISMATIC:
        c, s = axis(x, data, meta, e)
        return s * x[8], -c * x[8], -x[9]
    if kind == DISTANCE:
        dx, dy = separation(x, data, meta, e)
        length = root(dx * dx + dy * dy)
        return -x[8] * dx / length, -x[8] * dy / length, zero
    if kind == MOTION_X:
        return -x[8], zero, zero
    if kind == MOTION_Y:
        return zero, -x[8], zero
    return zero, zero, -x[8]
