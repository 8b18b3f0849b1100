"""What motors share, in the plane and in space: current from voltage, torque through a gear, the armature's inertia."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from dalembert.errors import InputError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_load import BaseLoad
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.rows import Rows
from dalembert.multibody.components.signals import Course
from dalembert.multibody.kernels.elementary import exponential, logarithm, real, root, tanh, where

NUMBERS = ("torque_constant", "resistance", "back_emf", "limit", "ratio", "log_efficiency", "slip", "inertia")
INTEGERS = ("limited", "by_current", "enabled")
CORNER = 0.02  # width of the rounded corners of a limited quantity, relative to the limit
TINY = 1e-18  # keeps |torque| differentiable where the torque vanishes, N^2 m^2


@inlined
def _log_cosh(z):
    """Logarithm of cosh(z), less ln 2."""
    size = where(real(z) > 0.0, z, -z)
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


class Turning(NamedTuple):
    """Relative rotation of two markers, as functions.

    ``angle`` (x, p, m); ``rate`` (x, v, p, m); ``acceleration`` (x, v, a, p, m); ``twist`` (x, p, m, torque, r): adds
    the generalised force of a torque on b and of its opposite on a.
    """

    angle: Callable[..., Any]
    rate: Callable[..., Any]
    acceleration: Callable[..., Any]
    twist: Callable[..., Any]


def drive_properties(command: Callable[..., Any], turning: Turning) -> dict[str, Any]:
    """Properties of the kind of a motor.

    ``command`` (x, v, p, m, inputs): returns its voltage or current.
    """
    commanded: Any = command
    angle_of_b, rate_of_b, acceleration_of_b, twist = turning

    @inlined
    def residual(x, v, a, p, m, inputs, r):
        rate = rate_of_b(x, v, p, m)
        torque = _torque(_current(commanded(x, v, p, m, inputs), rate, p, m, inputs), rate, p)
        twist(x, p, m, p.inertia * acceleration_of_b(x, v, a, p, m) - torque, r)

    @inlined
    def energy(x, v, p, m, inputs):
        """Kinetic energy of the armature, no energy stored, power behind the gear."""
        rate = rate_of_b(x, v, p, m)
        torque = _torque(_current(commanded(x, v, p, m, inputs), rate, p, m, inputs), rate, p)
        return 0.5 * p.inertia * rate * rate, 0.0 * rate, torque * rate

    @inlined
    def observe(x, v, a, p, m, inputs, out):
        rate = rate_of_b(x, v, p, m)
        current = _current(commanded(x, v, p, m, inputs), rate, p, m, inputs)
        out[0], out[1] = angle_of_b(x, p, m), rate
        out[2], out[3] = _torque(current, rate, p), current
        out[4] = p.resistance * current + p.back_emf * p.ratio * rate

    residual.__module__ = commanded.__module__  # where other processes find the kind
    return {
        "residual": residual,
        "energy": energy,
        "outputs": (("angle", "rad"), ("rate", "rad/s"), ("torque", "N*m"), ("current", "A"), ("voltage", "V")),
        "observe": observe,
        "observes_inputs": True,
        "dissipates": True,
        "loads": True,
        "holds": True,
    }


@dataclass(frozen=True)
class DriveNumbers(BaseLoad):
    """Fields of motors and servos, described in `MotorNumbers`."""

    a: Any
    b: Any
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
        """Raise for numbers that no motor has."""
        if np.real(self.gear_ratio) == 0:
            raise InputError(f"{owner}: gear_ratio is 0; expected a number other than zero")

    @abstractmethod
    def _pair(self, lowering: Any, owner: str) -> Any:
        """Markers of both sides, which have a direction."""

    def _law(self, lowering: Rows, *, by_current: bool = False) -> tuple[list[Number], list[int]]:
        """Numbers and integers of the motor."""
        back_emf = self.torque_constant if self.back_emf is None else self.back_emf
        inertia = self.gear_ratio * self.gear_ratio * self.armature_inertia
        limit = 1.0 if self.voltage_limit is None else self.voltage_limit
        numbers = [self.torque_constant, self.resistance or 0.0, back_emf, limit, self.gear_ratio]
        numbers += [np.log(self.efficiency), self.slip_rate, inertia]
        return numbers, [int(self.voltage_limit is not None), int(by_current), lowering.signal(self.enabled)]


@dataclass(frozen=True)
class MotorNumbers(DriveNumbers):
    """Fields and row of motors that a voltage or a current drives.

    Parameters
    ----------
    torque_constant : float
        N m/A.
    resistance : float
        Ohm; needed with a ``voltage``.
    back_emf : float
        Back-EMF constant, V s/rad; that of the torque if not given.
    voltage_limit : float, optional
        V. Larger voltages are reduced to it. The corners are rounded over 2 % of the limit, so that the torque has a
        derivative; the voltage differs by at most 0.7 % of the limit.
    gear_ratio : float
        Turns of the armature per turn of b against a; negative if they turn in opposite directions.
    efficiency : float
        Of the gear, in (0, 1]. The torque behind the gear is N k i e where the motor drives and N k i / e where it is
        driven, with the efficiency e; in between it is N k i e^s, s = tanh(w / slip_rate) sign(N i). So the friction
        of the gear grows with the motor's torque, and acts against the rate.
    slip_rate : float
        Rate of b against a, rad/s, over which the losses of the gear turn their sign.
    armature_inertia : float
        kg m^2, about the armature's axis. N^2 times it resists the angular acceleration of b against a. Where a turns
        as well, terms of the relative size 1/N are missing.
    enabled : float or Signal
        Factor of the current: 1, or 0 where the motor is switched off (no current, so no torque and no braking). A
        ``Step(1.0, 0.0, 2.0)`` switches off at 2 s.
    voltage : float or Signal, optional
        V. Give this or a ``current``.
    current : float or Signal, optional
        A. The amplifier then controls the current, and resistance and back-EMF have no influence.
    """

    voltage: Course | None = number("V", None)
    current: Course | None = number("A", None)

    def __post_init__(self) -> None:
        owner = f"motor {self.name!r}"
        if (self.voltage is None) == (self.current is None):
            count = "neither voltage nor current" if self.voltage is None else "both voltage and current"
            raise InputError(f"{owner}: {count} was given; give one of them")
        if self.voltage is not None and self.resistance is None:
            raise InputError(f"{owner}: a voltage was given without a resistance; give the resistance in ohm")
        self._check(owner)

    def lower(self, lowering: Any) -> None:
        command = self.current if self.voltage is None else self.voltage
        assert command is not None
        signal = lowering.signal(command)
        pair = self._pair(lowering, f"motor {self.name!r}")
        numbers, integers = self._law(lowering, by_current=self.voltage is None)
        lowering.add(self.kind, pair.slots, [*pair.data, *numbers], [*pair.integers, *integers, signal], self.name)
