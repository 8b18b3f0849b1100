"""A tree as arrays: the frames of the joints that move, and what hangs rigidly on each of them."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dalembert.errors import ModelError
from dalembert.kernels.words import Complexes, Integers, Reals
from dalembert.multibody.components.spatial.orientation import direction, skew
from dalembert.multibody.trees.tree import REVOLUTE, Tree, TreeJoint, pose_matrix

COSINE, SINE, CONSTANT, PLACE, SLIDE, AXIS, INERTIA, WIDTH = 0, 9, 18, 27, 30, 33, 36, 46
"""Where the numbers of a frame are in its row. Matrices are kept by columns."""


class Frames(NamedTuple):
    """The frames for kernels. ``parents`` (frames,): 0 for the base, k + 1 for frame k; ``turns`` (frames,): 1 for a
    revolute joint, 0 for a prismatic one; ``numbers`` (frames * WIDTH,): rotation from the frame to its parent's:
    constant part, factors of cosine and sine of the position; position in the parent's frame and its derivative by that
    of the joint; axis; mass, mass x centre and inertia about the origin of all that hangs rigidly on the frame.
    """

    parents: Integers
    turns: Integers
    numbers: Reals


class ComplexFrames(NamedTuple):
    """The frames of a tree with complex numbers, while a derivative is taken."""

    parents: Integers
    turns: Integers
    numbers: Complexes


@dataclass(frozen=True)
class FlatTree:
    """A tree as arrays. ``joints``: of each frame, also those that follow another joint; ``factors`` (frames, dofs);
    ``offsets`` (frames,): positions of the joints = factors @ positions of the tree + offsets; ``homes`` (links,): on
    which frame each link hangs: 0 for the base, k + 1 for frame k; ``places`` (links, 3), ``axes`` (links, 3, 3):
    position and orientation of the links in these frames.
    """

    frames: Frames | ComplexFrames
    joints: tuple[TreeJoint, ...]
    factors: np.ndarray
    offsets: np.ndarray
    homes: np.ndarray
    places: np.ndarray
    axes: np.ndarray

    @property
    def one_to_one(self) -> bool:
        """Whether no joint follows another one."""
        return all(joint.mimic is None for joint in self.joints)


def flat(tree: Tree) -> FlatTree:
    """The arrays of a tree. The tree keeps them, as it does with cached properties: they take as long as 500 samples.

    Raises ModelError: for a joint that follows itself or one that does not move.
    """
    kept = vars(tree)
    if "_flat" not in kept:
        kept["_flat"] = _flattened(tree)
    return kept["_flat"]


def _flattened(tree: Tree) -> FlatTree:
    hung = {tree.root: (0, np.zeros(3), np.eye(3))}
    parents, turns, rows = [], [], []
    pseudo = [np.zeros((4, 4))]
    for link in tree.links:
        slot, place, axes = hung[link.parent]
        own_place, own_axes = pose_matrix(link.joint.pose)
        place, axes = place + axes @ own_place, axes @ own_axes
        if link.joint.moves:
            parents.append(slot)
            turns.append(int(link.joint.kind == REVOLUTE))
            # Rodrigues' formula: R = A (u u^T + cos(q) (1 - u u^T) + sin(q) [u]x).
            u = direction(link.joint.axis, f"joint {link.joint.name!r}: axis")
            along, nothing = np.outer(u, u), np.zeros((3, 3))
            if link.joint.kind == REVOLUTE:
                parts, slide = (np.eye(3) - along, skew(u), along), np.zeros(3)
            else:
                parts, slide = (nothing, nothing, np.eye(3)), axes @ u
            rows.append(np.concatenate([*((axes @ part).T.ravel() for part in parts), place, slide, u]))
            pseudo.append(np.zeros((4, 4)))
            slot, place, axes = len(rows), np.zeros(3), np.eye(3)
        hung[link.name] = slot, place, axes
        if link.inertia is not None:
            pseudo[slot] = pseudo[slot] + moved(link.inertia.pseudo, place, axes)
    whole = [np.concatenate([row, ten_of(own)]) for row, own in zip(rows, pseudo[1:], strict=True)]
    numbers = np.concatenate([np.zeros(0), *whole])
    record = ComplexFrames if np.iscomplexobj(numbers) else Frames
    frames = record(np.array(parents, np.int64), np.array(turns, np.int64), numbers)
    joints, own = tuple(joint for joint in tree.joints if joint.moves), [hung[link.name] for link in tree.links]
    homes, places = np.array([home for home, _, _ in own], np.int64), np.array([place for _, place, _ in own])
    orientations = np.array([axes for _, _, axes in own])
    return FlatTree(
        frames, joints, *_following(tree), homes, places.reshape(-1, 3), orientations.reshape(-1, 3, 3)
    )  # fmt: skip


def _following(tree: Tree) -> tuple[np.ndarray, np.ndarray]:
    """Factors (joints, dofs) and offsets (joints,) of the positions of all joints."""
    slots = {joint.name: k for k, joint in enumerate(tree.moving)}
    by_name = {joint.name: joint for joint in tree.joints}
    moving = [joint for joint in tree.joints if joint.moves]
    factors, offsets = np.zeros((len(moving), len(slots))), np.zeros(len(moving))
    for row, joint in enumerate(moving):
        factor, offset, own = 1.0, 0.0, joint
        while own.mimic is not None:
            name, by, shift = own.mimic
            factor, offset, own = factor * by, offset + factor * shift, by_name[name]
            if not own.moves:
                raise ModelError(
                    f"joint {joint.name!r} follows joint {name!r}, which does not move. Let it follow one that moves"
                )
        factors[row, slots[own.name]], offsets[row] = factor, offset
    return factors, offsets


def moved(pseudo: np.ndarray, place: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Pseudo-inertia (4, 4) in another frame, where the body's frame has this position and orientation."""
    whole = np.block([[np.ones((1, 1)), np.zeros((1, 3))], [place[:, None], axes]])
    return whole @ pseudo @ whole.T


def ten_of(pseudo: np.ndarray) -> np.ndarray:
    """Mass, mass x centre, and inertia xx, yy, zz, xy, xz, yz about the origin, (10,), of a pseudo-inertia (4, 4)."""
    second = pseudo[1:, 1:]
    xx, yy, zz = np.trace(second) - np.diagonal(second)
    return np.array([*pseudo[0], xx, yy, zz, -second[0, 1], -second[0, 2], -second[1, 2]])


def pseudo_of(ten: np.ndarray) -> np.ndarray:
    """The pseudo-inertia (4, 4) of mass, mass x centre and inertia about the origin, (10,)."""
    m, x, y, z, xx, yy, zz, xy, xz, yz = ten
    half = 0.5 * (xx + yy + zz)
    return np.array([[m, x, y, z], [x, half - xx, -xy, -xz], [y, -xy, half - yy, -yz], [z, -xz, -yz, half - zz]])
