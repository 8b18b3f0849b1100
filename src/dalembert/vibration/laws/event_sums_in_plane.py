r"""Compiled: the sums of :mod:`dalembert.vibration.laws.event_sums` for contacts that slip in two directions.

With a = k_t u, the slider at z, ζ = k_t z, and L = mu N, a prime for the derivative by the phase:

    stuck:      f = a - ζ,   until |f| = L
    slipping:   f = L e(φ),  see :mod:`dalembert.vibration.laws.slip_in_plane`
    separated:  f = 0

The force's angle φ takes one step for each interval of samples, or part of one between events. An event is refined
within a step by taking it again. The periodic motion of the slider is one of its two numbers at the start of the
period: ζ where it sticks, φ and nothing where it slips.

Comparisons are of real parts: in complex arithmetic an imaginary part is a direction of differentiation.
"""

import numpy as np

from dalembert.kernels.arithmetic import Numbers2, Numbers3, kernels
from dalembert.kernels.blas import product
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Bytes2, Complexes, Integers, Reals2, Reals3, Reals4
from dalembert.vibration.dense import dot
from dalembert.vibration.laws.event_jumps import add_slip, add_trial, correct, smooth_terms
from dalembert.vibration.laws.event_sums import LEAST, MOST, crossing
from dalembert.vibration.laws.friction_law import FRICTION, GAP, LOAD, NORMAL, SEPARATED, SLIPPING, STUCK, TANGENTIAL
from dalembert.vibration.laws.friction_period import NEUTRAL, SWEEPS
from dalembert.vibration.laws.friction_period import SETTLED as PERIODIC
from dalembert.vibration.laws.slip_in_plane import (
    JUMPS,
    MOVE,
    NODES,
    OPENED,
    PLACE,
    PRESSED,
    add_signal,
    at,
    carry,
    direction,
    first_slip,
    pull,
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


@inner
def march(
    numbers, normal, wanted, orders, mean, waving, signals, constants, least, state, y, forces, states, result,
    sampled, slopes, tables, small, radau, jumps, x, seeds, grads,
):  # fmt: skip
    """One period of a contact from a slider's state and its two numbers y; the state at the end, whose numbers y gets.

    Writes the forces at samples (columns, samples), the states (samples,) and the corrections (columns, coefficients);
    if wanted, their derivatives (columns, samples or coefficients, columns of gradients). ``grads`` holds those of y.
    """
    steps, count, friction = forces.shape[1], waving.shape[2], numbers[FRICTION]
    unknowns, h, table, values = grads.shape[1] - 3, 2.0 * np.pi / forces.shape[1], tables[3], small[1]
    here, there, stages, tau = small[2], small[3], small[4:], grads[MOVE]
    phi, zx, zy, nothing = y[0], y[0], y[1], 0.0 * y[0]
    for column in range(len(result)):
        for q in range(count):
            result[column, q] = nothing
    if wanted:
        slopes[:] = 0.0
        sampled[:] = 0.0
    at(0.0, orders, mean, signals, constants, table, there)
    for t in range(steps):
        end, begin, opened, after = (t + 1) * h, t * h, t * h + nothing, (t + 1) % steps
        for m in range(unknowns + 2):
            grads[OPENED, m] = 0.0
        for order in range(3):
            for row in range(3):
                here[order, row] = there[order, row]
                there[order, row] = dot(signals[row], waving[order, after])
        for row in range(3):
            there[0, row] += constants[row]
        states[t] = state
        limit, c, s = friction * here[0, PRESSED], np.cos(phi), np.sin(phi)
        forces[0, t], forces[1, t] = nothing, nothing
        if state == STUCK:
            forces[0, t], forces[1, t] = here[0, 0] - zx, here[0, 1] - zy
        elif state == SLIPPING:
            forces[0, t], forces[1, t] = limit * c, limit * s
        if normal:
            forces[2, t] = here[0, PRESSED] - numbers[LOAD] if state != SEPARATED else -numbers[LOAD]
        if wanted and state != SEPARATED:
            for m in range(unknowns + 2):
                if state == STUCK:
                    sampled[0, t, m], sampled[1, t, m] = -grads[PLACE, m], -grads[PLACE + 1, m]
                else:
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
                weights = (0.0, 0.0, 1.0 if state == SEPARATED else -1.0)
                found = crossing(
                    weights, nothing, 0, begin, end, here, there, least, orders, mean, signals, constants, table, values
                )  # fmt: skip
                if found >= 0.0:
                    stop, changes = found, True
            exact = stop + nothing
            if changes:
                at(stop, orders, mean, signals, constants, table, values)
                if abs(values[0, PRESSED]) < 1e-6 * h * abs(values[1, PRESSED]):
                    exact = stop - values[0, PRESSED] / values[1, PRESSED]
            before, event = state, changes
            if state == STUCK:
                found = first_slip(
                    begin, stop, zx, zy, friction, least * least / LEAST, orders, mean, signals, constants, table,
                    values,
                )  # fmt: skip
                if found >= 0.0:
                    at(found, orders, mean, signals, constants, table, values)
                    size, rate = pull(values, zx, zy, friction)
                    stop, exact, event, changes = found, found + nothing, True, False
                    if abs(size) < 1e-6 * h * abs(rate):
                        exact = found - size / rate
            if state == SLIPPING:
                stopped = False
                grads[PLACE, unknowns + 2] = 0.0
                while (exact - opened).real > 0.0:
                    goal, whole = exact, True
                    change, found_step = step(
                        opened, goal, phi, friction, orders, mean, signals, constants, tables, stages, radau
                    )  # fmt: skip
                    while not found_step or abs(change.real) > TURN:
                        if (goal - opened).real < PARTS * h:
                            break
                        goal, whole = nothing + 0.5 * (goal.real + opened.real), False
                        change, found_step = step(
                            opened, goal, phi, friction, orders, mean, signals, constants, tables, stages, radau
                        )  # fmt: skip
                    late = slides(stages[2], phi + change, friction).real < 0.0
                    for j in range(2):
                        if not late and slides(stages[j], radau[1, j], friction).real < 0.0:
                            early = nothing + opened.real + NODES[j] * (goal - opened).real
                            change, found_step = step(
                                opened, early, phi, friction, orders, mean, signals, constants, tables, stages, radau
                            )  # fmt: skip
                            late = slides(stages[2], phi + change, friction).real < 0.0
                            if late:
                                goal = early
                            else:
                                change, found_step = step(
                                    opened, goal, phi, friction, orders, mean, signals, constants, tables, stages,
                                    radau,
                                )  # fmt: skip
                    if late:
                        length = stop_slip(
                            opened, goal, phi, friction, orders, mean, signals, constants, tables, stages, radau
                        )  # fmt: skip
                        goal, stopped = opened + length, True
                        change, found_step = step(
                            opened, goal, phi, friction, orders, mean, signals, constants, tables, stages, radau
                        )  # fmt: skip
                    carry(opened, goal, numbers, normal, wanted, tables, stages, radau, grads)
                    phi, opened = phi + change, goal
                    if whole or stopped:
                        break
                if stopped:
                    stop, exact, event, changes = opened.real, opened, True, False
            if not event:
                break
            at(exact, orders, mean, signals, constants, table, values)
            c, s = np.cos(phi), np.sin(phi)
            limit, rise = friction * values[0, PRESSED], friction * values[1, PRESSED]
            # the derivative of the event's angle
            for m in range(unknowns + 2):
                tau[m] = 0.0
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
            if wanted:
                for k in range(9):
                    for m in range(unknowns + 2):
                        grads[JUMPS + k, m] = 0.0
            size = np.hypot(values[1, 0].real, values[1, 1].real)
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
                for m in range(unknowns + 2):
                    grads[PLACE, m] = 0.0
            if state != STUCK:
                for m in range(unknowns + 2):
                    grads[PLACE + 1, m] = 0.0
            theta = (exact - t * h) / h
            for row in range(2):
                correct(row, 2, h, theta, wanted, table, jumps, grads, result[row], slopes[row])
            if changes:
                sign = -1.0 if state == SEPARATED else 1.0
                add_trial(sign, PRESSED, 6, numbers, wanted, table, values, jumps, grads)
                correct(6, 1, h, theta, wanted, table, jumps, grads, result[2], slopes[2])
            for level in range(3):
                for row in range(3):
                    here[level, row] = values[level, row]
            for m in range(unknowns + 2):
                grads[OPENED, m] = tau[m]
            begin, opened = stop, exact
    y[0], y[1] = nothing, nothing
    if state == STUCK:
        y[0], y[1] = zx, zy
    elif state == SLIPPING:
        y[0] = phi
    return state


@inner
def prepare(d, numbers, normal, signals, constants):
    """Set the signals of a contact from its displacements (columns, coefficients); what of them is zero."""
    count, size = d.shape[1], 0.0
    constants[0], constants[1], constants[PRESSED] = 0.0, 0.0, numbers[LOAD]
    for q in range(count):
        signals[0, q], signals[1, q] = numbers[TANGENTIAL] * d[0, q], numbers[TANGENTIAL] * d[1, q]
        signals[PRESSED, q] = 0.0
    if normal:
        constants[PRESSED] -= numbers[NORMAL] * numbers[GAP]
        for q in range(count):
            signals[PRESSED, q] = numbers[NORMAL] * d[2, q]
    for row in range(3):
        total = abs(constants[row])
        for q in range(count):
            total += abs(signals[row, q])
        size = max(size, total)
    return LEAST * size


@inner
def rest(numbers, normal, wanted, orders, mean, signals, constants, table, values, y, grads):
    """State of a slider that was at zero before the period begins; sets y and its gradient."""
    unknowns, count = grads.shape[1] - 3, table.shape[1]
    at(0.0, orders, mean, signals, constants, table, values)
    y[0], y[1] = 0.0 * y[0], 0.0 * y[1]
    for row in range(2):
        for m in range(unknowns + 2):
            grads[PLACE + row, m] = 0.0
    if normal and values[0, PRESSED].real <= 0.0:
        return SEPARATED
    size = np.hypot(values[0, 0].real, values[0, 1].real)
    if size <= (numbers[FRICTION] * values[0, PRESSED]).real:
        return STUCK
    y[0] = direction(values[0, 0], values[0, 1])
    if wanted:
        c, s = np.cos(y[0]), np.sin(y[0])
        for q in range(count):
            grads[PLACE, q] = -s * numbers[TANGENTIAL] * table[0, q] / size
            grads[PLACE, count + q] = c * numbers[TANGENTIAL] * table[0, q] / size
    return SLIPPING


@inner
def begin_with(unknowns, state, grads):
    """Set the gradient of a slider's two numbers at the start of a period."""
    for row in range(2):
        for m in range(unknowns + 2):
            grads[PLACE + row, m] = 0.0
    if state != SEPARATED:
        grads[PLACE, unknowns] = 1.0
    if state == STUCK:
        grads[PLACE + 1, unknowns + 1] = 1.0


@inner
def solved(grads, unknowns, first, second):
    """(1 - K)^-1 times (first, second), and the determinant; K is the derivative of y by itself a period before."""
    a, b = 1.0 - grads[PLACE, unknowns], -grads[PLACE, unknowns + 1]
    c, d = -grads[PLACE + 1, unknowns], 1.0 - grads[PLACE + 1, unknowns + 1]
    determinant = a * d - b * c
    if determinant.real <= NEUTRAL:
        return first, second, determinant.real
    return (d * first - b * second) / determinant, (a * second - c * first) / determinant, determinant.real


@inner
def settle(
    direct, numbers, normal, wanted, orders, mean, waving, signals, constants, least, y, before, forces, states, result,
    sampled, slopes, tables, small, radau, jumps, x, seeds, grads,
):  # fmt: skip
    """Periods until the slider returns to where it was: its state there, and whether that does not depend on its past.

    By Newton's method on its two numbers if ``direct``, else from one period to the next, with gradients from rest on.
    ``before`` keeps the numbers at the start of the last period.
    """
    unknowns, scale, last, forgets = grads.shape[1] - 3, least / LEAST, np.inf, False
    state = rest(numbers, normal, wanted, orders, mean, signals, constants, tables[3], small[1], y, grads)
    first = state
    for sweep in range(SWEEPS):
        first, before[0], before[1] = state, y[0], y[1]
        if direct:
            begin_with(unknowns, state, grads)
        state = march(
            numbers, normal, wanted, orders, mean, waving, signals, constants, least, state, y, forces, states, result,
            sampled, slopes, tables, small, radau, jumps, x, seeds, grads,
        )  # fmt: skip
        if state != first:
            continue
        one, two = y[0] - before[0], y[1] - before[1]
        if state == SLIPPING:
            one -= 2.0 * np.pi * np.round(one.real / (2.0 * np.pi))
        change, aside = max(abs(one.real), abs(two.real)), max(abs(one.imag), abs(two.imag))
        step_one, step_two, determinant = solved(grads, unknowns, one, two)
        forgets = direct and determinant > NEUTRAL
        size = 1.0 if state == SLIPPING else scale
        if change <= PERIODIC * size and aside <= 1e-10 * max(abs(y[0].imag), abs(y[1].imag)):
            break
        if forgets and sweep > 0 and change < last:
            y[0], y[1] = before[0] + step_one, before[1] + step_two
        last = change
    return first, forgets


def _sums(
    displacements: Numbers3, numbers: Numbers2, normal: bool, orders: Integers, mean: int, waving: Reals3,
    signals: Numbers2, tables: Numbers3, small: Numbers3, radau: Numbers2, grads: Numbers2, vectors: Numbers2,
    seeds: Complexes, forces: Numbers3, states: Bytes2, result: Numbers3,
) -> None:  # fmt: skip
    constants, jumps, x, y, before = small[0, 0], vectors[0], vectors[1], vectors[2], vectors[3]
    for c in range(len(displacements)):
        least = prepare(displacements[c], numbers[c], normal, signals, constants)
        y[0], y[1] = 0.0, 0.0
        for direct in (True, False):
            _, forgets = settle(
                direct, numbers[c], normal, False, orders, mean, waving, signals, constants, least, y, before,
                forces[c], states[c], result[c], tables, tables, tables, small, radau, jumps, x, seeds, grads,
            )  # fmt: skip
            if forgets:
                break


sums_real, sums_complex = kernels(_sums)


@kernel
def sums_and_slopes(
    numbers: Reals2, normal: bool, orders: Integers, mean: int, waving: Reals3, analysis: Reals2, gemm: Address,
    displacements: Reals3, signals: Reals2, tables: Reals3, small: Reals3, radau: Reals2, grads: Reals2, few: Reals2,
    vectors: Reals2, seeds: Complexes, sampled: Reals3, slopes: Reals3, local: Reals2, forces: Reals3, states: Bytes2,
    result: Reals3, jacobians: Reals4,
) -> None:  # fmt: skip
    constants, jumps, x, y, before = small[0, 0], vectors[0], vectors[1], vectors[2], vectors[3]
    count, unknowns = analysis.shape[0], jacobians.shape[3]
    for c in range(len(displacements)):
        least = prepare(displacements[c], numbers[c], normal, signals, constants)
        y[0], y[1] = 0.0, 0.0
        state, forgets = settle(
            True, numbers[c], normal, False, orders, mean, waving, signals, constants, least, y, before, forces[c],
            states[c], result[c], sampled, slopes, tables, small, radau, jumps, x, seeds, few,
        )  # fmt: skip
        if forgets:
            y[0], y[1] = before[0], before[1]
            begin_with(unknowns, state, grads)
            march(
                numbers[c], normal, True, orders, mean, waving, signals, constants, least, state, y, forces[c],
                states[c], result[c], sampled, slopes, tables, small, radau, jumps, x, seeds, grads,
            )  # fmt: skip
        else:
            settle(
                False, numbers[c], normal, True, orders, mean, waving, signals, constants, least, y, before, forces[c],
                states[c], result[c], sampled, slopes, tables, small, radau, jumps, x, seeds, grads,
            )  # fmt: skip
        if forgets:
            for m in range(unknowns):
                one, two, _ = solved(grads, unknowns, grads[PLACE, m], grads[PLACE + 1, m])
                grads[MOVE, m], grads[OPENED, m] = one, two
        for column in range(len(slopes)):
            product(gemm, analysis, sampled[column], 0.0, local)
            for i in range(count):
                weight = 1.0 / (np.pi if i >= mean else 2.0 * np.pi)
                for m in range(unknowns + 2):
                    local[i, m] += weight * slopes[column, i, m]
                for m in range(unknowns):
                    jacobians[c, column, i, m] = local[i, m]
                    if forgets:
                        jacobians[c, column, i, m] += local[i, unknowns] * grads[MOVE, m]
                        jacobians[c, column, i, m] += local[i, unknowns + 1] * grads[OPENED, m]
