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

from typing import NamedTuple

import numpy as np

from dalembert.kernels.arithmetic import Numbers2, Numbers3, kernels
from dalembert.kernels.blas import product
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Bytes2, Integers, Reals2, Reals3, Reals4
from dalembert.vibration.dense import dot
from dalembert.vibration.laws.friction_law import FRICTION, LOAD, NORMAL, SEPARATED, SLIPPING, STUCK, TANGENTIAL
from dalembert.vibration.laws.signal_zeros import LIMIT, PRESSED, TRIAL, at, crossing, keep, signals_of, value

MOST = 12
"""Events in an interval of samples; a force that changes more often is not resolved by its samples."""


@inner
# By the displacements at a fixed angle: the same terms with the gradients of κ', κ'' and κ'''.
def slope_of(weights, order, contact, table, gradient):
    """Set the gradient (unknowns,) of a combination of signals by the displacements' coefficients."""
    count, numbers, tangents = table.shape[1], contact.numbers, contact.tangents
    for j in range(tangents * count):
        gradient[j] = weights[0] * numbers[TANGENTIAL] * table[order, j]
    if contact.normal:
        rise = numbers[NORMAL] * (weights[1] * numbers[FRICTION] + weights[2])
        for j in range(count):
            gradient[tangents * count + j] = rise * table[order, j]


@inner
def bernoulli(theta, h):
    """The terms of Euler's and Maclaurin's sum at a part of an interval: B_1, and those of the first three jumps."""
    # B_2/2 h², -B_3/6 h³ and B_4/24 h⁴ with Bernoulli's polynomials; the trapezoidal sum has no B_1 term where the
    # force is continuous (Abramowitz and Stegun, 23.1.30).
    cube = theta * theta * theta
    b2 = (theta * theta - theta + 1.0 / 6.0) * 0.5 * h * h
    b3 = -(cube - 1.5 * theta * theta + 0.5 * theta) * h * h * h / 6.0
    b4 = (cube * theta - 2.0 * cube + theta * theta - 1.0 / 30.0) * h * h * h * h / 24.0
    return theta - 0.5, b2, b3, b4


@inner
def weights_of(state, sign):
    """The tangential force as a combination of signals; a separated contact has no sign."""
    return (1.0, 0.0, 0.0) if state == STUCK else (0.0, sign, 0.0)


@inner
def place_at_limit(sign, contact, table, place):
    """Set the gradient of the place of a slider whose force is at its limit."""
    slope_of((1.0, -sign, 0.0), 0, contact, table, place)
    for j in range(len(place)):
        place[j] /= contact.numbers[TANGENTIAL]


@inner
def add_correction(weights, contact, h, theta, table, values, result, slopes, move, gradient):
    """Add the correction for an event at which the force jumps by a combination of signals, to its coefficients
    (coefficients,), and their derivatives (coefficients, unknowns) if there are any; ``move`` (unknowns,) is the
    derivative of the event's angle.
    """
    count = table.shape[1]
    b1, b2, b3, b4 = bernoulli(theta, h)
    # With κ the jump of the force and c a wave: s_1 = κ'c, s_2 = 2κ'c' + κ''c, s_3 = 3κ'c'' + 3κ''c' + κ'''c. Sums are
    # sorted by c, c', c'' so that each wave is read once.
    f1, f2, f3 = value(weights, values, 1), value(weights, values, 2), value(weights, values, 3)
    own, first, second = b2 * f1 + b3 * f2 + b4 * f3, 2.0 * b3 * f1 + 3.0 * b4 * f2, 3.0 * b4 * f1
    for j in range(count):
        result[j] += own * table[0, j] + first * table[1, j] + second * table[2, j]
    if not len(move):
        return
    for order in range(1, 4):
        slope_of(weights, order, contact, table, gradient)
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
    # At the limit the force follows mu N if the trial force grows faster than the limit, and else it sticks: the
    # consistency condition of slip, |p|' > (mu N)'.
    rate, limit = values[1, TRIAL].real, values[1, LIMIT].real
    if rate - limit > 0.0:
        return 1.0
    return -1.0 if -rate - limit > 0.0 else 0.0


class Contact(NamedTuple):
    """A contact: its numbers (5,), its tangential directions (0 or 1), whether it has a normal one and remembers."""

    numbers: np.ndarray
    tangents: int
    normal: bool
    memory: bool


class Sums(NamedTuple):
    """What a march writes: forces at samples (columns, samples), states (samples,), corrections (columns, -).
    ``sampled`` (columns, samples, unknowns) and ``slopes`` (columns, coefficients, unknowns): derivatives of forces and
    of corrections. ``place`` and ``move`` (unknowns,): those of the slider and of an event's angle, without entries if
    no derivatives are asked for; ``gradient`` (unknowns,) is workspace.
    """

    forces: np.ndarray
    states: np.ndarray
    result: np.ndarray
    sampled: np.ndarray
    slopes: np.ndarray
    place: np.ndarray
    move: np.ndarray
    gradient: np.ndarray


class EventWorkspace(NamedTuple):
    """Workspace: a table of waves (5, coefficients), signals' values (5, 3) at an event and where a piece begins."""

    table: np.ndarray
    values: np.ndarray
    here: np.ndarray


@inner
def march(contact, signals, synthesis, grid, sums, scratch):
    """One contact over its periodic motion, from event to event; ``grid`` (samples, 3, 3): signals at samples."""
    numbers, tangents, normal, memory = contact
    forces, states, result, sampled, slopes, place, move, gradient = sums
    table, values, here = scratch
    steps, stiffness, wanted = forces.shape[1], numbers[TANGENTIAL], len(place) > 0
    h, count, remembers = 2.0 * np.pi / steps, synthesis.shape[1], memory and tangents == 1
    nothing = 0.0 * numbers[LOAD]
    keep(here, grid[0])
    z, sign, state = nothing, 0.0, STUCK
    if wanted:
        place[:] = 0.0
    if normal and here[0, PRESSED].real <= 0.0:
        state = SEPARATED
    # The first guess of the slider is zero. Its place after the first slip does not depend on this, so that a second
    # period is exact.
    elif tangents == 1 and abs(here[0, TRIAL].real) > here[0, LIMIT].real:
        sign = 1.0 if here[0, TRIAL].real > 0.0 else -1.0
        state = SLIPPING
        if memory and entered(here, memory) != sign:  # at the limit, on the way back
            state, z = STUCK, (here[0, TRIAL] - sign * here[0, LIMIT]) / stiffness
            if wanted:
                for j in range(count):
                    table[0, j] = synthesis[0, j]
                place_at_limit(sign, contact, table, place)
    # Two periods: the first forgets the guess, the second is periodic and writes the corrections. A slider that never
    # moves needs one.
    for period in range(2):
        last, moved = period == 1 or not remembers, state != STUCK
        result[:] = 0.0
        if wanted:
            slopes[:] = 0.0
            sampled[:] = 0.0
        for t in range(steps):
            begin, end, after = t * h, (t + 1) * h, (t + 1) % steps
            keep(here, grid[t])
            there = grid[after]
            states[t] = state
            if tangents == 1:
                forces[0, t] = nothing
                if state == STUCK:
                    # Samples take the state before the events of their interval: the corrections belong to the
                    # one-sided values.
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
                    # |k (u - z)| - mu N grows through zero: at ±(k u - k z) - mu N = 0, whichever comes first.
                    for direction in range(2):
                        turn = 1.0 - 2.0 * direction
                        own, offset = (turn, -1.0, 0.0), -turn * stiffness * z
                        found = crossing(own, offset, 0, begin, end, here, there, signals, table, values)
                        if found >= 0.0 and (event < 0.0 or found < event):
                            event, weights, shift, side = found, own, offset, turn
                if state == SLIPPING:
                    # Slip ends where the slider stops: ±k u' = mu N'. Without memory the force itself returns to the
                    # limit.
                    order = 1 if memory else 0
                    weights = (-sign, 1.0, 0.0)
                    event = crossing(weights, shift, order, begin, end, here, there, signals, table, values)
                opens = False
                if normal:
                    # N = 0, from below where the contact closes, from above where it opens; an opening wins over a slip
                    # at the same angle only if it is earlier.
                    own = (0.0, 0.0, 1.0 if state == SEPARATED else -1.0)
                    found = crossing(own, nothing, 0, begin, end, here, there, signals, table, values)
                    if found >= 0.0 and (event < 0.0 or found < event):
                        event, weights, shift, order, opens = found, own, nothing, 0, True
                if event < 0.0:
                    break
                moved = True
                at(event, signals, table, values)
                # One more step of Newton in the arithmetic of the displacements: bisection and real Newton steps leave
                # the angle real, this one carries the complex step or leaves it as it is.
                error, slope = value(weights, values, order) + shift, value(weights, values, order + 1)
                angle = event + nothing
                if abs(error) < 1e-6 * h * abs(slope):  # Newton's last step carries directions of differentiation
                    angle = event - error / slope
                    at(angle, signals, table, values)
                if wanted:
                    # Implicit function: ψ(τ, U) = 0 gives dτ/dU = -ψ_U/ψ'. The slider's place moves the limit at which
                    # slip begins.
                    slope_of(weights, order, contact, table, move)
                    for j in range(len(move)):
                        own_shift = stiffness * side * place[j] if state == STUCK and not opens else 0.0
                        move[j] = -(move[j] - own_shift) / slope if slope != 0.0 else 0.0
                # what comes next, and by what combination of signals the tangential force jumps
                # The jump of the force is the combination of signals after the event less that before: both are
                # continued smoothly through it.
                before = weights_of(state, sign)
                if state == SEPARATED:
                    sign = entered(values, memory) if tangents == 1 else 0.0
                    state = STUCK if sign == 0.0 else SLIPPING
                    if tangents == 1 and memory and state == STUCK:
                        z = values[0, TRIAL] / stiffness
                        if wanted:
                            slope_of((1.0, 0.0, 0.0), 0, contact, table, place)
                            for j in range(len(place)):
                                place[j] = (place[j] + values[1, TRIAL] * move[j]) / stiffness
                elif opens:
                    state, sign = SEPARATED, 0.0
                elif state == STUCK:
                    state, sign = SLIPPING, side
                else:
                    state = STUCK
                    if memory:
                        # z = u - mu N/k at the end of slip: the force is continuous where the slider stops.
                        z = (values[0, TRIAL] - sign * values[0, LIMIT]) / stiffness
                        if wanted:
                            place_at_limit(sign, contact, table, place)
                if last:
                    theta = (angle - t * h) / h
                    follows = weights_of(state, sign)
                    if tangents == 1:
                        jump = (follows[0] - before[0], follows[1] - before[1], 0.0)
                        add_correction(jump, contact, h, theta, table, values, result[0], slopes[0], move, gradient)
                    if opens:
                        jump = (0.0, 0.0, -1.0 if state == SEPARATED else 1.0)
                        load, by_load = result[tangents], slopes[tangents]
                        add_correction(jump, contact, h, theta, table, values, load, by_load, move, gradient)
                keep(here, values)
                begin = event
        if not (remembers and moved):
            break


@inner
def sample(signals, contact, waving, grid):
    """Set the values of the signals and of their first two derivatives at samples, (samples, 3, 3)."""
    for t in range(len(grid)):
        for order in range(3):
            for row in range(3):
                grid[t, order, row] = 0.0 if order else signals.constants[row]
            if contact.tangents == 1:
                grid[t, order, TRIAL] += dot(signals.rows[TRIAL], waving[order, t])
            if contact.normal:
                load = dot(signals.rows[PRESSED], waving[order, t])
                grid[t, order, PRESSED] += load
                grid[t, order, LIMIT] += contact.numbers[FRICTION] * load if contact.tangents == 1 else 0.0


def _sums(
    displacements: Numbers3, numbers: Numbers2, tangents: int, normal: bool, memory: bool, orders: Integers, mean: int,
    waving: Reals3, grid: Numbers3, scratch: Numbers2, small: Numbers3, slopes: Numbers3, forces: Numbers3,
    states: Bytes2, result: Numbers3,
) -> None:  # fmt: skip
    constants, none = small[0, 0], slopes[0, 0]
    places = EventWorkspace(scratch[3:8], small[1], small[2])
    for c in range(len(displacements)):
        contact = Contact(numbers[c], tangents, normal, memory)
        signals = signals_of(displacements[c], numbers[c], tangents, normal, orders, mean, scratch[:3], constants)
        sample(signals, contact, waving, grid)
        sums = Sums(forces[c], states[c], result[c], slopes, slopes, none, none, none)
        march(contact, signals, waving[0], grid, sums, places)


sums_real, sums_complex = kernels(_sums)


@kernel
def sums_and_slopes(
    numbers: Reals2, tangents: int, normal: bool, memory: bool, orders: Integers, mean: int, waving: Reals3,
    analysis: Reals2, gemm: Address, displacements: Reals3, grid: Reals3, scratch: Reals2, small: Reals3,
    sampled: Reals3,
    slopes: Reals3, given: Reals2, forces: Reals3, states: Bytes2, result: Reals3, jacobians: Reals4,
) -> None:  # fmt: skip
    constants, count = small[0, 0], analysis.shape[0]
    places = EventWorkspace(scratch[3:8], small[1], small[2])
    for c in range(len(displacements)):
        contact = Contact(numbers[c], tangents, normal, memory)
        signals = signals_of(displacements[c], numbers[c], tangents, normal, orders, mean, scratch[:3], constants)
        sample(signals, contact, waving, grid)
        sums = Sums(forces[c], states[c], result[c], sampled, slopes, given[0], given[1], given[2])
        march(contact, signals, waving[0], grid, sums, places)
        for column in range(len(slopes)):
            product(gemm, analysis, sampled[column], 0.0, jacobians[c, column])
            for i in range(count):
                weight = 1.0 / (np.pi if i >= mean else 2.0 * np.pi)
                for j in range(slopes.shape[2]):
                    jacobians[c, column, i, j] += weight * slopes[column, i, j]
