"""From a planar mechanism to the arrays of the kernels."""

from typing import Any

import numpy as np

from dalembert.errors import ModelError
from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.body import Marker
from dalembert.multibody.components.points import Ground, GroundPoint, Place, Point, Side
from dalembert.multibody.components.rows import Pair
from dalembert.multibody.model.lowering import MechanismLowering
from dalembert.multibody.model.system import Mechanism


class PlanarLowering(MechanismLowering):
    """Collects the rows of the kernels of a planar mechanism."""

    def __init__(self, system: Mechanism, begin: float = 0.0) -> None:
        super().__init__(system, begin)
        self._angles: dict[str, float] = {}  # of the frames of bodies

    def frame(self, body: BaseBody) -> np.ndarray:
        place: Any = body.place
        frame = body.frame(place(self) if callable(place) else self._stand(place, body.name)[:2])
        self._angles[body.name] = float(np.real(frame[2]))
        return frame

    def pair(self, a: Side, b: Side | None, owner: str) -> Pair:
        """The markers of two sides; a bare ground stands where the other side is, in the fixed axes."""
        if not isinstance(a, Point) and not isinstance(b, Point):
            raise ModelError(f"{owner!r}: it acts on the ground only; give it a point of a body")
        if isinstance(a, Point) and isinstance(b, Point) and a.body is b.body and a.body.rigid:
            raise ModelError(
                f"{owner!r}: both its points, {a} and {b}, belong to the same rigid body, so it does nothing; "
                "give it points of two bodies, or of a body and the ground"
            )
        ends = a, b or Ground()
        stands = [self._stand(other if isinstance(own, Ground) else own, owner) for own, other in (ends, ends[::-1])]
        first, second = (
            (x, y, 0.0 if isinstance(end, Ground) else angle) for end, (x, y, angle) in zip(ends, stands, strict=True)
        )
        sides = [self._marker(end, owner, stand) for end, stand in zip(ends, (first, second), strict=True)]
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
            return _stand(marker, self._coordinates[side.body.name], self._angles[side.body.name])
        return side[0], side[1], 0.0

    def _marker(self, side: Side, owner: str, stand: tuple[Number, Number, Number]) -> Marker:
        if isinstance(side, Point):
            marker = self._known(side, owner)
            first = self._first[side.body.name]
            return marker._replace(slots=tuple(None if k is None else first + k for k in marker.slots))
        return Marker(markers.GROUND, (None,) * 4, stand)


def _stand(marker: Marker, coordinates: np.ndarray, angle: float) -> tuple[Number, Number, Number]:
    """Position and angle of a marker of undeformed coordinates of a body that is placed at an angle."""
    own = [coordinates[k] if k is not None else 0.0 for k in marker.slots]
    sx, sy, phi = marker.data
    if marker.kind == markers.RIGID:
        c, s = np.cos(own[2]), np.sin(own[2])
        return own[0] + c * sx - s * sy, own[1] + s * sx + c * sy, own[2]
    if marker.kind == markers.NODE:
        real = np.arctan2(np.real(own[3]), np.real(own[2]))
        real += 2.0 * np.pi * np.round((angle - real) / (2.0 * np.pi))
        # First-order imaginary part: the gradient has length one here.
        turn = np.imag(own[3]) * np.real(own[2]) - np.imag(own[2]) * np.real(own[3])
        return own[0], own[1], (real + 1j * turn if np.iscomplexobj(coordinates) else real) + phi
    return own[0], own[1], 0.0
