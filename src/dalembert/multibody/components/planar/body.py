"""What every planar body offers."""

__all__ = ["Body"]

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import require_known
from dalembert.findings import Finding
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.lowering import Lowering
from dalembert.multibody.components.points import Place, Point

POSITION, GRADIENT, ANGLE = "position", "gradient", "angle"


class Marker(NamedTuple):
    """A point as kernels see it: kind, own coordinates (None: absent), and (sx, sy, phi)."""

    kind: int
    slots: tuple[int | None, ...]
    data: tuple[Number, Number, Number]


@dataclass(frozen=True)
class Body(Checked):
    """Base of all bodies: a name, a first placement and a first rigid motion."""

    name: str

    # The placed point is the start of beams and bars, the anchor of rigid bodies, the place of point masses.
    @property
    @abstractmethod
    def place(self) -> Place:
        """Where the placed point stands at first."""

    @property
    def turn(self) -> Number:
        """Angle at first, rad."""
        return getattr(self, "angle", 0.0)

    @property
    def motion(self) -> tuple[Number | None, Number | None, Number | None]:
        """Velocity of the placed point and angular velocity at first; None where they are not stated."""
        velocity = getattr(self, "velocity", None)
        along, across = (None, None) if velocity is None else velocity
        return along, across, getattr(self, "angular_velocity", None)

    @property
    @abstractmethod
    def coordinate_kinds(self) -> tuple[str, ...]:
        """Kind of each coordinate; positions and gradients come in pairs (x, y)."""

    @abstractmethod
    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        """Coordinates of the undeformed body with the placed point at (x, y), turned by ``angle``."""

    @abstractmethod
    def marker(self, point: str) -> Marker:
        """The marker of a point."""

    @property
    @abstractmethod
    def point_names(self) -> tuple[str, ...]:
        """Names of the points."""

    @abstractmethod
    def lower(self, lowering: Lowering, first: int) -> None:
        """Write the rows of the kernels; ``first`` is the body's first coordinate."""

    @abstractmethod
    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        """Line to draw, shape (frames, -, 2), from coordinates (frames, size)."""

    @property
    def turns(self) -> bool:
        """Whether the body has a direction."""
        return True

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What there is to say about the choice of this body, such as that its elements lock."""
        return ()

    @property
    def rigid(self) -> bool:
        """Whether the distances of its points never change."""
        return self.size <= 3

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.coordinate_kinds)

    def point(self, name: str) -> Point:
        """The point of this name."""
        require_known("point", name, self.point_names, f"body {self.name!r}")
        return Point(self, name)

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        """Derivatives of the coordinates by the frame: place (x, y) and angle about that place, (size, 3)."""
        kinds, i = self.coordinate_kinds, 0
        modes = np.zeros((len(kinds), 3), dtype=np.result_type(coordinates, frame))
        while i < len(kinds):
            if kinds[i] == ANGLE:
                modes[i, 2] = 1.0
                i += 1
                continue
            x, y = coordinates[i], coordinates[i + 1]
            if kinds[i] == POSITION:
                modes[i, 0] = modes[i + 1, 1] = 1.0
                x, y = x - frame[0], y - frame[1]
            modes[i, 2], modes[i + 1, 2] = -y, x
            i += 2
        return modes


def with_points(*names: str) -> Callable[[type], type]:
    """Give a class its named points as attributes, also where the constructor has an argument of that name."""

    def give(component: type) -> type:
        for name in names:
            setattr(component, name, property(lambda body, name=name: Point(body, name), doc=f"The point {name!r}."))
        return component

    return give


def turned(x: Number, y: Number, angle: Number) -> tuple[Number, Number]:
    """The vector (x, y) turned by ``angle``; complex-safe."""
    c, s = np.cos(angle), np.sin(angle)
    return c * x - s * y, s * x + c * y
