"""Servos: motors with a position loop."""

__all__ = ["Servo"]

from dataclasses import dataclass
from typing import Any

from dalembert.errors import InputError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.laws.motor_law import INTEGERS, NUMBERS, Turning, clipped, drive_properties
from dalembert.multibody.components.planar.angle_coordinate import AngleCoordinate, counted_angle
from dalembert.multibody.components.planar.drive import Drive, drive_kind
from dalembert.multibody.components.planar.pairs import relative_angle, relative_spin
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.components.signals import Course
from dalembert.multibody.kernels.kind import Kind

_COLUMNS = ("kp", "kd", "dead_band"), ("goal", "has_dead_band")


@inlined
def _voltage(angle, rate, p, m, inputs):
    """Voltage of the position loop."""
    error = inputs.signals[m.goal, 0] - angle
    if m.has_dead_band == 1:
        error -= clipped(error, p.dead_band)
    return p.kp * error - p.kd * rate


@inlined
def _command(x, v, p, m, inputs):
    return _voltage(relative_angle(x, p, m), relative_spin(x, v, m), p, m, inputs)


SERVO = drive_kind("servo", _command, *_COLUMNS)


@inlined
def _counted_command(x, v, p, m, inputs):
    return _voltage(x[0], v[0], p, m, inputs)


@inlined
def _counted_angle(x, p, m):
    return x[0]


@inlined
def _counted_rate(x, v, p, m):
    return v[0]


@inlined
def _counted_acceleration(x, v, a, p, m):
    return a[0]


@inlined
def _exert(x, p, m, torque, r):
    r[0] += torque


_TURNING = Turning(_counted_angle, _counted_rate, _counted_acceleration, _exert)
_PROPERTIES: dict[str, Any] = drive_properties(_counted_command, _TURNING) | {
    "holds": False
}  # the tie of the angle does
COUNTED_SERVO = Kind(
    "counted_servo", coordinates=1, numbers=(*NUMBERS, *_COLUMNS[0]), integers=(*INTEGERS, *_COLUMNS[1]), **_PROPERTIES
)


@dataclass(frozen=True)
class Servo(Drive):
    """A motor whose voltage a position loop controls: it turns b against a to the angle ``goal``.

    The voltage is kp (goal - angle) - kd rate, within ``voltage_limit``, of the angle and the rate of b against a.

    Parameters
    ----------
    name : str
    a, b : Point or ground
        Stator and output, which a revolute joint should connect.
    torque_constant, resistance, back_emf, gear_ratio, efficiency, slip_rate, armature_inertia, enabled
        Of the motor, see `Motor`. The resistance is needed.
    voltage_limit : float, optional
        V. A gain that is a duty ratio (0 to 1) per rad is multiplied by the supply voltage, which is the limit.
    goal : float or Signal
        rad; the channel ``angle`` of the servo is compared with it.
    kp : float
        V/rad.
    kd : float
        V s/rad. It acts on the measured rate, so that a step of the goal gives no impulse.
    dead_band : float, optional
        rad. Errors up to it have no voltage, larger ones are reduced by it; the corners are rounded over 2 % of it.

    Raises
    ------
    InputError
        Without a goal, kp or resistance, and for numbers out of range.

    Notes
    -----
    Outputs are those of `Motor`. The loop is continuous in time. The angle counts whole turns, also of nodes of beams;
    at the start it is the one that the bodies state.

    Examples
    --------
    A pendulum that a servo turns to 1 rad. The error that remains holds its weight:

    >>> from dalembert.multibody import RevoluteJoint, RigidBar, System, simulate
    >>> system = System(gravity=(0.0, -9.81))
    >>> bar = system.add(RigidBar("bar", length=0.2, mass=0.1))
    >>> _ = system.add(RevoluteJoint("pin", system.ground, bar.start, viscous=0.01))
    >>> motor = {"torque_constant": 1.0, "resistance": 4.0, "voltage_limit": 12.0}
    >>> _ = system.add(Servo("servo", system.ground, bar.start, **motor, goal=1.0, kp=30.0))
    >>> angle, torque = simulate(system, end=4.0).channels(["servo.angle", "servo.torque"])[-1].round(5)
    >>> float(angle), float(torque)
    (0.99285, 0.05359)
    """

    goal: Course | None = number("rad", None)
    kp: Number | None = number("V/rad", None, least=0)
    kd: Number = number("V*s/rad", 0.0, least=0)
    dead_band: Number | None = number("rad", None, above=0)

    kind = SERVO

    def __post_init__(self) -> None:
        owner = f"servo {self.name!r}"
        for name in ("goal", "kp", "resistance"):
            if getattr(self, name) is None:
                raise InputError(f"{owner}: {name} is missing; give it")
        self._check(owner)

    @property
    def coordinates(self) -> tuple[AngleCoordinate, ...]:
        return counted_angle(self.name, self.a, self.b)

    def lower(self, lowering: Lowering) -> None:
        assert self.goal is not None
        assert self.kp is not None
        band = 1.0 if self.dead_band is None else self.dead_band
        pair = self._pair(lowering, f"servo {self.name!r}")
        numbers, integers = self._law(lowering)
        numbers += [self.kp, self.kd, band]
        integers += [lowering.signal(self.goal), int(self.dead_band is not None)]
        if self.coordinates:
            index, _ = lowering.coordinate(self.coordinates[0])
            lowering.add(COUNTED_SERVO, [index], numbers, integers, self.name)
        else:
            lowering.add(SERVO, pair.slots, [*pair.data, *numbers], [*pair.integers, *integers], self.name)
