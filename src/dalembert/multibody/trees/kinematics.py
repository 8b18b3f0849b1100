"""Poses and velocities of the links of a tree from the positions and rates of its joints."""

__all__ = ["Motion", "coordinate", "motions", "values"]

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from dalembert.arguments import is_number
from dalembert.errors import InputError, ModelError, require_known, shown
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.spatial.orientation import Orientation, Pose, about, direction
from dalembert.multibody.trees.tree import FIXED, ORIGIN, REVOLUTE, Tree, TreeJoint, pose_matrix


class Motion(NamedTuple):
    """Position (3,) of a frame, its axes as columns (3, 3), its velocity (3,) and angular velocity (3,)."""

    position: np.ndarray
    axes: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray


def values(tree: Tree, given: Mapping[str, Number] | Sequence[Number] | None, what: str) -> dict[str, Number]:
    """Numbers of the moving joints by name, from a mapping (0 where a joint is missing) or from one number a joint.

    Raises InputError: for an unknown joint, another count, and what is no number.
    """
    names = [joint.name for joint in tree.moving]
    if given is None:
        given = {}
    if not isinstance(given, Mapping):
        row = list(np.atleast_1d(np.asarray(given)))
        if len(row) != len(names):
            raise InputError(
                f"Tree.system: {what} has {len(row)} numbers; expected {len(names)}, one for each of {names}"
            )
        given = dict(zip(names, row, strict=True))
    for name, value in given.items():
        require_known("joint", name, names, f"Tree.system: {what}")
        if not is_number(value):
            raise InputError(f"Tree.system: {what} of joint {name!r} is {shown(value)}; expected a finite number")
    return {name: given.get(name, 0.0) for name in names}


def motions(
    tree: Tree, positions: Mapping[str, Number], rates: Mapping[str, Number], base: Pose = ORIGIN
) -> dict[str, Motion]:
    """Motion of the frame of each link, the base included, by name.

    A joint that follows another one takes its position and rate from it.
    """
    where, axes = pose_matrix(base)
    found = {tree.root: Motion(where, axes, np.zeros(3), np.zeros(3))}
    for link in tree.links:
        joint = link.joint
        found[link.name] = moved(found[link.parent], joint, *coordinate(tree, joint, positions, rates))
    return found


def coordinate(
    tree: Tree, joint: TreeJoint, positions: Mapping[str, Number], rates: Mapping[str, Number]
) -> tuple[Number, Number]:
    """Position and rate of a joint, which may follow another one."""
    if not joint.moves:
        return 0.0, 0.0
    if joint.mimic is None:
        return positions.get(joint.name, 0.0), rates.get(joint.name, 0.0)
    other, factor, offset = joint.mimic
    followed = next(own for own in tree.joints if own.name == other)
    position, rate = coordinate(tree, followed, positions, rates)
    return factor * position + offset, factor * rate


def moved(parent: Motion, joint: TreeJoint, position: Number, rate: Number) -> Motion:
    """Motion of the frame behind a joint."""
    where, axes = joint_pose(joint, position)
    arm = parent.axes @ where
    own, velocity, spin = parent.axes @ axes, parent.velocity + np.cross(parent.spin, arm), parent.spin
    if joint.moves:
        along = own @ direction(joint.axis, f"joint {joint.name!r}: its axis")
        if joint.kind == REVOLUTE:
            spin = spin + rate * along
        else:
            velocity = velocity + rate * along
    return Motion(parent.position + arm, own, velocity, spin)


def joint_pose(joint: TreeJoint, position: Number) -> tuple[np.ndarray, np.ndarray]:
    """Position (3,) and axes (3, 3) of the frame behind a joint, in the frame of the parent."""
    where, axes = pose_matrix(joint.pose)
    if not joint.moves:
        return where, axes
    unit = direction(joint.axis, f"joint {joint.name!r}: its axis")
    if joint.kind == REVOLUTE:
        return where, axes @ about(unit, position)
    return where + axes @ (unit * position), axes


def fixed_joints(tree: Tree, positions: Mapping[str, Number]) -> Tree:
    """The tree with joints fixed at positions, see :meth:`Tree.with_fixed_joints`."""
    names = [joint.name for joint in tree.joints if joint.moves]
    for name, value in positions.items():
        require_known("joint", name, names, "Tree.with_fixed_joints")
        if not is_number(value):
            raise InputError(f"Tree.with_fixed_joints: {name!r} is {shown(value)}; expected a finite number")
    for joint in tree.joints:
        if joint.mimic and joint.mimic[0] in positions and joint.name not in positions:
            raise ModelError(f"joint {joint.name!r} follows {joint.mimic[0]!r}, which is to be fixed. Fix both")

    def fixed(joint: TreeJoint) -> TreeJoint:
        if joint.name not in positions:
            return joint
        where, axes = joint_pose(joint, positions[joint.name])
        return TreeJoint(joint.name, FIXED, Pose(tuple(where.tolist()), Orientation.of(axes)))  # type: ignore[arg-type]

    return replace(tree, links=tuple(replace(link, joint=fixed(link.joint)) for link in tree.links))
