"""Two markers: their relative position and axes, and the forces between them.

The axes of marker a are e1, e2, e3, those of b are f1, f2, f3. Local coordinates: those of a from slot 0, those of b
from slot 12. A side on the ground has no coordinates, and its slots are empty.
"""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.directors import POSE
from dalembert.multibody.components.spatial.spatial_markers import (
    SLOTS,
    axis,
    position,
    position_rate,
    push,
    push_axis,
    spin,
    twist,
)
from dalembert.multibody.components.spatial.vectors import dot, minus, times

_OF_SIDE = ("x", "y", "z", "11", "12", "13", "21", "22", "23", "31", "32", "33")
NUMBERS = tuple(f"{side}_{name}" for side in "ab" for name in _OF_SIDE)
INTEGERS = ("a_kind", "b_kind")
COORDINATES = 2 * SLOTS
CHARTS = 2 * POSE
LENGTHS = ("a_x", "a_y", "a_z", "b_x", "b_y", "b_z")


@inlined
def a_point(p):
    """Position of a in its body."""
    return p.a_x, p.a_y, p.a_z


@inlined
def b_point(p):
    """Position of b in its body."""
    return p.b_x, p.b_y, p.b_z


@inlined
def _a1(p):
    return p.a_11, p.a_12, p.a_13


@inlined
def _a2(p):
    return p.a_21, p.a_22, p.a_23


@inlined
def _a3(p):
    return p.a_31, p.a_32, p.a_33


@inlined
def _b1(p):
    return p.b_11, p.b_12, p.b_13


@inlined
def _b2(p):
    return p.b_21, p.b_22, p.b_23


@inlined
def _b3(p):
    return p.b_31, p.b_32, p.b_33


#: Axes of both markers in their bodies, as functions of the numbers.
A_AXES, B_AXES = (_a1, _a2, _a3), (_b1, _b2, _b3)


def _a_axis(own):
    @inlined
    def e(x, p, m):
        return axis(m.a_kind, 0, x, own(p))

    return e


def _b_axis(own):
    @inlined
    def f(x, p, m):
        return axis(m.b_kind, SLOTS, x, own(p))

    return f


#: Axes of the markers in space, as functions of coordinates, numbers and integers.
E = e1, e2, e3 = tuple(map(_a_axis, A_AXES))
F = f1, f2, f3 = tuple(map(_b_axis, B_AXES))


@inlined
def along_axes(vector, x, p, m):
    """A vector in the axes of a."""
    return dot(e1(x, p, m), vector), dot(e2(x, p, m), vector), dot(e3(x, p, m), vector)


@inlined
def separation(x, p, m):
    """Position of b relative to a."""
    return minus(position(m.b_kind, SLOTS, x, b_point(p)), position(m.a_kind, 0, x, a_point(p)))


@inlined
def separation_rate(v, p, m):
    """Velocity of b relative to a; with accelerations in place of velocities the acceleration."""
    return minus(position_rate(m.b_kind, SLOTS, v, b_point(p)), position_rate(m.a_kind, 0, v, a_point(p)))


@inlined
def relative_spin(x, v, m):
    """Angular velocity of b relative to a; with accelerations in place of velocities the angular acceleration."""
    return minus(spin(m.b_kind, SLOTS, x, v), spin(m.a_kind, 0, x, v))


@inlined
def push_pair(p, m, force, r):
    """A force on b and its opposite on a."""
    push(m.b_kind, SLOTS, b_point(p), force, r)
    push(m.a_kind, 0, a_point(p), times(-1.0, force), r)


@inlined
def twist_pair(x, m, torque, r):
    """A torque on b and its opposite on a."""
    twist(m.b_kind, SLOTS, x, torque, r)
    twist(m.a_kind, 0, x, times(-1.0, torque), r)


def push_a_axis(number):
    """A function (p, m, force, r): the generalised force that does the work ``force`` times the change of e_number."""
    own = A_AXES[number - 1]

    @inlined
    def push_e(p, m, force, r):
        push_axis(m.a_kind, 0, own(p), force, r)

    return push_e


def push_b_axis(number):
    """A function (p, m, force, r): the generalised force that does the work ``force`` times the change of f_number."""
    own = B_AXES[number - 1]

    @inlined
    def push_f(p, m, force, r):
        push_axis(m.b_kind, SLOTS, own(p), force, r)

    return push_f
