"""From a tree to a mechanism in space."""

__all__ = ["built", "groups", "names"]

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from dalembert.arguments import is_number
from dalembert.errors import InputError, ModelError, require_known, shown
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.signals import Course
from dalembert.multibody.components.spatial.armature import Armature
from dalembert.multibody.components.spatial.coupling_joint import CouplingJoint
from dalembert.multibody.components.spatial.friction import Friction
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.joint_limit import AngleLimit, DisplacementLimit
from dalembert.multibody.components.spatial.orientation import Orientation, Pose, Vector
from dalembert.multibody.components.spatial.shapes import Shape
from dalembert.multibody.components.spatial.spatial_force import Force, Torque
from dalembert.multibody.components.spatial.spatial_joint import Joint
from dalembert.multibody.components.spatial.spatial_prismatic_joint import PrismaticJoint
from dalembert.multibody.components.spatial.spatial_revolute_joint import RevoluteJoint
from dalembert.multibody.components.spatial.spatial_rigid_body import RigidBody
from dalembert.multibody.model.spatial_system import SpatialSystem
from dalembert.multibody.trees.idle_limits import import_findings
from dalembert.multibody.trees.kinematics import Motion, coordinate, joint_pose, motions, values
from dalembert.multibody.trees.tree import JOINT_NUMBERS, PRISMATIC, REVOLUTE, Tree, TreeJoint, pose_matrix

Law = tuple[Number, Number]
Limits = Law | Mapping[str, Law] | None
"""Stiffness and damping of the stops of all joints, or of some."""

AXIS = "driven axis"
"""Marker of a driven body."""
Frame = tuple[np.ndarray, np.ndarray]
"""Position (3,) and axes (3, 3)."""


@dataclass
class Group:
    """Links that are fixed to each other: one rigid body, named after the first of them. ``joint``: by which it hangs
    on another group, None for the group of the base; ``frames``: frame of each link in that of the first one;
    ``seats``: frame of each joint that hangs on it, at the position zero; ``shapes``: in the frame of the first link.
    """

    name: str
    joint: TreeJoint | None
    frames: dict[str, Frame]
    seats: dict[str, Frame] = field(default_factory=dict)
    inertias: list[tuple[Frame, Inertia]] = field(default_factory=list)
    shapes: list[Shape] = field(default_factory=list)

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
        return {name: _pose(frame) for name, frame in frames.items()}


def groups(tree: Tree) -> dict[str, Group]:
    """The group of each link, by the name of the link."""
    of = {tree.root: Group(tree.root, None, {tree.root: (np.zeros(3), np.eye(3))}, shapes=list(tree.shapes))}
    for link in tree.links:
        parent = of[link.parent]
        frame = composed(parent.frames[link.parent], joint_pose(link.joint, 0.0))
        if link.joint.moves:
            parent.seats[link.joint.name] = frame
            of[link.name] = Group(link.name, link.joint, {link.name: (np.zeros(3), np.eye(3))})
        else:
            of[link.name] = parent
            parent.frames[link.name] = frame
        own = of[link.name].frames[link.name]
        if link.inertia is not None:
            of[link.name].inertias.append((own, link.inertia))
        of[link.name].shapes += _moved(link.shapes, own)
    return of


def names(tree: Tree) -> tuple[list[str], dict[str, str]]:
    """Return the names of the bodies of a tree's mechanism, and the name of each joint there by its name in the tree.

    Links that are fixed to each other are one body. A joint that has the name of a body gets another name.
    """
    bodies = [link.name for link in tree.links if link.joint.moves]
    joints = [joint.name for joint in tree.joints if joint.moves]
    return bodies, {name: f"{name} joint" if name in bodies else name for name in joints}


def _moved(shapes: Iterable[Shape], frame: Frame) -> list[Shape]:
    """Shapes that are given in a frame."""
    return [replace(shape, pose=_pose(composed(frame, pose_matrix(shape.pose)))) for shape in shapes]


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
    limits: Limits,
    torques: Mapping[str, Course],
) -> SpatialSystem:
    """The mechanism of a tree, see :meth:`Tree.system`."""
    for name in torques:
        require_known("joint", name, [joint.name for joint in tree.moving], "Tree.system: torques")
    q, q_rates = values(tree, positions, "positions"), values(tree, rates, "rates")
    motion, of = motions(tree, q, q_rates, base), groups(tree)
    root = motion[tree.root]
    _, joint_names = names(tree)
    system = SpatialSystem(gravity, start=start)
    system.import_findings = partial(import_findings, tree, joint_names)
    system.ground_shapes = tuple(_moved(of[tree.root].shapes, (root.position, root.axes)))
    moving = [link for link in tree.links if link.joint.moves]
    described = {link.joint.name: link.joint for link in moving}
    joints: dict[str, Joint] = {}
    bodies = {
        link.name: system.add(_body(of[link.name], motion[link.name], link.joint.name in torques)) for link in moving
    }
    for link in moving:
        parent, name = of[link.parent], link.joint.name
        if parent.joint is None:
            at, axes = composed((root.position, root.axes), parent.seats[name])
            side: Side = system.ground.point(_row(at), Orientation.of(axes))
        else:
            side = bodies[parent.name].point(parent.seat(name))
        joints[name] = _connect(system, tree, link.joint, joint_names[name], side, bodies[link.name], slip)
        if name in torques:
            kind, at = Force if link.joint.kind == PRISMATIC else Torque, bodies[link.name].point(AXIS)
            system.add(kind(f"{link.joint.name} drive", at, z=torques[name], follower=True, against=side))
    at = {name: coordinate(tree, own, q, q_rates)[0] for name, own in described.items()}
    for own in described.values():
        if own.mimic:
            system.add(_follower(own, joints, at))
    for name, law in _stops(described, limits).items():
        system.add(_limit(described[name], joints[name], law, at[name]))
    return system


def _row(vector: np.ndarray) -> Vector:
    return tuple(vector.tolist())  # type: ignore[return-value]


def _pose(frame: Frame) -> Pose:
    return Pose(_row(frame[0]), Orientation.of(frame[1]))


def _follower(joint: TreeJoint, joints: Mapping[str, Joint], at: Mapping[str, Number]) -> CouplingJoint:
    """What makes a joint follow another one; ``at`` are their positions at the start."""
    assert joint.mimic is not None
    leader, factor, offset = joint.mimic
    if leader not in joints:
        raise ModelError(
            f"joint {joint.name!r} follows {leader!r}, which is fixed. Fix it too: {_fixing(joint.name, offset)}"
        )
    near = [float(np.real(at[name])) for name in (leader, joint.name)]
    follower = joints[joint.name]
    return CouplingJoint(
        f"{follower.name} mimic", joints[leader], follower, factor, offset, near_a=near[0], near_b=near[1]
    )


def _fixing(joint: str, position: float) -> str:
    """How a joint is fixed, in Python and in a study file."""
    return (
        f"tree.with_fixed_joints({{{joint!r}: {position}}}), or fixed = {{ {json.dumps(joint)} = {position} }} in "
        "[model.robot]"
    )


def _stops(joints: Mapping[str, TreeJoint], limits: Limits) -> dict[str, Law]:
    """Stiffness and damping of the stops of each joint that gets some."""
    limited = [name for name, own in joints.items() if np.isfinite(own.lower) or np.isfinite(own.upper)]
    given = {} if limits is None else limits if isinstance(limits, Mapping) else dict.fromkeys(limited, limits)
    for name, law in given.items():
        require_known("joint with limits", name, limited, "Tree.system: limits")
        if not (isinstance(law, Sequence) and len(law) == 2 and all(map(is_number, law))):
            raise InputError(
                f"Tree.system: limits of joint {name!r} is {shown(law)}; expected two numbers, stiffness and damping"
            )
    return dict(given)


def _limit(own: TreeJoint, joint: Joint, law: Law, at: Number) -> AngleLimit | DisplacementLimit:
    """The stops of a joint; ``at`` is its position at the start."""
    lower, upper = (end if np.isfinite(end) else None for end in (own.lower, own.upper))
    name, (stiffness, damping) = f"{joint.name} limits", law
    if own.kind == PRISMATIC:
        return DisplacementLimit(name, joint, stiffness, lower, upper, damping)
    return AngleLimit(name, joint, stiffness, lower, upper, damping, float(np.real(at)))


def _body(group: Group, motion: Motion, driven: bool) -> RigidBody:
    """The body of a group; with a marker whose z axis is that of the joint, if a torque drives it."""
    assert group.joint is not None
    if not group.inertias:
        raise ModelError(
            f"link {group.name!r} moves by joint {group.joint.name!r}, but has no mass, and no link with mass is fixed "
            f"to it. Give it an inertia, or fix the joint: {_fixing(group.joint.name, 0.0)}"
        )
    return RigidBody(
        group.name,
        merged(group.inertias),
        position=_row(motion.position),
        orientation=Orientation.of(motion.axes),
        points=group.points | ({AXIS: Pose(orientation=Orientation.by_axes(group.joint.axis))} if driven else {}),
        velocity=_row(motion.velocity),
        angular_velocity=_row(motion.spin),
        shapes=tuple(group.shapes),
    )


def _connect(
    system: SpatialSystem, tree: Tree, joint: TreeJoint, name: str, a: Side, body: RigidBody, slip: Number
) -> Joint:
    """Add a joint of this name, which is returned, its friction and its armature inertia."""
    has = {name: getattr(joint, name) != 0.0 or f"{joint.name}.{name}" in tree.changed for name in JOINT_NUMBERS}
    friction = None
    if has["damping"] or has["friction"]:
        friction = Friction(joint.damping, joint.friction if has["friction"] else None, slip=slip)
    kind = RevoluteJoint if joint.kind == REVOLUTE else PrismaticJoint
    made = system.add(kind(name, a, body.point("origin"), joint.axis, friction))
    if has["armature"]:
        slides = joint.kind == PRISMATIC
        system.add(Armature(f"{name} armature", a, body.point("origin"), joint.armature, joint.axis, slides))
    return made
