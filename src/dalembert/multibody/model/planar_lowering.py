"""From a planar mechanism to the arrays of the kernels."""

from typing import Any

import numpy as np

from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.body import Marker
from dalembert.multibody.components.points import Ground, GroundPoint, Point, Side
from dalembert.multibody.components.rows import Pair
from dalembert.multibody.model.lowering import MechanismLowering


class PlanarLowering(MechanismLowering):
    """Collects the rows of the kernels of a planar mechanism."""

    def frame(self, body: BaseBody) -> np.ndarray:
        place: Any = body.place
        if callable(place):
            place = place(self)
        elif not isinstance(place, tuple | list | np.ndarray):
            place = self._stand(place, self._known(place, body.name) if isinstance(place, Point) else None)
        return body.frame(place[:2])

    def pair(self, a: Side, b: Side | None, owner: str) -> Pair:
        """The markers of two sides; a bare ground stands where the other side is, in the fixed axes."""
        ends = self._ends(a, b, owner)
        stands = [self._stand(*(other if isinstance(end[0], Ground) else end)) for end, other in (ends, ends[::-1])]
        first, second = (
            (x, y, 0.0 if isinstance(end, Ground) else angle)
            for (end, _), (x, y, angle) in zip(ends, stands, strict=True)
        )
        sides = [self._marker(*end, stand) for end, stand in zip(ends, (first, second), strict=True)]
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

    def _stand(self, side: Any, marker: Marker | None) -> tuple[Number, Number, Number]:
        """Position and angle of a side at first."""
        if marker is not None:
            return _stand(marker, self._coordinates[side.body.name], float(np.real(self._frames[side.body.name][2])))
        return (side.x, side.y, side.angle) if isinstance(side, GroundPoint) else (0.0, 0.0, 0.0)

    def _marker(self, side: Any, marker: Marker | None, stand: tuple[Number, Number, Number]) -> Marker:
        if marker is not None:
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
