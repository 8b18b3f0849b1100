"""From points of the plane or of space to the plane of a picture."""

from dataclasses import dataclass

import numpy as np

EYE = np.array([1.0, -1.6, 0.75])
"""Direction from which space is seen, as in the figures of reports: x to the right, z up."""
LIGHT = np.array([0.4, -0.5, 0.9])
"""Direction of the light."""


@dataclass(frozen=True, eq=False)
class Projection:
    """A parallel projection.

    Parameters
    ----------
    axes : array, shape (2, dimensions)
        Right and up in the picture.
    towards : array, shape (dimensions,)
        The direction of the eye.
    """

    axes: np.ndarray
    towards: np.ndarray

    @classmethod
    def of(cls, dimensions: int) -> "Projection":
        """Return the projection of points with 2 or 3 coordinates.

        >>> Projection.of(2)(np.array([[1.0, 2.0]])).tolist()
        [[1.0, 2.0]]
        """
        if dimensions == 2:
            return cls(np.eye(2), np.zeros(2))
        towards = EYE / np.linalg.norm(EYE)
        right = np.cross((0.0, 0.0, 1.0), towards)
        right /= np.linalg.norm(right)
        return cls(np.array([right, np.cross(towards, right)]), towards)

    @property
    def flat(self) -> bool:
        """Return True for the plane."""
        return len(self.towards) == 2

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Points (points, 2) of the picture, in m."""
        return np.asarray(points, dtype=float) @ self.axes.T

    def depth(self, points: np.ndarray) -> np.ndarray:
        """How near points are to the eye, (points,), m."""
        return np.asarray(points, dtype=float) @ self.towards

    def brightness(self, normals: np.ndarray) -> np.ndarray:
        """Brightness of faces with these normals, (faces,), from 0 to 1, whichever side is seen."""
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        units = normals / np.where(lengths > 0, lengths, 1.0)
        facing = np.where(units @ self.towards < 0, -1.0, 1.0)[:, None] * units
        return np.clip(facing @ LIGHT / np.linalg.norm(LIGHT), 0.0, 1.0)
