r"""The linearised motion over a period, step by step in time: Floquet multipliers where laws have a memory.

Disturbances of displacements, velocities and sliders are carried along the balanced motion by the trapezoidal rule

.. math:: M \frac{v_+ - v}{h} + C \frac{v_+ + v}{2} + K \frac{y_+ + y}{2} + L^T \frac{\lambda_+ + \lambda}{2} = 0,
          \qquad y_+ - y = h \frac{v_+ + v}{2},

which neither damps nor excites by itself. Elements add what their linearised laws at each sample say, sliders with
their memory. A rigid contact that sticks or is closed holds its coordinates, and where it begins to hold, it takes
their velocities by an impulse; one that slips feels its normal force alone. Coordinates without mass are in balance at
the end of each step.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import cholesky

from dalembert.errors import InputError
from dalembert.vibration.balance.uncondensed import Uncondensed
from dalembert.vibration.interface.lowering import ELASTIC
from dalembert.vibration.laws.friction_law import FRICTION, SEPARATED, STUCK
from dalembert.vibration.stability.element_slopes import Laws, changes, element_slopes, gathered

MEMORY = 4_000_000
"""Numbers that the steps made at once may have."""


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
    mass, combination = system.matrices[1], system.lowered.coordinates.combination
    light = _massless(mass)
    parts = list(element_slopes(system.lowered, system.series, combination @ unknowns, omega))
    constraints = _held(system, linear, unknowns, omega)
    n, samples = len(mass), system.series.samples
    states = 2 * n + sum(part.laws.keeping.shape[1] for part in parts)
    # Between changes, friction in one direction repeats the same step.
    begun = changes(parts, samples)
    for values in (constraints.active, constraints.push):
        begun |= np.any((values != np.roll(values, 1, axis=0)).reshape(samples, -1), axis=1)
    starts = np.flatnonzero(begun)
    lengths = np.diff(np.append(starts, samples))
    result, chunk = np.eye(states), max(1, MEMORY // (states * (n + len(constraints.rows))))
    begins = constraints.active & ~np.roll(constraints.active, 1, axis=0)
    for first in range(0, len(starts), chunk):
        steps = starts[first : first + chunk]
        begin, end = (gathered(parts, len(combination), at).combined(combination) for at in (steps - 1, steps))
        matrices = _steps(system, begin, end, constraints, light, 2 * np.pi / omega / samples, steps)
        for t, step, length in zip(steps, matrices, lengths[first : first + chunk], strict=True):
            if begins[t].any():
                # The impulse acts before the step that begins to hold.
                result[n : 2 * n] = _stopped(mass, result[n : 2 * n], constraints.rows[constraints.active[t]], light)
            # Steps between two changes of a law's slopes are equal: powers by squaring.
            result = np.linalg.matrix_power(step, int(length)) @ result
    return result


def _steps(
    system: Uncondensed, begin: Laws, end: Laws, constraints: Held, light: np.ndarray, h: float, steps: np.ndarray
) -> np.ndarray:
    """Matrices (steps, states, states) from each sample's predecessor to it. ``begin``, ``end``: the laws at both."""
    stiffness, mass, damping = system.matrices
    n, q, z, r = len(mass), system.retained, end.memory.shape[2], len(constraints.rows)
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
    matrix[:, :q, :q] += end.reaction + end.damping * speeds
    matrix[:, n:, :q] = np.where(constraints.active[steps, :, None], constraints.rows, 0.0)
    matrix[:, :q, n:] = np.swapaxes(constraints.push[steps], 1, 2)
    # Rows that do not hold have a unit equation for their multiplier, so that the matrix has one size for all steps.
    matrix[:, np.arange(n, n + r), np.arange(n, n + r)] = ~constraints.active[steps]
    right[:, :n, :n] = carried - stiffness * heavy[:, None]
    right[:, :q, :q] -= begin.stiffness * heavy[:q, None]
    right[:, :q, :q] += end.damping * speeds
    right[:, :n, n : 2 * n] = 4 / h * mass
    right[:, :q, n : n + q] += end.damping - begin.ended * heavy[:q, None]
    right[:, :q, 2 * n :] = -end.memory - begin.release * heavy[:q, None]
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
    result[:, 2 * n :] = end.following @ places[:, :q] + end.turning @ rates
    result[:, 2 * n :, 2 * n :] += end.keeping
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
