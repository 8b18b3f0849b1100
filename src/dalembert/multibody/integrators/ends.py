"""The ends of the last steps, and the polynomial through them: outputs between steps with their derivatives."""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.kernels.compiled import compiled, kernel
from dalembert.multibody.kernels.motion import Motion

_SHORT = 0.3  # of the step: a step before it that is shorter gives no support to the polynomial


class Ends(NamedTuple):
    """Times of the ends, s, newest last, their states (ends, N + 1) and derivatives (directions, ends, N + 1).

    Only the last ``known[0]`` are filled; ``settled`` are those whose accelerations and multipliers are there.
    """

    times: np.ndarray
    states: Motion
    derivatives: Motion
    settled: np.ndarray
    known: np.ndarray


@compiled
def ends(count, like):
    """Room for ``count`` ends, with derivatives as ``like`` (directions, N + 1)."""
    directions, width = like.x.shape
    shape, derivatives = (count, width), (directions, count, width)
    return Ends(
        np.zeros(count),
        Motion(np.zeros(shape), np.zeros(shape), np.zeros(shape), np.zeros(shape)),
        Motion(np.zeros(derivatives), np.zeros(derivatives), np.zeros(derivatives), np.zeros(derivatives)),
        np.zeros(count, np.bool_),
        np.zeros(1, np.int64),
    )


@kernel
def _shift(array):
    """Each row takes the place of the one before."""
    for j in range(len(array) - 1):
        for k in range(array.shape[1]):
            array[j, k] = array[j + 1, k]


@kernel
def append(t, state, derivatives, settled, e):
    """The end of a step becomes the newest one; where ``e`` is full the oldest one is forgotten."""
    count = len(e.times)
    for j in range(count - 1):
        e.times[j], e.settled[j] = e.times[j + 1], e.settled[j + 1]
    _shift(e.states.x)
    _shift(e.states.v)
    _shift(e.states.a)
    for d in range(len(derivatives.x)):
        _shift(e.derivatives.x[d])
        _shift(e.derivatives.v[d])
        _shift(e.derivatives.a[d])
    j = count - 1
    e.times[j], e.settled[j] = t, settled
    for k in range(len(state.x)):
        e.states.x[j, k], e.states.v[j, k], e.states.a[j, k] = state.x[k], state.v[k], state.a[k]
        for d in range(len(derivatives.x)):
            e.derivatives.x[d, j, k] = derivatives.x[d, k]
            e.derivatives.v[d, j, k] = derivatives.v[d, k]
            e.derivatives.a[d, j, k] = derivatives.a[d, k]
    e.known[0] = min(count, e.known[0] + 1)


@kernel
def support(e):
    """The oldest end that the polynomial of the last step goes through."""
    first, newest = len(e.times) - e.known[0], len(e.times) - 1
    oldest = max(first, newest - 1)
    shortest = _SHORT * (e.times[newest] - e.times[oldest])
    while oldest > first and e.times[oldest] - e.times[oldest - 1] >= shortest:
        oldest -= 1
    return oldest


@kernel
def weigh_ends(e, oldest, t, weights):
    """Weights of the ends' data in the state at ``t``, (4, ends, 3).

    Those of coordinates, velocities and accelerations in the same three, by Hermite's interpolation: with l the cube of
    Lagrange's polynomial of an end and D, E its logarithmic derivatives there, the basis is l (1 - D x + (D^2 - E)
    x^2 / 2), l (x - D x^2) and l x^2 / 2. Behind them stand Lagrange's polynomials, for the multipliers.
    """
    for j in range(oldest, len(e.times)):
        ell, slope, bend, first, second = 1.0, 0.0, 0.0, 0.0, 0.0
        for k in range(oldest, len(e.times)):
            if k != j:
                gap = e.times[j] - e.times[k]
                ahead = t - e.times[k]
                ell *= ahead / gap
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
        ell *= ell * ell
        for i in range(3):
            base, rate, second = weights[0, j, i], weights[1, j, i], weights[2, j, i]
            weights[0, j, i] = ell * base
            weights[1, j, i] = ell * (rate + slope * base)
            weights[2, j, i] = ell * (second + 2.0 * slope * rate + (slope * slope + bend) * base)


@kernel
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
