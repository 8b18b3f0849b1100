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

import numpy as np

from dalembert.vibration.compiled import compiled

SEPARATED, STUCK, SLIPPING = 0, 1, 2
STATES = ("separated", "stuck", "slipping")

#: Columns of a contact's numbers.
TANGENTIAL, NORMAL, GAP, FRICTION, LOAD = range(5)

SWEEPS = 200
"""Periods after which a slider in two dimensions is taken as it is; one in one dimension is exact after two."""
SETTLED = 1e-13
"""Change of a slider over a period, as part of the largest displacement, at which it is periodic."""
NEUTRAL = 1e-6
"""Determinant of 1 - ∂z(end)/∂z(start), z the slider's place, at which a slider stays wherever it starts."""


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
def _restart(kept):
    """Determinant of 1 - kept, (tangents, tangents)."""
    if len(kept) == 1:
        return 1.0 - kept[0, 0]
    return (1.0 - kept[0, 0]) * (1.0 - kept[1, 1]) - kept[0, 1] * kept[1, 0]


@compiled
def _solve(kept, right):
    """(1 - kept)⁻¹ times (tangents, columns), in place."""
    determinant = _restart(kept)
    for column in range(right.shape[1]):
        first = right[0, column]
        if len(kept) == 1:
            right[0, column] = first / determinant
        else:
            second = right[1, column]
            right[0, column] = ((1.0 - kept[1, 1]) * first + kept[0, 1] * second) / determinant
            right[1, column] = (kept[1, 0] * first + (1.0 - kept[0, 0]) * second) / determinant


@compiled
def _period(d, z, force, forces, states, kept, numbers, tangents, normal, memory):
    """One period from a slider's place: writes forces and states, moves it; how many samples do not stick.

    ``kept`` (tangents, tangents) becomes the derivative of the place at the end by that at the start.
    """
    moving = 0
    kept[:] = 0.0
    for i in range(tangents):
        kept[i, i] = 1.0
    for t in range(d.shape[1]):
        state, size = update(d[:, t], z, force, numbers, tangents, normal, memory)
        states[t] = state
        for i in range(len(force)):
            forces[i, t] = force[i]
        if state == STUCK:
            continue
        moving += 1
        if state == SEPARATED or tangents == 1:
            kept[:] = 0.0
            continue
        limit = np.hypot(force[0].real, force[1].real)
        if limit == 0.0:
            kept[:] = 0.0
            continue
        e, f, ratio = force[0].real / limit, force[1].real / limit, limit / size.real
        for j in range(tangents):
            along = e * kept[0, j] + f * kept[1, j]
            kept[0, j] = ratio * (kept[0, j] - e * along)
            kept[1, j] = ratio * (kept[1, j] - f * along)
    return moving


@compiled
def _settle(d, z, before, force, forces, states, kept, numbers, tangents, normal, memory, direct):
    """Periods until the slider returns to where it was, from z = 0, in ``before`` and ``z``.

    By the period's derivative (Newton) if ``direct``, from one period to the next if not. Returns how many samples of
    all these periods did not stick.
    """
    scale, last, moving = np.max(np.abs(d.real)), np.inf, 0
    step = np.zeros((tangents, 1), dtype=z.dtype)
    z[:] = 0.0
    for sweep in range(SWEEPS if memory else 1):
        before[:] = z
        moving += _period(d, z, force, forces, states, kept, numbers, tangents, normal, memory)
        if sweep > 0 and (tangents == 1 or _settled(z, before, scale)):
            break
        if direct and sweep > 0 and _restart(kept) > NEUTRAL:
            change = 0.0
            for i in range(tangents):
                step[i, 0] = z[i] - before[i]
                change = max(change, abs(step[i, 0].real))
            if change < last:
                _solve(kept, step)
                z[:tangents] = before[:tangents] + step[:, 0]
            last = change
    return moving


@compiled
def _balanced(d, z, before, force, forces, states, kept, numbers, tangents, normal, memory):
    """As :func:`_settle`, directly where the slider's place does not depend on its past: that, and whether it moves."""
    moving = _settle(d, z, before, force, forces, states, kept, numbers, tangents, normal, memory, True)
    forgets = _restart(kept) > NEUTRAL
    if memory and not forgets and tangents == 2:
        moving = _settle(d, z, before, force, forces, states, kept, numbers, tangents, normal, memory, False)
    return forgets, moving > 0


@compiled
def _line(d, force, states, numbers):
    """A slider in one dimension that remembers, under a constant load: the law of :func:`update` in scalars.

    Writes forces and states of the periodic motion, each (samples,). Returns whether its place does not depend on its
    past, since it slips in each period, and whether it slips at all. The second period is as the first from where both
    slip to the same side, which puts the slider in the same place.
    """
    stiffness, limit = numbers[TANGENTIAL], numbers[FRICTION] * numbers[LOAD]
    z, begins, forgets = 0.0 * d[0], False, False
    for period in range(2):
        for t in range(len(d)):
            p = stiffness * (d[t] - z)
            if abs(p.real) <= limit.real:
                force[t], states[t] = p, STUCK
                continue
            p = limit if p.real >= 0.0 else -limit
            if period > 0 and states[t] == SLIPPING and force[t] == p:
                return True, True
            force[t], states[t] = p, SLIPPING
            z = d[t] - p / stiffness
            begins, forgets = True, period > 0
        if not begins:
            break
    return forgets, begins


@compiled
def _line_slopes(states, stiffness, synthesis, slopes):
    """Derivatives of the forces of :func:`_line`, (samples, coefficients), where it slips at some time.

    A slider that sticks is where its last slip left it: its place moves as the displacement did at that sample.
    """
    last = 0
    for t in range(len(states)):
        last = t if states[t] == SLIPPING else last
    for t in range(len(states)):
        if states[t] == SLIPPING:
            slopes[t], last = 0.0, t
            continue
        for j in range(slopes.shape[1]):
            slopes[t, j] = stiffness * (synthesis[t, j] - synthesis[last, j])


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
    z, kept = np.zeros_like(displacements[0, :, 0]), np.zeros((tangents, tangents))
    before, force = np.zeros_like(z), np.zeros_like(z)
    for c in range(contacts):
        if memory and tangents == 1 and not normal:
            _line(displacements[c, 0], result[c, 0], states[c], numbers[c])
            continue
        _balanced(displacements[c], z, before, force, result[c], states[c], kept, numbers[c], tangents, normal, memory)
    return result, states


@compiled
def _slopes(d, z, force, states, moved, kept, slopes, past, numbers, tangents, normal, memory, synthesis):
    """One period's derivatives of the forces by the displacements' coefficients, (columns, samples, unknowns).

    ``moved`` (tangents, unknowns) is carried on: the derivative of the slider's place. ``kept`` becomes that of the end
    by the start, and ``past`` (tangents, samples, tangents) that of the forces by it.
    """
    count = synthesis.shape[1]
    stiffness, friction = numbers[TANGENTIAL], numbers[FRICTION]
    direction, own, unknowns = np.zeros(2), tangents * count, slopes.shape[2]
    kept[:] = 0.0
    for i in range(tangents):
        kept[i, i] = 1.0
    for t in range(d.shape[1]):
        for i in range(tangents):
            direction[i] = stiffness * (d[i, t] - z[i])
        state, size = update(d[:, t], z, force, numbers, tangents, normal, memory)
        states[t] = state
        # Loops, not expressions of arrays, which would make new arrays at each sample.
        if normal:
            rise = numbers[NORMAL] if state != SEPARATED else 0.0
            for j in range(count):
                slopes[tangents, t, own + j] = rise * synthesis[t, j]
        held = stiffness if state == STUCK or (state == SLIPPING and tangents == 2) else 0.0
        for i in range(tangents):
            for j in range(unknowns):
                slopes[i, t, j] = -held * moved[i, j]
            for j in range(count):
                slopes[i, t, i * count + j] += held * synthesis[t, j]
            for j in range(tangents):
                past[i, t, j] = -held * kept[i, j]
        if state == SLIPPING:
            for i in range(tangents):
                direction[i] /= size
            if tangents == 2:
                e, f = direction[0], direction[1]
                ratio = (force[0] * e + force[1] * f) / size
                for j in range(unknowns):
                    along = e * slopes[0, t, j] + f * slopes[1, t, j]
                    slopes[0, t, j] = ratio * (slopes[0, t, j] - e * along)
                    slopes[1, t, j] = ratio * (slopes[1, t, j] - f * along)
                for j in range(tangents):
                    along = e * past[0, t, j] + f * past[1, t, j]
                    past[0, t, j] = ratio * (past[0, t, j] - e * along)
                    past[1, t, j] = ratio * (past[1, t, j] - f * along)
            if normal:
                for i in range(tangents):
                    for j in range(own, unknowns):
                        slopes[i, t, j] += friction * direction[i] * slopes[tangents, t, j]
        if memory and state != STUCK:
            for i in range(tangents):
                for j in range(unknowns):
                    moved[i, j] = -slopes[i, t, j] / stiffness
                for j in range(count):
                    moved[i, i * count + j] += synthesis[t, j]
                for j in range(tangents):
                    kept[i, j] = -past[i, t, j] / stiffness


@compiled
def tangent(displacements, numbers, tangents, normal, memory, synthesis, analysis):
    """Forces over a period, and the derivative of their harmonics by those of the displacements.

    Where the slider's place over the period does not depend on where it was before, its derivative is that of the
    periodic one, from a single period; else it is carried through all periods from rest, as the place itself.

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
    slopes, past = np.zeros((columns, samples, columns * count)), np.zeros((tangents, samples, tangents))
    moved, kept = np.zeros((tangents, columns * count)), np.zeros((tangents, tangents))
    z, before, force = np.zeros(columns), np.zeros(columns), np.zeros(columns)
    for c in range(contacts):
        d, own = displacements[c], numbers[c]
        line = memory and tangents == 1 and not normal
        forgets, moving = _line(d[0], result[c, 0], states[c], own) if line else (False, True)
        if line and forgets:
            _line_slopes(states[c], own[TANGENTIAL], synthesis, slopes[0])
            jacobians[c] = np.dot(analysis, slopes[0])
            continue
        if moving:
            forgets, moving = _balanced(d, z, before, force, result[c], states[c], kept, own, tangents, normal, memory)
        if memory and not moving:
            for i in range(columns):
                for j in range(i * count, (i + 1) * count):
                    jacobians[c, j, j] = own[TANGENTIAL] if i < tangents else own[NORMAL]
            continue
        moved[:] = 0.0
        if forgets or not memory:
            z[:] = before
            _slopes(d, z, force, states[c], moved, kept, slopes, past, own, tangents, normal, memory, synthesis)
        else:
            z[:] = 0.0
            scale = np.max(np.abs(d))
            for sweep in range(SWEEPS):
                before[:] = z
                _slopes(d, z, force, states[c], moved, kept, slopes, past, own, tangents, normal, memory, synthesis)
                if sweep > 0 and (tangents == 1 or _settled(z, before, scale)):
                    break
        for i in range(columns):
            jacobians[c, i * count : (i + 1) * count] = np.dot(analysis, slopes[i])
        if forgets and memory:
            _solve(kept, moved)
            for i in range(tangents):
                jacobians[c, i * count : (i + 1) * count] += np.dot(np.dot(analysis, past[i]), moved)
    return result, states, jacobians
