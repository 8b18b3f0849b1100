"""From a planar mechanism to the arrays of the kernels."""

import numpy as np

from dalembert.errors import ModelError
from dalembert.multibody.components.body import BaseBody
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.lowering import Pair
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.body import Marker
from dalembert.multibody.components.points import Ground, GroundPoint, Place, Point, Side
from dalembert.multibody.lowering import MechanismLowering


class PlanarLowering(MechanismLowering):
    """Collects the rows of the kernels of a planar mechanism."""

    def frame(self, body: BaseBody) -> np.ndarray:
        return body.frame(self._stand(body.place, body.name)[:2])

    def pair(self, a: Side, b: Side | None, owner: str) -> Pair:
        """The markers of two sides; a bare ground stands where the other side is."""
        if not isinstance(a, Point) and not isinstance(b, Point):
            raise ModelError(f"{owner!r}: it acts on the ground only; give it a point of a body")
        if isinstance(a, Point) and isinstance(b, Point) and a.body is b.body and a.body.rigid:
            raise ModelError(
                f"{owner!r}: both its points, {a} and {b}, belong to the same rigid body, so it does nothing; "
                "give it points of two bodies, or of a body and the ground"
            )
        first = self._stand(b if isinstance(a, Ground) and b is not None else a, owner)
        second = self._stand(a if b is None or isinstance(b, Ground) else b, owner)
        sides = self._marker(a, owner, first), self._marker(b or Ground(), owner, second)
        dx, dy = second[0] - first[0], second[1] - first[1]
        square = dx * dx + dy * dy
        c, s = np.cos(first[2]), np.sin(first[2])
        return Pair(
            slots=[*sides[0].slots, *sides[1].slots],
            data=[*sides[0].data, *sides[1].data],
            integers=[sides[0].kind, sides[1].kind, int(markers.NODE in (sides[0].kind, sides[1].kind))],
            distance=np.sqrt(square) if np.real(square) > 0 else 0.0,
            rest_angle=second[2] - first[2],
            angles=(first[2], second[2]),
            relative=(c * dx + s * dy, c * dy - s * dx),
        )

    def _stand(self, side: Side | Place, owner: str) -> tuple[Number, Number, Number]:
        """Position and angle of a side at first."""
        if isinstance(side, GroundPoint):
            return side.x, side.y, side.angle
        if isinstance(side, Ground):
            return 0.0, 0.0, 0.0
        if isinstance(side, Point):
            marker = self._known(side, owner)
            return _stand(marker, self._coordinates[side.body.name])
        return side[0], side[1], 0.0

    def _marker(self, side: Side, owner: str, stand: tuple[Number, Number, Number]) -> Marker:
        if isinstance(side, Point):
            marker = self._known(side, owner)
            first = self._first[side.body.name]
            return marker._replace(slots=tuple(None if k is None else first + k for k in marker.slots))
        place = (*stand[:2], 0.0) if isinstance(side, Ground) else (side.x, side.y, side.angle)
        return Marker(markers.GROUND, (None,) * 4, place)


def _stand(marker: Marker, coordinates: np.ndarray) -> tuple[Number, Number, Number]:
    """Position and angle of a marker of undeformed coordinates."""
    own = [coordinates[k] if k is not None else 0.0 for k in marker.slots]
    sx, sy, phi = marker.data
    if marker.kind == markers.RIGID:
        c, s = np.cos(own[2]), np.sin(own[2])
        return own[0] + c * sx - s * sy, own[1] + s * sx + c * sy, own[2]
    if marker.kind == markers.NODE:
        real = np.arctan2(np.real(own[3]), np.real(own[2]))
        # First-order imaginary part: the gradient has length one here.
        turn = np.imag(own[3]) * np.real(own[2]) - np.imag(own[2]) * np.real(own[3])
        return own[0], own[1], (real + 1j * turn if np.iscomplexobj(coordinates) else real) + phi
    return own[0], own[1], 0.0
