r"""Compiled: the angle φ of the force of a contact that slips in two directions, and its gradient.

With a = k_t u and the limit L = mu N, a prime for the derivative by the phase, the force is L e(φ), where
e = (cos φ, sin φ) and n = (-sin φ, cos φ), and the slider moves along the force:

    L φ' = a'·n(φ),   while a'·e(φ) > L'

This is solved by Radau IIA of order five, which bears L = 0, where φ is the direction of a'. The gradients (columns,)
are by the displacements' coefficients and by the two numbers of the slider at the start of the period; the last column
is by the angle at which a step ends.

Source: E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, Springer 1996, section IV.5.
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner
from dalembert.vibration.dense import dot
from dalembert.vibration.laws.friction_law import FRICTION, NORMAL, TANGENTIAL
from dalembert.vibration.laws.signal_zeros import LEAST, PRESSED, REFINEMENTS, SETTLED, at, between, evaluate, waves

ROOT = 6.0**0.5
NODES = ((4.0 - ROOT) / 10.0, (4.0 + ROOT) / 10.0, 1.0)
WEIGHTS = (
    ((88.0 - 7.0 * ROOT) / 360.0, (296.0 - 169.0 * ROOT) / 1800.0, (-2.0 + 3.0 * ROOT) / 225.0),
    ((296.0 + 169.0 * ROOT) / 1800.0, (88.0 + 7.0 * ROOT) / 360.0, (-2.0 - 3.0 * ROOT) / 225.0),
    ((16.0 - ROOT) / 36.0, (16.0 + ROOT) / 36.0, 1.0 / 9.0),
)
"""Radau IIA of order five: nodes and weights of its stages, of which the last is the end of the step."""
AHEAD = tuple(
    tuple(float(np.prod([(1.0 + end - other) / (node - other) for other in NODES if other != node])) for node in NODES)
    for end in NODES
)
"""From what the stages of a step have to those of the next one of the same length: Lagrange's polynomials."""
ITERATIONS = 12
"""Of Newton's method for the stages of a step; a step that needs more is halved."""
FAR = 100.0
"""Change of a stage in an iteration from which the method does not return; the imaginary parts would overflow."""

#: Rows of a step.
COSINE, SINE = 7, 8
#: Rows of gradients.
PLACE, OPENED, MOVE, STAGES, JUMPS, ROWS = 0, 2, 3, 4, 7, 16


class StageMemory(NamedTuple):
    """Waves at the stages of whole intervals, ``tables`` (3 samples, 3, coefficients), and the signals of one contact
    there, ``values`` (3 samples, 3, 3). ``grid`` (samples, 3, 3): signals at samples. ``known`` (2, samples): whether
    the first two are filled.
    """

    tables: np.ndarray
    values: np.ndarray
    grid: np.ndarray
    known: np.ndarray


@inner
def sample(signals, waving, grid):
    """Set the signals, with their first two derivatives, at samples (samples, 3, 3)."""
    for t in range(len(grid)):
        for order in range(3):
            for row in range(3):
                grid[t, order, row] = dot(signals.rows[row], waving[order, t])
        for row in range(3):
            grid[t, 0, row] += signals.constants[row]


@inner
def set_stages(begin, end, signals, tables, stages):
    """Set waves and signals, with their first two derivatives, at the stages of a step."""
    for j in range(3):
        waves(begin + NODES[j] * (end - begin), signals.orders, signals.mean, tables[j], 3)
        evaluate(signals, tables[j], stages[j, :3])


@inner
def recall_stages(t, begin, end, signals, memory, tables, stages):
    """Set the same for the whole interval ``t``, which all contacts share, and all periods of one contact."""
    for j in range(3):
        own, values = memory.tables[3 * t + j], memory.values[3 * t + j]
        if memory.known[0, t] == 0:
            waves(begin + NODES[j] * (end - begin), signals.orders, signals.mean, own, 3)
        if memory.known[1, t] == 0:
            evaluate(signals, own, values)
        # Gradients need the waves and their first derivatives alone.
        for row in range(2):
            for q in range(own.shape[1]):
                tables[j, row, q] = own[row, q]
        for order in range(3):
            for row in range(3):
                stages[j, order, row] = values[order, row]
    memory.known[0, t] = memory.known[1, t] = 1


@inner
def direction(x, y):
    """Angle of a vector; the step of Newton's method carries directions of differentiation."""
    # arctan2 of real parts, and one step of Newton for φ in e(φ) × (x, y) = 0, which is exact in the complex step.
    angle = np.arctan2(y.real, x.real)
    c, s = np.cos(angle), np.sin(angle)
    return angle + (c * y - s * x) / (c * x + s * y)


@inner
def slides(stages, radau, j, friction):
    """Velocity of a slipping slider along the force at a stage, times k_t: a'·e - L'."""
    along = stages[j, 1, 0] * radau[COSINE, j] + stages[j, 1, 1] * radau[SINE, j]
    return (along - friction * stages[j, 1, PRESSED]).real


@inner
def at_end(x, y, z):
    """Sum of what the stages have with the weights of the last one, which is the end of the step."""
    return WEIGHTS[2][0] * x + WEIGHTS[2][1] * y + WEIGHTS[2][2] * z


@inner
def solved(radau, j):
    """An entry of the product of the inverse (rows 2 to 4) and the row 6."""
    return radau[2 + j, 0] * radau[6, 0] + radau[2 + j, 1] * radau[6, 1] + radau[2 + j, 2] * radau[6, 2]


@inner
def step(begin, end, phi, friction, stages, radau, follows):
    """One step of φ: its change, and whether it was found. ``radau`` (9, 3) keeps the changes κ of the stages, their φ,
    and the inverse of their matrix (rows 2 to 4); the derivative of the stages by the end of the step (row 5); cosines
    and sines of φ. It begins with the polynomial of the step before if it ``follows`` one of the same length.
    """
    # Stages κ_j with φ_j = φ + Σ a_ji κ_i and L_j κ_j = h a'_j · n(φ_j): multiplied by L, so that L = 0 is regular.
    size, found, done = end - begin, False, False
    a, b, c = radau[0, 0], radau[0, 1], radau[0, 2]
    for j in range(3):
        radau[0, j] = AHEAD[j][0] * a + AHEAD[j][1] * b + AHEAD[j][2] * c if follows else 0.0 * phi
    for _ in range(ITERATIONS):
        moved = 0.0
        for j in range(3):
            angle = phi
            for i in range(3):
                angle += WEIGHTS[j][i] * radau[0, i]
            c, s, limit = np.cos(angle), np.sin(angle), friction * stages[j, 0, PRESSED]
            radau[COSINE, j], radau[SINE, j] = c, s
            across, along = c * stages[j, 1, 1] - s * stages[j, 1, 0], c * stages[j, 1, 0] + s * stages[j, 1, 1]
            radau[1, j], radau[6, j] = angle, size * across - limit * radau[0, j]
            for i in range(3):
                # Matrix of Newton's method: L_j δ_ji + h a'_j · e(φ_j) a_ji, as n' = -e. Slip has a'·e > L' there, so
                # that it is regular with L = 0, too.
                radau[2 + j, i] = size * along * WEIGHTS[j][i]
            radau[2 + j, j] += limit
        # One more iteration after the last change is below 1e-9: quadratic convergence takes it to rounding, and it
        # makes the inverse that of the solution, which the gradients need.
        if done:
            found = True
        if not invert(radau):
            return 0.0 * phi, False
        for j in range(3):
            change = solved(radau, j)
            if not abs(change.real) <= FAR:
                return 0.0 * phi, False
            radau[0, j] += change
            moved = max(moved, abs(change.real))
        if found:
            break
        done = moved <= SETTLED
    for j in range(3):
        c, s = radau[COSINE, j], radau[SINE, j]
        across, bent = c * stages[j, 1, 1] - s * stages[j, 1, 0], c * stages[j, 2, 1] - s * stages[j, 2, 0]
        # Derivative of the stages by the end of the step: the size of h, and the waves at stages that move with it.
        push = size * bent - radau[0, j] * friction * stages[j, 1, PRESSED]
        radau[6, j] = across + NODES[j] * push
    for j in range(3):
        radau[5, j] = solved(radau, j)
    return at_end(radau[0, 0], radau[0, 1], radau[0, 2]), found


@inner
def invert(radau):
    """Invert the rows 2 to 4; whether they can be inverted."""
    a, b, c = radau[2, 0], radau[2, 1], radau[2, 2]
    d, e, f = radau[3, 0], radau[3, 1], radau[3, 2]
    g, h, i = radau[4, 0], radau[4, 1], radau[4, 2]
    first, second, third = e * i - f * h, f * g - d * i, d * h - e * g
    determinant = a * first + b * second + c * third
    if determinant.real == 0.0:
        return False
    # One division: nine of them took as long as all products of an iteration.
    inverse = 1.0 / determinant
    radau[2, 0], radau[3, 0], radau[4, 0] = first * inverse, second * inverse, third * inverse
    radau[2, 1], radau[3, 1] = (c * h - b * i) * inverse, (a * i - c * g) * inverse
    radau[4, 1] = (b * g - a * h) * inverse
    radau[2, 2], radau[3, 2] = (b * f - c * e) * inverse, (c * d - a * f) * inverse
    radau[4, 2] = (a * e - b * d) * inverse
    return True


@inner
def speed(radau):
    """Derivative of φ at the end of a step by this end."""
    return at_end(radau[5, 0], radau[5, 1], radau[5, 2])


@inner
def column_at_end(radau, i):
    """The same of a column of the inverse (rows 2 to 4)."""
    return at_end(radau[2, i], radau[3, i], radau[4, i])


@inner
def carry(begin, end, numbers, normal, wanted, tables, stages, radau, grads):
    """Carry the gradient of φ over a step whose end is fixed; its last entry is by the end."""
    size, count, friction = end - begin, tables.shape[2], numbers[FRICTION]
    unknowns, own = grads.shape[1] - 3, numbers[FRICTION] * numbers[NORMAL]
    for j in range(3):
        c, s, kappa = radau[COSINE, j], radau[SINE, j], radau[0, j]
        along, across = c * stages[j, 1, 0] + s * stages[j, 1, 1], c * stages[j, 1, 1] - s * stages[j, 1, 0]
        bent = c * stages[j, 2, 1] - s * stages[j, 2, 0]
        # The beginning of the step may be an event, which moves with the displacements by `OPENED`: the stages move by
        # (1 - c_j) of it.
        shift = (1.0 - NODES[j]) * (size * bent - kappa * friction * stages[j, 1, PRESSED]) - across
        for m in range(unknowns + 2):
            grads[STAGES + j, m] = shift * grads[OPENED, m] - size * along * grads[PLACE, m]
        if wanted:
            factor = size * numbers[TANGENTIAL]
            for q in range(count):
                grads[STAGES + j, q] -= factor * s * tables[j, 1, q]
                grads[STAGES + j, count + q] += factor * c * tables[j, 1, q]
            if normal:
                for q in range(count):
                    grads[STAGES + j, 2 * count + q] -= kappa * own * tables[j, 0, q]
    first, second, third = column_at_end(radau, 0), column_at_end(radau, 1), column_at_end(radau, 2)
    for m in range(unknowns + 2):
        grads[PLACE, m] += first * grads[STAGES, m] + second * grads[STAGES + 1, m] + third * grads[STAGES + 2, m]
    grads[OPENED] = 0.0
    grads[PLACE, unknowns + 2] = speed(radau)


@inner
def stop_slip(begin, end, phi, friction, signals, tables, stages, radau):
    """The angle in a step at which the slider stops, as a length from its beginning; the last step was to this end."""
    low, high = 0.0, (end - begin).real
    place = 0.5 * high
    length, close = place + 0.0 * phi, False
    for _ in range(REFINEMENTS):
        set_stages(begin, begin + length, signals, tables, stages)
        change, found = step(begin, begin + length, phi, friction, stages, radau, False)
        angle = phi + change
        c, s = np.cos(angle), np.sin(angle)
        size = stages[2, 1, 0] * c + stages[2, 1, 1] * s - friction * stages[2, 1, PRESSED]
        rate = stages[2, 2, 0] * c + stages[2, 2, 1] * s - friction * stages[2, 2, PRESSED]
        rate += (c * stages[2, 1, 1] - s * stages[2, 1, 0]) * speed(radau)
        if close and found:  # the last step carries directions of differentiation
            return length - size / rate
        # a'·e - L' > 0: it still slips at this length. A step that is not found counts as too long.
        if found and size.real > 0.0:
            low = place
        else:
            high = place
        trial = between(low, high, place, size.real, rate.real if found else 0.0)
        close = abs(trial - place) <= SETTLED * (end - begin).real
        place = trial
        length = place + 0.0 * phi
    return length


@inner
def add_signal(target, row, order, factor, numbers, table):
    """Add to a gradient that of a signal's derivative of an order."""
    count = table.shape[1]
    own = factor * (numbers[NORMAL] if row == PRESSED else numbers[TANGENTIAL])
    for q in range(count):
        target[row * count + q] += own * table[order, q]


@inner
def pull(values, zx, zy, friction):
    """What makes a stuck contact slip where it becomes positive, |f|² - L², and its derivative."""
    x, y, limit = values[0, 0] - zx, values[0, 1] - zy, friction * values[0, PRESSED]
    size = x * x + y * y - limit * limit
    return size, 2.0 * (x * values[1, 0] + y * values[1, 1] - limit * friction * values[1, PRESSED])


@inner
def first_slip(begin, end, here, there, zx, zy, friction, signals, table, values):
    """The first angle between two at which a stuck contact begins to slip, or a negative number. ``here`` and ``there``
    are the signals at both ends.

    Of two such changes between them the first is found by the largest force that they enclose.
    """
    least = signals.least * signals.least / LEAST
    size, rate = pull(there, zx, zy, friction)
    low, high = begin, end
    if size.real <= least:
        if rate.real >= 0.0:
            # No zero if |f|² - L² does not fall towards the end: it has no maximum inside.
            return -1.0
        _, rate = pull(here, zx, zy, friction)
        if rate.real <= 0.0:
            return -1.0
        for _ in range(REFINEMENTS):
            middle = 0.5 * (low + high)
            at(middle, signals, table, values)
            size, rate = pull(values, zx, zy, friction)
            if size.real > least or high - low <= SETTLED * (end - begin):
                break
            if rate.real > 0.0:
                low = middle
            else:
                high = middle
        if size.real <= least:
            return -1.0
        low, high = begin, middle
    place = 0.5 * (low + high)
    for _ in range(REFINEMENTS):
        at(place, signals, table, values)
        size, rate = pull(values, zx, zy, friction)
        if size.real > 0.0:
            high = place
        else:
            low = place
        trial = between(low, high, place, size.real, rate.real)
        close = abs(trial - place) <= SETTLED * (end - begin)
        place = trial
        if close:
            break
    return place
