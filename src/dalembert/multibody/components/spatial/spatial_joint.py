"""What joints in space share: the base class, and the kind made of conditions, with their channels.

The joint frames: axes e1, e2, e3 at a and f1, f2, f3 at b. The third axes are the joint's axis, if it has one.
"""

__all__ = ["Joint"]

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import stack
from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.components.points import Point, require_direction
from dalembert.multibody.components.spatial import spatial_markers as markers
from dalembert.multibody.components.spatial import spatial_pairs as pairs
from dalembert.multibody.components.spatial.conditions import Condition, constraint_of, forces_of
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.orientation import Orientation, Vector, direction
from dalembert.multibody.components.spatial.spatial_markers import BODY, GROUND, SLOTS, position
from dalembert.multibody.components.spatial.spatial_pairs import (
    b_point,
    e1,
    e2,
    e3,
    f1,
    relative_spin,
    separation,
    separation_rate,
)  # fmt: skip
from dalembert.multibody.components.spatial.spatial_rows import Pair, SpatialRows
from dalembert.multibody.components.spatial.vectors import at, cross, dot, minus, plus, times
from dalembert.multibody.kernels.elementary import angle_of
from dalembert.multibody.kernels.kind import Kind

REACTIONS = (
    ("force_x", "N"), ("force_y", "N"), ("force_z", "N"),
    ("torque_x", "N*m"), ("torque_y", "N*m"), ("torque_z", "N*m"),
    ("force_1", "N"), ("force_2", "N"), ("force_3", "N"),
    ("torque_1", "N*m"), ("torque_2", "N*m"), ("torque_3", "N*m"),
)  # fmt: skip
ANGLE = (("angle", "rad"), ("rate", "rad/s"))
DISPLACEMENT = (("displacement", "m"), ("speed", "m/s"))


@inlined
def joint_angle(x, p, m):
    """Angle of b relative to a about e3, atan2(e2 . f1, e1 . f1), within (-pi, pi]."""
    f = f1(x, p, m)
    return angle_of(dot(e1(x, p, m), f), dot(e2(x, p, m), f))


@inlined
def joint_rate(x, v, p, m):
    """Angular velocity of b relative to a about e3."""
    return dot(relative_spin(x, v, m), e3(x, p, m))


@inlined
def observe_turn(x, v, p, m, out):
    """Fill angle and rate."""
    out[0], out[1] = joint_angle(x, p, m), joint_rate(x, v, p, m)


@inlined
def joint_displacement(x, p, m):
    """Displacement of b relative to a along e3."""
    return dot(e3(x, p, m), separation(x, p, m))


@inlined
def joint_speed(x, v, p, m):
    """Rate of the displacement, e3' . Delta + e3 . Delta' with e3' = omega_a x e3."""
    axis = e3(x, p, m)
    turning = cross(markers.spin(m.a_kind, 0, x, v), axis)
    return dot(turning, separation(x, p, m)) + dot(axis, separation_rate(v, p, m))


@inlined
def _moment(k, x, r):
    """Moment about the origin of a body of generalised forces on its directors, d_i x r_i."""
    first, second = cross(at(x, k + 3), at(r, k + 3)), cross(at(x, k + 6), at(r, k + 6))
    return plus(plus(first, second), cross(at(x, k + 9), at(r, k + 9)))


@inlined
def observe_reactions(x, p, m, r, out):
    """Fill 12 outputs: force and torque on b at its point, from the generalised forces r on the left side.

    In the fixed axes, then along the axes of the joint at a.
    """
    place = position(m.b_kind, SLOTS, x, b_point(p))
    if m.b_kind != GROUND:
        k, sign = SLOTS, -1.0
    else:
        k, sign = 0, 1.0
    force, torque = at(r, k), times(0.0, at(r, k))
    if (m.b_kind if m.b_kind != GROUND else m.a_kind) == BODY:
        torque = minus(_moment(k, x, r), cross(minus(place, at(x, k)), force))
    else:
        torque = times(-1.0, cross(minus(place, at(x, k)), force))
    force, torque = times(sign, force), times(sign, torque)
    out[0], out[1], out[2] = force
    out[3], out[4], out[5] = torque
    first, second, third = e1(x, p, m), e2(x, p, m), e3(x, p, m)
    out[6], out[7], out[8] = dot(force, first), dot(force, second), dot(force, third)
    out[9], out[10], out[11] = dot(torque, first), dot(torque, second), dot(torque, third)


def observed(forces: Any, width: int, angle: bool, displacement: bool) -> Callable[..., Any]:
    """The function that fills the channels of a joint with these constraint forces."""
    own = 12 + 2 * angle

    @inlined
    def observe(x, v, a, p, m, inputs, out):
        r = stack(x, width)
        for i in range(width):
            r[i] = 0.0
        forces(x, p, m, r)
        observe_reactions(x, p, m, r, out)
        if angle:
            out[12], out[13] = joint_angle(x, p, m), joint_rate(x, v, p, m)
        if displacement:
            out[own], out[own + 1] = joint_displacement(x, p, m), joint_speed(x, v, p, m)

    return observe


def joint_kind(
    name: str, home: str, *conditions: Condition, angle: bool = False, displacement: bool = False, **properties: Any
) -> Kind:
    """The kind of a joint.

    ``home``: module that holds it; ``angle``, ``displacement``: whether the joint has an angle about its axis, and a
    displacement along it.
    """
    count, forces = sum(entry.count for entry in conditions), forces_of(conditions, pairs.COORDINATES)
    settings = {
        "constraint": constraint_of(conditions),
        "forces": forces,
        "outputs": (*REACTIONS, *ANGLE * angle, *DISPLACEMENT * displacement),
        "angles": ("angle",) * angle,
        "turn": observe_turn,
        "observe": observed(forces, pairs.COORDINATES + count, angle, displacement),
        "lengths": pairs.LENGTHS,
        "holds": True,
    }
    return pair_kind(name, home, multipliers=count, **{**settings, **properties})


def turned_to(axis: Vector, owner: str) -> tuple[np.ndarray, np.ndarray]:
    """Rotations (3, 3) from the axes of both markers to those with this third axis."""
    own = Orientation.by_axes(tuple(direction(axis, f"{owner}: the axis").tolist())).matrix
    return own, own


@dataclass(frozen=True)
class Joint(BaseJoint):
    """Base of all joints in space: a name and two sides."""

    a: Side
    b: Side

    kind: ClassVar[Kind]

    aligned: ClassVar[tuple[int, ...]] = ()
    """Axes of both markers, by number, that the conditions make parallel or opposite, and that have to be parallel."""

    @property
    def turned(self) -> tuple[np.ndarray, np.ndarray]:
        """Rotations (3, 3) from the axes of both markers to those of the joint."""
        axis = getattr(self, "axis", None)
        return turned_to((0.0, 0.0, 1.0) if axis is None else axis, f"{type(self).__name__} {self.name!r}")

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        outputs = dict(self.kind.outputs)
        return tuple(name for (name, _), _ in (ANGLE, DISPLACEMENT) if name in outputs and not self.kind.driven)

    @property
    def _rotations(self) -> tuple[str, ...]:
        """Rotation vector of b relative to a in the axes of marker a, for joints that leave rotations free."""
        turns = any(isinstance(side, Point) and side.body.has_axes for side in (self.a, self.b))
        return ("rotation_x", "rotation_y", "rotation_z") if turns else ()

    def stating(self, coordinate: str, course: Any) -> BaseJoint:
        from dalembert.multibody.components.spatial.spatial_joint_state import stated

        return stated(self, coordinate, course)

    def keeping(
        self, coordinate: str, course: Any, numbers: np.ndarray, integers: np.ndarray, x: np.ndarray
    ) -> BaseJoint:
        from dalembert.multibody.components.spatial.spatial_joint_state import kept

        e, f = (
            np.column_stack([axis_in_space(side, number, numbers, integers, x) for number in (1, 2, 3)])
            for side in (0, 1)
        )
        gap = _point(1, numbers, integers, x) - _point(0, numbers, integers, x)
        return kept(self, coordinate, course, (e, f, gap))

    def lower(self, lowering: SpatialRows) -> None:
        self._add(lowering, self.pair(lowering))

    def pair(self, lowering: SpatialRows) -> Pair:
        """The markers of both sides, with the axes of the joint."""
        return lowering.pair(self.a, self.b, self.name, self.turned)

    def _add(
        self, lowering: SpatialRows, pair: Pair, numbers: Sequence[Any] = (), integers: Sequence[int] = ()
    ) -> list[int | None]:
        """Add the joint with the numbers and integers that follow those of its markers; its unknowns."""
        index = pair.slots + lowering.multipliers(self.name, self.kind.multipliers)
        lowering.add(self.kind, index, [*pair.data, *numbers], [*pair.integers, *integers], self.name)
        return index

    def _oriented(self, *sides: Side) -> None:
        """Refuse sides that have no axes; both are asked where none is named."""
        owner = f"{type(self).__name__} {self.name!r}"
        require_direction(owner, "a spherical or distance joint, or a rigid body", *(sides or (self.a, self.b)))

    def position(self, kind: Kind, numbers: np.ndarray, integers: np.ndarray, x: np.ndarray) -> np.ndarray | None:
        """Position of the second side, or of the first one if the second is the ground, (frames, 3)."""
        if kind.integers[:2] != pairs.INTEGERS:
            return None
        return _point(0 if integers[1] == GROUND else 1, numbers, integers, x)

    def axis_directions(self, numbers: np.ndarray, integers: np.ndarray, x: np.ndarray) -> np.ndarray:
        return axis_in_space(0, 3, numbers, integers, x)

    def misaligned(
        self, kind: Kind, numbers: np.ndarray, integers: np.ndarray, placed: np.ndarray, closed: np.ndarray
    ) -> str:
        """Conditions of orthogonality have other solutions: opposite axes, and axes that have changed places."""
        for number in self.aligned:
            before, after = (
                float(axis_in_space(0, number, numbers, integers, x) @ axis_in_space(1, number, numbers, integers, x))
                for x in (placed, closed)
            )
            if after < 0.5 and before > -0.999:  # a joint may be placed with opposite axes
                angle = np.degrees(np.arccos(np.clip(after, -1.0, 1.0)))
                return f"axis {number} of b is at {angle:.0f} deg to axis {number} of a, and has to be parallel to it"
        return ""


def _point(side: int, numbers: np.ndarray, integers: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Position of a marker in the fixed axes, (..., 3), from unknowns (..., width)."""
    k, place = SLOTS * side, numbers[SLOTS * side : SLOTS * side + 3]
    if integers[side] == GROUND:
        return np.broadcast_to(place, (*x.shape[:-1], 3))
    if integers[side] == BODY:
        return x[..., k : k + 3] + place @ x[..., k + 3 : k + SLOTS].reshape(*x.shape[:-1], 3, 3)
    return x[..., k : k + 3]


def axis_in_space(side: int, number: int, numbers: np.ndarray, integers: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Axis with this number of a marker in the fixed axes, (..., 3), from unknowns (..., width)."""
    k = SLOTS * side
    own = numbers[k + 3 * number : k + 3 * number + 3]
    directors = x[..., k + 3 : k + SLOTS].reshape(*x.shape[:-1], 3, 3)
    return own @ directors if integers[side] == BODY else np.broadcast_to(own, (*x.shape[:-1], 3))
