"""From a tree to a mechanism in space."""

__all__ = ["built", "groups"]

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from dalembert.errors import ModelError, listed
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.spatial.armature import Armature
from dalembert.multibody.components.spatial.friction import Friction
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.orientation import Orientation, Pose, Vector
from dalembert.multibody.components.spatial.points import Side
from dalembert.multibody.components.spatial.prismatic_joint import PrismaticJoint
from dalembert.multibody.components.spatial.revolute_joint import RevoluteJoint
from dalembert.multibody.components.spatial.rigid_body import RigidBody
from dalembert.multibody.spatial_system import SpatialSystem
from dalembert.multibody.trees.kinematics import Motion, joint_pose, motions, values
from dalembert.multibody.trees.tree import JOINT_NUMBERS, PRISMATIC, REVOLUTE, Tree, TreeJoint

Frame = tuple[np.ndarray, np.ndarray]
"""Position (3,) and axes (3, 3)."""


@dataclass
class Group:
    """Links that are fixed to each other: one rigid body, named after the first of them.

    Parameters
    ----------
    name : str
    joint : TreeJoint or None
        By which it hangs on another group; None for the group of the base.
    frames : dict of str to Frame
        Frame of each link in that of the first one.
    seats : dict of str to Frame
        Frame of each joint that hangs on it, at the position zero.
    inertias : list of (Frame, Inertia)
    """

    name: str
    joint: TreeJoint | None
    frames: dict[str, Frame]
    seats: dict[str, Frame] = field(default_factory=dict)
    inertias: list[tuple[Frame, Inertia]] = field(default_factory=list)

    def seat(self, joint: str) -> str:
        """Name of the marker of a joint that hangs on it."""
        name = f"{joint} frame"
        while name in self.frames:
            name += "_"
        return name

    @property
    def points(self) -> dict[str, Pose]:
        """The markers: frames of all links but the first, and of the joints that hang on it."""
        frames = {name: frame for name, frame in self.frames.items() if name != self.name}
        frames |= {self.seat(joint): frame for joint, frame in self.seats.items()}
        return {name: Pose(_row(at), Orientation.of(axes)) for name, (at, axes) in frames.items()}


def groups(tree: Tree) -> dict[str, Group]:
    """The group of each link, by the name of the link."""
    of = {tree.root: Group(tree.root, None, {tree.root: (np.zeros(3), np.eye(3))})}
    for link in tree.links:
        parent = of[link.parent]
        frame = composed(parent.frames[link.parent], joint_pose(link.joint, 0.0))
        if link.joint.moves:
            parent.seats[link.joint.name] = frame
            of[link.name] = Group(link.name, link.joint, {link.name: (np.zeros(3), np.eye(3))})
        else:
            of[link.name] = parent
            parent.frames[link.name] = frame
        if link.inertia is not None:
            of[link.name].inertias.append((of[link.name].frames[link.name], link.inertia))
    return of


def composed(outer: Frame, inner: Frame) -> Frame:
    """The frame ``inner``, which is given in the frame ``outer``."""
    return outer[0] + outer[1] @ inner[0], outer[1] @ inner[1]


def merged(inertias: Sequence[tuple[Frame, Inertia]]) -> Inertia:
    """Inertia of bodies that are fixed to each other, in common axes."""
    if len(inertias) == 1 and not np.any(inertias[0][0][0]) and np.array_equal(inertias[0][0][1], np.eye(3)):
        return inertias[0][1]
    mass = sum(own.mass for _, own in inertias)
    centres = [at + axes @ np.array(own.centre) for (at, axes), own in inertias]
    centre = sum(own.mass * at for (_, own), at in zip(inertias, centres, strict=True)) / mass
    tensor = np.zeros((3, 3))
    for ((_, axes), own), at in zip(inertias, centres, strict=True):
        arm = at - centre
        tensor = tensor + axes @ own.tensor @ axes.T + own.mass * ((arm @ arm) * np.eye(3) - np.outer(arm, arm))
    return Inertia.of(mass, tensor, centre)


def built(
    tree: Tree,
    positions: Mapping[str, Number] | Sequence[Number] | None,
    rates: Mapping[str, Number] | Sequence[Number] | None,
    gravity: tuple[Number, Number, Number],
    base: Pose,
    slip: Number,
    start: str,
) -> SpatialSystem:
    """The mechanism of a tree, see :meth:`Tree.system`."""
    _refuse_mimic(tree)
    q, q_rates = values(tree, positions, "positions"), values(tree, rates, "rates")
    motion, of = motions(tree, q, q_rates, base), groups(tree)
    root = motion[tree.root]
    system = SpatialSystem(gravity, start=start)
    moving = [link for link in tree.links if link.joint.moves]
    bodies = {link.name: system.add(_body(of[link.name], motion[link.name])) for link in moving}
    for link in moving:
        parent, name = of[link.parent], link.joint.name
        if parent.joint is None:
            at, axes = composed((root.position, root.axes), parent.seats[name])
            side: Side = system.ground.point(_row(at), Orientation.of(axes))
        else:
            side = bodies[parent.name].point(parent.seat(name))
        _connect(system, tree, link.joint, side, bodies[link.name], slip)
    return system


def _row(vector: np.ndarray) -> Vector:
    return tuple(vector.tolist())  # type: ignore[return-value]


def _refuse_mimic(tree: Tree) -> None:
    following = [joint.name for joint in tree.joints if joint.moves and joint.mimic]
    if following:
        raise ModelError(
            f"robot {tree.name!r}: the joints {listed([repr(name) for name in following])} follow other joints "
            f"(mimic), which a system does not support. Fix them: tree.with_fixed_joints({{{following[0]!r}: 0.0}})"
        )


def _body(group: Group, motion: Motion) -> RigidBody:
    assert group.joint is not None
    if not group.inertias:
        raise ModelError(
            f"link {group.name!r} moves by joint {group.joint.name!r}, but has no mass, and no link with mass is fixed "
            f"to it. Give it an inertia, or fix the joint: tree.with_fixed_joints({{{group.joint.name!r}: 0.0}})"
        )
    return RigidBody(
        group.name,
        merged(group.inertias),
        position=_row(motion.position),
        orientation=Orientation.of(motion.axes),
        points=group.points,
        velocity=_row(motion.velocity),
        angular_velocity=_row(motion.spin),
    )


def _connect(system: SpatialSystem, tree: Tree, joint: TreeJoint, a: Side, body: RigidBody, slip: Number) -> None:
    """Add a joint, its friction and its armature inertia. Zero numbers that are parameters stay in the model."""
    has = {name: getattr(joint, name) != 0.0 or f"{joint.name}.{name}" in tree.changed for name in JOINT_NUMBERS}
    friction = None
    if has["damping"] or has["friction"]:
        friction = Friction(joint.damping, joint.friction if has["friction"] else None, slip=slip)
    bodies = {own.name for own in system.bodies}
    name = f"{joint.name} joint" if joint.name in bodies else joint.name
    kind = RevoluteJoint if joint.kind == REVOLUTE else PrismaticJoint
    system.add(kind(name, a, body.point("origin"), joint.axis, friction))
    if has["armature"]:
        slides = joint.kind == PRISMATIC
        system.add(Armature(f"{name} armature", a, body.point("origin"), joint.armature, joint.axis, slides))
