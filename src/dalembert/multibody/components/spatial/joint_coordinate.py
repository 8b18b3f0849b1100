"""The angle of a joint in space, counted over whole turns, or its displacement, as a coordinate without mass.

The orientation of two bodies gives their angle up to whole turns. A coordinate u that is tied to it by
cos(u) e2 . f1 - sin(u) e1 . f1 = 0, which is sin(angle - u) = 0 where the axes are aligned, follows it continuously. So
couplings, limits and torsion springs are functions of u. The multiplier of the tie transmits torques to the bodies.
"""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from dalembert.errors import InputError, listed
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_body import ANGLE, DISPLACEMENT
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.spatial import spatial_pairs as pairs
from dalembert.multibody.components.spatial.massless_coordinate import MasslessCoordinate
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_displacement
from dalembert.multibody.components.spatial.spatial_pairs import (
    e1,
    e2,
    e3,
    f1,
    push_a_axis,
    push_b_axis,
    push_pair,
    separation,
)
from dalembert.multibody.components.spatial.spatial_rows import Pair, SpatialRows
from dalembert.multibody.components.spatial.vectors import dot, minus, times
from dalembert.multibody.kernels.charts import flat
from dalembert.multibody.kernels.elementary import sin_cos
from dalembert.multibody.kernels.kind import Kind

_OWN, _FORCE = pairs.COORDINATES, pairs.COORDINATES + 1
_push_e1, _push_e2, _push_e3, _push_f1 = push_a_axis(1), push_a_axis(2), push_a_axis(3), push_b_axis(1)


@inlined
def _angle_tie(x, p, m, inputs, g):
    s, c = sin_cos(x[_OWN])
    f = f1(x, p, m)
    g[0] = c * dot(e2(x, p, m), f) - s * dot(e1(x, p, m), f)


@inlined
def _angle_forces(x, p, m, r):
    s, c = sin_cos(x[_OWN])
    first, second, f, force = e1(x, p, m), e2(x, p, m), f1(x, p, m), x[_FORCE]
    _push_e2(p, m, times(force * c, f), r)
    _push_e1(p, m, times(-force * s, f), r)
    _push_f1(p, m, times(force, minus(times(c, second), times(s, first))), r)
    r[_OWN] -= force * (s * dot(second, f) + c * dot(first, f))


@inlined
def _displacement_tie(x, p, m, inputs, g):
    g[0] = joint_displacement(x, p, m) - x[_OWN]


@inlined
def _displacement_forces(x, p, m, r):
    _push_e3(p, m, times(x[_FORCE], separation(x, p, m)), r)
    push_pair(p, m, times(x[_FORCE], e3(x, p, m)), r)
    r[_OWN] -= x[_FORCE]


def _tie(name: str, constraint: Any, forces: Any) -> Kind:
    return Kind(
        name,
        coordinates=pairs.COORDINATES + 1,
        multipliers=1,
        numbers=pairs.NUMBERS,
        integers=pairs.INTEGERS,
        constraint=constraint,
        forces=forces,
        charts=(*pairs.CHARTS, flat(1)),
        lengths=pairs.LENGTHS,
        holds=True,
        home=__name__,
    )


TIES = {
    ANGLE: _tie("joint_angle", _angle_tie, _angle_forces),
    DISPLACEMENT: _tie("joint_displacement", _displacement_tie, _displacement_forces),
}
#: Names and units of the coordinate, its rate, and the torque or force on it.
CHANNELS = {
    ANGLE: (("angle", "rad"), ("rate", "rad/s"), ("torque", "N*m")),
    DISPLACEMENT: (("displacement", "m"), ("speed", "m/s"), ("force", "N")),
}


def coordinates_of(joint: Joint) -> list[str]:
    """Which coordinates a joint has about or along its axis."""
    outputs = dict(joint.kind.outputs)
    return [name for name in CHANNELS if name in outputs]


def chosen_coordinate(owner: str, joint: Any, coordinate: str | None) -> str:
    """The coordinate of a joint that is asked for; the angle, or else the displacement, where none is."""
    known = coordinates_of(joint) if isinstance(joint, Joint) else []
    if not known or coordinate not in (None, *known):
        given = f"{type(joint).__name__} {getattr(joint, 'name', joint)!r}"
        wanted = f"the coordinate {coordinate!r}" if coordinate else "an angle or a displacement"
        own = f"; it has {listed([repr(name) for name in known])}" if known else ""
        raise InputError(
            f"{owner}: {given} was given as a joint with {wanted}{own}. Give a joint with an axis, such as a "
            "RevoluteJoint or a PrismaticJoint"
        )
    return coordinate or known[0]


def _turns(angle: float, least: float, most: float) -> float:
    """Whole turns that put an angle between two others, or nearest to their middle.

    >>> _turns(0.5, -1.0, 1.0), _turns(-0.5, 0.0, 100.0), _turns(7.5, -1.0, 1.0)
    (0.0, 1.0, -1.0)
    """
    turn = 2.0 * np.pi
    fewest = max(np.ceil((least - angle) / turn), 0.0) - max(np.ceil((angle - most) / turn), 0.0)
    if least <= angle + fewest * turn <= most:
        return float(fewest)
    return float(np.round((0.5 * (least + most) - angle) / turn))


class Paired(Protocol):
    """What has two markers with an axis: a joint, or a torsion spring."""

    def pair(self, lowering: SpatialRows) -> Pair:
        """The markers of both sides, with their axis as the third one."""
        ...


@dataclass(frozen=True)
class JointCoordinate(MasslessCoordinate):
    """A coordinate without mass that is the counted angle of a joint, or its displacement.

    ``within`` (float, float): the angle at the start is counted from a turn that puts it between these, rad; if none
    does, it is the one nearest to their middle.
    """

    joint: Paired
    coordinate: str = ANGLE
    within: tuple[float, float] = (-np.pi, np.pi)

    @property
    def place(self) -> Any:
        return self._initial

    def _initial(self, lowering: SpatialRows) -> tuple[Number, Number, Number]:
        pair = self.joint.pair(lowering)
        if self.coordinate == DISPLACEMENT:
            return pair.displacement, 0.0, 0.0
        return pair.angle + 2.0 * np.pi * _turns(np.real(pair.angle), *self.within), 0.0, 0.0

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return (self.coordinate,)

    def placed(self, frame: np.ndarray) -> np.ndarray:
        return frame[:1]

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        return np.eye(1, 6, dtype=np.result_type(coordinates, frame))

    def lower(self, lowering: SpatialRows, first: int) -> None:
        pair = self.joint.pair(lowering)
        index = [*pair.slots, first, *lowering.multipliers(self.name, 1)]
        lowering.add(TIES[self.coordinate], index, pair.data, pair.integers)
