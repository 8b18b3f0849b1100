"""One step of Radau IIA for the stabilised equations of Gear, Gupta and Leimkuhler.

With u = D (q - q0) and a = D (v - v0), D = A^-1 / h the differentiation of the collocation polynomial, each stage
fulfils M (u - v) + J^T m = 0, the equations of motion, the constraints and their rates. Newton's iteration is split. As
the multipliers m only weigh velocities against inertia, their part in the equations of motion joins that of lambda; so
the coordinates need one real system of the size of the mechanism and a complex one for each two other stages (Hairer
and Wanner 1996, IV.8), and the velocities then follow by a projection at each stage.
"""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators.lifting import set_signals
from dalembert.multibody.integrators.matrices import (
    add_inertia,
    add_product,
    factorise_complex,
    factorise_real,
    solve_complex,
)
from dalembert.multibody.integrators.settling import weigh, weigh_along
from dalembert.multibody.kernels.assembly import constraint_rates, residual, residual_here
from dalembert.multibody.kernels.compiled import compiled, inlined, kernel, template
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import solve
from dalembert.multibody.kernels.model import Work

_CLOSED = 1e-15  # violation against the largest scale that is rounding
_NOISE = 1e-13  # part of a step's way below which the ratio of two corrections says nothing
# Relative corrections that stop to shrink are rounding below the first size, and below the second one if a nearly
# singular position magnifies it.
_ROUNDING, _MAGNIFIED = 1e-12, 1e-9
_MOST_ITERATIONS = 14
_VISIBLE = 0.03  # part of the tolerance from which corrections hardly change the estimated error


class Stages(NamedTuple):
    """States of the stages, each array (stages, N + 1).

    Rates ``u`` of the coordinates' polynomial and ``a`` of the velocities' one, from which follow what coordinates and
    velocities are ahead of the start of the step, ``dx`` and ``dv``, and unknowns ``x`` and velocities ``v`` (the other
    way round, rounding would be 1/h times as large in the rates); ``m`` holds the second multipliers in the places of
    the first.
    """

    x: np.ndarray
    v: np.ndarray
    dx: np.ndarray
    dv: np.ndarray
    u: np.ndarray
    a: np.ndarray
    m: np.ndarray


class Buffers(NamedTuple):
    """Residuals ``motion``, ``weighed`` and ``rate`` (stages, N + 1), corrections, some vectors.

    ``place``, ``pace`` and ``pull`` are the corrections of coordinates (and multipliers), of their rates and of the
    rates of the velocities, and before them the same along the eigenvectors of A.
    """

    motion: np.ndarray
    weighed: np.ndarray
    rate: np.ndarray
    place: np.ndarray
    pace: np.ndarray
    pull: np.ndarray
    moved: np.ndarray
    given: np.ndarray
    answer: np.ndarray
    lifted: np.ndarray


@compiled
def stages(count, width):
    """Stages at rest."""
    return Stages(
        np.zeros((count, width)), np.zeros((count, width)), np.zeros((count, width)), np.zeros((count, width)),
        np.zeros((count, width)), np.zeros((count, width)), np.zeros((count, width)),
    )  # fmt: skip


@compiled
def buffers(count, width):
    """Room for a step."""
    return Buffers(
        np.zeros((count, width)), np.zeros((count, width)), np.zeros((count, width)), np.zeros((count, width)),
        np.zeros((count, width)), np.zeros((count, width)), np.zeros((count, width)),
        np.zeros(2 * width), np.zeros(2 * width), np.zeros((10, width), np.complex128),
    )  # fmt: skip


@template
def at_stage(work, signals, i):
    """Room of one component with the signals of a stage."""
    return Work(work.x, work.v, work.a, work.r, signals[i], work.real, work.matrix)


@kernel
def listen(method, model, t, h, target, within, work, signals):
    """Evaluate the signals at the stages."""
    for i in range(len(method.c)):
        time = target if i == len(method.c) - 1 else t + method.c[i] * h
        set_signals(model, time, within, at_stage(work, signals, i))


@kernel
def factorise(n, method, pattern, matrices, h):
    """Factorise the systems of a step; whether they are regular."""
    if not factorise_real(n, pattern, matrices, method.real / h):
        return False
    for p in range(len(method.pairs)):
        if not factorise_complex(n, pattern, matrices, p, method.pairs[p] / h):
            return False
    return True


@inlined
def _combine(weights, factor, source, count, target):
    """target = factor * weights source, for the first ``count`` unknowns of all stages."""
    for i in range(len(weights)):
        for k in range(count):
            target[i, k] = 0.0
        for j in range(len(weights)):
            weight = factor * weights[i, j]
            for k in range(count):
                target[i, k] += weight * source[j, k]


@kernel
def begin(n, h, method, start, s):
    """Stages of a start: coordinates and velocities by their rates, multipliers held."""
    for i in range(len(method.c)):
        t = method.c[i] * h
        for k in range(len(start.x)):
            s.m[i, k] = 0.0
            s.x[i, k] = start.x[k]
            if k < n:
                s.u[i, k], s.a[i, k] = start.v[k] + t * start.a[k], start.a[k]


@kernel
def go_back(past, s):
    """Stages of the step before, as the prediction kept them."""
    for i in range(len(past.x)):
        for k in range(s.x.shape[1]):
            s.x[i, k], s.u[i, k], s.a[i, k] = past.x[i, k], past.u[i, k], past.a[i, k]


@kernel
def _extrapolate(method, h, before, earlier, more, nodes, weights):
    """Weights (stages, stages + more) of the stages before, and of the last ``more`` of those earlier."""
    count = len(method.c)
    for j in range(count):
        nodes[j] = (method.c[j] - 1.0) * before
    for j in range(more):
        nodes[count + j] = (method.c[count - more + j] - 1.0) * earlier - before
    for i in range(count):
        for j in range(count + more):
            weight = 1.0
            for k in range(count + more):
                if k != j:
                    weight *= (method.c[i] * h - nodes[k]) / (nodes[j] - nodes[k])
            weights[i, j] = weight


@kernel
def go_on(n, h, method, before, earlier, past, s, b, weights):
    """Stages by the polynomial through those of the step before, and of the one earlier (0: without) in ``past``.

    They took ``before`` and ``earlier`` seconds; ``weights`` (stages + 1, 2 stages) is room. The stages before are then
    in ``past``.
    """
    count = len(method.c)
    more = 0 if earlier == 0.0 else method.more
    _extrapolate(method, h, before, earlier, more, weights[count], weights)
    width = s.x.shape[1]
    for i in range(count):
        for k in range(width):
            s.m[i, k] = 0.0
            b.place[i, k] = b.pace[i, k] = b.pull[i, k] = 0.0
        for j in range(count):
            weight = weights[i, j]
            for k in range(width):
                b.place[i, k] += weight * s.x[j, k]
                b.pace[i, k] += weight * s.u[j, k]
                b.pull[i, k] += weight * s.a[j, k]
        for j in range(more):
            weight, early = weights[i, count + j], count - more + j
            for k in range(width):
                b.place[i, k] += weight * past.x[early, k]
                b.pace[i, k] += weight * past.u[early, k]
                b.pull[i, k] += weight * past.a[early, k]
    go_back(s, past)
    for i in range(count):
        for k in range(width):
            s.x[i, k], s.u[i, k], s.a[i, k] = b.place[i, k], b.pace[i, k], b.pull[i, k]


@inlined
def _integrate_velocities(n, h, method, start, s):
    _combine(method.a, h, s.a, n, s.dv)
    for i in range(len(method.c)):
        for k in range(n):
            s.v[i, k] = start.v[k] + s.dv[i, k]


@kernel
def integrate_stages(n, h, method, start, s):
    """States of the stages by the rates."""
    _combine(method.a, h, s.u, n, s.dx)
    for i in range(len(method.c)):
        for k in range(n):
            s.x[i, k] = start.x[k] + s.dx[i, k]
    _integrate_velocities(n, h, method, start, s)


@kernel
def _correct_coordinates(n, size, method, pattern, matrices, h, b):
    """Corrections of the stages' coordinates, multipliers and rates by the residuals ``motion`` and ``weighed``."""
    given, answer = b.given, b.answer
    _combine(method.back, 1.0, b.motion, size, b.place)
    _combine(method.back, 1.0, b.weighed, n, b.pace)
    real = method.real / h
    square = real * real
    for k in range(size):  # what the velocities lack in weight acts as an inertial force
        given[k] = b.place[0, k] + real * b.pace[0, k] if k < n else square * b.place[0, k]
    solve(pattern.layout, matrices.real, given, answer)
    for k in range(size):
        if k < n:
            b.place[0, k], b.pace[0, k], b.pull[0, k] = answer[k] / square, answer[k] / real, answer[k]
        else:
            b.place[0, k] = answer[k]
    for p in range(len(method.pairs)):
        pair, i, j = method.pairs[p] / h, 2 * p + 1, 2 * p + 2
        double = pair * pair
        for k in range(size):
            z = complex(b.place[i, k], b.place[j, k])
            z = z + pair * complex(b.pace[i, k], b.pace[j, k]) if k < n else double * z
            given[k], given[size + k] = z.real, z.imag
        solve_complex(pattern, matrices, p, given, answer)
        for k in range(size):
            z = complex(answer[k], answer[size + k])
            if k < n:
                b.pull[i, k], b.pull[j, k] = z.real, z.imag
                z /= pair
                b.pace[i, k], b.pace[j, k] = z.real, z.imag
                z /= pair
            b.place[i, k], b.place[j, k] = z.real, z.imag


@kernel
def _take_coordinates(n, size, h, method, start, b, s):
    """Take the corrections off the stages; ``moved`` becomes that of the coordinates."""
    _combine(method.t, 1.0, b.place, size, b.moved)
    _combine(method.t, 1.0, b.pace, n, b.place)
    _combine(method.t, 1.0, b.pull, n, b.pace)
    for i in range(len(method.c)):
        for k in range(n):
            s.u[i, k] -= b.place[i, k]
            s.a[i, k] -= b.pace[i, k]
        for k in range(n, size):
            s.x[i, k] -= b.moved[i, k]
    integrate_stages(n, h, method, start, s)


@kernel
def _take_velocities(n, size, method, pattern, matrices, h, start, b, s):
    """Move the stages' velocities onto the constraints; ``moved`` becomes the size of the whole correction."""
    for i in range(len(method.c)):
        for k in range(size):
            b.given[k] = -b.weighed[i, k] if k < n else b.rate[i, k]
        solve(pattern.layout, matrices.rigid, b.given, b.answer)
        for k in range(size):
            b.place[i, k] = b.answer[k]
            if k < n:
                b.moved[i, k] = abs(b.moved[i, k]) + h * abs(b.answer[k])
            else:
                s.m[i, k] += b.answer[k]
    _combine(method.inverse, 1.0 / h, b.place, size, b.pace)
    for i in range(len(method.c)):
        for k in range(n):
            s.a[i, k] -= b.pace[i, k]
        for k in range(n, size):
            s.x[i, k] -= b.pace[i, k]
    _integrate_velocities(n, h, method, start, s)


@kernel
def _largest(n, scale, moves):
    """Largest correction of a coordinate against its scale, and which one."""
    norm, worst = 0.0, 0
    for i in range(len(moves)):
        for k in range(n):
            moved = abs(moves[i, k]) / scale[k]
            if norm == norm and not moved <= norm:  # the first that is not a number stays
                norm, worst = moved, k
    return norm, worst


@template
def converge(
    problem, method, pattern, matrices, model, damped, work, signals, h, start, s, b, tolerance, speed, limit,
):  # fmt: skip
    """Newton's iteration on the stages: whether it converged, iterations, last contraction, unknown that moved most.

    Corrections end at ``tolerance`` times the way that the coordinates go in the step, by ``speed`` (1/s) at least, in
    parts of their scales. The stages are given as predicted, with their integrals. It also
    ends where the estimated error of the step is certain to be larger than ``limit``.
    """
    n, size, count = problem.n, len(start.x) - 1, len(method.c)
    before, norm, rate, worst = 0.0, 1.0, 1.0, 0
    closed, seen = 0.0, False
    for k in range(n):
        closed = max(closed, _CLOSED * problem.scale[k])
    for iteration in range(1, _MOST_ITERATIONS + 1):
        for i in range(count):
            own = at_stage(work, signals, i)
            residual_here(model, n, s.x[i], s.v[i], s.a[i], own, 1.0, b.motion[i])
            for k in range(n, size):  # rounding would come back as velocities, 1/h times as large
                if abs(b.motion[i, k]) <= closed:
                    b.motion[i, k] = 0.0
            for k in range(n):
                b.given[k] = s.u[i, k] - s.v[i, k]
            for k in range(n, size + 1):
                b.given[k] = s.m[i, k]
            weigh(model, n, pattern, matrices, s.x[i], b.given, own, b.weighed[i])
        _correct_coordinates(n, size, method, pattern, matrices, h, b)
        _take_coordinates(n, size, h, method, start, b, s)
        for i in range(count):
            constraint_rates(model, n, s.x[i], s.v[i], s.a[i], at_stage(work, signals, i), b.rate[i], b.given)
        _take_velocities(n, size, method, pattern, matrices, h, start, b, s)
        norm, worst = _largest(n, problem.scale, b.moved)
        way = max(h * speed, _largest(n, problem.scale, s.dx)[0])
        if iteration > 1 and norm > _NOISE * way:
            rate = norm / before
        if not norm < 1e100 or (iteration > 2 and rate > 2.0 and norm > 1e-9):
            break
        if norm <= tolerance * way or (rate < 1.0 and norm * rate / (1.0 - rate) <= tolerance * way):
            return True, iteration, rate, worst
        if iteration > 2 and norm <= _ROUNDING and norm > 0.5 * before:
            return True, iteration, rate, worst
        before = norm
        if not seen and norm <= _VISIBLE * limit * min(1.0, h * speed):
            seen = True
            if estimate(problem, method, pattern, matrices, damped, h, start, s, b, speed) > 1.1 * limit:
                return True, iteration, rate, worst
    return norm <= _MAGNIFIED, iteration, rate, worst


@template
def converge_along(problem, method, pattern, matrices, tilted, work, signals, h, s, dstart, ds, b):
    """Derivatives ``ds`` of the converged stages along a direction, by the same iteration on imaginary parts."""
    n, size, count = problem.n, len(dstart.x) - 1, len(method.c)
    at = b.lifted
    begin(n, h, method, dstart, ds)
    integrate_stages(n, h, method, dstart, ds)
    before = 0.0
    for _ in range(4 * _MOST_ITERATIONS):
        for i in range(count):
            for k in range(size + 1):
                at[0, k] = complex(s.x[i, k], STEP * ds.x[i, k])
                at[1, k] = complex(s.v[i, k], STEP * ds.v[i, k])
                at[2, k] = complex(s.a[i, k], STEP * ds.a[i, k])
                at[3, k] = complex(s.u[i, k] - s.v[i, k], STEP * (ds.u[i, k] - ds.v[i, k]))
                if k >= n:
                    at[3, k] = complex(s.m[i, k], STEP * ds.m[i, k])
            own = at_stage(work, signals, i)
            residual(tilted, n, at[0], at[1], at[2], own, 1.0, at[4])
            weigh_along(tilted, n, at[0], at[3], own, at[7:], at[5])
            for k in range(size + 1):
                b.motion[i, k], b.weighed[i, k] = at[4, k].imag / STEP, at[5, k].imag / STEP
        _correct_coordinates(n, size, method, pattern, matrices, h, b)
        _take_coordinates(n, size, h, method, dstart, b, ds)
        for i in range(count):
            for k in range(size + 1):
                at[0, k] = complex(s.x[i, k], STEP * ds.x[i, k])
                at[1, k] = complex(s.v[i, k], STEP * ds.v[i, k])
            constraint_rates(tilted, n, at[0], at[1], at[2], at_stage(work, signals, i), at[4], at[5])
            for k in range(size + 1):
                b.rate[i, k] = at[4, k].imag / STEP
        _take_velocities(n, size, method, pattern, matrices, h, dstart, b, ds)
        norm = _largest(n, problem.scale, b.moved)[0]
        length = _largest(n, problem.scale, ds.dx)[0]
        if norm <= 1e-14 * length or not norm < 1e100 or (norm <= 1e-10 * length and norm > 0.5 * before):
            break
        before = norm


@kernel
def estimate(problem, method, pattern, matrices, damped, h, start, s, b, speed):
    """Estimated error of a step, as a part of the scales: of coordinates, and of velocities against ``speed``, 1/s.

    It is the difference to the method of the order of the stages that also weighs the rates at the start, by the
    reciprocal of the real eigenvalue (Hairer and Wanner 1996, IV.8.18).
    """
    n, size = problem.n, len(start.x) - 1
    real = method.real / h
    q, v, given, answer = b.weighed[0], b.weighed[1], b.given, b.answer
    for k in range(n):
        q[k], v[k] = start.v[k], start.a[k]
        for i in range(len(method.c)):
            q[k] -= method.start[i] * s.u[i, k]
            v[k] -= method.start[i] * s.a[i, k]
        q[k] /= real
        v[k] /= real
    for k in range(size):
        given[k] = 0.0
        if k < n:
            v[k] = v[k] / real + q[k]
    add_inertia(pattern, matrices, v, given)
    if damped:
        add_product(n, pattern, matrices.damping, q, 1.0 / real, given)
    solve(pattern.layout, matrices.real, given, answer)
    error = 0.0
    for k in range(n):
        error = max(error, abs(answer[k]) / problem.scale[k])
        v[k] = real * (answer[k] - q[k])
        given[k] = 0.0
    add_inertia(pattern, matrices, v, given)
    solve(pattern.layout, matrices.rigid, given, answer)
    for k in range(n):
        error = max(error, abs(answer[k]) / (problem.scale[k] * speed))
    return error
