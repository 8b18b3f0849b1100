r"""Compiled: one period of a contact that slips in two directions, from event to event.

With a = k_t u, the slider at z, ζ = k_t z, and L = mu N, a prime for the derivative by the phase:

    stuck:      f = a - ζ,   until |f| = L
    slipping:   f = L e(φ),  see :mod:`dalembert.vibration.laws.slip_in_plane`
    separated:  f = 0

The force's angle φ takes one step for each interval of samples, or part of one between events. An event is refined
within a step by taking it again. The slider's two numbers are ζ where it sticks, φ and nothing where it slips.

Comparisons are of real parts: in complex arithmetic an imaginary part is a direction of differentiation.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner
from dalembert.vibration.laws.event_jumps import add_slip, add_trial, correct, smooth_terms
from dalembert.vibration.laws.event_sums import MOST
from dalembert.vibration.laws.friction_law import FRICTION, LOAD, NORMAL, SEPARATED, SLIPPING, STUCK, TANGENTIAL
from dalembert.vibration.laws.signal_zeros import PRESSED, at, crossing, keep
from dalembert.vibration.laws.slip_in_plane import (
    JUMPS,
    MOVE,
    NODES,
    OPENED,
    PLACE,
    StageMemory,
    add_signal,
    carry,
    direction,
    first_slip,
    pull,
    recall_stages,
    set_stages,
    slides,
    step,
    stop_slip,
)

TURN = 1.0
"""Largest change of φ in a step; a step that turns farther is halved."""
PARTS = 1 / 64
"""Smallest step, as part of an interval."""
LAYER = 4.0
"""Samples' interval, in terms of L/|a'|, above which the higher jumps of a slipping force say nothing of its course."""


class Sums(NamedTuple):
    """What a march writes: forces at samples (columns, samples), states (samples,), corrections (columns, -).
    ``sampled`` (columns, samples, -) and ``slopes`` (columns, coefficients, -): derivatives of forces and of
    corrections by what columns of gradients are of.
    """

    forces: np.ndarray
    states: np.ndarray
    result: np.ndarray
    sampled: np.ndarray
    slopes: np.ndarray


class PlanarMarchWorkspace(NamedTuple):
    """Workspace: tables of waves (4, 5, coefficients), signals' values (7, 5, 3), stages of a step (7, 3), jumps (9,).

    ``x`` and ``seeds`` (11,): arguments of the derivatives of a slipping force; ``memory``: stages of whole intervals.
    """

    tables: np.ndarray
    small: np.ndarray
    radau: np.ndarray
    jumps: np.ndarray
    x: np.ndarray
    seeds: np.ndarray
    memory: StageMemory


@inner
def march(numbers, normal, wanted, waving, signals, state, y, sums, scratch, grads):
    """One period of a contact from a slider's state and its two numbers y; the state at the end, whose numbers y gets.

    ``grads`` holds the gradients of y. Derivatives are written if wanted.
    """
    forces, states, result, sampled, slopes = sums
    tables, small, radau, jumps, x, seeds, memory = scratch
    steps, count, friction = forces.shape[1], waving.shape[2], numbers[FRICTION]
    unknowns, h, table, values = grads.shape[1] - 3, 2.0 * np.pi / forces.shape[1], tables[3], small[1]
    here, stages, tau, grid = small[2], small[4:], grads[MOVE], memory.grid
    phi, zx, zy, nothing = y[0], y[0], y[1], 0.0 * y[0]
    result[:] = 0.0
    if wanted:
        slopes[:] = 0.0
        sampled[:] = 0.0
    follows = False  # a whole interval of slip is behind, whose stages predict those of the next one
    for t in range(steps):
        end, begin, opened, after = (t + 1) * h, t * h, t * h + nothing, (t + 1) % steps
        grads[OPENED] = 0.0
        keep(here, grid[t])
        there = grid[after]
        states[t] = state
        limit, c, s = friction * here[0, PRESSED], nothing, nothing
        forces[0, t], forces[1, t] = nothing, nothing
        if state == STUCK:
            forces[0, t], forces[1, t] = here[0, 0] - zx, here[0, 1] - zy
        elif state == SLIPPING:
            c, s = np.cos(phi), np.sin(phi)
            forces[0, t], forces[1, t] = limit * c, limit * s
        if normal:
            forces[2, t] = here[0, PRESSED] - numbers[LOAD] if state != SEPARATED else -numbers[LOAD]
        if wanted and state != SEPARATED:
            for m in range(unknowns + 2):
                if state == STUCK:
                    sampled[0, t, m], sampled[1, t, m] = -grads[PLACE, m], -grads[PLACE + 1, m]
                else:
                    # f = L e(φ): ∂f = e ∂L + L n ∂φ; here the part of φ, that of L below.
                    sampled[0, t, m], sampled[1, t, m] = -limit * s * grads[PLACE, m], limit * c * grads[PLACE, m]
            for q in range(count):
                wave = waving[0, t, q]
                if state == STUCK:
                    sampled[0, t, q] += numbers[TANGENTIAL] * wave
                    sampled[1, t, count + q] += numbers[TANGENTIAL] * wave
                if normal:
                    sampled[2, t, 2 * count + q] = numbers[NORMAL] * wave
                    if state == SLIPPING:
                        sampled[0, t, 2 * count + q] += friction * c * numbers[NORMAL] * wave
                        sampled[1, t, 2 * count + q] += friction * s * numbers[NORMAL] * wave
        for _ in range(MOST):
            # the contact opens or closes at ``stop``, unless it begins or ends to slip before
            stop, changes = end, False
            if normal:
                # Lift-off and closing are zeros of the load alone: they are found before the slip is integrated.
                weights = (0.0, 0.0, 1.0 if state == SEPARATED else -1.0)
                found = crossing(weights, nothing, 0, begin, end, here, there, signals, table, values)
                if found >= 0.0:
                    stop, changes = found, True
            exact = stop + nothing
            if changes:
                at(stop, signals, table, values)
                if abs(values[0, PRESSED]) < 1e-6 * h * abs(values[1, PRESSED]):
                    exact = stop - values[0, PRESSED] / values[1, PRESSED]
            before, event = state, changes
            if state == STUCK:
                # |f|² = L² rather than |f| = L: a polynomial of the signals, without a root that is singular at f = 0.
                # Signals where the contact opens or closes, else at the next sample.
                last = values if changes else there
                found = first_slip(begin, stop, here, last, zx, zy, friction, signals, table, small[3])
                if found >= 0.0:
                    at(found, signals, table, values)
                    size, rate = pull(values, zx, zy, friction)
                    stop, exact, event, changes = found, found + nothing, True, False
                    if abs(size) < 1e-6 * h * abs(rate):
                        exact = found - size / rate
            if state == SLIPPING:
                stopped = False
                # Column of the step's end: zero until the first step, then φ'.
                grads[PLACE, unknowns + 2] = 0.0
                while (exact - opened).real > 0.0:
                    goal, whole = exact, True
                    within = opened.real == t * h and goal.real == end and opened.imag == 0.0 and goal.imag == 0.0
                    if within:
                        recall_stages(t, opened, goal, signals, memory, tables, stages)
                    else:
                        set_stages(opened, goal, signals, tables, stages)
                    change, known = step(opened, goal, phi, friction, stages, radau, within and follows)
                    if within and follows and not known:
                        change, known = step(opened, goal, phi, friction, stages, radau, False)
                    # Radau's stages find only one branch of φ if it turns by less than about a radian in a step; halves
                    # of the step do, down to 1/64.
                    while not known or abs(change.real) > TURN:
                        if (goal - opened).real < PARTS * h:
                            break
                        goal, whole = nothing + 0.5 * (goal.real + opened.real), False
                        set_stages(opened, goal, signals, tables, stages)
                        change, known = step(opened, goal, phi, friction, stages, radau, False)
                    # a'·e < L': the slider would go backwards at the end of the step, so it has stopped before. Both
                    # inner stages are looked at too, since it may stop and start again between.
                    late = slides(stages, radau, 2, friction) < 0.0
                    for j in range(2):
                        if not late and slides(stages, radau, j, friction) < 0.0:
                            early = nothing + opened.real + NODES[j] * (goal - opened).real
                            set_stages(opened, early, signals, tables, stages)
                            change, known = step(opened, early, phi, friction, stages, radau, False)
                            late = slides(stages, radau, 2, friction) < 0.0
                            if late:
                                goal = early
                            else:
                                set_stages(opened, goal, signals, tables, stages)
                                change, known = step(opened, goal, phi, friction, stages, radau, False)
                    if late:
                        # The end of slip is a zero of a'·e - L' along the numerical solution: the step is taken again
                        # with each trial of its length, so that the end is that of the step, and its derivative exact.
                        goal = opened + stop_slip(opened, goal, phi, friction, signals, tables, stages, radau)
                        stopped = True
                        set_stages(opened, goal, signals, tables, stages)
                        change, known = step(opened, goal, phi, friction, stages, radau, False)
                    carry(opened, goal, numbers, normal, wanted, tables, stages, radau, grads)
                    phi, opened, follows = phi + change, goal, within and whole and not late
                    if whole or stopped:
                        break
                if stopped:
                    stop, exact, event, changes = opened.real, opened, True, False
            if not event:
                break
            follows = False
            at(exact, signals, table, values)
            c, s = np.cos(phi), np.sin(phi)
            limit, rise = friction * values[0, PRESSED], friction * values[1, PRESSED]
            # the derivative of the event's angle
            # dτ/dU = -ψ_U/ψ' of the event's function ψ: the load, |f|² - L², or a'·e - L'.
            tau[:] = 0.0
            if changes:
                if wanted:
                    add_signal(tau, PRESSED, 0, -1.0 / values[1, PRESSED], numbers, table)
            elif state == STUCK:
                fx, fy = values[0, 0] - zx, values[0, 1] - zy
                _, rate = pull(values, zx, zy, friction)
                for m in range(unknowns + 2):
                    tau[m] = 2.0 * (fx * grads[PLACE, m] + fy * grads[PLACE + 1, m]) / rate
                if wanted:
                    add_signal(tau, 0, 0, -2.0 * fx / rate, numbers, table)
                    add_signal(tau, 1, 0, -2.0 * fy / rate, numbers, table)
                    if normal:
                        add_signal(tau, PRESSED, 0, 2.0 * limit * friction / rate, numbers, table)
            else:
                across = c * values[1, 1] - s * values[1, 0]
                rate = values[2, 0] * c + values[2, 1] * s - friction * values[2, PRESSED]
                rate += across * grads[PLACE, unknowns + 2]
                for m in range(unknowns + 2):
                    tau[m] = -across * grads[PLACE, m] / rate
                if wanted:
                    add_signal(tau, 0, 1, -c / rate, numbers, table)
                    add_signal(tau, 1, 1, -s / rate, numbers, table)
                    if normal:
                        add_signal(tau, PRESSED, 1, friction / rate, numbers, table)
            if state == SLIPPING:
                for m in range(unknowns + 2):
                    grads[PLACE, m] += grads[PLACE, unknowns + 2] * tau[m]
            # the jumps
            jumps[:] = 0.0
            grads[JUMPS:] = 0.0
            size = np.hypot(values[1, 0].real, values[1, 1].real)
            # Where L = 0 the angle has fewer derivatives: before lift-off it tends to its end with a power of the time
            # left, which need not be whole, so that the order falls to about two.
            terms = smooth_terms(values, friction, size) if changes else (3 if limit.real * LAYER > h * size else 0)
            if before == STUCK:
                for row in range(2):
                    add_trial(-1.0, row, row, numbers, wanted, table, values, jumps, grads)
            elif before == SLIPPING:
                add_slip(-1.0, phi, terms, numbers, normal, wanted, table, values, x, seeds, jumps, grads)
            # what comes next
            if before == SEPARATED:
                state = SLIPPING if size > rise.real else STUCK
            elif changes:
                state = SEPARATED
            else:
                state = SLIPPING if before == STUCK else STUCK
            if state == SLIPPING:
                # A contact that closes has no force yet: it slips along the rate a' of the trial force.
                order = 1 if before == SEPARATED else 0
                fx, fy = values[order, 0], values[order, 1]
                if order == 0:
                    fx, fy = fx - zx, fy - zy
                phi = direction(fx, fy)
                c, s = np.cos(phi), np.sin(phi)
                part = c * fx + s * fy
                turn = (c * values[order + 1, 1] - s * values[order + 1, 0]) / part
                for m in range(unknowns + 2):
                    moved = (s * grads[PLACE, m] - c * grads[PLACE + 1, m]) / part if order == 0 else nothing
                    grads[PLACE, m] = moved + turn * tau[m]
                if wanted:
                    add_signal(grads[PLACE], 0, order, -s / part, numbers, table)
                    add_signal(grads[PLACE], 1, order, c / part, numbers, table)
                add_slip(1.0, phi, terms, numbers, normal, wanted, table, values, x, seeds, jumps, grads)
            elif state == STUCK:
                if before == SEPARATED:
                    limit, rise = nothing, nothing
                # ζ = a - L e(φ): the force is continuous where slip ends.
                zx, zy = values[0, 0] - limit * c, values[0, 1] - limit * s
                for m in range(unknowns + 2):
                    angle = grads[PLACE, m] if before == SLIPPING else nothing
                    grads[PLACE, m] = limit * s * angle + (values[1, 0] - rise * c) * tau[m]
                    grads[PLACE + 1, m] = -limit * c * angle + (values[1, 1] - rise * s) * tau[m]
                if wanted:
                    add_signal(grads[PLACE], 0, 0, 1.0, numbers, table)
                    add_signal(grads[PLACE + 1], 1, 0, 1.0, numbers, table)
                    if normal and before == SLIPPING:
                        add_signal(grads[PLACE], PRESSED, 0, -friction * c, numbers, table)
                        add_signal(grads[PLACE + 1], PRESSED, 0, -friction * s, numbers, table)
                for row in range(2):
                    add_trial(1.0, row, row, numbers, wanted, table, values, jumps, grads)
            if state == SEPARATED:
                grads[PLACE] = 0.0
            if state != STUCK:
                grads[PLACE + 1] = 0.0
            theta = (exact - t * h) / h
            for row in range(2):
                # Both tangential forces jump in their derivatives at any event of slip, the load only where the contact
                # opens or closes.
                correct(row, 2, h, theta, wanted, table, jumps, grads, result[row], slopes[row])
            if changes:
                sign = -1.0 if state == SEPARATED else 1.0
                add_trial(sign, PRESSED, 6, numbers, wanted, table, values, jumps, grads)
                correct(6, 1, h, theta, wanted, table, jumps, grads, result[2], slopes[2])
            keep(here, values)
            for m in range(unknowns + 2):
                grads[OPENED, m] = tau[m]
            begin, opened = stop, exact
    y[0], y[1] = nothing, nothing
    if state == STUCK:
        y[0], y[1] = zx, zy
    elif state == SLIPPING:
        y[0] = phi
    return state
