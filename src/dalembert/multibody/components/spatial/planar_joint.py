"""The planar joint."""

__all__ = ["PlanarJoint"]

from dataclasses import dataclass

from dalembert.multibody.components.spatial.conditions import level, perpendicular
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_kind
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows

KIND = joint_kind("planar_joint", __name__, level(3), perpendicular(3, 1), perpendicular(3, 2), angle=True)


@dataclass(frozen=True)
class PlanarJoint(Joint):
    """A contact of planes: b slides in the plane through a and turns about its normal.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axis : (float, float, float)
        Normal of the plane, the same in the axes of both markers.

    Notes
    -----
    An initial state may state ``angle`` about the normal, and ``displacement_1`` and ``displacement_2``, the position
    of b relative to a along the joint's first two axes.
    """

    axis: Vector = (0.0, 0.0, 1.0)

    kind = KIND
    aligned = (3,)

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        return ("angle", "displacement_1", "displacement_2")

    def lower(self, lowering: SpatialRows) -> None:
        self._oriented()
        super().lower(lowering)
