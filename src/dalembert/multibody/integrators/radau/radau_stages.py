"""The stages of a step of Radau IIA: their states by rates, and their prediction by the steps before."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner
from dalembert.kernels.words import Reals, Reals2
from dalembert.multibody.kernels.assembly import set_signals


class Stages(NamedTuple):
    """States of the stages, each array (stages, N + 1). Rates ``u`` of the coordinates' polynomial and ``a`` of the
    velocities' one, from which follow what coordinates and velocities are ahead of the start of the step, ``dx`` and
    ``dv``, and unknowns ``x`` and velocities ``v`` (the other way round, rounding would be 1/h times as large in the
    rates); ``m`` holds the second multipliers in the places of the first.
    """

    x: Reals2
    v: Reals2
    dx: Reals2
    dv: Reals2
    u: Reals2
    a: Reals2
    m: Reals2


class Buffers(NamedTuple):
    """Residuals ``motion``, ``weighed`` and ``rate`` (stages, N + 1), corrections, some vectors. ``change_x``,
    ``change_u`` and ``change_a`` are the corrections of coordinates (and multipliers), of their rates and of the rates
    of the velocities, and before them the same along the eigenvectors of A.
    """

    motion: Reals2
    weighed: Reals2
    rate: Reals2
    change_x: Reals2
    change_u: Reals2
    change_a: Reals2
    moved: Reals2
    given: Reals
    answer: Reals


def stages(count: int, width: int) -> Stages:
    """Stages at rest."""
    return Stages(*np.zeros((7, count, width)))


def buffers(count: int, width: int) -> Buffers:
    """Workspace for a step; the vectors are as long as a complex system."""
    motion, weighed, rate, change_x, change_u, change_a, moved = np.zeros((7, count, width))
    given, answer = np.zeros((2, 2 * width))
    return Buffers(motion, weighed, rate, change_x, change_u, change_a, moved, given, answer)


@inner
def set_stage_signals(method, model, t, h, target, within, works):
    """Evaluate the signals at the stages, in the calls ``works`` of which."""
    for i in range(len(method.c)):
        time = target if i == len(method.c) - 1 else t + method.c[i] * h
        set_signals(model, time, within, works[i])


@inner
def combine(weights, factor, source, count, target):
    """target = factor * weights source, for the first ``count`` unknowns of all stages."""
    for i in range(len(weights)):
        for k in range(count):
            target[i, k] = 0.0
        for j in range(len(weights)):
            weight = factor * weights[i, j]
            for k in range(count):
                target[i, k] += weight * source[j, k]


@inner
def begin(n, h, method, start, s):
    """Stages of a start: coordinates and velocities by their rates, multipliers held."""
    # Without a step before, the motion continues with constant acceleration. The second multipliers are zero on a
    # solution.
    c, x, u, a, m = method.c, s.x, s.u, s.a, s.m
    for i in range(len(c)):
        t = c[i] * h
        for k in range(len(start.x)):
            m[i, k] = 0.0
            x[i, k] = start.x[k]
            if k < n:
                u[i, k], a[i, k] = start.v[k] + t * start.a[k], start.a[k]


@inner
def recall(x, u, a, s):
    """Stages of these unknowns and rates, such as those of the step before that the prediction kept."""
    own_x, own_u, own_a = s.x, s.u, s.a
    for i in range(len(x)):
        for k in range(x.shape[1]):
            own_x[i, k], own_u[i, k], own_a[i, k] = x[i, k], u[i, k], a[i, k]


@inner
def _extrapolation(c, h, before, earlier, more, nodes, weights):
    """Weights (stages, stages + more) of the stages before, and of the last ``more`` of those earlier."""
    # Times of the stages before, measured from the start of the new step; its own stages are at c h.
    count = len(c)
    for j in range(count):
        nodes[j] = (c[j] - 1.0) * before
    for j in range(more):
        nodes[count + j] = (c[count - more + j] - 1.0) * earlier - before
    for i in range(count):
        for j in range(count + more):
            # Lagrange polynomials through all these nodes, evaluated at the new stages.
            weight = 1.0
            for k in range(count + more):
                if k != j:
                    weight *= (c[i] * h - nodes[k]) / (nodes[j] - nodes[k])
            weights[i, j] = weight


@inner
def extrapolate(n, h, method, before, earlier, past, s, b, weights):
    """Stages by the polynomial through those of the step before, and of the one earlier (0: without) in ``past``. They
    took ``before`` and ``earlier`` seconds; ``weights`` (stages + 1, 2 stages) is workspace. The stages before are then
    in ``past``.
    """
    count = len(method.c)
    more = 0 if earlier == 0.0 else method.more
    _extrapolation(method.c, h, before, earlier, more, weights[count], weights)
    x, u, a, m, early_x, early_u, early_a = s.x, s.u, s.a, s.m, past.x, past.u, past.a
    change_x, change_u, change_a = b.change_x, b.change_u, b.change_a
    for i in range(count):
        for k in range(x.shape[1]):
            m[i, k] = change_x[i, k] = change_u[i, k] = change_a[i, k] = 0.0
        for j in range(count + more):
            weight, recent = weights[i, j], j < count
            own_x, own_u = x[j] if recent else early_x[j - more], u[j] if recent else early_u[j - more]
            own_a = a[j] if recent else early_a[j - more]
            for k in range(x.shape[1]):
                change_x[i, k] += weight * own_x[k]
                change_u[i, k] += weight * own_u[k]
                change_a[i, k] += weight * own_a[k]
    # Kept before they are overwritten: if the step is refused, the next try extrapolates from the same stages.
    recall(x, u, a, past)
    recall(change_x, change_u, change_a, s)


@inner
def integrate_velocities(n, h, method, start, s):
    """Velocities of the stages by their rates: v_i = v_0 + h sum_j A_ij v'_j."""
    # The integral is kept apart from the start, ``dv``: the sum would lose its last digits, which the estimate needs.
    v, ahead = s.v, s.dv
    combine(method.a, h, s.a, n, ahead)
    for i in range(len(v)):
        for k in range(n):
            v[i, k] = start.v[k] + ahead[i, k]


@inner
def integrate_stages(n, h, method, start, s):
    """States of the stages by the rates: q_i = q_0 + h sum_j A_ij q'_j, and velocities alike."""
    x, ahead = s.x, s.dx
    combine(method.a, h, s.u, n, ahead)
    for i in range(len(x)):
        for k in range(n):
            x[i, k] = start.x[k] + ahead[i, k]
    integrate_velocities(n, h, method, start, s)


@inner
def read(n, s, new):
    """State at the end of a step: its last stage."""
    last = len(s.x) - 1
    for k in range(len(new.x)):
        new.x[k] = s.x[last, k]
        if k < n:
            new.v[k], new.a[k] = s.v[last, k], s.a[last, k]
