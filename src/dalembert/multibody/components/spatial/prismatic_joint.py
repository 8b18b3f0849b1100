"""The prismatic joint in space."""

__all__ = ["PrismaticJoint"]

from dataclasses import dataclass, field

from dalembert.multibody.components.base_joint import Smoothing
from dalembert.multibody.components.spatial.conditions import level, perpendicular
from dalembert.multibody.components.spatial.friction import Friction, friction_kind
from dalembert.multibody.components.spatial.joint import Joint, joint_kind
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.kernels.kind import Kind

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
class PrismaticJoint(Joint):
    """A slide: b moves along the axis and does not turn relative to a.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.
    friction : Friction, optional
    """

    axis: Vector = (0.0, 0.0, 1.0)
    friction: Friction | None = field(default=None, metadata={"table": "FrictionAlong"})

    kind = KIND
    aligned = (1, 2, 3)

    @property
    def smoothing(self) -> Smoothing | None:
        return self.friction.smoothing("speed", "m/s") if self.friction else None

    @property
    def parts(self) -> dict[str, Kind]:
        return {"friction": FRICTION} if self.friction else {}

    def lower(self, lowering: SpatialRows) -> None:
        self._oriented()
        pair = self.pair(lowering)
        index = self._add(lowering, pair)
        if self.friction:
            law = self.friction.law(f"prismatic joint {self.name!r}", turns=False)
            lowering.add(FRICTION, index, [*pair.data, *law], pair.integers, f"{self.name}.friction")
