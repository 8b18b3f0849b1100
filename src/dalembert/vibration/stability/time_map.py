r"""The linearised motion over a period, step by step in time: Floquet multipliers where laws have a memory.

Disturbances of displacements, velocities and sliders are carried along the balanced motion by the trapezoidal rule

.. math:: M \frac{v_+ - v}{h} + C \frac{v_+ + v}{2} + K \frac{y_+ + y}{2} + L^T \frac{\lambda_+ + \lambda}{2} = 0,
          \qquad y_+ - y = h \frac{v_+ + v}{2},

which neither damps nor excites by itself. Elements add what their linearised laws at each sample say, sliders with
their memory. A rigid contact that sticks or is closed holds its coordinates, and where it begins to hold, it takes
their velocities by an impulse; one that slips feels its normal force alone. Coordinates without mass are in balance at
the end of each step.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.linalg import cholesky

from dalembert.errors import InputError
from dalembert.vibration.balance.uncondensed import Uncondensed
from dalembert.vibration.interface.lowering import ELASTIC
from dalembert.vibration.laws.friction_law import FRICTION, SEPARATED, STUCK, TANGENTIAL
from dalembert.vibration.laws.marched_sums import MarchedSums

MEMORY = 4_000_000
"""Numbers that the steps made at once may have."""


class Laws(NamedTuple):
    """Linearised laws on the q retained coordinates and z internal numbers, at each sample. Internal numbers are the
    places of slipping sliders, and, of other laws with a memory, their states and forces at the end of the step before.

    ``reaction`` (samples, q, q): forces at the end of a step by displacements there; ``memory`` (samples, q, z): the
    same by internal numbers at its begin; ``following`` (samples, z, q), ``keeping`` (samples, z, z): internal numbers
    at the end by the same two; ``stiffness`` (samples, q, q), ``release`` (samples, q, z): the same forces by
    displacements and internal numbers at the end, from which the next step begins; ``damping``, ``ended``
    (samples, q, q), ``turning`` (samples, z, q): forces at the end of a step, forces from which the next one begins,
    and internal numbers, by velocities there.
    """

    reaction: np.ndarray
    memory: np.ndarray
    following: np.ndarray
    keeping: np.ndarray
    stiffness: np.ndarray
    release: np.ndarray
    damping: np.ndarray
    ended: np.ndarray
    turning: np.ndarray


class Held(NamedTuple):
    """What rigid contacts may hold: rows (r, q), whether they do (samples, r), and how they push (samples, r, q)."""

    rows: np.ndarray
    active: np.ndarray
    push: np.ndarray


def monodromy(system: Uncondensed, linear: np.ndarray, unknowns: np.ndarray, omega: float) -> np.ndarray:
    """Return disturbances after a period from those before, (states, states): displacements, velocities, sliders that
    slip. ``linear``, ``unknowns`` (q, coefficients): linear part of the balance, and the motion. A coordinate that only
    together with others has a mass is refused.
    """
    mass = system.matrices[1]
    light = _massless(mass)
    laws, constraints = _laws(system, unknowns, omega), _held(system, linear, unknowns, omega)
    n, samples = len(mass), system.series.samples
    states = 2 * n + laws.memory.shape[2]
    starts = _changes(laws, constraints)
    lengths = np.diff(np.append(starts, samples))
    result, chunk = np.eye(states), max(1, MEMORY // (states * (n + len(constraints.rows))))
    begins = constraints.active & ~np.roll(constraints.active, 1, axis=0)
    for first in range(0, len(starts), chunk):
        steps = starts[first : first + chunk]
        matrices = _steps(system, laws, constraints, light, 2 * np.pi / omega / samples, steps)
        for t, step, length in zip(steps, matrices, lengths[first : first + chunk], strict=True):
            if begins[t].any():
                # The impulse acts before the step that begins to hold.
                result[n : 2 * n] = _stopped(mass, result[n : 2 * n], constraints.rows[constraints.active[t]], light)
            # Steps between two changes of a law's slopes are equal: powers by squaring.
            result = np.linalg.matrix_power(step, int(length)) @ result
    return result


def _changes(laws: Laws, constraints: Held) -> np.ndarray:
    """Samples from which steps are others than before; between them friction in one direction repeats the same."""
    samples = len(constraints.active)
    begun = np.zeros(samples, dtype=bool)
    begun[0] = True
    ended = (np.roll(laws.stiffness, 1, axis=0), np.roll(laws.release, 1, axis=0))  # where the step before ended
    ended += (np.roll(laws.ended, 1, axis=0),)
    step_arrays = laws.reaction, laws.memory, laws.following, laws.keeping, laws.damping, laws.turning
    for values in (*step_arrays, *ended, constraints.active, constraints.push):
        begun |= np.any((values != np.roll(values, 1, axis=0)).reshape(samples, -1), axis=1)
    return np.flatnonzero(begun)


def _steps(
    system: Uncondensed, laws: Laws, constraints: Held, light: np.ndarray, h: float, steps: np.ndarray
) -> np.ndarray:
    """Matrices (steps, states, states) from each sample's predecessor to it."""
    stiffness, mass, damping = system.matrices
    n, q, z, r = len(mass), system.retained, laws.memory.shape[2], len(constraints.rows)
    # Coordinates without mass follow backward differences, as the trapezoidal rule would let their velocities
    # alternate.
    carried = 4 / h**2 * mass + 2 / h * damping
    carried[light] = damping[light] / h
    heavy = ~light
    # With v_+ = 2 (y_+ - y)/h - v the rule is (4 M/h² + 2 C/h + K) y_+ + λ_+ = (4 M/h² + 2 C/h - K) y + 4 M v/h - λ,
    # bordered by the rows that hold y_+ = y; coordinates without mass: (C/h + K) y_+ + λ_+ = C y/h.
    matrix, right = np.zeros((len(steps), n + r, n + r)), np.zeros((len(steps), n + r, 2 * n + z))
    matrix[:, :n, :n] = carried + stiffness
    speeds = np.where(heavy[:q], 2 / h, 1 / h)  # by which velocities change with displacements
    matrix[:, :q, :q] += laws.reaction[steps] + laws.damping[steps] * speeds
    matrix[:, n:, :q] = np.where(constraints.active[steps, :, None], constraints.rows, 0.0)
    matrix[:, :q, n:] = np.swapaxes(constraints.push[steps], 1, 2)
    # Rows that do not hold have a unit equation for their multiplier, so that the matrix has one size for all steps.
    matrix[:, np.arange(n, n + r), np.arange(n, n + r)] = ~constraints.active[steps]
    right[:, :n, :n] = carried - stiffness * heavy[:, None]
    right[:, :q, :q] -= laws.stiffness[steps - 1] * heavy[:q, None]
    right[:, :q, :q] += laws.damping[steps] * speeds
    right[:, :n, n : 2 * n] = 4 / h * mass
    right[:, :q, n : n + q] += laws.damping[steps] - laws.ended[steps - 1] * heavy[:q, None]
    right[:, :q, 2 * n :] = -laws.memory[steps] - laws.release[steps - 1] * heavy[:q, None]
    right[:, n:, :q] = matrix[:, n:, :q]
    places = np.linalg.solve(matrix, right)[:, :n]
    result = np.zeros((len(steps), 2 * n + z, 2 * n + z))
    result[:, :n] = places
    result[:, n : 2 * n] = 2 / h * places
    result[:, np.arange(n, 2 * n), np.arange(n)] -= 2 / h
    result[:, np.arange(n, 2 * n), np.arange(n, 2 * n)] -= 1.0
    result[:, n : 2 * n] *= heavy[:, None]
    rates = speeds[:, None] * places[:, :q]
    rates[:, np.arange(q), np.arange(q)] -= speeds
    rates[:, np.arange(q), np.arange(n, n + q)] -= heavy[:q]
    result[:, 2 * n :] = laws.following[steps] @ places[:, :q] + laws.turning[steps] @ rates
    result[:, 2 * n :, 2 * n :] += laws.keeping[steps]
    return result


def _massless(mass: np.ndarray) -> np.ndarray:
    """Which coordinates have no mass, (n,)."""
    light = ~np.any(mass, axis=1)
    try:
        # Mass of the others must be positive definite: else a velocity is not determined by its momentum.
        cholesky(mass[np.ix_(~light, ~light)])
    except np.linalg.LinAlgError:
        raise InputError(
            "stability: some degrees of freedom with contacts have a mass only together with others; give each a mass"
        ) from None
    return light


def _stopped(mass: np.ndarray, velocity: np.ndarray, rows: np.ndarray, light: np.ndarray) -> np.ndarray:
    """Velocities after the impulses that stop what is held from here on."""
    held_rows = np.zeros((len(rows), len(mass)))
    held_rows[:, : rows.shape[1]] = rows
    heavy = np.flatnonzero(~light)
    held_rows = held_rows[np.any(held_rows[:, heavy], axis=1)][:, heavy]
    # v_+ = v - M⁻¹ Hᵀ (H M⁻¹ Hᵀ)⁻¹ H v, with the rows H that are held
    back = np.linalg.solve(mass[np.ix_(heavy, heavy)], held_rows.T)
    result = velocity.copy()
    result[heavy] -= back @ np.linalg.solve(held_rows @ back, held_rows @ velocity[heavy])
    return result


def _held(system: Uncondensed, linear: np.ndarray, unknowns: np.ndarray, omega: float) -> Held:
    combination, series = system.lowered.coordinates.combination, system.series
    speed = (combination @ unknowns @ series.derivative.T) @ series.synthesis.T
    rows, active, push = [], [], []
    states = system.elements(linear, unknowns, omega).evaluation.states
    for block, block_states in zip(system.lowered.blocks, states, strict=True):
        for cell, numbers, state in zip(block.rows, block.numbers, block_states, strict=True):
            if block.kind == ELASTIC:
                continue
            sliding = speed[cell[: block.tangents]].T
            sizes = np.linalg.norm(sliding, axis=1, keepdims=True)
            way = np.where((state != STUCK)[:, None], sliding / np.where(sizes > 0, sizes, 1.0), 0.0)
            for number, row in enumerate(combination[cell]):
                rows.append(row)
                active.append(state == STUCK if number < block.tangents else state != SEPARATED)
                along = (
                    0.0 if number < block.tangents else numbers[FRICTION] * way @ combination[cell[: block.tangents]]
                )
                push.append(np.where(active[-1][:, None], row + along, 0.0))
    q, samples = len(unknowns), series.samples
    if not rows:
        return Held(np.zeros((0, q)), np.zeros((samples, 0), dtype=bool), np.zeros((samples, 0, q)))
    return Held(np.array(rows), np.stack(active, axis=1), np.stack(push, axis=1))


class _Memory(NamedTuple):
    """Internal numbers of one element: the parts of :class:`Laws` that it adds, each (samples, ...)."""

    memory: np.ndarray
    following: np.ndarray
    keeping: np.ndarray
    release: np.ndarray
    turning: np.ndarray


def _laws(system: Uncondensed, unknowns: np.ndarray, omega: float) -> Laws:
    """Of all elements but rigid contacts."""
    combination, series = system.lowered.coordinates.combination, system.series
    motion = combination @ unknowns
    q, samples = unknowns.shape[0], series.samples
    reaction, damping, parts = np.zeros((samples, q, q)), np.zeros((samples, q, q)), []
    for rows, element in system.lowered.functions:
        slopes = np.moveaxis(element.law(motion[rows] @ series.synthesis.T)[1], 2, 0)
        reaction += combination[rows].T @ slopes @ combination[rows]
    stiffness, ended = reaction.copy(), damping.copy()
    for block in system.lowered.laws:
        slopes = MarchedSums(block, series, events=False).derivatives(motion[block.rows], omega)
        for element_slopes, rows in zip(slopes, block.rows, strict=True):
            seen, columns = combination[rows], len(rows)
            by_place, by_speed = (
                seen.T @ element_slopes[:, :columns, first : first + columns] @ seen for first in (0, columns)
            )
            reaction += by_place
            damping += by_speed
            if block.states:
                parts.append(_remembered(seen, element_slopes))
            else:
                stiffness += by_place
                ended += by_speed
    for block in (friction_block for friction_block in system.lowered.blocks if friction_block.kind == ELASTIC):
        columns, tangents = block.rows.shape[1], block.tangents
        slopes = MarchedSums(block.ruled, series, events=False).derivatives(motion[block.rows], omega)
        for element_slopes, rows, numbers in zip(slopes, block.rows, block.numbers, strict=True):
            seen = combination[rows]
            reaction += seen.T @ element_slopes[:, :columns, :columns] @ seen
            spring = element_slopes[:, :columns, :columns].copy()  # its force, whatever the slider did: k (u - z)
            spring[:, :tangents] = np.eye(tangents, columns) * numbers[TANGENTIAL]
            stiffness += seen.T @ spring @ seen
            # A slider that sticks at all samples keeps its place: a multiplier of 1 that says nothing, and is left out.
            if not np.allclose(
                element_slopes[:, columns:, 2 * columns :], np.eye(tangents)
            ):  # else where it rests is given
                parts.append(_slid(seen, element_slopes, numbers[TANGENTIAL]))
    ends = np.cumsum([0, *(part.keeping.shape[1] for part in parts)])
    memory, release = np.zeros((2, samples, q, ends[-1]))
    following, turning = np.zeros((2, samples, ends[-1], q))
    keeping = np.zeros((samples, ends[-1], ends[-1]))
    for part, (begin, end) in zip(parts, pairwise(ends), strict=True):
        memory[:, :, begin:end], release[:, :, begin:end] = part.memory, part.release
        following[:, begin:end], turning[:, begin:end] = part.following, part.turning
        keeping[:, begin:end, begin:end] = part.keeping
    return Laws(reaction, memory, following, keeping, stiffness, release, damping, ended, turning)


def _slid(seen: np.ndarray, slopes: np.ndarray, spring: float) -> _Memory:
    """The place of a slider, which with the displacement says the force of its spring."""
    columns = len(seen)
    following = slopes[:, columns:, :columns] @ seen
    return _Memory(
        seen.T @ slopes[:, :columns, 2 * columns :], following, slopes[:, columns:, 2 * columns :],
        np.broadcast_to(-spring * seen[: following.shape[1]].T, (len(slopes), seen.shape[1], following.shape[1])),
        np.zeros_like(following),
    )  # fmt: skip


def _remembered(seen: np.ndarray, slopes: np.ndarray) -> _Memory:
    """States of a law and its forces, from which the next step begins; no states that nothing changes."""
    columns = len(seen)
    unmoved = np.eye(slopes.shape[1] - columns, slopes.shape[2], k=2 * columns)
    moving = columns + np.flatnonzero(np.any(slopes[:, columns:] != unmoved, axis=(0, 2)))
    kept = np.concatenate([np.arange(columns), moving])
    slopes = slopes[:, kept][:, :, np.concatenate([np.arange(2 * columns), columns + moving])]
    states = len(moving)
    keeping = np.zeros((len(slopes), states + columns, states + columns))
    after = np.roll(slopes, -columns, axis=1)  # states, then forces
    keeping[:, :, :states] = after[:, :, 2 * columns :]
    unit = np.concatenate([np.zeros((states, columns)), np.eye(columns)])
    memory = np.zeros((len(slopes), seen.shape[1], states + columns))
    memory[:, :, :states] = seen.T @ slopes[:, :columns, 2 * columns :]
    return _Memory(
        memory,
        after[:, :, :columns] @ seen, keeping,
        np.broadcast_to((unit @ seen).T, (len(slopes), seen.shape[1], len(unit))),
        after[:, :, columns : 2 * columns] @ seen,
    )  # fmt: skip
