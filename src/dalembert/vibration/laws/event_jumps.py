r"""Compiled: corrections at the events of contacts that slip in two directions, and their gradients.

They take the jumps of three derivatives of the force: of L e(φ) where the contact slips, of a signal else. ``jumps``
(9,) has both tangential parts of the first derivative, of the second, of the third, then the three of the load.
"""

import numpy as np

from dalembert.kernels.kernel import inner
from dalembert.vibration.laws.friction_law import FRICTION
from dalembert.vibration.laws.signal_zeros import PRESSED
from dalembert.vibration.laws.slip_in_plane import JUMPS, MOVE, PLACE, add_signal


@inner
def bend(x, terms):
    """First three derivatives of L e(φ), both parts of each, from those of a (6), L and its derivatives (4), and φ.

    ``terms`` is the number of derivatives of φ to take; 3 for L > 0, else those that it has at L = 0.
    """
    c, s = np.cos(x[10]), np.sin(x[10])
    along, across = c * x[0] + s * x[3], c * x[3] - s * x[0]
    along2, across2, across3 = c * x[1] + s * x[4], c * x[4] - s * x[1], c * x[5] - s * x[2]
    # φ', φ'' and φ''' from L φ' = a'·n, differentiated twice; with e' = φ' n and n' = -φ' e.
    limit, first, second, third = x[6], 0.0 * x[6], 0.0 * x[6], 0.0 * x[6]
    if terms == 3:
        first = across / limit
        second = (across2 - first * along - x[7] * first) / limit
        rate = across3 - first * along2 - second * along - first * (along2 + first * across)
        third = (rate - x[8] * first - 2.0 * x[7] * second) / limit
    else:
        # L = 0: the equations of the next order determine φ' = a''·n/(L' + a'·e) and φ'' = ..., as far as these are
        # finite.
        limit = 0.0 * limit
        if terms > 0:
            first = across2 / (x[7] + along)
        if terms > 1:
            second = (across3 - 2.0 * first * along2 - x[8] * first) / (2.0 * x[7] + along)
    # (L e)'' and (L e)''' in the directions e and n, then in x and y.
    e2, n2 = x[8] - limit * first * first, 2.0 * x[7] * first + limit * second
    e3 = x[9] - 3.0 * x[7] * first * first - 3.0 * limit * first * second
    n3 = 3.0 * x[8] * first + 3.0 * x[7] * second + limit * (third - first * first * first)
    return (
        x[7] * c - across * s, x[7] * s + across * c,
        e2 * c - n2 * s, e2 * s + n2 * c,
        e3 * c - n3 * s, e3 * s + n3 * c,
    )  # fmt: skip


@inner
def add_slip(sign, phi, terms, numbers, normal, wanted, table, values, x, seeds, jumps, grads):
    """Add the derivatives of a slipping force to jumps (9,), and their gradients."""
    friction, unknowns = numbers[FRICTION], grads.shape[1] - 3
    for order in range(3):
        x[order], x[3 + order] = values[1 + order, 0], values[1 + order, 1]
    for order in range(4):
        x[6 + order] = friction * values[order, PRESSED]
    x[10] = phi
    bent = bend(x, terms)
    for k in range(6):
        jumps[k] += sign * bent[k]
    if not wanted:
        return
    for k in range(11):
        seeds[k] = x[k].real
    for number in range(11):
        # Gradients of the jumps by the complex step through `bend`: eleven calls of a short function.
        seeds[number] += 1e-30j
        slopes = bend(seeds, terms)
        seeds[number] = seeds[number].real
        # φ is the slider's own number and has a gradient; the signals have theirs by the waves and by the angle of the
        # event.
        if number == 10:
            for k in range(6):
                factor = sign * slopes[k].imag * 1e30
                for m in range(unknowns + 2):
                    grads[JUMPS + k, m] += factor * grads[PLACE, m]
            continue
        row, order = (number // 3, 1 + number % 3) if number < 6 else (PRESSED, number - 6)
        scale = friction if row == PRESSED else 1.0
        for k in range(6):
            factor = sign * slopes[k].imag * 1e30 * scale
            if factor == 0.0:
                continue
            if row != PRESSED or normal:
                add_signal(grads[JUMPS + k], row, order, factor, numbers, table)
            for m in range(unknowns + 2):
                grads[JUMPS + k, m] += factor * values[order + 1, row] * grads[MOVE, m]


@inner
def add_trial(sign, row, place, numbers, wanted, table, values, jumps, grads):
    """Add the derivatives of a signal, a stuck force or the load, to jumps in each third place from one on."""
    unknowns, stride = grads.shape[1] - 3, 2 if row != PRESSED else 1
    for order in range(1, 4):
        k = place + stride * (order - 1)
        jumps[k] += sign * values[order, row]
        if wanted:
            add_signal(grads[JUMPS + k], row, order, sign, numbers, table)
            for m in range(unknowns + 2):
                grads[JUMPS + k, m] += sign * values[order + 1, row] * grads[MOVE, m]


@inner
def correct(first, stride, h, theta, wanted, table, jumps, grads, result, slopes):
    """Add the correction for an event to coefficients (coefficients,), and to their derivatives."""
    unknowns, count = grads.shape[1] - 3, table.shape[1]
    square = theta * theta
    b1 = theta - 0.5
    b2 = (square - theta + 1.0 / 6.0) * 0.5 * h * h
    b3 = -(square * theta - 1.5 * square + 0.5 * theta) * h * h * h / 6.0
    b4 = (square * square - 2.0 * square * theta + square - 1.0 / 30.0) * h * h * h * h / 24.0
    f1, f2, f3 = jumps[first], jumps[first + stride], jumps[first + 2 * stride]
    own, once, twice = b2 * f1 + b3 * f2 + b4 * f3, 2.0 * b3 * f1 + 3.0 * b4 * f2, 3.0 * b4 * f1
    for i in range(count):
        result[i] += own * table[0, i] + once * table[1, i] + twice * table[2, i]
    if not wanted:
        return
    # by the angle: the derivative of a Bernoulli term is the one before, b1 h, -b2, -b3
    rate, rate1, rate2 = b1 * h * f1 - b2 * f2 - b3 * f3, -2.0 * b2 * f1 - 3.0 * b3 * f2, -3.0 * b3 * f1
    g1, g2, g3 = grads[JUMPS + first], grads[JUMPS + first + stride], grads[JUMPS + first + 2 * stride]
    move = grads[MOVE]
    for i in range(count):
        along = rate * table[0, i] + rate1 * table[1, i] + rate2 * table[2, i]
        along += own * table[1, i] + once * table[2, i] + twice * table[3, i]
        one = b2 * table[0, i] + 2.0 * b3 * table[1, i] + 3.0 * b4 * table[2, i]
        two, three = b3 * table[0, i] + 3.0 * b4 * table[1, i], b4 * table[0, i]
        for m in range(unknowns + 2):
            slopes[i, m] += one * g1[m] + two * g2[m] + three * g3[m] + along * move[m]


@inner
def smooth_terms(values, friction, size):
    """How many derivatives the direction of slip has where a contact lifts off or closes."""
    # |a'|/|L'| is the power with which φ tends to its end before lift-off: derivatives below it exist.
    rise = (friction * values[1, PRESSED]).real
    if rise >= 0.0 or size > -3.0 * rise:
        return 2
    return 1 if size > -2.0 * rise else 0
