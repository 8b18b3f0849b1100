"""Rigid motions that the surroundings of a mechanism leave free: to each belongs a momentum that it keeps."""

from collections.abc import Sequence

import numpy as np

from dalembert.multibody.components.planar.markers import GROUND
from dalembert.multibody.integrators.midpoint.energy_balance import FreeRigidMotions
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.structure import Structure

_VECTORS = ("position", "director", "gradient")


def takes_means(structure: Structure) -> bool:
    """Whether a step that keeps the energy takes mean forces, and constraint forces of its middle.

    So do mechanisms with components that have mean forces: beams and cables in space. Constraints are quadratic in the
    coordinates there, but for angles of rotors.
    """
    return any(kind.has("mean") for kind in structure.index) and "rotor" not in structure.kinds


def rigid_motions(lowered: Lowered, perturbed: Sequence[Lowered]) -> FreeRigidMotions:
    """The free translations and rotations of a mechanism, by its gravity and what holds it to the ground.

    Without any hold, those are the translations across gravity, and the rotations about axes along gravity: all without
    gravity, one in the plane. Pins, rods and springs at points of the ground leave the rotations about an axis through
    all of them. What else may be free (along a slide) is not looked for.
    """
    kinds = np.array(lowered.structure.kinds)
    held, points = _held(lowered)
    weighs = np.any(_gravity(lowered), axis=0)
    frees = not held and len(points) == 0
    translations = [axis for axis in range(lowered.dimension) if frees and not weighs[axis]]
    spread = np.ptp(np.real(points), axis=0) != 0.0 if len(points) else np.zeros(lowered.dimension, bool)
    # In space what projected velocities lose can only be balanced by a force against rotations, too.
    turns = [(0, 1)] if lowered.dimension == 2 and not held and not np.any(weighs | spread) else []
    partner = np.tile(np.arange(len(kinds)), (len(translations) + len(turns), 1))
    sign = np.zeros(partner.shape)
    vectors = np.flatnonzero(np.isin(kinds, _VECTORS))
    for row, (x, y) in enumerate(turns, start=len(translations)):
        first, second = vectors[x :: lowered.dimension], vectors[y :: lowered.dimension]
        partner[row, first], partner[row, second], sign[row, first], sign[row, second] = second, first, -1.0, 1.0
    shifts = np.array([_shifts(entry, kinds, translations, turns) for entry in (lowered, *perturbed)])
    return FreeRigidMotions(partner, sign, np.ascontiguousarray(shifts[0].real), np.ascontiguousarray(shifts[1:]))


def _shifts(
    lowered: Lowered, kinds: np.ndarray, translations: Sequence[int], turns: Sequence[tuple[int, int]]
) -> np.ndarray:
    """Velocities of the rigid motions where all coordinates are zero, (motions, n), complex."""
    shift = np.zeros((len(translations) + len(turns), len(kinds)), complex)
    positions, points = np.flatnonzero(kinds == "position"), _held(lowered)[1]
    for row, axis in enumerate(translations):
        shift[row, positions[axis :: lowered.dimension]] = 1.0
    for row, (x, y) in enumerate(turns, start=len(translations)):
        # A rotation about the point c moves p with the velocity of p - c.
        centre = points[0] if len(points) else np.zeros(lowered.dimension)
        shift[row, positions[x :: lowered.dimension]] = centre[y]
        shift[row, positions[y :: lowered.dimension]] = -centre[x]
        if lowered.dimension == 2:
            shift[row, kinds == "angle"] = 1.0
    return shift


def _grounded(lowered: Lowered, kind: Kind) -> np.ndarray:
    """Which sides of the components of a kind are on the ground, (count, 2)."""
    columns = [kind.integers.index(f"{side}_kind") for side in "ab"]
    return lowered.structure.meta[kind][:, columns] == GROUND


def _gravity(lowered: Lowered) -> np.ndarray:
    """The gravity that acts on each component, (components, 2 or 3)."""
    weights = [np.real(data[:, kind.columns(kind.gravity)]) for kind, data in lowered.data.items() if kind.gravity]
    return np.vstack([np.zeros((0, lowered.dimension)), *weights])


def _held(lowered: Lowered) -> tuple[bool, np.ndarray]:
    """Whether a frame of the ground holds the mechanism, and the points of the ground that do, (points, 2 or 3)."""
    found, held = [np.zeros((0, lowered.dimension))], False
    axes = "xyz"[: lowered.dimension]
    for kind, data in lowered.data.items():
        if not kind.holds:
            continue
        for side, grounded in zip("ab", _grounded(lowered, kind).T, strict=True):
            held = held or (kind.holds_frame and bool(np.any(grounded)))
            found.append(data[grounded][:, kind.columns(tuple(f"{side}_{axis}" for axis in axes))])
    return held, np.vstack(found)
