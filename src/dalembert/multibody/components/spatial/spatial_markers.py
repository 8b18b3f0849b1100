"""Markers: the points and axes of bodies that joints, loads and sensors refer to.

A body has twelve coordinates from the slot ``k`` on, its origin r and its directors d1, d2, d3: the columns of its
rotation matrix. A marker has constants in the axes of the body: its position ``s``, and ``c`` for each of its axes. Its
point r + s_i d_i and its axes c_i d_i are linear in the coordinates, so one function serves for values, for rates and
for second derivatives.

======  ==================  ======================================
kind    coordinates         constants
======  ==================  ======================================
GROUND  none                position and axes
MASS    r                   none: a point has no axes
BODY    r, d1, d2, d3       position and axes, in those of the body
======  ==================  ======================================
"""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.vectors import add_at, at, combined, cross, plus, times

GROUND, MASS, BODY = range(3)
SLOTS = 12


@inlined
def _directed(k, x, c):
    return combined(c, at(x, k + 3), at(x, k + 6), at(x, k + 9))


@inlined
def position(kind, k, x, s):
    """Position of a marker: r + s_i d_i."""
    if kind == BODY:
        return plus(at(x, k), _directed(k, x, s))
    if kind == MASS:
        return at(x, k)
    return s


@inlined
def position_rate(kind, k, v, s):
    """Velocity of a marker from the velocities of its coordinates, or its acceleration from their accelerations."""
    if kind == BODY:
        return plus(at(v, k), _directed(k, v, s))
    if kind == MASS:
        return at(v, k)
    return times(0.0, s)


@inlined
def axis(kind, k, x, c):
    """A direction of the marker's body: c_i d_i."""
    return _directed(k, x, c) if kind == BODY else c


@inlined
def axis_rate(kind, k, v, c):
    """First or second time derivative of a direction of the marker's body."""
    return _directed(k, v, c) if kind == BODY else times(0.0, c)


@inlined
def spin(kind, k, x, v):
    """Angular velocity, omega = d_i x d_i' / 2; with accelerations in place of velocities the angular acceleration."""
    if kind == BODY:
        first, second = cross(at(x, k + 3), at(v, k + 3)), cross(at(x, k + 6), at(v, k + 6))
        return times(0.5, plus(plus(first, second), cross(at(x, k + 9), at(v, k + 9))))
    return times(0.0, at(v, 0))


@inlined
def push(kind, k, s, force, r):
    """Add the generalised force of a force at a marker to the local vector ``r``: f on r, s_i f on d_i."""
    if kind != GROUND:
        add_at(r, k, force)
        push_axis(kind, k, s, force, r)


@inlined
def push_axis(kind, k, c, force, r):
    """Add the generalised force that does the work ``force`` times the change of a direction c_i d_i."""
    if kind == BODY:
        add_at(r, k + 3, times(c[0], force))
        add_at(r, k + 6, times(c[1], force))
        add_at(r, k + 9, times(c[2], force))


@inlined
def twist(kind, k, x, torque, r):
    """Add the generalised force of a torque to the local vector ``r``: tau x d_i / 2 on d_i."""
    if kind == BODY:
        half = times(0.5, torque)
        for i in range(k + 3, k + 12, 3):
            add_at(r, i, cross(half, at(x, i)))
