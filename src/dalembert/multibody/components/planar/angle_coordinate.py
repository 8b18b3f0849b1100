"""The angle between two markers, counted over whole turns, as a coordinate without mass.

The gradient of a node gives its angle up to whole turns. A coordinate u that is tied to the angle of b relative to a by
angle - u = 0 within half a turn follows it continuously. So springs and position loops on nodes are functions of u. The
multiplier of the tie is the torque that they exert.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_body import ANGLE
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.planar.body import Body, Marker
from dalembert.multibody.components.planar.markers import NODE
from dalembert.multibody.components.planar.pairs import COORDINATES, pair_kind, relative_angle, twist_pair
from dalembert.multibody.components.points import Point, Side
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.elementary import wrapped

_OWN, _FORCE = COORDINATES, COORDINATES + 1
_UNIT = 1e2
"""rad of a unit of the frame, so that the angle counts little where assembly moves bodies as little as possible."""


@inlined
def _tie(x, p, m, inputs, g):
    g[0] = wrapped(relative_angle(x, p, m) - x[_OWN])


@inlined
def _forces(x, p, m, r):
    twist_pair(x, m, x[_FORCE], r)
    r[_OWN] -= x[_FORCE]


NODE_ANGLE = pair_kind(
    "node_angle", coordinates=COORDINATES + 1, multipliers=1, constraint=_tie, forces=_forces, holds=True
)


@dataclass(frozen=True)
class AngleCoordinate(Body):
    """The counted angle of b relative to a; components that need one return it in their ``coordinates``.

    At the start it is the angle that the bodies state.
    """

    turns = has_axes = False
    a: Side
    b: Side

    @property
    def place(self) -> Any:
        return self._initial

    def _initial(self, lowering: Lowering) -> tuple[Number, Number]:
        return lowering.pair(self.a, self.b, self.name).rest_angle / _UNIT, 0.0

    @property
    def motion(self) -> tuple[None, None, None]:
        return None, None, None

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return (ANGLE,)

    @property
    def point_names(self) -> tuple[str, ...]:
        return ()

    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        return np.array([_UNIT * x])

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        modes = np.zeros((1, len(self.FRAME)), dtype=np.result_type(coordinates, frame))
        modes[0, 0] = _UNIT
        return modes

    def marker(self, point: str) -> Marker:
        raise NotImplementedError  # it has no points

    def lower(self, lowering: Lowering, first: int) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        index = [*pair.slots, first, *lowering.multipliers(self.name, 1)]
        lowering.add(NODE_ANGLE, index, pair.data, pair.integers)

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        return np.zeros((len(coordinates), 0, 2))


def counted_angle(name: str, a: Side, b: Side) -> tuple[AngleCoordinate, ...]:
    """The counted angle that a component needs whose torque depends on the angle of nodes; none for rigid bodies."""
    return (AngleCoordinate(f"{name}.joint", a, b),) if _is_node(a) or _is_node(b) else ()


def _is_node(side: Side) -> bool:
    return isinstance(side, Point) and side.body.has_axes and side.body.marker(side.name).kind == NODE
