"""Motors in space that a voltage or a current drives."""

__all__ = ["Motor"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.laws.motor_law import INTEGERS, NUMBERS, MotorNumbers, Turning, drive_properties
from dalembert.multibody.components.points import require_direction
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.joint import joint_angle, joint_rate, observe_turn, turned_to
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.load import Load
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.pairs import e3, relative_spin, twist_pair
from dalembert.multibody.components.spatial.rotor import TURNING_ROTOR
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import dot, times


@inlined
def _command(x, v, p, m, inputs):
    return inputs.signals[m.command, 0]


@inlined
def _acceleration(x, v, a, p, m):
    """Relative angular acceleration about the axis, which is that of the angle where both bodies share the axis."""
    return dot(relative_spin(x, a, m), e3(x, p, m))


@inlined
def _twist(x, p, m, torque, r):
    twist_pair(x, m, times(torque, e3(x, p, m)), r)


_PROPERTIES = drive_properties(_command, Turning(joint_angle, joint_rate, _acceleration, _twist))
MOTOR = pair_kind(
    "motor_in_space", __name__, NUMBERS, (*INTEGERS, "command"), angles=("angle",), turn=observe_turn,
    varying_mass="inertia", rotor=TURNING_ROTOR, **_PROPERTIES,
)  # fmt: skip


@dataclass(frozen=True)
class Motor(MotorNumbers, Load):
    """A direct-current motor with a gear about the axis of a joint: it turns b against a.

    The law, the outputs and the errors are those of :class:`dalembert.multibody.Motor`. Its torque on b acts about the
    axis, the opposite torque on a.

    Parameters
    ----------
    name : str
    a, b : Point or ground
        Stator and output, which a joint with this axis should connect.
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
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.

    Examples
    --------
    The steady rate of a motor without load is voltage / back_emf:

    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import Inertia, RevoluteJoint, RigidBody, SpatialSystem
    >>> system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    >>> disc = system.add(RigidBody("disc", Inertia.cylinder(mass=1.0, radius=0.05, length=0.01)))
    >>> _ = system.add(RevoluteJoint("bearing", system.ground, disc.point("origin")))
    >>> sides = system.ground, disc.point("origin")
    >>> _ = system.add(Motor("motor", *sides, torque_constant=0.05, resistance=1.0, voltage=0.3))
    >>> simulate(system, end=8.0).channels(["motor.rate"])[-1].round(3)
    array([6.])
    """

    a: Side
    b: Side
    axis: Vector = (0.0, 0.0, 1.0)

    kind = MOTOR

    def lower(self, lowering: SpatialRows) -> None:
        owner = f"motor {self.name!r}"
        require_direction(owner, "a force, or a rigid body", self.a, self.b)
        pair = lowering.pair(self.a, self.b, self.name, turned_to(self.axis, owner))
        number = self._command(lowering)
        own, marks = self._law(lowering, by_current=self.voltage is None)
        row = [*pair.data, *own], [*pair.integers, *marks, number]
        lowering.add(MOTOR, pair.slots, *row, self.name)
