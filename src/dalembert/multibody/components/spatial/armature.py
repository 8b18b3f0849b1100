"""The inertia of a motor behind its gear, which resists the relative acceleration of two bodies about or along an axis.

T = inertia x rate^2 / 2 with the rate of the joint. The gyroscopic torques of the rotor, which are smaller by the gear
ratio, are neglected (Featherstone 2008, Rigid Body Dynamics Algorithms, section 9.6).
"""

__all__ = ["Armature"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.points import require_direction
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.orientation import Orientation, Vector
from dalembert.multibody.components.spatial.rotor import SLIDING_ROTOR, TURNING_ROTOR
from dalembert.multibody.components.spatial.spatial_joint import joint_rate
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_markers import axis_rate
from dalembert.multibody.components.spatial.spatial_pairs import (
    A_AXES,
    e3,
    push_a_axis,
    push_pair,
    relative_spin,
    separation,
    separation_rate,
    twist_pair,
)  # fmt: skip
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import dot, times

_a3, _push_e3 = A_AXES[2], push_a_axis(3)


@inlined
def _turning_residual(x, v, a, p, m, inputs, r):
    """Torque inertia x (e3 . alpha + e3' . omega) about the axis."""
    rate = dot(relative_spin(x, a, m), e3(x, p, m))
    rate += dot(relative_spin(x, v, m), axis_rate(m.a_kind, 0, v, _a3(p)))
    twist_pair(x, m, times(p.inertia * rate, e3(x, p, m)), r)


@inlined
def _turning_energy(x, v, p, m, inputs):
    rate = joint_rate(x, v, p, m)
    return 0.5 * p.inertia * rate * rate, 0.0 * rate, 0.0 * rate


@inlined
def _sliding_residual(x, v, a, p, m, inputs, r):
    """Force inertia x (e3 . Delta)'' that does work on e3 . Delta."""
    delta, turning = separation(x, p, m), axis_rate(m.a_kind, 0, v, _a3(p))
    rate = dot(e3(x, p, m), separation_rate(a, p, m)) + 2.0 * dot(turning, separation_rate(v, p, m))
    rate += dot(axis_rate(m.a_kind, 0, a, _a3(p)), delta)
    push_pair(p, m, times(p.inertia * rate, e3(x, p, m)), r)
    _push_e3(p, m, times(p.inertia * rate, delta), r)


@inlined
def _sliding_energy(x, v, p, m, inputs):
    turning = axis_rate(m.a_kind, 0, v, _a3(p))
    rate = dot(turning, separation(x, p, m)) + dot(e3(x, p, m), separation_rate(v, p, m))
    return 0.5 * p.inertia * rate * rate, 0.0 * rate, 0.0 * rate


TURNING = pair_kind(
    "turning_armature", __name__, ("inertia",), residual=_turning_residual, energy=_turning_energy,
    varying_mass="inertia", rotor=TURNING_ROTOR,
)  # fmt: skip
SLIDING = pair_kind(
    "sliding_armature", __name__, ("inertia",), residual=_sliding_residual, energy=_sliding_energy,
    varying_mass="inertia", rotor=SLIDING_ROTOR,
)  # fmt: skip


@dataclass(frozen=True)
class Armature(Load):
    """Inertia of a motor behind its gear, for a revolute or a prismatic joint between the same markers.

    Kinetic energy = inertia x rate^2 / 2, with the rate of the joint. There is no weight. The masses change with the
    coordinates; Variational and EnergyMomentum integrate a coordinate of the rotor with a constant mass instead.

    Parameters
    ----------
    name : str
    a, b : Point or ground
        Those of the joint.
    inertia : float
        About the axis of the joint, squared gear ratio times that of the rotor, kg m^2; of prismatic joints kg.
    axis : (float, float, float)
        That of the joint.
    slides : bool
        Whether the joint is prismatic.

    Examples
    --------
    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import Force, Inertia, PrismaticJoint, RigidBody, SpatialSystem
    >>> system = SpatialSystem(gravity=(0.0, 0.0, -1.0))
    >>> table = system.add(RigidBody("table", Inertia.sphere(mass=1.0, radius=0.1)))
    >>> slide = system.add(PrismaticJoint("slide", system.ground, table.point("origin")))
    >>> motor = system.add(Armature("motor", system.ground, table.point("origin"), 3.0, slides=True))
    >>> simulate(system, end=1.0).channels(["slide.speed"])[-1].round(6)  # weight 1 N, inertia 4 kg
    array([-0.25])
    """

    a: Side
    b: Side
    inertia: Number = number("kg*m**2", least=0)
    axis: Vector = (0.0, 0.0, 1.0)
    slides: bool = False

    kind = TURNING

    def lower(self, lowering: SpatialRows) -> None:
        require_direction(f"armature {self.name!r}", "a rigid body", self.a, self.b)
        own = Orientation.by_axes(self.axis).matrix
        pair = lowering.pair(self.a, self.b, self.name, (own, own))
        kind = SLIDING if self.slides else TURNING
        lowering.add(kind, pair.slots, [*pair.data, self.inertia], pair.integers, self.name)
