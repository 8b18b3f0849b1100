"""The state of a joint in space that is stated: one of its coordinates, and the rate, as assembly needs them."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.signals import Signal
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.orientation import Orientation
from dalembert.multibody.components.spatial.rotations import rotation_vector
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_angle, joint_displacement
from dalembert.multibody.components.spatial.spatial_pairs import LENGTHS, along_axes, f1, f2, f3, separation
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.kernels.elementary import angle_of, root, wrapped
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.time_inputs import signal


@inlined
def _angle(x, p, m, inputs, g):
    g[0] = wrapped(joint_angle(x, p, m) - signal(inputs, m.course))


@inlined
def _displacement(x, p, m, inputs, g):
    g[0] = joint_displacement(x, p, m) - signal(inputs, m.course)


@inlined
def _rotation(x, p, m, inputs, g):
    """Component along e3 of the rotation vector from the axes of a to those of b."""
    first, second = along_axes(f1(x, p, m), x, p, m), along_axes(f2(x, p, m), x, p, m)
    g[0] = rotation_vector(first, second, along_axes(f3(x, p, m), x, p, m))[2] - signal(inputs, m.course)


@inlined
def _azimuth(x, p, m, inputs, g):
    """Angle about e3 from e1 to the line from a to b."""
    along, across, _ = along_axes(separation(x, p, m), x, p, m)
    g[0] = wrapped(angle_of(along, across) - signal(inputs, m.course))


@inlined
def _elevation(x, p, m, inputs, g):
    """Angle of the line from a to b above the plane of e1 and e2."""
    along, across, up = along_axes(separation(x, p, m), x, p, m)
    g[0] = angle_of(root(along * along + across * across), up) - signal(inputs, m.course)


def _stated(name: str, constraint: Any) -> Kind:
    return pair_kind(
        name, __name__, integers=("course",), multipliers=1, constraint=constraint, lengths=LENGTHS, lanes=False
    )


STATED_ANGLE, STATED_DISPLACEMENT = _stated("stated_angle", _angle), _stated("stated_displacement", _displacement)
STATED_ROTATION = _stated("stated_rotation", _rotation)
STATED_DIRECTIONS = {
    "azimuth": _stated("stated_azimuth", _azimuth),
    "elevation": _stated("stated_elevation", _elevation),
}

_LAST = {1: [1, 2, 0], 2: [2, 0, 1], 3: [0, 1, 2]}
"""Order of the axes that makes one of them the third."""


@dataclass(frozen=True)
class JointState(Joint):
    """A constraint on the coordinate of a joint, with the name of that coordinate.

    ``axes`` (array, array): rotations (3, 3) from the axes of both markers to those in which the kernel measures the
    coordinate.
    """

    axes: tuple[np.ndarray, np.ndarray]
    measures: Kind
    course: Signal

    kind = STATED_ANGLE

    @property
    def turned(self) -> tuple[np.ndarray, np.ndarray]:
        return self.axes

    def lower(self, lowering: SpatialRows) -> None:
        pair = lowering.pair(self.a, self.b, self.name, self.axes)
        index = pair.slots + lowering.multipliers(self.name, 1)
        lowering.add(self.measures, index, pair.data, [*pair.integers, lowering.signal(self.course)], self.name)


def stated(joint: Joint, coordinate: str, course: Signal) -> JointState:
    """Return the constraint that makes a coordinate of a joint follow a signal."""
    name, a, b, (e, f) = f"{joint.name}.{coordinate}", joint.a, joint.b, joint.turned
    what, _, axis = coordinate.partition("_")
    if coordinate in STATED_DIRECTIONS:
        return JointState(name, a, b, (e, f), STATED_DIRECTIONS[coordinate], course)
    if what == "rotation":
        number = "xyz".index(axis) + 1 if axis in "xyz" else int(axis)
        e, f = (np.eye(3), np.eye(3)) if axis in "xyz" else (e, f)  # in the axes of the marker, or of the joint
        return JointState(name, a, b, (e[:, _LAST[number]], f[:, _LAST[number]]), STATED_ROTATION, course)
    if what == "displacement":
        order = _LAST[int(axis or 3)]
        return JointState(name, a, b, (e[:, order], f[:, order]), STATED_DISPLACEMENT, course)
    if axis == "a":  # of a universal joint: the angle about e1 from e2 to f2
        return JointState(name, a, b, (e[:, _LAST[1]], f[:, _LAST[1]]), STATED_ANGLE, course)
    if axis == "b":  # the angle about f2 from f1 to e1, towards f3
        return JointState(name, b, a, (f[:, [0, 2, 1]] * [1.0, 1.0, -1.0], e), STATED_ANGLE, course)
    return JointState(name, a, b, (e, f), STATED_ANGLE, course)


def kept(joint: Joint, coordinate: str, course: Signal, now: tuple[np.ndarray, np.ndarray, np.ndarray]) -> JointState:
    """Return the constraint that makes a coordinate follow a signal, a rotation or direction from the present pose on.

    ``now`` (array, array, array): the axes of the joint at a and at b, as columns, and the position of b relative to a,
    in the fixed axes.
    """
    (e, f, gap), state = now, stated(joint, coordinate, course)
    a, b, (first, second) = joint.a, joint.b, joint.turned
    if state.measures not in (STATED_ROTATION, *STATED_DIRECTIONS.values()):
        return state
    if state.measures == STATED_ROTATION:
        measured = e @ first.T @ state.axes[0]  # in the fixed axes
        axes = state.axes[0], second @ f.T @ measured
        return JointState(state.name, a, b, axes, state.measures, course)
    if not turns(joint.a) and turns(joint.b):  # the rod turns with the side that has axes
        a, b, e, f, gap, first, second = b, a, f, e, -gap, second, first
    along = Orientation.by_axes(gap.tolist()).matrix[:, [2, 0, 1]]
    return JointState(state.name, a, b, (first @ e.T @ along, second), state.measures, course)


def turns(side: Any) -> bool:
    """Whether a side of a joint has axes: the ground and rigid bodies have them, point masses have none."""
    return not isinstance(side, Point) or side.body.has_axes
