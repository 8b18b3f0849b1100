"""The torsion spring with damper in space, about an axis."""

__all__ = ["TorsionSpring"]

from dataclasses import dataclass

import numpy as np

from dalembert.multibody.components.fields import number, parameters_of
from dalembert.multibody.components.laws.spring_law import TwistSpring, counted_spring
from dalembert.multibody.components.points import require_direction
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.joint_coordinate import JointCoordinate
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_joint import turned_to
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_rows import Pair, SpatialRows

TORSION_SPRING = counted_spring("torsion_spring_in_space", __name__, (("twist", "rad"), ("torque", "N*m")))


@parameters_of(TwistSpring)
@dataclass(frozen=True)
class TorsionSpring(TwistSpring, Load):
    """A torsion spring with damper about the axis of a joint.

    Torque = stiffness x twist + cubic x twist^3 + damping x rate of twist. The twist is the angle of b relative to a
    less the free angle. The angle is counted over whole turns.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    {law}
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.
    near : float, optional
        The angle at the start is the one nearest to this, rad; so a spring can start with whole turns. If not given,
        the twist at the start is within half a turn.

    Notes
    -----
    The angle is that of a revolute joint with this axis, also where no such joint is there: its tangent is
    (e2 . f1)/(e1 . f1). The torque is what does work on it.

    Examples
    --------
    A wheel that winds a spring by two turns, and turns back:

    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import Inertia, RevoluteJoint, RigidBody, SpatialSystem, TorsionSpring
    >>> system = SpatialSystem()
    >>> wheel = system.add(RigidBody("wheel", Inertia(1.0, (0.02, 0.02, 0.02)), angular_velocity=(0.0, 0.0, 20.0)))
    >>> sides = system.ground, wheel.point("origin")
    >>> _ = system.add(RevoluteJoint("pin", *sides))
    >>> _ = system.add(TorsionSpring("coil", *sides, stiffness=0.05))
    >>> simulate(system, end=4.0, solver="auto").channels(["coil.twist"]).max().round(2)  # 20 (J/k)^(1/2)
    np.float64(12.65)
    """

    a: Side
    b: Side
    axis: Vector = (0.0, 0.0, 1.0)
    near: float | None = number("rad", None)

    kind = TORSION_SPRING

    @property
    def coordinates(self) -> tuple[JointCoordinate]:
        middle = self.near
        if middle is None:
            middle = 0.0 if self.free_angle is None else float(np.real(self.free_angle))
        return (JointCoordinate(f"{self.name}.joint", self, within=(middle - np.pi, middle + np.pi)),)

    def pair(self, lowering: SpatialRows) -> Pair:
        """The markers of both sides, with the axis as their third one."""
        owner = f"torsion spring {self.name!r}"
        require_direction(owner, "a spring, or a rigid body", self.a, self.b)
        return lowering.pair(self.a, self.b, self.name, turned_to(self.axis, owner))

    def lower(self, lowering: SpatialRows) -> None:
        index, angle = lowering.coordinate(self.coordinates[0])
        free = angle if self.free_angle is None else self.free_angle
        lowering.add(self.kind, [index], [free, self.stiffness, self.damping, self.cubic], name=self.name)
