"""Compiled: signals of a contact, which are trigonometric polynomials, their values and their zeros."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner
from dalembert.vibration.dense import dot
from dalembert.vibration.laws.friction_law import FRICTION, GAP, LOAD, NORMAL, TANGENTIAL

#: Rows of signals: trial force k u, limit mu N, load N; in two directions of slip both trial forces, and the load.
TRIAL, LIMIT, PRESSED = range(3)
REFINEMENTS = 60
"""Of a zero, at most: bisections that end at rounding."""
LEAST = 1e-14
"""Value of a signal, as part of its amplitude, that is zero."""
SETTLED = 1e-9
"""Newton step of an angle after which a zero is known to rounding."""


class Signals(NamedTuple):
    """Signals of a contact: constants plus trigonometric polynomials of the harmonics ``orders``, the mean if 1.

    ``rows`` (3, coefficients) and ``constants`` (3,); a value that is not larger than ``least`` is zero.
    """

    orders: np.ndarray
    mean: int
    rows: np.ndarray
    constants: np.ndarray
    least: float


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
        # The addition theorem in place of a cosine for each harmonic: two products a harmonic.
        while reached < order:
            c, s, reached = c * cosine - s * sine, s * cosine + c * sine, reached + 1
        at = mean + 2 * (number - mean)
        table[0, at], table[0, at + 1] = c, s
        table[1, at], table[1, at + 1] = -order * s, order * c
        for row in range(2, rows):
            # cos'' = -h² cos: even derivatives repeat.
            table[row, at] = -order * order * table[row - 2, at]
            table[row, at + 1] = -order * order * table[row - 2, at + 1]


@inner
def value(weights, values, order):
    """A combination of signals, or of their derivatives of an order, from their values (orders, signals)."""
    return weights[0] * values[order, 0] + weights[1] * values[order, 1] + weights[2] * values[order, 2]


@inner
def evaluate(signals, table, values):
    """Set values (orders, signals) of the signals (signals, coefficients) from a table of waves."""
    for order in range(len(values)):
        for row in range(3):
            values[order, row] = dot(signals.rows[row], table[order])
    for row in range(3):
        values[0, row] += signals.constants[row]


@inner
def at(angle, signals, table, values):
    """Set a table of waves at an angle, and the signals' values there."""
    waves(angle, signals.orders, signals.mean, table, 5)
    evaluate(signals, table, values)


@inner
def keep(target, values):
    """Copy the values (3, 3) of three signals and of their first two derivatives."""
    for order in range(3):
        for row in range(3):
            target[order, row] = values[order, row]


@inner
def signals_of(d, numbers, tangents, normal, orders, mean, rows, constants):
    """Return the signals of a contact with displacements (columns, coefficients)."""
    size = 0.0
    rows[:] = 0.0
    constants[:] = 0.0
    constants[PRESSED] = numbers[LOAD]
    for j in range(d.shape[1]):
        for row in range(tangents):
            rows[row, j] = numbers[TANGENTIAL] * d[row, j]
        if normal:
            rows[PRESSED, j] = numbers[NORMAL] * d[tangents, j]
        if tangents == 1:
            rows[LIMIT, j] = numbers[FRICTION] * rows[PRESSED, j]
    if normal:
        constants[PRESSED] -= numbers[NORMAL] * numbers[GAP]
    if tangents == 1:
        constants[LIMIT] = numbers[FRICTION] * constants[PRESSED]
    for row in range(3):
        total = abs(constants[row])
        for j in range(d.shape[1]):
            total += abs(rows[row, j])
        size = max(size, total)
    return Signals(orders, mean, rows, constants, LEAST * size)


@inner
def between(low, high, place, size, slope):
    """Newton's next place between two bounds, else their middle."""
    found = place - size / slope if slope != 0.0 else low
    return found if low < found < high else 0.5 * (low + high)


@inner
def zero(weights, shift, order, low, high, rising, signals, table):
    """The zero of a combination of signals between two angles; ``rising`` says whether it grows through zero."""
    place = 0.5 * (low + high)
    for _ in range(REFINEMENTS):
        waves(place, signals.orders, signals.mean, table, order + 2)
        size, slope = shift, 0.0 * shift
        for row in range(3):
            if weights[row] != 0.0:
                size += weights[row] * dot(signals.rows[row], table[order])
                slope += weights[row] * dot(signals.rows[row], table[order + 1])
                size += weights[row] * signals.constants[row] if order == 0 else 0.0
        if (size.real > 0.0) == rising:
            high = place
        else:
            low = place
        # Newton inside a bracket: bisection where its step leaves the bracket, so that it ends at rounding in any case.
        trial = between(low, high, place, size.real, slope.real)
        close = abs(trial - place) <= SETTLED
        place = trial
        if close:  # Newton's next step would be the square of this one
            break
    return place


@inner
def crossing(weights, shift, order, begin, end, here, there, signals, table, values):
    """Return the first angle after ``begin`` where a combination of signals becomes positive, or a negative number.
    ``here`` and ``there`` are the values (orders, signals) at both ends. Of two zeros between them the first is found
    by the maximum that they enclose.
    """
    high = end
    if (value(weights, there, order) + shift).real <= signals.least:
        # Both ends below zero: two zeros lie between only around a maximum, where the slope changes from rising to
        # falling. Shorter excursions than an interval are found that way, several maxima are not.
        rise, fall = value(weights, here, order + 1).real, value(weights, there, order + 1).real
        if not (rise > 0.0 and fall < 0.0):
            return -1.0
        high = zero(weights, 0.0 * shift, order + 1, begin, end, False, signals, table)
        at(high, signals, table, values)
        if (value(weights, values, order) + shift).real <= signals.least:
            return -1.0
    return zero(weights, shift, order, begin, high, True, signals, table)
