"""The cylindrical joint."""

__all__ = ["CylindricalJoint"]

from dataclasses import dataclass

from dalembert.multibody.components.spatial.conditions import level, perpendicular
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_kind
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows

KIND = joint_kind(
    "cylindrical", __name__, level(1), level(2), perpendicular(1, 3), perpendicular(2, 3), angle=True, displacement=True
)


@dataclass(frozen=True)
class CylindricalJoint(Joint):
    """A sleeve: b slides along the axis and turns about it.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.

    The channels ``displacement`` and ``angle`` are those of b relative to a.
    """

    axis: Vector = (0.0, 0.0, 1.0)

    kind = KIND
    aligned = (3,)

    def lower(self, lowering: SpatialRows) -> None:
        self._oriented()
        super().lower(lowering)
