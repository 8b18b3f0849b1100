"""Points: the named frames of bodies and of the ground that joints, loads and channels refer to."""

__all__ = ["Ground", "GroundPoint", "Point"]

from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from dalembert.arguments import Checked
from dalembert.errors import ModelError
from dalembert.multibody.components.fields import Number


class Carrier(Protocol):
    """What has points: a body."""

    @property
    def name(self) -> str:
        """Of the body."""
        ...

    has_axes: ClassVar[bool]
    """Whether its points have axes."""

    @property
    def rigid(self) -> bool:
        """Whether the distances of its points never change."""
        ...

    def marker(self, point: str) -> Any:
        """The marker of a point."""
        ...


@dataclass(frozen=True)
class Point:
    """A named point of a body."""

    body: Carrier
    name: str

    IN_WORDS = "a point of a body such as rod.end"

    def __str__(self) -> str:
        return f"{self.body.name}.{self.name}"


@dataclass(frozen=True)
class GroundPoint(Checked):
    """A fixed point, in m, with the angle of its axes, in rad."""

    x: Number
    y: Number
    angle: Number = 0.0

    IN_WORDS = "a point of the ground such as system.ground.point(0.0, 0.0)"

    def __str__(self) -> str:
        return f"ground({self.x}, {self.y})"


@dataclass(frozen=True)
class Ground:
    """What does not move. As a side of a joint: the initial position of the other side."""

    IN_WORDS = "the ground"

    def point(self, x: Number, y: Number, angle: Number = 0.0) -> GroundPoint:
        """A fixed point at (x, y) in m, its axes turned by ``angle`` in rad."""
        return GroundPoint(x, y, angle)


def require_direction(owner: str, advice: str, *sides: object) -> None:
    """Refuse sides that have no axes: points of point masses and of cables in space."""
    for side in sides:
        if isinstance(side, Point) and not side.body.has_axes:
            raise ModelError(f"{owner}: {side} has no direction; use {advice}")


#: Where a body may start: coordinates in m, or a point of a body that was added before, or of the ground.
Place = tuple[Number, Number] | Point | GroundPoint
#: What a joint or a load may hold on to.
Side = Point | GroundPoint | Ground
