"""Points of the ground in space, and where bodies may be placed."""

__all__ = ["Ground", "GroundPoint"]

from dataclasses import dataclass

from dalembert.arguments import Checked
from dalembert.multibody.components.fields import number
from dalembert.multibody.components.points import Ground as AnyGround
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.spatial.orientation import Orientation, Vector

FIXED_AXES = Orientation()


@dataclass(frozen=True)
class GroundPoint(Checked):
    """A fixed marker: position in m, and orientation."""

    position: Vector = number("m")
    orientation: Orientation = FIXED_AXES

    IN_WORDS = "a point of the ground such as system.ground.point((0.0, 0.0, 0.0))"

    def __str__(self) -> str:
        return f"ground({', '.join(map(str, self.position))})"


@dataclass(frozen=True)
class Ground(AnyGround):
    """What does not move. As a side of a joint: the position of the other side at the start, with the fixed axes."""

    def point(self, position: Vector, orientation: Orientation = FIXED_AXES) -> GroundPoint:  # type: ignore[override]
        """A fixed marker at a position in m."""
        return GroundPoint(position, orientation)


#: Where a body may be placed: coordinates in m, a point of a body that was added before, or of the ground.
Place = Vector | Point | GroundPoint
#: What a joint or a load may act on.
Side = Point | GroundPoint | Ground
