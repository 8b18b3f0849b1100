"""What every body offers, in the plane and in space."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import require_known
from dalembert.findings import Finding
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.points import Point
from dalembert.multibody.kernels.kind import Kind

POSITION, ANGLE, DISPLACEMENT = "position", "angle", "displacement"
"""Kinds of coordinates: of positions, angles, and displacements of joints."""


@dataclass(frozen=True)
class BaseBody(Checked):
    """Base of all bodies: a name, an initial pose and an initial rigid motion.

    The frame of a body is an array of numbers that pose the undeformed body; a step of ``FRAME`` numbers changes it.
    """

    name: str

    FRAME: ClassVar[tuple[str, ...]]
    dimension: ClassVar[int]
    """Number of coordinates of a position."""
    buckles: ClassVar[bool] = True
    """Whether its stiffness follows the forces in it, as far as it deforms."""
    has_motion_findings: ClassVar[bool] = False
    """Whether a motion may have findings on the body."""
    turns: ClassVar[bool] = True
    """Whether the body has a direction."""
    has_axes: ClassVar[bool] = True
    """Whether its points have axes."""
    sensor: ClassVar[Kind]
    without_axes: ClassVar[tuple[str, ...]]
    """Outputs of the sensor that a point without axes does not have."""

    # The placed point is the start of beams and bars, the anchor of rigid bodies, the position of point masses.
    @property
    @abstractmethod
    def place(self) -> Any:
        """Initial position of the placed point, or the point of another body where it is."""

    @property
    @abstractmethod
    def motion(self) -> tuple[Number | None, ...]:
        """Initial rates of the frame, as many as ``FRAME``; None where they are not stated."""

    @property
    @abstractmethod
    def coordinate_kinds(self) -> tuple[str, ...]:
        """Kind of each coordinate."""

    @property
    @abstractmethod
    def point_names(self) -> tuple[str, ...]:
        """Names of the points."""

    @abstractmethod
    def frame(self, position: Any, axes: Any = None) -> np.ndarray:
        """Initial frame of the body with the placed point at a position."""

    @abstractmethod
    def moved(self, frame: np.ndarray, step: np.ndarray) -> np.ndarray:
        """The frame after a step."""

    @abstractmethod
    def placed(self, frame: np.ndarray) -> np.ndarray:
        """Coordinates of the undeformed body in a frame."""

    @abstractmethod
    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        """Derivatives of the coordinates by a step of the frame, (size, len(FRAME))."""

    @abstractmethod
    def marker(self, point: str) -> Any:
        """The marker of a point."""

    @abstractmethod
    def point_rates(self, marker: Any, coordinates: np.ndarray, modes: np.ndarray) -> np.ndarray:
        """Derivative of the position of a marker by the frame, (2 or 3, len(FRAME))."""

    @abstractmethod
    def point_index(self, point: str, first: int, absent: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Unknowns and integers of the sensor at a point; ``absent`` is the number of no unknown."""

    @abstractmethod
    def point_numbers(self, point: str) -> list[Number]:
        """Numbers of the sensor at a point."""

    @abstractmethod
    def lower(self, lowering: Any, first: int) -> None:
        """Write the rows of the kernels; ``first`` is the body's first coordinate."""

    @abstractmethod
    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        """Line to draw, shape (frames, -, 2 or 3), from coordinates (frames, size)."""

    def moving_axes(self, coordinates: np.ndarray) -> np.ndarray | None:
        """Origin and axes over time, (frames, 4, 3), of a body in space that has them; None for others."""
        return None

    def skin(self, coordinates: np.ndarray) -> Any:
        """The surface over time, with corners (frames, corners, 3) in the fixed axes, of a body that deforms and has
        one; None for others.
        """
        return None

    @property
    def surface(self) -> Any:
        """Corners (corners, 3) in the axes of the body and triangles to draw; None where there are none."""
        return None

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What there is to say about the choice of this body, such as that its elements lock."""
        return ()

    def motion_findings(self, times: np.ndarray, states: np.ndarray, rates: np.ndarray) -> tuple[Finding, ...]:
        """What there is to say about a motion: coordinates of the body and their velocities, (samples, size)."""
        return ()

    @property
    def rigid(self) -> bool:
        """Whether the distances of its points never change."""
        return self.size <= 3

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.coordinate_kinds)

    @property
    def point_outputs(self) -> tuple[tuple[str, str], ...]:
        """Names and units of the channels of a point."""
        return tuple(entry for entry in self.sensor.outputs if self.has_axes or entry[0] not in self.without_axes)

    def point(self, name: str) -> Point:
        """The point of this name."""
        require_known("point", name, self.point_names, f"body {self.name!r}")
        return Point(self, name)


def with_points(*names: str) -> Callable[[type], type]:
    """Give a class its named points as attributes, also where the constructor has an argument of that name."""

    def give(component: type) -> type:
        for name in names:
            setattr(component, name, property(lambda body, name=name: Point(body, name), doc=f"The point {name!r}."))
        return component

    return give
