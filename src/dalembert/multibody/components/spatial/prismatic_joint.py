"""The prismatic joint in space."""

__all__ = ["PrismaticJoint"]

from dataclasses import dataclass

from dalembert.multibody.components.spatial.conditions import level, perpendicular
from dalembert.multibody.components.spatial.joint import Joint, joint_kinds
from dalembert.multibody.components.spatial.lowering import SpatialLowering
from dalembert.multibody.components.spatial.orientation import Vector

KINDS = TO_GROUND, BETWEEN = joint_kinds(
    "prismatic_in_space",
    __name__,
    level(1),
    level(2),
    perpendicular(1, 3),
    perpendicular(2, 3),
    perpendicular(1, 2),
    displacement=True,
)


@dataclass(frozen=True)
class PrismaticJoint(Joint):
    """A slide: b moves along the axis and does not turn relative to a.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.
    """

    axis: Vector = (0.0, 0.0, 1.0)

    kinds = KINDS

    def lower(self, lowering: SpatialLowering) -> None:
        self._oriented()
        super().lower(lowering)
