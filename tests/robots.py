"""Robots with random, physically consistent inertias, and the same robots as systems of bodies."""

import numpy as np

from dalembert.multibody.spatial import (
    Inertia,
    Orientation,
    Pose,
    PrismaticJoint,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
)
from dalembert.multibody.trees.dynamics import poses
from dalembert.multibody.trees.tree import FIXED, PRISMATIC, REVOLUTE, Link, Tree, TreeJoint


def random_inertia(random: np.random.Generator) -> Inertia:
    """That of twelve random point masses."""
    masses, points = random.uniform(0.05, 0.3, 12), random.uniform(-0.2, 0.2, (12, 3))
    lifted = np.column_stack([np.ones(12), points])
    return Inertia.of_pseudo(lifted.T @ (masses[:, None] * lifted))


def random_pose(random: np.random.Generator) -> Pose:
    vector = random.uniform(-1.0, 1.0, 3).tolist()
    return Pose(tuple(random.uniform(-0.4, 0.4, 3).tolist()), Orientation.by_rotation_vector(vector))


def random_robot(seed: int, kinds: str = "rrr", parents: tuple[int, ...] | None = None, **numbers: float) -> Tree:
    """A robot with joints "r" (revolute), "p" (prismatic) and "f" (fixed), a chain or with these parents (-1 the base)."""
    random, links = np.random.default_rng(seed), []
    named = {"r": REVOLUTE, "p": PRISMATIC, "f": FIXED}
    for k, kind in enumerate(kinds):
        parent = k - 1 if parents is None else parents[k]
        axis = tuple(random.normal(size=3).tolist())
        joint = TreeJoint(f"joint{k}", named[kind], random_pose(random), axis, **numbers if kind != "f" else {})
        links.append(Link(f"link{k}", "base" if parent < 0 else f"link{parent}", joint, random_inertia(random)))
    return Tree(f"robot{seed}", "base", tuple(links))


def three_joints(**numbers: float) -> Tree:
    return random_robot(3, "rpr", **numbers)


def six_joints(**numbers: float) -> Tree:
    """With two branches, and links on fixed joints at the base, between joints and at an end."""
    return random_robot(6, "frrfprrfr", (-1, 0, 1, 2, 3, 4, 3, 6, 7), **numbers)


def random_motion(tree: Tree, samples: int, seed: int = 0) -> np.ndarray:
    """Positions, velocities and accelerations (3, samples, dofs)."""
    return np.random.default_rng(seed).normal(size=(3, samples, len(tree.moving)))


def system_of(tree: Tree, q: np.ndarray, v: np.ndarray) -> SpatialSystem:
    """The tree as bodies and joints, in a position q (dofs,) with velocities v (dofs,)."""
    step = 1e-30
    place, axes = (own[0] for own in poses(tree, (q + 1j * step * v)[None, :]))
    system, bodies = SpatialSystem(), {}
    for k, link in enumerate(tree.links):
        children = {own.joint.name: own.joint.pose for own in tree.links if own.parent == link.name}
        rotation = axes[k].real
        spin = axes[k].imag / step @ rotation.T
        bodies[link.name] = system.add(
            RigidBody(
                link.name,
                link.inertia,
                position=tuple(place[k].real.tolist()),
                orientation=Orientation.of(rotation),
                points=children,
                velocity=tuple((place[k].imag / step).tolist()),
                angular_velocity=(spin[2, 1], spin[0, 2], spin[1, 0]),
            )
        )
        pose = link.joint.pose
        a = (
            system.ground.point(pose.position, pose.orientation)
            if link.parent == tree.root
            else bodies[link.parent].point(link.joint.name)
        )
        kind = RevoluteJoint if link.joint.kind == REVOLUTE else PrismaticJoint
        system.add(kind(link.joint.name, a, bodies[link.name].point("origin"), axis=link.joint.axis))
    return system
