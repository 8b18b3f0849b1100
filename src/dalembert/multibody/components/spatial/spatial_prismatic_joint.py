"""The prismatic joint in space."""

__all__ = ["PrismaticJoint"]

from dataclasses import dataclass, field

from dalembert.multibody.components.spatial.conditions import level, perpendicular
from dalembert.multibody.components.spatial.friction import Friction, RubbingJoint, friction_kind
from dalembert.multibody.components.spatial.spatial_joint import joint_kind

KIND = joint_kind(
    "prismatic_in_space",
    __name__,
    level(1),
    level(2),
    perpendicular(1, 3),
    perpendicular(2, 3),
    perpendicular(1, 2),
    displacement=True,
)

FRICTION = friction_kind("prismatic_friction_in_space", __name__, 5, (0, 1), False)


@dataclass(frozen=True)
class PrismaticJoint(RubbingJoint):
    """A slide: b moves along the axis and does not turn relative to a.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.
    friction : Friction, optional
    """

    friction: Friction | None = field(default=None, metadata={"table": "FrictionAlong"})

    kind = KIND
    friction_kind = FRICTION
    rate = "speed"
    aligned = (1, 2, 3)
