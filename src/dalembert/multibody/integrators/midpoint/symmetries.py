"""Rigid motions that the surroundings of a mechanism leave free: to each belongs a momentum that it keeps."""

from collections.abc import Sequence

import numpy as np

from dalembert.multibody.components.base_body import ANGLE, POSITION
from dalembert.multibody.components.planar.markers import GROUND
from dalembert.multibody.components.spatial.spatial_body import DIRECTOR, GRADIENT
from dalembert.multibody.integrators.midpoint.energy_balance import FreeRigidMotions
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.model.lowered import Lowered


def rigid_motions(lowered: Lowered, perturbed: Sequence[Lowered]) -> FreeRigidMotions:
    """The free translations and rotations of a mechanism, by its gravity and what holds it to the ground.
    Without any hold, those are the translations across gravity, and the rotations about it or, without gravity, about
    all axes. Pins, rods and springs at one point of the ground leave the rotations about it. What else may be free
    (along a slide) is not looked for.
    """
    kinds, dimension = np.array(lowered.structure.kinds), lowered.dimension
    held, points = _held(lowered)
    gravity = _gravity(lowered).any(axis=0)
    shifts = [axis for axis in range(dimension) if not (held or len(points) or gravity[axis])]
    at_one_point = not np.any(np.ptp(np.real(points), axis=0) if len(points) else 0.0)
    planes = _planes(gravity) if at_one_point and not held else []
    partner = np.tile(np.arange(len(kinds)), (len(shifts) + len(planes), 1))
    sign = np.zeros(partner.shape)
    first = _vectors(kinds, dimension)
    for row, (one, other) in enumerate(planes, start=len(shifts)):
        # A vector turns from the first axis of the plane to the second one: its rates are -other and +one.
        partner[row, first + one], sign[row, first + one] = first + other, -1.0
        partner[row, first + other], sign[row, first + other] = first + one, 1.0
    moved = [_shifts(entry, kinds, shifts, planes) for entry in (lowered, *perturbed)]
    along = np.array(moved[1:], dtype=complex).reshape(len(perturbed), *moved[0].shape)
    return FreeRigidMotions(partner, sign, np.ascontiguousarray(moved[0].real), along)


def _planes(gravity: np.ndarray) -> list[tuple[int, int]]:
    """Planes in which a mechanism may turn, by the axes (dimension,) along which gravity acts."""
    planes = [(0, 1)] if len(gravity) == 2 else [(1, 2), (2, 0), (0, 1)]
    return [plane for plane in planes if not gravity[list(plane)].any()]


def _vectors(kinds: np.ndarray, dimension: int) -> np.ndarray:
    """First coordinates of all vectors, of positions, slopes and directors."""
    return np.flatnonzero(np.isin(kinds, (POSITION, GRADIENT, DIRECTOR)))[::dimension]


def _shifts(
    lowered: Lowered, kinds: np.ndarray, shifts: Sequence[int], planes: Sequence[tuple[int, int]]
) -> np.ndarray:
    """What rigid motions have beside the turn of vectors about the origin, (motions, n)."""
    rows = np.zeros((len(shifts) + len(planes), len(kinds)), dtype=complex)
    places = np.flatnonzero(kinds == POSITION)[:: lowered.dimension]
    for row, axis in zip(rows, shifts, strict=False):
        row[places + axis] = 1.0
    points = _held(lowered)[1]
    at = points[0] if len(points) else np.zeros(lowered.dimension)
    for row, (one, other) in zip(rows[len(shifts) :], planes, strict=True):
        if lowered.dimension == 2:
            row[kinds == ANGLE] = 1.0
        row[places + one], row[places + other] = at[other], -at[one]
    return rows


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
    axes = "xyz"[: lowered.dimension]
    found, held = [np.zeros((0, len(axes)))], False
    for kind, data in lowered.data.items():
        if not kind.holds:
            continue
        for side, grounded in zip("ab", _grounded(lowered, kind).T, strict=True):
            held = held or (kind.holds_frame and bool(np.any(grounded)))
            found.append(data[grounded][:, kind.columns(tuple(f"{side}_{axis}" for axis in axes))])
    return held, np.vstack(found)
