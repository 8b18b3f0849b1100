"""What coordinates without mass share that components bring with them."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.spatial.spatial_body import FREE, Body


@dataclass(frozen=True)
class MasslessCoordinate(Body):
    """Base of coordinates without mass and points. Components have them in their ``coordinates``; no one adds them."""

    turns = has_axes = False

    @property
    def motion(self) -> tuple[Number | None, ...]:
        return *FREE, *FREE

    @property
    def point_names(self) -> tuple[str, ...]:
        return ()

    def marker(self, point: str) -> Any:
        raise NotImplementedError  # it has no points

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        return np.zeros((len(coordinates), 0, 3))
