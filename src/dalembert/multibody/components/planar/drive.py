"""Drives in the plane: what motors and servos share."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from dalembert.errors import ModelError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.laws.motor_law import INTEGERS, NUMBERS, DriveNumbers, Turning, drive_properties
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.pairs import (
    pair_kind,
    relative_angle,
    relative_spin,
    relative_spin_rate,
    twist_pair,
)
from dalembert.multibody.components.points import Side, require_direction
from dalembert.multibody.components.rows import Lowering, Pair
from dalembert.multibody.kernels.kind import Kind


@inlined
def _rate(x, v, p, m):
    return relative_spin(x, v, m)


@inlined
def _acceleration(x, v, a, p, m):
    return relative_spin_rate(x, v, a, m)


@inlined
def _twist(x, p, m, torque, r):
    twist_pair(x, m, torque, r)


_TURNING = Turning(relative_angle, _rate, _acceleration, _twist)


def drive_kind(
    name: str, command: Callable[..., Any], numbers: tuple[str, ...] = (), integers: tuple[str, ...] = ()
) -> Kind:
    """Kind of a motor, from ``command(x, v, p, m, inputs)``, which returns its voltage, or its current where
    the integer ``by_current`` is 1. Its arguments are those of a residual (:class:`Declaration`), with all columns.
    ``numbers``, ``integers``: further columns of the command; they follow those of all motors.
    """
    properties = drive_properties(command, _TURNING)
    return pair_kind(name, (*NUMBERS, *numbers), (*INTEGERS, *integers), **properties)


@dataclass(frozen=True)
class Drive(DriveNumbers, Load):
    """Base of motors in the plane."""

    a: Side
    b: Side

    def _pair(self, lowering: Lowering, owner: str) -> Pair:
        require_direction(owner, "a force, or a rigid body", self.a, self.b)
        pair = lowering.pair(self.a, self.b, self.name)
        if pair.integers[2] and self.armature_inertia != 0:
            raise ModelError(
                f"{owner}: {self.a} or {self.b} is a node of a beam, which cannot carry an armature_inertia. Fix a "
                "rigid body to the node, and give the motor that body"
            )
        return pair
