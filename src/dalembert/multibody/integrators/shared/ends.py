"""The ends of the last steps, and the polynomial through them: outputs between steps with their derivatives."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner
from dalembert.kernels.words import Integers, Reals
from dalembert.multibody.kernels.states import Histories, MotionState, MotionStates, resting, row, rows

_SHORT = 0.3  # of the step: a step before it that is shorter gives no support to the polynomial


class Ends(NamedTuple):
    """Times of the ends, s, newest last, their states (ends, N + 1) and derivatives (directions, ends, N + 1).

    Only the last ``known[0]`` are filled; ``settled`` are those whose accelerations and multipliers are there.
    """

    times: Reals
    states: MotionStates
    derivatives: Histories
    settled: Integers
    known: Integers


def ends(count: int, like: MotionState) -> Ends:
    """Workspace for ``count`` ends, with derivatives as ``like`` (directions, N + 1)."""
    directions, width = like.x.shape
    states, derivatives = resting(count, width), resting(directions, count, width)
    return Ends(np.zeros(count), states, derivatives, np.zeros(count, np.int64), np.zeros(1, np.int64))


@inner
def write(state, target):
    """Copy unknowns, velocities and accelerations, which outputs have."""
    for k in range(len(state.x)):
        target.x[k], target.v[k], target.a[k] = state.x[k], state.v[k], state.a[k]


@inner
def _shift(states, state):
    """Each of the states takes the place of the one before, and a state that of the last."""
    last = len(states.x) - 1
    for j in range(last):
        write(row(states, j + 1), row(states, j))
    write(state, row(states, last))


@inner
def append(t, state, derivatives, settled, e):
    """The end of a step becomes the newest one; where ``e`` is full the oldest one is forgotten."""
    last = len(e.times) - 1
    for j in range(last):
        e.times[j], e.settled[j] = e.times[j + 1], e.settled[j + 1]
    e.times[last], e.settled[last] = t, settled
    _shift(e.states, state)
    for d in range(len(derivatives.x)):
        _shift(rows(e.derivatives, d), row(derivatives, d))
    e.known[0] = min(last + 1, e.known[0] + 1)


@inner
def support(e):
    """The oldest end that the polynomial of the last step goes through."""
    first, newest = len(e.times) - e.known[0], len(e.times) - 1
    oldest = max(first, newest - 1)
    shortest = _SHORT * (e.times[newest] - e.times[oldest])
    while oldest > first and e.times[oldest] - e.times[oldest - 1] >= shortest:
        # Ends that are close together would make the polynomial swing: it goes through ends of similar distances only.
        oldest -= 1
    return oldest


@inner
def weigh_ends(e, oldest, t, weights):
    """Weights of the ends' data in the state at ``t``, (4, ends, 3). Those of coordinates, velocities and accelerations
    in the same three, by Hermite's interpolation: with l the cube of Lagrange's polynomial of an end and D, E its
    logarithmic derivatives there, the basis is l (1 - D x + (D^2 - E) x^2 / 2), l (x - D x^2) and l x^2 / 2. Behind
    them stand Lagrange's polynomials, for the multipliers.
    """
    for j in range(oldest, len(e.times)):
        ell, slope, bend, first, second = 1.0, 0.0, 0.0, 0.0, 0.0
        for k in range(oldest, len(e.times)):
            if k != j:
                gap = e.times[j] - e.times[k]
                ahead = t - e.times[k]
                ell *= ahead / gap
                # Logarithmic derivatives of the cube: at t, to differentiate l, and at the end itself, for the basis.
                # The time t is never an end: there the state is copied.
                slope += 3.0 / ahead
                bend -= 3.0 / (ahead * ahead)
                first += 3.0 / gap
                second -= 3.0 / (gap * gap)
        x = t - e.times[j]
        curve = 0.5 * (first * first - second)
        weights[0, j, 0], weights[1, j, 0] = 1.0 - first * x + curve * x * x, -first + 2.0 * curve * x
        weights[0, j, 1], weights[1, j, 1] = x - first * x * x, 1.0 - 2.0 * first * x
        weights[0, j, 2], weights[1, j, 2] = 0.5 * x * x, x
        weights[2, j, 0], weights[2, j, 1], weights[2, j, 2] = 2.0 * curve, -2.0 * first, 1.0
        weights[3, j, 0] = ell
        # The cube of Lagrange's polynomial has zeros of third order at all other ends: values, rates and second rates
        # there stay as they are.
        ell *= ell * ell
        for i in range(3):
            base, rate, second = weights[0, j, i], weights[1, j, i], weights[2, j, i]
            weights[0, j, i] = ell * base
            weights[1, j, i] = ell * (rate + slope * base)
            weights[2, j, i] = ell * (second + 2.0 * slope * rate + (slope * slope + bend) * base)


@inner
def interpolate_ends(n, oldest, weights, e, state):
    """State by the states ``e`` (ends, N + 1)."""
    for k in range(len(state.x)):
        state.x[k] = state.v[k] = state.a[k] = 0.0
    for j in range(oldest, len(e.x)):
        for k in range(n):
            x, v, a = e.x[j, k], e.v[j, k], e.a[j, k]
            state.x[k] += weights[0, j, 0] * x + weights[0, j, 1] * v + weights[0, j, 2] * a
            state.v[k] += weights[1, j, 0] * x + weights[1, j, 1] * v + weights[1, j, 2] * a
            state.a[k] += weights[2, j, 0] * x + weights[2, j, 1] * v + weights[2, j, 2] * a
        for k in range(n, len(state.x)):
            state.x[k] += weights[3, j, 0] * e.x[j, k]
