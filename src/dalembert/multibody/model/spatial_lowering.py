"""From a mechanism in space to the arrays of the kernels."""

from typing import Any

import numpy as np

from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.spatial import spatial_markers as markers
from dalembert.multibody.components.spatial.ground_points import Ground, GroundPoint, Side
from dalembert.multibody.components.spatial.spatial_body import Marker
from dalembert.multibody.components.spatial.spatial_rows import Pair
from dalembert.multibody.model.lowering import MechanismLowering

Stand = tuple[np.ndarray, np.ndarray]
"""Position (3,) of a side and its axes as columns (3, 3), in the fixed axes."""


class SpatialLowering(MechanismLowering):
    """Collects the rows of the kernels of a mechanism in space."""

    def frame(self, body: BaseBody) -> np.ndarray:
        place: Any = body.place
        if callable(place):
            return body.frame(place(self))
        if isinstance(place, Point | GroundPoint):
            return body.frame(*self._stand(place, self._known(place, body.name) if isinstance(place, Point) else None))
        return body.frame(place)

    def pair(self, a: Side, b: Side | None, owner: str, turned: tuple[np.ndarray, np.ndarray] | None = None) -> Pair:
        """The markers of two sides; a bare ground stands where the other side is.

        ``turned``: rotation matrices that turn the axes of both markers into those of the joint.
        """
        ends = self._ends(a, b, owner)
        stands = [self._stand(*(other if isinstance(end[0], Ground) else end)) for end, other in (ends, ends[::-1])]
        stands = [
            (at, np.eye(3) if isinstance(end, Ground) else axes)
            for (end, _), (at, axes) in zip(ends, stands, strict=True)
        ]
        own = [self._marker(*end, stand) for end, stand in zip(ends, stands, strict=True)]
        axes = [stand[1] for stand in stands]
        if turned is not None:
            own = [one._replace(axes=one.axes @ turn) for one, turn in zip(own, turned, strict=True)]
            axes = [one @ turn for one, turn in zip(axes, turned, strict=True)]
        slots = [slot for one in own for slot in one.slots]
        return Pair(
            slots=slots,
            data=[*own[0].numbers, *own[1].numbers],
            integers=[own[0].kind, own[1].kind],
            separation=stands[1][0] - stands[0][0],
            axes=(axes[0], axes[1]),
        )

    def _stand(self, side: Any, marker: Marker | None) -> Stand:
        """Position and axes of a side at the start."""
        if isinstance(side, GroundPoint):
            return np.array(side.position), side.orientation.matrix
        if marker is None:
            return np.zeros(3), np.eye(3)
        own = self._coordinates[side.body.name][marker.slots[0] or 0 :]
        if marker.kind == markers.MASS:
            return own[:3], np.eye(3)
        directors = own[3:12].reshape(3, 3).T
        return own[:3] + directors @ marker.position, directors @ marker.axes

    def _marker(self, side: Any, marker: Marker | None, stand: Stand) -> Marker:
        if marker is not None:
            first = self._first[side.body.name]
            return marker._replace(slots=tuple(None if k is None else first + k for k in marker.slots))
        return Marker(markers.GROUND, (None,) * markers.SLOTS, *stand)
