"""Compiled: dry friction under a variable normal load, over the samples of a period, and its exact tangent.

One contact has one or two tangential displacements and, or not, a normal one; with d the displacements, z the slider's
place, k_t and k_n stiffnesses, g the gap and N0 the initial normal load:

    N = N0 + k_n (d_N - g);   separated where N <= 0: no force, z = d_T
    p = k_t (d_T - z);        stuck where |p| <= mu N: force p
    otherwise slipping:       force mu N p/|p|, z = d_T - force/k_t

The rigid law of Coulomb and Signorini is the same function of a predicted displacement (see
:mod:`dalembert.vibration.balance`); with ``memory`` off the slider stays at zero, and d_T may be any predicted force.

Comparisons are of real parts: in complex arithmetic an imaginary part is a direction of differentiation. At a kink
(|p| = mu N, or N = 0) the derivative is the one-sided one of the stuck and of the separated branch.
"""

from typing import Any

import numpy as np
from numba import njit

# No fast-math, so that results are the same bits on every run.
_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
compiled: Any = njit(**_OPTIONS)

SEPARATED, STUCK, SLIPPING = 0, 1, 2
STATES = ("separated", "stuck", "slipping")

#: Columns of a contact's numbers.
TANGENTIAL, NORMAL, GAP, FRICTION, LOAD = range(5)

SWEEPS = 200
"""Periods after which a slider in two dimensions is taken as it is; one in one dimension is exact after two."""
SETTLED = 1e-13
"""Change of a slider over a period, as part of the largest displacement, at which it is periodic."""


@compiled
def update(d, z, force, numbers, tangents, normal, memory):
    """One sample: writes the forces (normal: N - N0), moves the slider; the state, and the size of the trial force."""
    load = numbers[LOAD]
    if normal:
        load = load + numbers[NORMAL] * (d[tangents] - numbers[GAP])
        if load.real <= 0.0:
            for i in range(tangents):
                force[i] = 0.0
                if memory:
                    z[i] = d[i]
            force[tangents] = -numbers[LOAD]
            return SEPARATED, 0.0 * load
        force[tangents] = load - numbers[LOAD]
    limit = numbers[FRICTION] * load
    stiffness = numbers[TANGENTIAL]
    for i in range(tangents):
        force[i] = stiffness * (d[i] - z[i])
    if tangents == 1:
        size = force[0] if force[0].real >= 0.0 else -force[0]
    else:
        size = np.sqrt(force[0] * force[0] + force[1] * force[1])
    if size.real <= limit.real:
        return STUCK, size
    for i in range(tangents):
        force[i] = limit * force[i] / size
        if memory:
            z[i] = d[i] - force[i] / stiffness
    return SLIPPING, size


@compiled
def _settled(z, before, scale):
    """Whether a slider has moved over a period, in either part, by no more than rounding."""
    for i in range(len(z)):
        change = z[i] - before[i]
        if abs(change.real) > SETTLED * scale or abs(change.imag) > 1e-10 * abs(z[i].imag):
            return False
    return True


@compiled
def forces(displacements, numbers, tangents, normal, memory):
    """Forces over a period, real or complex.

    Parameters
    ----------
    displacements : array, shape (contacts, tangents + normal, samples)
    numbers : array, shape (contacts, 5)
        Tangential stiffness, normal stiffness, gap, coefficient of friction, initial normal load.

    Returns
    -------
    forces : array like ``displacements``; the normal one is N - N0
    states : array of uint8, shape (contacts, samples)
    """
    contacts, _, samples = displacements.shape
    result = np.zeros_like(displacements)
    states = np.zeros((contacts, samples), dtype=np.uint8)
    for c in range(contacts):
        scale = np.max(np.abs(displacements[c].real))
        z, before = np.zeros_like(displacements[c, :, 0]), np.zeros_like(displacements[c, :, 0])
        force = np.zeros_like(z)
        for sweep in range(SWEEPS if memory else 1):
            before[:] = z
            for t in range(samples):
                states[c, t] = update(displacements[c, :, t], z, force, numbers[c], tangents, normal, memory)[0]
                result[c, :, t] = force
            if (tangents == 1 and sweep > 0) or (sweep > 0 and _settled(z, before, scale)):
                break
    return result, states


@compiled
def tangent(displacements, numbers, tangents, normal, memory, synthesis, analysis):
    """Forces over a period, and the derivative of their harmonics by those of the displacements.

    Parameters
    ----------
    displacements, numbers
        As in :func:`forces`; real.
    synthesis : array, shape (samples, coefficients)
    analysis : array, shape (coefficients, samples)

    Returns
    -------
    forces, states
        As in :func:`forces`.
    jacobians : array, shape (contacts, columns * coefficients, columns * coefficients)
    """
    contacts, columns, samples = displacements.shape
    count = synthesis.shape[1]
    result = np.zeros_like(displacements)
    states = np.zeros((contacts, samples), dtype=np.uint8)
    jacobians = np.zeros((contacts, columns * count, columns * count))
    slopes = np.zeros((columns, samples, columns * count))
    moved = np.zeros((tangents, columns * count))  # derivative of the slider's place
    row, rise = np.zeros((tangents, columns * count)), np.zeros(columns * count)
    z, before, force, direction = np.zeros(columns), np.zeros(columns), np.zeros(columns), np.zeros(columns)
    for c in range(contacts):
        scale = np.max(np.abs(displacements[c]))
        stiffness, normal_stiffness, friction = numbers[c, TANGENTIAL], numbers[c, NORMAL], numbers[c, FRICTION]
        z[:] = 0.0
        moved[:] = 0.0
        for sweep in range(SWEEPS if memory else 1):
            before[:] = z
            for t in range(samples):
                d = displacements[c, :, t]
                for i in range(tangents):
                    direction[i] = stiffness * (d[i] - z[i])
                state, size = update(d, z, force, numbers[c], tangents, normal, memory)
                states[c, t] = state
                result[c, :, t] = force
                rise[:] = 0.0
                if normal and state != SEPARATED:
                    rise[tangents * count : (tangents + 1) * count] = normal_stiffness * synthesis[t]
                if state != SEPARATED:
                    for i in range(tangents):
                        row[i] = -stiffness * moved[i]
                        row[i, i * count : (i + 1) * count] += stiffness * synthesis[t]
                if state == SLIPPING:
                    direction /= size
                    ratio = (force[0] * direction[0] + (force[1] * direction[1] if tangents == 2 else 0.0)) / size
                    if tangents == 1:
                        row[0] = friction * direction[0] * rise
                    else:
                        along = direction[0] * row[0] + direction[1] * row[1]
                        for i in range(2):
                            row[i] = friction * direction[i] * rise + ratio * (row[i] - direction[i] * along)
                elif state == SEPARATED:
                    row[:] = 0.0
                if memory and state != STUCK:
                    for i in range(tangents):
                        moved[i] = -row[i] / stiffness
                        moved[i, i * count : (i + 1) * count] += synthesis[t]
                for i in range(tangents):
                    slopes[i, t] = row[i]
                if normal:
                    slopes[tangents, t] = rise
            if (tangents == 1 and sweep > 0) or (sweep > 0 and _settled(z, before, scale)):
                break
        for i in range(columns):
            jacobians[c, i * count : (i + 1) * count] = np.dot(analysis, slopes[i])
    return result, states, jacobians
