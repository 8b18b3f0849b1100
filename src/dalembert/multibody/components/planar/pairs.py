"""Two markers: their relative position, velocity, angle, and the forces between them.

Local coordinates: marker a (slots 0-3) and b (4-7); absent ones are 0. Numbers: ``a_x a_y a_angle b_x b_y b_angle``;
integers: ``a_kind`` and ``b_kind``, see :mod:`markers`, and ``wraps``: 1 where a node's angle must be wrapped.
"""

from typing import Any

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.planar.markers import (
    acceleration,
    angle,
    position,
    push,
    spin,
    spin_rate,
    twist,
    velocity,
)
from dalembert.multibody.kernels.kind import Kind

COORDINATES = 8
NUMBERS = ("a_x", "a_y", "a_angle", "b_x", "b_y", "b_angle")
INTEGERS = ("a_kind", "b_kind", "wraps")


def pair_kind(
    name: str,
    numbers: tuple[str, ...] = (),
    integers: tuple[str, ...] = (),
    *,
    coordinates: int = COORDINATES,
    **declared: Any,
) -> Kind:
    """Kind of a component between two markers; ``numbers`` and ``integers`` are the columns that follow theirs."""
    numbers, integers = (*NUMBERS, *numbers), (*INTEGERS, *integers)
    return Kind(name, coordinates=coordinates, numbers=numbers, integers=integers, **declared)


@inlined
def separation(x, p, m):
    """Return the position of b minus that of a, (x, y), m."""
    ax, ay = position(m.a_kind, 0, x, p.a_x, p.a_y)
    bx, by = position(m.b_kind, 4, x, p.b_x, p.b_y)
    return bx - ax, by - ay


@inlined
def separation_rate(x, v, p, m):
    """Return the velocity of b minus that of a, (x, y), m/s."""
    ax, ay = velocity(m.a_kind, 0, x, v, p.a_x, p.a_y)
    bx, by = velocity(m.b_kind, 4, x, v, p.b_x, p.b_y)
    return bx - ax, by - ay


@inlined
def separation_second(x, v, a, p, m):
    """Return the acceleration of b minus that of a, (x, y), m/s^2."""
    ax, ay = acceleration(m.a_kind, 0, x, v, a, p.a_x, p.a_y)
    bx, by = acceleration(m.b_kind, 4, x, v, a, p.b_x, p.b_y)
    return bx - ax, by - ay


@inlined
def relative_angle(x, p, m):
    """Return the angle of b minus that of a, rad."""
    return angle(m.b_kind, 4, x, p.b_angle) - angle(m.a_kind, 0, x, p.a_angle)


@inlined
def relative_spin(x, v, m):
    """Return the angular velocity of b minus that of a, rad/s."""
    return spin(m.b_kind, 4, x, v) - spin(m.a_kind, 0, x, v)


@inlined
def relative_spin_rate(x, v, a, m):
    """Return the angular acceleration of b minus that of a, rad/s^2."""
    return spin_rate(m.b_kind, 4, x, v, a) - spin_rate(m.a_kind, 0, x, v, a)


@inlined
def push_pair(x, p, m, fx, fy, r):
    """Add (fx, fy) at b and (-fx, -fy) at a to the left side ``r`` of the equations of motion, N.

    The force on b is then (-fx, -fy): forces have the opposite sign on the left side.
    """
    push(m.b_kind, 4, x, p.b_x, p.b_y, fx, fy, r)
    push(m.a_kind, 0, x, p.a_x, p.a_y, -fx, -fy, r)


@inlined
def twist_pair(x, m, torque, r):
    """Add a torque at b and its opposite at a to the left side ``r`` of the equations of motion, N m.

    The torque on b is then the opposite one.
    """
    twist(m.b_kind, 4, x, torque, r)
    twist(m.a_kind, 0, x, -torque, r)
