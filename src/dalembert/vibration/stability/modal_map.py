r"""The linearised motion over a period by receptances: disturbances of the modes of the structure whose contacts stick.

With a the rows of the elements that do not do what their reference says, W the modes there, and d the disturbance of
their forces beyond the reference,

.. math:: \mu \ddot\eta + \hat C \dot\eta + (1 + \hat N) \eta + W^T d = 0, \qquad u_a = W \eta - G_r d,

where :math:`G_r = G_0 - W W^T` is the compliance that the modes leave. With all modes this is exact; those whose
period has too few steps follow as in statics. Steps are those of :mod:`dalembert.vibration.stability.time_map`:
trapezoidal ones of modes with inertia, backward differences of those without; rows have no inertia apart from that of
the modes.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.lowering import Lowered
from dalembert.vibration.interface.receptances import ReceptancePoint
from dalembert.vibration.stability.element_slopes import Laws, changes, element_slopes, gathered

LIGHT = 1e-12
"""Inertia, as part of the largest, of a mode that has none."""
RESOLVED = 20
"""Steps in the period of the fastest mode whose disturbances have inertia: the error of its frequency is 1 %."""
FEWEST_MODES = 4
"""Modes that are kept, however fast they are."""
MOST_ROWS = 600
"""Rows of active elements, at most: a step costs their cube."""
MEMORY = 4_000_000
"""Numbers that the laws of the steps made at once may have."""


class Modes(NamedTuple):
    """Modes at the active rows: W (rows, modes), and G_r (rows, rows); ``inertias`` (modes,); ``damping``,
    ``stiffness`` (modes, modes); ``reference`` (rows,): stiffnesses of the rows.
    """

    shapes: np.ndarray
    compliance: np.ndarray
    inertias: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    reference: np.ndarray


def active_rows(lowered: Lowered) -> np.ndarray:
    """Return the rows of all elements of a system, in ascending order."""
    blocks = [block.rows.ravel() for block in (*lowered.blocks, *lowered.laws)]
    return np.unique(np.concatenate([np.zeros(0, dtype=int), *blocks, *(rows for rows, _ in lowered.functions)]))


def modal_map(
    lowered: Lowered, point: ReceptancePoint, series: Fourier, unknowns: np.ndarray, speed: float
) -> np.ndarray:
    """Return disturbances after a period from those before, (states, states): of the modes, their velocities, and
    internal numbers of the elements. ``lowered``: with the active elements alone; ``unknowns`` (rows, coefficients):
    the motion of all rows; ``speed``: of a rotor, rad/s.
    """
    rows, omega = active_rows(lowered), point.omega
    h = 2 * np.pi / omega / series.samples
    modes = _modes(point, rows, speed, h)
    parts = [
        replace(part, rows=np.searchsorted(rows, part.rows))
        for part in element_slopes(lowered, series, unknowns, omega)
    ]
    rated = any(np.any(part.laws.damping) or np.any(part.laws.turning) for part in parts)
    starts = np.flatnonzero(changes(parts, series.samples))
    lengths = np.diff(np.append(starts, series.samples))
    chunk = max(1, MEMORY // max(1, 4 * len(rows) ** 2))
    result: np.ndarray | None = None
    for first in range(0, len(starts), chunk):
        places = starts[first : first + chunk]
        laws, before = gathered(parts, len(rows), places), gathered(parts, len(rows), places[:1] - 1)
        if result is None:
            result = _begin(modes, before, rated)
        for number, length in enumerate(lengths[first : first + chunk]):
            step = _step(modes, Laws(*(part[number] for part in laws)), rated, h)
            result = np.linalg.matrix_power(step, int(length)) @ result
    assert result is not None  # a period has a step
    # Forces on the modes follow from the other states where no law sees velocities.
    return result[: result.shape[1]]


def _modes(point: ReceptancePoint, rows: np.ndarray, speed: float, h: float) -> Modes:
    """The modes at some rows that steps h resolve."""
    stuck = point.stuck
    full = {name: np.diag(part) if part.ndim == 1 else part for name, part in stuck.damping.items()}
    # ω = 1/√μ, and 2π/ω is at least `RESOLVED` steps; a mode without inertia may have damping.
    slow = stuck.inertias >= (RESOLVED * h / (2 * np.pi)) ** 2
    slow[:FEWEST_MODES] = True
    light = stuck.inertias <= LIGHT * stuck.inertias.max(initial=0.0)
    kept = np.flatnonzero(slow | (light & np.any([np.any(part, axis=1) for part in full.values()], axis=0)))
    shapes = stuck.row_shapes[np.ix_(rows, kept)]
    full = {name: part[np.ix_(kept, kept)] for name, part in full.items()}
    none = np.zeros((len(kept), len(kept)))
    damping = full.get("damping", none) + speed * full.get("gyroscopic", none)
    stiffness = np.eye(len(kept)) + speed * full.get("circulatory", none)
    compliance = stuck.compliance[np.ix_(rows, rows)] - shapes @ shapes.T
    return Modes(shapes, compliance, stuck.inertias[kept], damping, stiffness, stuck.reference[rows])


def _begin(modes: Modes, laws: Laws, rated: bool) -> np.ndarray:
    """States (η, η', z, Wᵀ d) at the begin of a period from the independent ones among them, (states, independent).

    ``rated``: whether laws see velocities, so that z has the places of the rows, too, and all states count as such.
    """
    count, internal = modes.shapes.shape[1], laws.release.shape[2]
    if rated:
        return np.eye(3 * count + internal + len(modes.reference))
    # u = W η - G_r d with d = (S - r) u + R z at the end of a step.
    beyond = laws.stiffness[0] - np.diag(modes.reference)
    right = np.hstack([modes.shapes, np.zeros_like(modes.shapes), -modes.compliance @ laws.release[0]])
    places = np.linalg.solve(np.eye(len(beyond)) + modes.compliance @ beyond, right)
    forces = beyond @ places
    forces[:, 2 * count :] += laws.release[0]
    return np.vstack([np.eye(2 * count + internal), modes.shapes.T @ forces])


def _step(modes: Modes, laws: Laws, rated: bool, h: float) -> np.ndarray:
    """Matrix of a step of the states (η, η', z, Wᵀ d)."""
    shapes, (rows, count) = modes.shapes, modes.shapes.shape
    heavy = modes.inertias > LIGHT * modes.inertias.max(initial=0.0)
    internal = laws.keeping.shape[1] + rated * rows
    states = 3 * count + internal
    beyond, drag = laws.reaction - np.diag(modes.reference), np.zeros((rows, count))
    numbers = slice(2 * count, 2 * count + laws.keeping.shape[1])
    memory, past, seen = np.zeros((rows, states)), np.zeros((rows, states)), shapes * heavy
    memory[:, numbers] = laws.memory
    if rated:
        # v_+ = W η'_+ + (r_+ - r)/h with η'_+ = 2 (η_+ - η)/h - η', and r = u - W η, which has no inertia and is an
        # internal number, too: v_+ = u_+/h + W η_+/h + past.
        past[:, :count], past[:, count : 2 * count] = -2 / h * seen, -seen
        past[:, numbers.stop : numbers.stop + rows] = -np.eye(rows) / h
        beyond, drag, memory = beyond + laws.damping / h, laws.damping @ seen / h, memory + laws.damping @ past
    # d_+ = m u_+ + N η_+ + M s with the states s before: (1 + G_r m) u_+ = (W - G_r N) η_+ - G_r M s.
    factors = lu_factor(np.eye(rows) + modes.compliance @ beyond, check_finite=False)
    by_modes = lu_solve(factors, shapes - modes.compliance @ drag, check_finite=False)
    by_states, moved = np.zeros((rows, states)), slice(None) if rated else numbers
    by_states[:, moved] = -lu_solve(factors, modes.compliance @ memory[:, moved], check_finite=False)
    by_present, by_past = shapes.T @ (beyond @ by_modes + drag), shapes.T @ (beyond @ by_states + memory)
    # Trapezoidal rule: (4 μ/h² + 2 C/h + K) η_+ + p_+ = (4 μ/h² + 2 C/h - K) η + 4 μ/h η' - p, with p = Wᵀ d, and
    # without inertia (C/h + K) η_+ + p_+ = C/h η.
    inertias, ended = np.diag(modes.inertias * heavy), np.diag(heavy.astype(float))
    carried = 4 / h**2 * inertias + np.where(heavy, 2 / h, 1 / h)[:, None] * modes.damping
    right = -by_past
    right[:, :count] += carried - ended @ modes.stiffness
    right[:, count : 2 * count] += 4 / h * inertias
    right[:, -count:] -= ended
    places = np.linalg.solve(carried + modes.stiffness + by_present, right)
    speeds = 2 / h * ended @ places
    speeds[:, :count] -= 2 / h * ended
    speeds[:, count : 2 * count] -= ended
    displaced = by_modes @ places + by_states
    following = laws.following @ displaced
    following[:, numbers] += laws.keeping
    if rated:
        following += laws.turning @ (displaced / h + seen @ places / h + past)
        following = np.vstack([following, displaced - seen @ places])
    return np.vstack([places, speeds, following, by_present @ places + by_past])
