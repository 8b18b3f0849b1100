"""What every planar body offers."""

__all__ = ["Body"]

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from dalembert.multibody.components.base_body import ANGLE, POSITION, BaseBody
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.sensor import DIRECTIONAL, SENSOR
from dalembert.multibody.components.points import Place
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.kind import Kind

GRADIENT = "gradient"


class Marker(NamedTuple):
    """A point as kernels see it: kind, own coordinates (None: absent), and (sx, sy, phi)."""

    kind: int
    slots: tuple[int | None, ...]
    data: tuple[Number, Number, Number]


@dataclass(frozen=True)
class Body(BaseBody):
    """Base of all planar bodies: a name, an initial placement, an initial rigid motion; the frame is (x, y, angle)."""

    FRAME: ClassVar[tuple[str, ...]] = ("x", "y", "angle")
    dimension: ClassVar[int] = 2
    sensor: ClassVar[Kind] = SENSOR
    without_axes: ClassVar[tuple[str, ...]] = DIRECTIONAL

    @property
    @abstractmethod
    def place(self) -> Place:
        """Initial position of the placed point."""

    @property
    def turn(self) -> Number:
        """Initial angle, rad."""
        return getattr(self, "angle", 0.0)

    @property
    def motion(self) -> tuple[Number | None, Number | None, Number | None]:
        """Initial velocity (x, y) of the placed point and angular velocity; None where they are not given."""
        velocity = getattr(self, "velocity", None)
        along, across = (None, None) if velocity is None else velocity
        return along, across, getattr(self, "angular_velocity", None)

    @property
    @abstractmethod
    def coordinate_kinds(self) -> tuple[str, ...]:
        """Kind of each coordinate; positions and gradients come in pairs (x, y)."""

    @abstractmethod
    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        """Coordinates (size,) of the undeformed body with the placed point at (x, y), turned by ``angle``."""

    @abstractmethod
    def marker(self, point: str) -> Marker:
        """The marker of a point."""

    @abstractmethod
    def lower(self, lowering: Lowering, first: int) -> None:
        """Write the rows of the kernels; ``first`` is the body's first coordinate."""

    def frame(self, position: Any, axes: None = None) -> np.ndarray:
        return np.array([*position, self.turn])

    def moved(self, frame: np.ndarray, step: np.ndarray) -> np.ndarray:
        return frame + step

    def placed(self, frame: np.ndarray) -> np.ndarray:
        return self.coordinates(*frame)

    def point_rates(self, marker: Marker, coordinates: np.ndarray, modes: np.ndarray) -> np.ndarray:
        first, second = (modes[slot] for slot in marker.slots[:2] if slot is not None)
        if marker.kind != markers.RIGID:
            return np.array([first, second])
        ox, oy = turned(*marker.data[:2], coordinates[2])
        return np.array([first - oy * modes[2], second + ox * modes[2]])

    def point_index(self, point: str, first: int, absent: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
        marker = self.marker(point)
        slots = tuple(absent if k is None else first + k for k in marker.slots)
        return (absent,) * 4 + slots, (markers.GROUND, marker.kind, int(marker.kind == markers.NODE))

    def point_numbers(self, point: str) -> list[Number]:
        return [0.0, 0.0, 0.0, *self.marker(point).data]

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


def turned(x: Number, y: Number, angle: Number) -> tuple[Number, Number]:
    """The vector (x, y) turned by ``angle``; complex-safe."""
    c, s = np.cos(angle), np.sin(angle)
    return c * x - s * y, s * x + c * y
