"""Rigid motions that the surroundings of a mechanism leave free: to each belongs a momentum that it keeps."""

from collections.abc import Sequence

import numpy as np

from dalembert.multibody.components.planar.markers import GROUND
from dalembert.multibody.integrators.midpoint.energy_balance import FreeRigidMotions
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.model.lowered import Lowered


def rigid_motions(lowered: Lowered, perturbed: Sequence[Lowered]) -> FreeRigidMotions:
    """The free translations and the free rotation of a mechanism, by its gravity and what holds it to the ground.
    Without any hold, those are the translations across gravity, and without gravity the rotation, too. Pins, rods and
    springs at one point of the ground leave the rotation about it. What else may be free (along a slide) is not looked
    for.
    """
    if lowered.dimension == 3:
        return _translations(lowered, len(perturbed))
    kinds = np.array(lowered.structure.kinds)
    vectors, positions = np.flatnonzero(kinds != "angle"), np.flatnonzero(kinds == "position")
    partner, sign = np.arange(len(kinds)), np.zeros(len(kinds))
    partner[vectors[::2]], partner[vectors[1::2]] = vectors[1::2], vectors[::2]
    sign[vectors[::2]], sign[vectors[1::2]] = -1.0, 1.0
    held, points = _held(lowered)
    gravity = _gravity(lowered)
    free = [not held and len(points) == 0 and not np.any(gravity[:, axis]) for axis in range(2)]
    turns = not held and not np.any(gravity) and not np.any(np.ptp(np.real(points), axis=0) if len(points) else 0.0)
    shifts = []
    for entry in (lowered, *perturbed):
        rows = []
        for axis in np.flatnonzero(free):
            rows.append(np.zeros(len(kinds), dtype=complex))
            rows[-1][positions[axis::2]] = 1.0
        if turns:
            places = _held(entry)[1]
            x, y = places[0] if len(places) else (0.0, 0.0)
            rows.append(np.where(kinds == "angle", 1.0 + 0j, 0j))
            rows[-1][positions[::2]], rows[-1][positions[1::2]] = y, -x
        shifts.append(np.array(rows).reshape(len(rows), len(kinds)))
    spin = np.array([0.0] * sum(free) + [1.0] * turns)
    along = np.array(shifts[1:], dtype=complex).reshape(len(perturbed), *shifts[0].shape)
    return FreeRigidMotions(partner, sign, spin, np.ascontiguousarray(shifts[0].real), along)


def _translations(lowered: Lowered, directions: int) -> FreeRigidMotions:
    """The free translations of a mechanism in space: across gravity, where nothing holds it."""
    kinds = np.array(lowered.structure.kinds)
    held = any(kind.holds and np.any(_grounded(lowered, kind)) for kind in lowered.data)
    free = [] if held else [axis for axis in range(3) if not np.any(_gravity(lowered)[:, axis])]
    shift = np.zeros((len(free), len(kinds)))
    for row, axis in enumerate(free):
        shift[row, np.flatnonzero(kinds == "position")[axis::3]] = 1.0
    along = np.tile(shift.astype(complex), (directions, 1, 1))
    return FreeRigidMotions(np.arange(len(kinds)), np.zeros(len(kinds)), np.zeros(len(free)), shift, along)


def _grounded(lowered: Lowered, kind: Kind) -> np.ndarray:
    """Which sides of the components of a kind are on the ground, (count, 2)."""
    columns = [kind.integers.index(f"{side}_kind") for side in "ab"]
    return lowered.structure.meta[kind][:, columns] == GROUND


def _gravity(lowered: Lowered) -> np.ndarray:
    """The gravity that acts on each component, (components, 2 or 3)."""
    weights = [np.real(data[:, kind.columns(kind.gravity)]) for kind, data in lowered.data.items() if kind.gravity]
    return np.vstack([np.zeros((0, lowered.dimension)), *weights])


def _held(lowered: Lowered) -> tuple[bool, np.ndarray]:
    """Whether a frame of the ground holds the mechanism, and the points of the ground that do, (points, 2)."""
    found, held = [np.zeros((0, 2))], False
    for kind, data in lowered.data.items():
        if not kind.holds:
            continue
        for side, grounded in zip("ab", _grounded(lowered, kind).T, strict=True):
            held = held or (kind.holds_frame and bool(np.any(grounded)))
            found.append(data[grounded][:, kind.columns((f"{side}_x", f"{side}_y"))])
    return held, np.vstack(found)
