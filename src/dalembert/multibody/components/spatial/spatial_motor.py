"""Motors in space that a voltage or a current drives."""

__all__ = ["Motor"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import parameters_of
from dalembert.multibody.components.laws.motor_law import INTEGERS, NUMBERS, MotorNumbers, Turning, drive_properties
from dalembert.multibody.components.points import require_direction
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.rotor import TURNING_ROTOR
from dalembert.multibody.components.spatial.spatial_joint import joint_angle, joint_rate, observe_turn, turned_to
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_pairs import e3, relative_spin, twist_pair
from dalembert.multibody.components.spatial.spatial_rows import Pair, SpatialRows
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


@parameters_of(MotorNumbers)
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
    {law}
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

    def _pair(self, lowering: SpatialRows, owner: str) -> Pair:
        require_direction(owner, "a force, or a rigid body", self.a, self.b)
        return lowering.pair(self.a, self.b, self.name, turned_to(self.axis, owner))
