"""A point on a line."""

__all__ = ["PointOnLineJoint"]

from dataclasses import dataclass

from dalembert.multibody.components.spatial.conditions import level
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_kind
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows

KIND = joint_kind("point_on_line", __name__, level(1), level(2), displacement=True, holds_frame=True)


@dataclass(frozen=True)
class PointOnLineJoint(Joint):
    """A ball in a straight groove: b stays on the line through a along the axis.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axis : (float, float, float)
        Direction of the line in the axes of a.

    Notes
    -----
    An initial state may state ``displacement`` along the line, and ``rotation_x``, ``rotation_y`` and ``rotation_z`` as
    those of a spherical joint.
    """

    axis: Vector = (0.0, 0.0, 1.0)

    kind = KIND

    def lower(self, lowering: SpatialRows) -> None:
        self._oriented(self.a)
        super().lower(lowering)

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        return (*super().stated_coordinates, *self._rotations)
