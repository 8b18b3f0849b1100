r"""Compiled: Fourier coefficients of contact forces, from samples with corrections at the events between them.

Displacements are trigonometric polynomials. Between events the force of a contact in one direction is one as well:

    stuck:      f = k (u - z), z constant
    slipping:   f = ±mu N,     N = N0 + k_n (u_N - g)
    separated:  f = 0

An event, a zero of a trigonometric polynomial, ends a piece: the trial force reaches mu N, the sliding stops, N passes
zero. The slider goes from event to event, so that its place is exact. The force is continuous and its derivatives jump
at events. With h the interval of samples, θ the part of its interval at which an event lies, s_j the jumps of the j-th
derivative of force times wave, and B_j the Bernoulli polynomials, Euler's and Maclaurin's sum adds to the sum of the
samples, at each event,

    s_1 h² B_2(θ)/2 - s_2 h³ B_3(θ)/6 + s_3 h⁴ B_4(θ)/24,

and leaves an error of the fifth order. The sum is once differentiable in the displacements, unlike that of the samples
alone, which has a kink for each sample that changes its state.

Comparisons are of real parts: in complex arithmetic an imaginary part is a direction of differentiation.
"""

import numpy as np

from dalembert.kernels.arithmetic import Numbers2, Numbers3, kernels
from dalembert.kernels.blas import product
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Bytes2, Integers, Reals2, Reals3, Reals4
from dalembert.vibration.dense import dot
from dalembert.vibration.laws.friction_law import FRICTION, GAP, LOAD, NORMAL, SEPARATED, SLIPPING, STUCK, TANGENTIAL

MOST = 12
"""Events in an interval of samples; a force that changes more often is not resolved by its samples."""
REFINEMENTS = 60
"""Of a zero, at most: bisections that end at rounding."""
LEAST = 1e-14
"""Value of a signal, as part of its amplitude, that is zero."""
SETTLED = 1e-9
"""Newton step of an angle after which a zero is known to rounding."""

#: Rows of signals: trial force k u, limit mu N, load N.
TRIAL, LIMIT, PRESSED = range(3)


@inner
def waves(tau, orders, mean, table, rows):
    """Set rows of a table (5, coefficients) to cosines and sines at an angle, and to their derivatives."""
    if mean:
        for row in range(rows):
            table[row, 0] = 1.0 if row == 0 else 0.0
    cosine, sine = np.cos(tau), np.sin(tau)
    c, s, reached = cosine, sine, 1
    for number in range(mean, len(orders)):
        order = orders[number]
        while reached < order:
            c, s, reached = c * cosine - s * sine, s * cosine + c * sine, reached + 1
        at = mean + 2 * (number - mean)
        table[0, at], table[0, at + 1] = c, s
        table[1, at], table[1, at + 1] = -order * s, order * c
        for row in range(2, rows):
            table[row, at] = -order * order * table[row - 2, at]
            table[row, at + 1] = -order * order * table[row - 2, at + 1]


@inner
def value(weights, values, order):
    """A combination of signals, or of their derivatives of an order, from their values (orders, signals)."""
    return weights[0] * values[order, 0] + weights[1] * values[order, 1] + weights[2] * values[order, 2]


@inner
def evaluate(signals, constants, table, values):
    """Set values (orders, signals) of the signals (signals, coefficients) from a table of waves."""
    for order in range(len(values)):
        for row in range(3):
            values[order, row] = dot(signals[row], table[order])
    for row in range(3):
        values[0, row] += constants[row]


@inner
def zero(weights, shift, order, low, high, rising, orders, mean, signals, constants, table, values):
    """The zero of a combination of signals between two angles; ``rising`` says whether it grows through zero."""
    place = 0.5 * (low + high)
    for _ in range(REFINEMENTS):
        waves(place, orders, mean, table, order + 2)
        size, slope = shift, 0.0 * shift
        for row in range(3):
            if weights[row] != 0.0:
                size += weights[row] * dot(signals[row], table[order])
                slope += weights[row] * dot(signals[row], table[order + 1])
                size += weights[row] * constants[row] if order == 0 else 0.0
        if (size.real > 0.0) == rising:
            high = place
        else:
            low = place
        trial = place - size.real / slope.real if slope.real != 0.0 else low
        if not low < trial < high:
            trial = 0.5 * (low + high)
        close = abs(trial - place) <= SETTLED
        place = trial
        if close:  # Newton's next step would be the square of this one
            break
    return place


@inner
def crossing(
    weights, shift, order, begin, end, here, there, least, orders, mean, signals, constants, table, values
):  # fmt: skip
    """The first angle after ``begin`` where a combination of signals becomes positive, or a negative number.

    ``here`` and ``there`` are the values (orders, signals) at both ends. Of two zeros between them the first is found
    by the maximum that they enclose. What is not larger than ``least`` is zero.
    """
    high = end
    if (value(weights, there, order) + shift).real <= least:
        rise, fall = value(weights, here, order + 1).real, value(weights, there, order + 1).real
        if not (rise > 0.0 and fall < 0.0):
            return -1.0
        high = zero(weights, 0.0 * shift, order + 1, begin, end, False, orders, mean, signals, constants, table, values)
        waves(high, orders, mean, table, 5)
        evaluate(signals, constants, table, values)
        if (value(weights, values, order) + shift).real <= least:
            return -1.0
    return zero(weights, shift, order, begin, high, True, orders, mean, signals, constants, table, values)


@inner
def slope_of(weights, order, numbers, table, tangents, normal, gradient):
    """Set the gradient (unknowns,) of a combination of signals by the displacements' coefficients."""
    count = table.shape[1]
    for j in range(tangents * count):
        gradient[j] = weights[0] * numbers[TANGENTIAL] * table[order, j]
    if normal:
        rise = numbers[NORMAL] * (weights[1] * numbers[FRICTION] + weights[2])
        for j in range(count):
            gradient[tangents * count + j] = rise * table[order, j]


@inner
def add_correction(
    weights, numbers, h, theta, tangents, normal, table, values, result, slopes, move, gradient
):  # fmt: skip
    """Add the correction for an event at which the force jumps by a combination of signals.

    To its coefficients (coefficients,), and their derivatives (coefficients, unknowns) if there are any; ``move``
    (unknowns,) is the derivative of the event's angle.
    """
    count = table.shape[1]
    b1 = theta - 0.5
    b2 = (theta * theta - theta + 1.0 / 6.0) * 0.5 * h * h
    b3 = -(theta * theta * theta - 1.5 * theta * theta + 0.5 * theta) * h * h * h / 6.0
    b4 = (
        (theta * theta * theta * theta - 2.0 * theta * theta * theta + theta * theta - 1.0 / 30.0)
        * h
        * h
        * h
        * h
        / 24.0
    )
    f1, f2, f3 = value(weights, values, 1), value(weights, values, 2), value(weights, values, 3)
    own, first, second = b2 * f1 + b3 * f2 + b4 * f3, 2.0 * b3 * f1 + 3.0 * b4 * f2, 3.0 * b4 * f1
    for j in range(count):
        result[j] += own * table[0, j] + first * table[1, j] + second * table[2, j]
    if not len(move):
        return
    for order in range(1, 4):
        slope_of(weights, order, numbers, table, tangents, normal, gradient)
        for i in range(count):
            if order == 1:
                factor = b2 * table[0, i] + 2.0 * b3 * table[1, i] + 3.0 * b4 * table[2, i]
            elif order == 2:
                factor = b3 * table[0, i] + 3.0 * b4 * table[1, i]
            else:
                factor = b4 * table[0, i]
            for j in range(len(gradient)):
                slopes[i, j] += factor * gradient[j]
    # by the angle: the derivative of a Bernoulli term is the one before, b1 h, -b2, -b3
    f4 = value(weights, values, 4)
    own_rate = b1 * h * f1 + b4 * f4
    first_rate = 2.0 * (-b2 * f1 + b3 * f2) + 3.0 * (-b3 * f2 + b4 * f3)
    second_rate = 3.0 * (-b3 * f1 + b4 * f2)
    for i in range(count):
        along = own_rate * table[0, i] + first_rate * table[1, i] + second_rate * table[2, i]
        along += own * table[1, i] + first * table[2, i] + second * table[3, i]
        for j in range(len(move)):
            slopes[i, j] += along * move[j]


@inner
def entered(values, memory):
    """Direction in which a contact slips on from its limit, 0 if it sticks.

    From the rates of trial force and limit if the slider follows, else from the trial force.
    """
    if not memory:
        return 1.0 if values[0, TRIAL].real > 0.0 else -1.0
    rate, limit = values[1, TRIAL].real, values[1, LIMIT].real
    if rate - limit > 0.0:
        return 1.0
    return -1.0 if -rate - limit > 0.0 else 0.0


@inner
def march(
    numbers, tangents, normal, memory, orders, mean, synthesis, grid, signals, constants, forces, states, result,
    sampled, slopes, table, values, here, there, place, move, gradient,
):  # fmt: skip
    """One contact over its periodic motion, from event to event.

    Writes the forces at samples (columns, samples), the states (samples,) and the corrections (columns, coefficients)
    of integrals. If ``place`` has entries, also the derivatives of the former (columns, samples, unknowns) and of the
    latter (columns, coefficients, unknowns); ``place`` and ``move`` (unknowns,) are those of the slider and of an
    event's angle.
    """
    steps, stiffness, wanted = forces.shape[1], numbers[TANGENTIAL], len(place) > 0
    h, count, remembers = 2.0 * np.pi / steps, synthesis.shape[1], memory and tangents == 1
    least, nothing = 0.0, 0.0 * numbers[LOAD]
    for row in range(3):
        size = abs(constants[row])
        for j in range(count):
            size += abs(signals[row, j])
        least = max(least, LEAST * size)
    for order in range(3):
        for row in range(3):
            here[order, row] = grid[order, 0, row]
    z, sign, state = nothing, 0.0, STUCK
    if wanted:
        place[:] = 0.0
    if normal and here[0, PRESSED].real <= 0.0:
        state = SEPARATED
    elif tangents == 1 and abs(here[0, TRIAL].real) > here[0, LIMIT].real:
        sign = 1.0 if here[0, TRIAL].real > 0.0 else -1.0
        state = SLIPPING
        if memory and entered(here, memory) != sign:  # at the limit, on the way back
            state, z = STUCK, (here[0, TRIAL] - sign * here[0, LIMIT]) / stiffness
            if wanted:
                for j in range(count):
                    table[0, j] = synthesis[0, j]
                slope_of((1.0, -sign, 0.0), 0, numbers, table, tangents, normal, place)
                for j in range(len(place)):
                    place[j] /= stiffness
    for period in range(2):
        last, moved = period == 1 or not remembers, state != STUCK
        for column in range(len(result)):
            for j in range(count):
                result[column, j] = nothing
        if wanted:
            slopes[:] = 0.0
            sampled[:] = 0.0
        for t in range(steps):
            begin, end, after = t * h, (t + 1) * h, (t + 1) % steps
            for order in range(3):
                for row in range(3):
                    here[order, row] = grid[order, t, row]
                    there[order, row] = grid[order, after, row]
            states[t] = state
            if tangents == 1:
                forces[0, t] = nothing
                if state == STUCK:
                    forces[0, t] = here[0, TRIAL] - stiffness * z
                elif state == SLIPPING:
                    forces[0, t] = sign * here[0, LIMIT]
                if wanted and state == STUCK:
                    for j in range(len(place)):
                        sampled[0, t, j] = -stiffness * place[j]
                    for j in range(count):
                        sampled[0, t, j] += stiffness * synthesis[t, j]
                if wanted and state == SLIPPING and normal:
                    for j in range(count):
                        sampled[0, t, count + j] = sign * numbers[FRICTION] * numbers[NORMAL] * synthesis[t, j]
            if normal:
                forces[tangents, t] = -numbers[LOAD]
                if state != SEPARATED:
                    forces[tangents, t] = here[0, PRESSED] - numbers[LOAD]
                    if wanted:
                        for j in range(count):
                            sampled[tangents, t, tangents * count + j] = numbers[NORMAL] * synthesis[t, j]
            for _ in range(MOST):
                # the event that ends this piece: where a combination of signals grows through zero
                event, weights, shift, order, side = -1.0, (0.0, 0.0, 0.0), nothing, 0, 0.0
                if state == STUCK and tangents == 1:
                    for direction in range(2):
                        turn = 1.0 - 2.0 * direction
                        own, offset = (turn, -1.0, 0.0), -turn * stiffness * z
                        at = crossing(
                            own, offset, 0, begin, end, here, there, least, orders, mean, signals, constants, table,
                            values,
                        )  # fmt: skip
                        if at >= 0.0 and (event < 0.0 or at < event):
                            event, weights, shift, side = at, own, offset, turn
                if state == SLIPPING:
                    order = 1 if memory else 0
                    weights = (-sign, 1.0, 0.0)
                    event = crossing(
                        weights, shift, order, begin, end, here, there, least, orders, mean, signals, constants, table,
                        values,
                    )  # fmt: skip
                opens = False
                if normal:
                    own = (0.0, 0.0, 1.0 if state == SEPARATED else -1.0)
                    at = crossing(
                        own, nothing, 0, begin, end, here, there, least, orders, mean, signals, constants, table, values
                    )  # fmt: skip
                    if at >= 0.0 and (event < 0.0 or at < event):
                        event, weights, shift, order, opens = at, own, nothing, 0, True
                if event < 0.0:
                    break
                moved = True
                waves(event, orders, mean, table, 5)
                evaluate(signals, constants, table, values)
                error, slope = value(weights, values, order) + shift, value(weights, values, order + 1)
                angle = event + nothing
                if abs(error) < 1e-6 * h * abs(slope):  # Newton's last step carries directions of differentiation
                    angle = event - error / slope
                    waves(angle, orders, mean, table, 5)
                    evaluate(signals, constants, table, values)
                if wanted:
                    slope_of(weights, order, numbers, table, tangents, normal, move)
                    for j in range(len(move)):
                        own_shift = stiffness * side * place[j] if state == STUCK and not opens else 0.0
                        move[j] = -(move[j] - own_shift) / slope if slope != 0.0 else 0.0
                # what comes next, and by what combination of signals the tangential force jumps
                before = (1.0, 0.0, 0.0) if state == STUCK else (0.0, sign, 0.0)
                if state == SEPARATED:
                    before = (0.0, 0.0, 0.0)
                    sign = entered(values, memory) if tangents == 1 else 0.0
                    state = STUCK if sign == 0.0 else SLIPPING
                    if tangents == 1 and memory and state == STUCK:
                        z = values[0, TRIAL] / stiffness
                        if wanted:
                            slope_of((1.0, 0.0, 0.0), 0, numbers, table, tangents, normal, place)
                            for j in range(len(place)):
                                place[j] = (place[j] + values[1, TRIAL] * move[j]) / stiffness
                elif opens:
                    state, sign = SEPARATED, 0.0
                elif state == STUCK:
                    state, sign = SLIPPING, side
                else:
                    state = STUCK
                    if memory:
                        z = (values[0, TRIAL] - sign * values[0, LIMIT]) / stiffness
                        if wanted:
                            slope_of((1.0, -sign, 0.0), 0, numbers, table, tangents, normal, place)
                            for j in range(len(place)):
                                place[j] /= stiffness
                if last:
                    theta = (angle - t * h) / h
                    follows = (1.0, 0.0, 0.0) if state == STUCK else (0.0, sign, 0.0)
                    if state == SEPARATED:
                        follows = (0.0, 0.0, 0.0)
                    if tangents == 1:
                        jump = (follows[0] - before[0], follows[1] - before[1], 0.0)
                        add_correction(
                            jump, numbers, h, theta, tangents, normal, table, values, result[0], slopes[0], move,
                            gradient,
                        )  # fmt: skip
                    if opens:
                        jump = (0.0, 0.0, -1.0 if state == SEPARATED else 1.0)
                        add_correction(
                            jump, numbers, h, theta, tangents, normal, table, values, result[tangents],
                            slopes[tangents], move, gradient,
                        )  # fmt: skip
                for row in range(3):
                    for level in range(3):
                        here[level, row] = values[level, row]
                begin = event
        if not (remembers and moved):
            break


@inner
def prepare(d, numbers, tangents, normal, orders, mean, table, signals, constants, waving, grid):
    """Set the signals of a contact from its displacements (columns, coefficients), and their values at samples."""
    count = d.shape[1]
    for row in range(3):
        constants[row] = 0.0 * numbers[LOAD]
        for j in range(count):
            signals[row, j] = 0.0 * numbers[LOAD]
    for j in range(tangents * count):
        signals[TRIAL, j] = numbers[TANGENTIAL] * d[0, j]
    constants[PRESSED] = numbers[LOAD]
    if normal:
        constants[PRESSED] -= numbers[NORMAL] * numbers[GAP]
        for j in range(count):
            signals[PRESSED, j] = numbers[NORMAL] * d[tangents, j]
    if tangents == 1:
        constants[LIMIT] = numbers[FRICTION] * constants[PRESSED]
        for j in range(count):
            signals[LIMIT, j] = numbers[FRICTION] * signals[PRESSED, j]
    for order in range(3):
        for t in range(grid.shape[1]):
            for row in range(3):
                grid[order, t, row] = 0.0 if order else constants[row]
            if tangents == 1:
                grid[order, t, TRIAL] += dot(signals[TRIAL], waving[order, t])
            if normal:
                load = dot(signals[PRESSED], waving[order, t])
                grid[order, t, PRESSED] += load
                grid[order, t, LIMIT] += numbers[FRICTION] * load if tangents == 1 else 0.0


def _sums(
    displacements: Numbers3, numbers: Numbers2, tangents: int, normal: bool, memory: bool, orders: Integers, mean: int,
    waving: Reals3, grid: Numbers3, room: Numbers2, small: Numbers3, slopes: Numbers3, forces: Numbers3,
    states: Bytes2, result: Numbers3,
) -> None:  # fmt: skip
    signals, table = room[:3], room[3:8]
    constants, values, here, there = small[0, 0], small[1], small[2], small[3]
    for c in range(len(displacements)):
        prepare(displacements[c], numbers[c], tangents, normal, orders, mean, table, signals, constants, waving, grid)
        march(
            numbers[c], tangents, normal, memory, orders, mean, waving[0], grid, signals, constants, forces[c],
            states[c], result[c], slopes, slopes, table, values, here, there, slopes[0, 0], slopes[0, 0], slopes[0, 0],
        )  # fmt: skip


sums_real, sums_complex = kernels(_sums)


@kernel
def sums_and_slopes(
    numbers: Reals2, tangents: int, normal: bool, memory: bool, orders: Integers, mean: int, waving: Reals3,
    analysis: Reals2, gemm: Address, displacements: Reals3, grid: Reals3, room: Reals2, small: Reals3, sampled: Reals3,
    slopes: Reals3, given: Reals2, forces: Reals3, states: Bytes2, result: Reals3, jacobians: Reals4,
) -> None:  # fmt: skip
    signals, table = room[:3], room[3:8]
    constants, values, here, there = small[0, 0], small[1], small[2], small[3]
    count = analysis.shape[0]
    for c in range(len(displacements)):
        prepare(displacements[c], numbers[c], tangents, normal, orders, mean, table, signals, constants, waving, grid)
        march(
            numbers[c], tangents, normal, memory, orders, mean, waving[0], grid, signals, constants, forces[c],
            states[c], result[c], sampled, slopes, table, values, here, there, given[0], given[1], given[2],
        )  # fmt: skip
        for column in range(len(slopes)):
            product(gemm, analysis, sampled[column], 0.0, jacobians[c, column])
            for i in range(count):
                weight = 1.0 / (np.pi if i >= mean else 2.0 * np.pi)
                for j in range(slopes.shape[2]):
                    jacobians[c, column, i, j] += weight * slopes[column, i, j]
