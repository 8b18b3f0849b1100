"""What every body in space offers."""

__all__ = ["Body"]

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.spatial import spatial_markers as markers
from dalembert.multibody.components.spatial.orientation import Orientation, turned
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.spatial_sensor import AXIAL, SENSOR

DIRECTOR, GRADIENT = "director", "gradient"
FREE = None, None, None


class Marker(NamedTuple):
    """A point with axes as kernels see it: kind, coordinates of the body (None: absent), position, axes as columns."""

    kind: int
    slots: tuple[int | None, ...]
    position: np.ndarray
    axes: np.ndarray

    @property
    def numbers(self) -> list[Number]:
        """Position, then the three axes one after the other."""
        return [*self.position.tolist(), *self.axes.T.ravel().tolist()]


@dataclass(frozen=True)
class Body(BaseBody):
    """Base of all bodies in space: a name, an initial pose and an initial rigid motion."""

    FRAME: ClassVar[tuple[str, ...]] = ("x", "y", "z", "rotation_x", "rotation_y", "rotation_z")
    dimension: ClassVar[int] = 3
    sensor: ClassVar = SENSOR
    without_axes: ClassVar = AXIAL

    @property
    def motion(self) -> tuple[Number | None, ...]:
        """Initial velocity of the placed point and angular velocity; None where they are not stated."""
        return *(getattr(self, "velocity", None) or FREE), *(getattr(self, "angular_velocity", None) or FREE)

    @abstractmethod
    def marker(self, point: str) -> Marker:
        """The marker of a point."""

    @abstractmethod
    def lower(self, lowering: SpatialRows, first: int) -> None:
        """Write the rows of the kernels; ``first`` is the body's first coordinate."""

    def frame(self, position: Any, axes: np.ndarray | None = None) -> np.ndarray:
        """Initial frame: position of the placed point, then the axes of the body one after the other, (12,).

        The orientation of a body that is placed at a marker is relative to the ``axes`` of that marker.
        """
        own = getattr(self, "orientation", Orientation()).matrix
        return np.concatenate([np.asarray(position), (own if axes is None else axes @ own).T.ravel()])

    def moved(self, frame: np.ndarray, step: np.ndarray) -> np.ndarray:
        """The frame after a displacement and a rotation vector (6,) in the fixed axes."""
        return np.concatenate([frame[:3] + step[:3], turned(frame[3:].reshape(3, 3), step[3:]).ravel()])

    def point_rates(self, marker: Marker, coordinates: np.ndarray, modes: np.ndarray) -> np.ndarray:
        """Derivative of the position of a marker by the frame, (3, 6)."""
        k = marker.slots[0] or 0
        rates = modes[k : k + 3]
        if marker.kind == markers.BODY:
            rates = rates + np.tensordot(marker.position, modes[k + 3 : k + 12].reshape(3, 3, -1), 1)
        return rates

    def point_index(self, point: str, first: int, absent: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Unknowns and integers of the sensor at a point."""
        marker = self.marker(point)
        slots = tuple(absent if k is None else first + k for k in marker.slots)
        return slots, (marker.kind,)

    def point_numbers(self, point: str) -> list[Number]:
        """Numbers of the sensor at a point."""
        return self.marker(point).numbers


TURNS = np.cross(np.eye(3)[None], np.eye(3)[:, None]).transpose(0, 2, 1)  # e_j x u = sum_k u_k TURNS[k, :, j]


def pose_modes(coordinates: np.ndarray, frame: np.ndarray, vectors: int = 4) -> np.ndarray:
    """Derivatives of nodes by displacements and rotations about the placed point, (size, 6).

    A node has a position and the ``vectors`` less one that turn with it, three coordinates each.
    """
    nodes = coordinates.reshape(-1, vectors, 3).copy()
    modes = np.zeros((*nodes.shape, 6), np.result_type(coordinates, frame))
    modes[:, 0, :, :3] = np.eye(3)
    nodes[:, 0] -= frame[:3]
    modes[..., 3:] = np.tensordot(nodes, TURNS, 1)
    return modes.reshape(-1, 6)
