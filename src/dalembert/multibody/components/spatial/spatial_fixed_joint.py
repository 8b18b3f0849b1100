"""The fixed joint in space."""

__all__ = ["FixedJoint"]

from dataclasses import dataclass

from dalembert.multibody.components.spatial.conditions import MEETS, perpendicular
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_kind
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows

KIND = joint_kind("fixed_in_space", __name__, MEETS, perpendicular(1, 2), perpendicular(2, 3), perpendicular(3, 1))


@dataclass(frozen=True)
class FixedJoint(Joint):
    """A weld: points and axes of both markers coincide.

    Parameters
    ----------
    name : str
    a, b : Point or ground

    As a force sensor: the channels ``force_1`` to ``torque_3`` are force and torque on b along the axes of a.
    """

    kind = KIND
    aligned = (1, 2, 3)

    def lower(self, lowering: SpatialRows) -> None:
        self._oriented()
        super().lower(lowering)
