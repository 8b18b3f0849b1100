"""From a mechanism in space to the arrays of the kernels."""

from typing import Any

import numpy as np

from dalembert.errors import ModelError
from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.spatial import markers
from dalembert.multibody.components.spatial.body import Marker
from dalembert.multibody.components.spatial.ground_points import Ground, GroundPoint, Side
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
            return body.frame(*self._stand(place, body.name))
        return body.frame(place)

    def pair(self, a: Side, b: Side | None, owner: str, turned: tuple[np.ndarray, np.ndarray] | None = None) -> Pair:
        """The markers of two sides; a bare ground stands where the other side is.

        ``turned``: rotation matrices that turn the axes of both markers into those of the joint.
        """
        if not isinstance(a, Point) and not isinstance(b, Point):
            raise ModelError(f"{owner!r}: it acts on the ground only; give it a point of a body")
        if isinstance(a, Point) and isinstance(b, Point) and a.body is b.body and a.body.rigid:
            raise ModelError(
                f"{owner!r}: both its points, {a} and {b}, belong to the same rigid body, so it does nothing; "
                "give it points of two bodies, or of a body and the ground"
            )
        sides = (a, b or Ground())
        stands = [self._stand(one if not _bare(one) else other, owner) for one, other in (sides, sides[::-1])]
        stands = [(at, np.eye(3) if _bare(one) else axes) for one, (at, axes) in zip(sides, stands, strict=True)]
        own = [self._marker(side, owner, stand) for side, stand in zip(sides, stands, strict=True)]
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

    def _stand(self, side: Any, owner: str) -> Stand:
        """Position and axes of a side at the start."""
        if isinstance(side, GroundPoint):
            return np.array(side.position), side.orientation.matrix
        if isinstance(side, Ground):
            return np.zeros(3), np.eye(3)
        marker, own = self._known(side, owner), self._coordinates[side.body.name]
        if marker.kind == markers.MASS:
            return own[:3], np.eye(3)
        directors = own[3:12].reshape(3, 3).T
        return own[:3] + directors @ marker.position, directors @ marker.axes

    def _marker(self, side: Any, owner: str, stand: Stand) -> Marker:
        if isinstance(side, Point):
            marker = self._known(side, owner)
            first = self._first[side.body.name]
            return marker._replace(slots=tuple(None if k is None else first + k for k in marker.slots))
        return Marker(markers.GROUND, (None,) * markers.SLOTS, *stand)


def _bare(side: Any) -> bool:
    """Whether a side is the ground without a position."""
    return isinstance(side, Ground)
