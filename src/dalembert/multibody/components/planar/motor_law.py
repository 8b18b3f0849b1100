"""What motors share: current from voltage, torque through a gear, and the armature's inertia."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.errors import InputError, ModelError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.lowering import Lowering
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.pairs import (
    pair_kind,
    relative_angle,
    relative_spin,
    relative_spin_rate,
    twist_pair,
)
from dalembert.multibody.components.points import Side, require_direction
from dalembert.multibody.components.signals import Course
from dalembert.multibody.kernels.elementary import exponential, logarithm, root, tanh
from dalembert.multibody.kernels.kind import Kind

NUMBERS = ("torque_constant", "resistance", "back_emf", "limit", "ratio", "log_efficiency", "slip", "inertia")
INTEGERS = ("limited", "by_current", "enabled")
CORNER = 0.02  # width of the rounded corners of a limited quantity, relative to the limit
TINY = 1e-18  # keeps |torque| differentiable where the torque vanishes, N^2 m^2


@inlined
def _log_cosh(z):
    """Logarithm of cosh(z), less ln 2."""
    size = z if z.real > 0 else -z
    return size + logarithm(1.0 + exponential(-2.0 * size))


@inlined
def clipped(value, limit):
    """A value between -limit and limit, with rounded corners.

    The slope is (tanh((value + limit)/w) - tanh((value - limit)/w))/2 with w = CORNER limit: 1 inside to rounding, 0
    outside, and at the limit the value is ln(2) w/2 = 0.7 % below it.
    """
    width = CORNER * limit
    return 0.5 * width * (_log_cosh((value + limit) / width) - _log_cosh((value - limit) / width))


@inlined
def _current(command, rate, p, m, inputs):
    """Current of a command, which is a current or a voltage."""
    if m.by_current == 1:
        current = command
    else:
        voltage = clipped(command, p.limit) if m.limited == 1 else command
        current = (voltage - p.back_emf * p.ratio * rate) / p.resistance
    return inputs.signals[m.enabled, 0] * current


@inlined
def _torque(current, rate, p):
    """Torque behind the gear, whose losses act against the rate."""
    torque = p.ratio * p.torque_constant * current
    driving = tanh(rate / p.slip) * torque / root(torque * torque + TINY)
    return torque * exponential(driving * p.log_efficiency)


def drive_kind(
    name: str, command: Callable[..., Any], numbers: tuple[str, ...] = (), integers: tuple[str, ...] = ()
) -> Kind:
    """Kind of a motor, from ``command(x, v, p, m, inputs)``, which returns its voltage or current.

    Parameters
    ----------
    name : str
    command : function
    numbers, integers : tuple of str
        Columns of the command; they follow those of all motors.
    """
    commanded: Any = command

    @inlined
    def residual(x, v, a, p, m, inputs, r):
        rate = relative_spin(x, v, m)
        torque = _torque(_current(commanded(x, v, p, m, inputs), rate, p, m, inputs), rate, p)
        twist_pair(x, m, p.inertia * relative_spin_rate(x, v, a, m) - torque, r)

    @inlined
    def energy(x, v, p, m, inputs):
        """Kinetic energy of the armature, no energy stored, power behind the gear."""
        rate = relative_spin(x, v, m)
        torque = _torque(_current(commanded(x, v, p, m, inputs), rate, p, m, inputs), rate, p)
        return 0.5 * p.inertia * rate * rate, 0.0 * rate, torque * rate

    @inlined
    def observe(x, v, a, p, m, inputs, out):
        rate = relative_spin(x, v, m)
        current = _current(commanded(x, v, p, m, inputs), rate, p, m, inputs)
        out[0], out[1] = relative_angle(x, p, m), rate
        out[2], out[3] = _torque(current, rate, p), current
        out[4] = p.resistance * current + p.back_emf * p.ratio * rate

    residual.__module__ = commanded.__module__  # where other processes find the kind
    return pair_kind(
        name,
        (*NUMBERS, *numbers),
        (*INTEGERS, *integers),
        residual=residual,
        energy=energy,
        outputs=(("angle", "rad"), ("rate", "rad/s"), ("torque", "N*m"), ("current", "A"), ("voltage", "V")),
        observe=observe,
        observes_inputs=True,
        dissipates=True,
        loads=True,
        holds=True,
    )


@dataclass(frozen=True)
class Drive(Load):
    """Base of motors: what they are made of.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    torque_constant, resistance, back_emf, voltage_limit, gear_ratio, efficiency, slip_rate, armature_inertia, enabled
        See `Motor`.
    """

    a: Side
    b: Side
    torque_constant: Number = number("N*m/A", above=0)
    resistance: Number | None = number("ohm", None, above=0)
    back_emf: Number | None = number("V*s/rad", None, least=0)
    voltage_limit: Number | None = number("V", None, above=0)
    gear_ratio: Number = number("", 1.0)
    efficiency: Number = number("", 1.0, above=0, most=1)
    slip_rate: Number = number("rad/s", 0.1, above=0)
    armature_inertia: Number = number("kg*m**2", 0.0, least=0)
    enabled: Course = number("", 1.0)

    def _check(self, owner: str) -> None:
        """Refuse numbers that no motor has."""
        if np.real(self.gear_ratio) == 0:
            raise InputError(f"{owner}: gear_ratio is 0; expected a number other than zero")

    def _add(
        self, lowering: Lowering, owner: str, numbers: list[Number], integers: list[int], *, by_current: bool = False
    ) -> None:
        """Write the row, with the numbers and integers of the command."""
        require_direction(owner, "a force, or a rigid body", self.a, self.b)
        pair = lowering.pair(self.a, self.b, self.name)
        if pair.integers[2] and self.armature_inertia != 0:
            raise ModelError(
                f"{owner}: {self.a} or {self.b} is a node of a beam, which cannot carry an armature_inertia. Fix a "
                "rigid body to the node, and give the motor that body"
            )
        back_emf = self.torque_constant if self.back_emf is None else self.back_emf
        inertia = self.gear_ratio * self.gear_ratio * self.armature_inertia
        limit = 1.0 if self.voltage_limit is None else self.voltage_limit
        own = [self.torque_constant, self.resistance or 0.0, back_emf, limit, self.gear_ratio]
        own += [np.log(self.efficiency), self.slip_rate, inertia]
        marks = [int(self.voltage_limit is not None), int(by_current), lowering.signal(self.enabled)]
        row = [*pair.data, *own, *numbers], [*pair.integers, *marks, *integers]
        lowering.add(self.kind, pair.slots, *row, self.name)
