"""One step of Radau IIA with three stages for the stabilised equations of Gear, Gupta and Leimkuhler.

With u = D (q - q0) and a = D (v - v0), D = A^-1 / h the differentiation of the collocation polynomial, each stage
fulfils M (u - v) + J^T m = 0, the equations of motion, the constraints and their rates. Newton's iteration is split. As
the multipliers m only weigh velocities against inertia, their part in the equations of motion joins that of lambda; so
the coordinates need one real and one complex system of the size of the mechanism (Hairer and Wanner 1996, IV.8), and
the velocities then follow by a projection at each stage.
"""

from typing import Any, NamedTuple

import numpy as np

from dalembert.multibody.integrators.matrices import add_inertia, add_product, factorise_complex, factorise_real
from dalembert.multibody.integrators.settling import weigh, weigh_along
from dalembert.multibody.kernels.assembly import constraint_rates, residual, residual_here
from dalembert.multibody.kernels.compiled import compiled, kernel
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import solve
from dalembert.multibody.kernels.motion import Motion

_R6 = np.sqrt(6.0)
C = np.array([(4 - _R6) / 10, (4 + _R6) / 10, 1.0])
_POWERS = C[:, None] ** np.arange(3)
A = (C[:, None] ** np.arange(1, 4) / np.arange(1, 4)) @ np.linalg.inv(_POWERS)
INVERSE = np.linalg.inv(A)


def _split() -> tuple[float, complex, np.ndarray]:
    """Eigenvalues of A^-1 and its real block form T: A^-1 T = T diag(g, [a, -b; b, a])."""
    eigen: Any = np.linalg.eig(INVERSE)
    values, vectors = eigen
    own = int(np.argmin(np.abs(values.imag)))
    pair = int(np.argmax(values.imag))
    columns = [vectors[:, own].real, vectors[:, pair].real, -vectors[:, pair].imag]
    return float(values[own].real), complex(values[pair]), np.array(columns).T


REAL, COMPLEX, T = _split()
TI = np.linalg.inv(T)
# Weights of the three stages in the difference to the embedded method of order 3 (Hairer and Wanner 1996, IV.8.19).
ERROR = np.array([-13 - 7 * _R6, -13 + 7 * _R6, -1.0]) / (3 * REAL)
_CLOSED = 1e-15  # violation against the largest scale that is rounding
_NOISE = 1e-13  # part of a step's way below which the ratio of two corrections says nothing
# Relative corrections that stop to shrink are rounding below the first size, and below the second one if a nearly
# singular position magnifies it.
_ROUNDING, _MAGNIFIED = 1e-12, 1e-9
_MOST_ITERATIONS = 14


class Stages(NamedTuple):
    """States of the three stages, each array (3, N + 1).

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
    """Residuals ``motion``, ``weighed`` and ``rate`` (3, N + 1), corrections ``dx`` and ``dm``, some vectors."""

    motion: np.ndarray
    weighed: np.ndarray
    rate: np.ndarray
    dx: np.ndarray
    dm: np.ndarray
    given: np.ndarray
    answer: np.ndarray
    lifted: np.ndarray


@compiled
def stages(width):
    """Stages at rest."""
    return Stages(
        np.zeros((3, width)), np.zeros((3, width)), np.zeros((3, width)), np.zeros((3, width)),
        np.zeros((3, width)), np.zeros((3, width)), np.zeros((3, width)),
    )  # fmt: skip


@compiled
def copies(states):
    """A stack of states of the same shape, at rest."""
    return Motion(np.zeros_like(states.x), np.zeros_like(states.x), np.zeros_like(states.x), np.zeros_like(states.x))


@compiled
def buffers(width):
    """Room for a step."""
    return Buffers(
        np.zeros((3, width)), np.zeros((3, width)), np.zeros((3, width)), np.zeros((3, width)), np.zeros((3, width)),
        np.zeros(2 * width), np.zeros(2 * width), np.zeros((10, width), np.complex128),
    )  # fmt: skip


@kernel
def factorise(n, pattern, matrices, h):
    """Factorise the systems of a step; whether they are regular."""
    return factorise_real(n, pattern, matrices, REAL / h) and factorise_complex(n, pattern, matrices, COMPLEX / h)


@kernel
def begin(n, h, start, s):
    """Stages of a start: coordinates and velocities by their rates, multipliers held."""
    for i in range(3):
        t = C[i] * h
        for k in range(len(start.x)):
            s.m[i, k] = 0.0
            s.x[i, k] = start.x[k]
            if k < n:
                s.u[i, k], s.a[i, k] = start.v[k] + t * start.a[k], start.a[k]


@kernel
def go_back(past, s):
    """Stages of the step before, as the prediction kept them."""
    for i in range(3):
        for k in range(s.x.shape[1]):
            s.x[i, k], s.u[i, k], s.a[i, k] = past.x[i, k], past.u[i, k], past.a[i, k]


@kernel
def go_on(n, h, before, earlier, past, s, weights):
    """Stages by the polynomial through those of the step before, and of the one earlier (0: without) in ``past``.

    They took ``before`` and ``earlier`` seconds; ``weights`` (4, 6) is room. The stages before are then in ``past``.
    """
    count = 3 if earlier == 0.0 else 6
    nodes = weights[3]
    for j in range(3):
        nodes[j], nodes[3 + j] = (C[j] - 1.0) * before, (C[j] - 1.0) * earlier - before
    for i in range(3):
        for j in range(count):
            weight = 1.0
            for k in range(count):
                if k != j:
                    weight *= (C[i] * h - nodes[k]) / (nodes[j] - nodes[k])
            weights[i, j] = weight
    for k in range(s.x.shape[1]):
        x0, x1, x2 = s.x[0, k], s.x[1, k], s.x[2, k]
        u0, u1, u2 = s.u[0, k], s.u[1, k], s.u[2, k]
        a0, a1, a2 = s.a[0, k], s.a[1, k], s.a[2, k]
        for i in range(3):
            w0, w1, w2 = weights[i, 0], weights[i, 1], weights[i, 2]
            s.m[i, k] = 0.0
            if k < n:
                s.u[i, k] = w0 * u0 + w1 * u1 + w2 * u2
                s.a[i, k] = w0 * a0 + w1 * a1 + w2 * a2
            else:
                s.x[i, k] = w0 * x0 + w1 * x1 + w2 * x2
            for j in range(count - 3):
                weight = weights[i, 3 + j]
                if k < n:
                    s.u[i, k] += weight * past.u[j, k]
                    s.a[i, k] += weight * past.a[j, k]
                else:
                    s.x[i, k] += weight * past.x[j, k]
        past.x[0, k], past.x[1, k], past.x[2, k] = x0, x1, x2
        past.u[0, k], past.u[1, k], past.u[2, k] = u0, u1, u2
        past.a[0, k], past.a[1, k], past.a[2, k] = a0, a1, a2


@kernel
def integrate_stages(n, h, start, s):
    """States of the stages by the rates."""
    for i in range(3):
        d0, d1, d2 = h * A[i, 0], h * A[i, 1], h * A[i, 2]
        for k in range(n):
            s.dx[i, k] = d0 * s.u[0, k] + d1 * s.u[1, k] + d2 * s.u[2, k]
            s.dv[i, k] = d0 * s.a[0, k] + d1 * s.a[1, k] + d2 * s.a[2, k]
            s.x[i, k] = start.x[k] + s.dx[i, k]
            s.v[i, k] = start.v[k] + s.dv[i, k]


@kernel
def _rates_of(values, k, h):
    """Rates at the stages of the polynomial that is zero at the start and has ``values[:, k]`` at the stages."""
    x0, x1, x2 = values[0, k] / h, values[1, k] / h, values[2, k] / h
    return (
        INVERSE[0, 0] * x0 + INVERSE[0, 1] * x1 + INVERSE[0, 2] * x2,
        INVERSE[1, 0] * x0 + INVERSE[1, 1] * x1 + INVERSE[1, 2] * x2,
        INVERSE[2, 0] * x0 + INVERSE[2, 1] * x1 + INVERSE[2, 2] * x2,
    )


@kernel
def _correct_coordinates(n, size, pattern, matrices, h, b):
    """Corrections ``dx`` of the stages' coordinates and multipliers by the residuals ``motion`` and ``weighed``."""
    g, w, given, answer = b.motion, b.weighed, b.given, b.answer
    real, pair = REAL / h, COMPLEX / h
    square, own = pair * pair, real * real
    for k in range(size):
        if k < n:  # what the velocities lack in weight acts as an inertial force
            w0, w1, w2 = w[0, k], w[1, k], w[2, k]
            for i in range(3):
                g[i, k] += (INVERSE[i, 0] * w0 + INVERSE[i, 1] * w1 + INVERSE[i, 2] * w2) / h
        g0, g1, g2 = g[0, k], g[1, k], g[2, k]
        for i in range(3):
            g[i, k] = TI[i, 0] * g0 + TI[i, 1] * g1 + TI[i, 2] * g2
        if k >= n:
            turned = square * complex(g[1, k], g[2, k])
            g[0, k], g[1, k], g[2, k] = own * g[0, k], turned.real, turned.imag
        given[k] = g[0, k]
    solve(pattern.layout, matrices.real, given, answer)
    for k in range(size):
        g[0, k] = answer[k] / own if k < n else answer[k]
        given[k], given[size + k] = g[1, k], g[2, k]
    solve(pattern.double_layout, matrices.double, given, answer)
    for k in range(size):
        z = complex(answer[k], answer[size + k])
        if k < n:
            z /= square
        g0 = g[0, k]
        for i in range(3):
            b.dx[i, k] = T[i, 0] * g0 + T[i, 1] * z.real + T[i, 2] * z.imag


@kernel
def _take_coordinates(n, size, h, start, b, s):
    """Take ``dx`` off the stages; velocities follow the coordinates."""
    for k in range(size):
        if k < n:
            rates = _rates_of(b.dx, k, h)
            for i in range(3):
                s.u[i, k] -= rates[i]
                b.dm[i, k] = rates[i]
            rates = _rates_of(b.dm, k, h)
            for i in range(3):
                s.a[i, k] -= rates[i]
        else:
            for i in range(3):
                s.x[i, k] -= b.dx[i, k]
    integrate_stages(n, h, start, s)


@kernel
def _take_velocities(n, size, pattern, matrices, h, start, b, s):
    """Move the stages' velocities onto the constraints; ``dx`` becomes the size of the whole correction."""
    for i in range(3):
        for k in range(size):
            b.given[k] = -b.weighed[i, k] if k < n else b.rate[i, k]
        solve(pattern.layout, matrices.rigid, b.given, b.answer)
        for k in range(size):
            b.dm[i, k] = b.answer[k]
            if k < n:
                b.dx[i, k] = abs(b.dx[i, k]) + h * abs(b.answer[k])
            else:
                s.m[i, k] += b.answer[k]
    for k in range(size):
        rates = _rates_of(b.dm, k, h)
        for i in range(3):
            if k < n:
                s.a[i, k] -= rates[i]
            else:
                s.x[i, k] -= rates[i]
    integrate_stages(n, h, start, s)


@kernel
def _largest(n, scale, dx):
    """Largest correction of a coordinate against its scale, and which one."""
    norm, worst = 0.0, 0
    for i in range(3):
        for k in range(n):
            moved = abs(dx[i, k]) / scale[k]
            if norm == norm and not moved <= norm:  # the first that is not a number stays
                norm, worst = moved, k
    return norm, worst


@kernel
def converge(problem, pattern, matrices, model, works, h, start, s, b, tolerance, least):
    """Newton's iteration on the stages: whether it converged, iterations, last contraction, unknown that moved most.

    Corrections end at ``tolerance`` times the way that the coordinates go in the step, and at least ``least``, in parts
    of their scales. The stages are given as predicted, with their integrals.
    """
    n, size = problem.n, len(start.x) - 1
    before, norm, rate, worst = 0.0, 1.0, 1.0, 0
    closed = 0.0
    for k in range(n):
        closed = max(closed, _CLOSED * problem.scale[k])
    for iteration in range(1, _MOST_ITERATIONS + 1):
        for i in range(3):
            residual_here(model, n, s.x[i], s.v[i], s.a[i], works[i], 1.0, b.motion[i])
            for k in range(n, size):  # rounding would come back as velocities, 1/h times as large
                if abs(b.motion[i, k]) <= closed:
                    b.motion[i, k] = 0.0
            for k in range(n):
                b.given[k] = s.u[i, k] - s.v[i, k]
            for k in range(n, size + 1):
                b.given[k] = s.m[i, k]
            weigh(model, n, pattern, matrices, s.x[i], b.given, works[i], b.weighed[i])
        _correct_coordinates(n, size, pattern, matrices, h, b)
        _take_coordinates(n, size, h, start, b, s)
        for i in range(3):
            constraint_rates(model, n, s.x[i], s.v[i], s.a[i], works[i], b.rate[i], b.given)
        _take_velocities(n, size, pattern, matrices, h, start, b, s)
        norm, worst = _largest(n, problem.scale, b.dx)
        way = max(least, _largest(n, problem.scale, s.dx)[0])
        if iteration > 1 and norm > _NOISE * way:
            rate = norm / before
        if not norm < 1e100 or (iteration > 2 and rate > 2.0 and norm > 1e-9):
            break
        if norm <= tolerance * way or (rate < 1.0 and norm * rate / (1.0 - rate) <= tolerance * way):
            return True, iteration, rate, worst
        if iteration > 2 and norm <= _ROUNDING and norm > 0.5 * before:
            return True, iteration, rate, worst
        before = norm
    return norm <= _MAGNIFIED, iteration, rate, worst


@compiled
def converge_along(problem, pattern, matrices, tilted, works, h, s, dstart, ds, b):
    """Derivatives ``ds`` of the converged stages along a direction, by the same iteration on imaginary parts."""
    n, size = problem.n, len(dstart.x) - 1
    at = b.lifted
    begin(n, h, dstart, ds)
    integrate_stages(n, h, dstart, ds)
    before = 0.0
    for _ in range(4 * _MOST_ITERATIONS):
        for i in range(3):
            for k in range(size + 1):
                at[0, k] = complex(s.x[i, k], STEP * ds.x[i, k])
                at[1, k] = complex(s.v[i, k], STEP * ds.v[i, k])
                at[2, k] = complex(s.a[i, k], STEP * ds.a[i, k])
                at[3, k] = complex(s.u[i, k] - s.v[i, k], STEP * (ds.u[i, k] - ds.v[i, k]))
                if k >= n:
                    at[3, k] = complex(s.m[i, k], STEP * ds.m[i, k])
            residual(tilted, n, at[0], at[1], at[2], works[i], 1.0, at[4])
            weigh_along(tilted, n, at[0], at[3], works[i], at[7:], at[5])
            for k in range(size + 1):
                b.motion[i, k], b.weighed[i, k] = at[4, k].imag / STEP, at[5, k].imag / STEP
        _correct_coordinates(n, size, pattern, matrices, h, b)
        _take_coordinates(n, size, h, dstart, b, ds)
        for i in range(3):
            for k in range(size + 1):
                at[0, k] = complex(s.x[i, k], STEP * ds.x[i, k])
                at[1, k] = complex(s.v[i, k], STEP * ds.v[i, k])
            constraint_rates(tilted, n, at[0], at[1], at[2], works[i], at[4], at[5])
            for k in range(size + 1):
                b.rate[i, k] = at[4, k].imag / STEP
        _take_velocities(n, size, pattern, matrices, h, dstart, b, ds)
        norm = _largest(n, problem.scale, b.dx)[0]
        length = _largest(n, problem.scale, ds.dx)[0]
        if norm <= 1e-14 * length or not norm < 1e100 or (norm <= 1e-10 * length and norm > 0.5 * before):
            break
        before = norm


@kernel
def estimate(problem, pattern, matrices, damped, h, start, s, b, speed):
    """Estimated error of a step, as a part of the scales: of coordinates, and of velocities against ``speed``, 1/s."""
    n, size = problem.n, len(start.x) - 1
    s1 = REAL / h
    q, v, given, answer = b.weighed[0], b.weighed[1], b.given, b.answer
    for k in range(n):
        q[k], v[k] = start.v[k] / s1, start.a[k] / s1
        for i in range(3):
            q[k] += ERROR[i] * s.dx[i, k]
            v[k] += ERROR[i] * s.dv[i, k]
    for k in range(size):
        given[k] = 0.0
        if k < n:
            v[k] = v[k] / s1 + q[k]
    add_inertia(pattern, matrices, v, given)
    if damped:
        add_product(n, pattern, matrices.damping, q, 1.0 / s1, given)
    solve(pattern.layout, matrices.real, given, answer)
    error = 0.0
    for k in range(n):
        error = max(error, abs(answer[k]) / problem.scale[k])
        v[k] = s1 * (answer[k] - q[k])
        given[k] = 0.0
    add_inertia(pattern, matrices, v, given)
    solve(pattern.layout, matrices.rigid, given, answer)
    for k in range(n):
        error = max(error, abs(answer[k]) / (problem.scale[k] * speed))
    return error
