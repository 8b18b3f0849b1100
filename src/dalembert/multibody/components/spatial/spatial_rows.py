"""What spatial components call while a system is lowered."""

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np

from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.rows import Rows
from dalembert.multibody.components.spatial.ground_points import Side


class Pair(NamedTuple):
    """Two markers as kernels see them, and how they are placed at the start.

    ``slots``: coordinates of a and of b, 24; None on the side of the ground; ``separation`` (3,): position of b
    relative to a, in the fixed axes; ``axes`` (array, array): axes of both markers, as columns, in the fixed axes.
    """

    slots: list[int | None]
    data: list[Number]
    integers: list[int]
    separation: np.ndarray
    axes: tuple[np.ndarray, np.ndarray]

    @property
    def distance(self) -> Any:
        """Distance of the markers; complex-safe."""
        square = self.separation @ self.separation
        return np.sqrt(square) if np.real(square) > 0 else 0.0

    @property
    def angle(self) -> Any:
        """Angle of b relative to a about the third axes; complex-safe."""
        e, f = self.axes
        c, s = e[:, 0] @ f[:, 0], e[:, 1] @ f[:, 0]
        angle = np.arctan2(np.real(s), np.real(c))
        slope = (np.real(c) * np.imag(s) - np.real(s) * np.imag(c)) / (np.real(c) ** 2 + np.real(s) ** 2)
        return angle + 1j * slope if np.iscomplexobj(e) or np.iscomplexobj(f) else angle

    @property
    def displacement(self) -> Any:
        """Displacement of b relative to a along the third axis of a."""
        return self.axes[0][:, 2] @ self.separation


class SpatialRows(Rows, Protocol):
    """Collects the rows of the kernels of a mechanism in space."""

    gravity: tuple[Number, Number, Number]
    loads: Sequence[Any]
    """Of the mechanism."""

    def pair(self, a: Side, b: Side | None, owner: str, turned: tuple[np.ndarray, np.ndarray] | None = None) -> Pair:
        """The markers of two sides; a bare ground stands where the other side is.

        ``turned``: rotation matrices that turn the axes of both markers into those of the joint.
        """
        ...


def first_coordinate(lowering: SpatialRows, point: Point, owner: str) -> int:
    """The first coordinate of the body of a point."""
    at_point, within_body = lowering.pair(point, None, owner).slots[0], point.body.marker(point.name).slots[0]
    assert at_point is not None
    return at_point - within_body
