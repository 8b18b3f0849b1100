"""One step of Radau IIA for the stabilised equations of Gear, Gupta and Leimkuhler.

With u = D (q - q0) and a = D (v - v0), D = A^-1 / h the differentiation of the collocation polynomial, each stage
fulfils M (u - v) + J^T m = 0, the equations of motion, the constraints and their rates. Newton's iteration is split. As
the multipliers m only weigh velocities against inertia, their part in the equations of motion joins that of lambda; so
the coordinates need one real system of the size of the mechanism and a complex one for each two other stages (Hairer
and Wanner 1996, IV.8), and the velocities then follow by a projection at each stage.
"""

from dalembert.kernels.kernel import inlined, inner
from dalembert.multibody.integrators.radau.radau_stages import combine, integrate_stages, integrate_velocities
from dalembert.multibody.integrators.shared.convergence import (
    BALANCED,
    CLOSED,
    MAGNIFIED,
    NOISE,
    ROUNDING,
    largest_entry,
)
from dalembert.multibody.integrators.shared.matrices import (
    add_inertia,
    add_product,
    factorise_complex,
    factorise_real,
    inverse,
    product,
    solve_complex,
    times,
)
from dalembert.multibody.integrators.shared.settling import weigh
from dalembert.multibody.kernels.assembly import constraint_rates, residual
from dalembert.multibody.kernels.elementary import size_of
from dalembert.multibody.kernels.linear import solve
from dalembert.multibody.kernels.linear_lanes import solve_slopes

MOST_ITERATIONS = 14
_VISIBLE = 0.03  # part of the tolerance from which corrections hardly change the estimated error


@inner
def factorise(n, method, matrices, h):
    """Factorise the systems of a step; whether they are regular."""
    if not factorise_real(n, matrices, method.real / h):
        return False
    for p in range(len(method.pairs)):
        if not factorise_complex(n, matrices, p, _scaled(method.pairs[p], h)):
            return False
    return True


@inlined
def _scaled(pair, h):
    """A complex number over a real one."""
    return complex(pair.real / h, pair.imag / h)


@inner
def correct_coordinates(n, size, method, matrices, h, b):
    """Corrections of the stages' coordinates, multipliers and rates by the residuals ``motion`` and ``weighed``. Along
    each eigenvector of D = A^-1 / h, with eigenvalue s: the system [M + C/s + K/s^2, J^T; J, 0]
    (`docs/theory/radau.md`) for ``motion`` + s ``weighed``. Its solution is the correction of v' (``change_a``); that
    of q' is 1/s times it, that of q 1/s^2 times it.
    """
    given, answer, change_x, change_u, change_a = b.given, b.answer, b.change_x, b.change_u, b.change_a
    pairs = method.pairs
    # Along the eigenvectors of D the stages are no longer coupled: one real eigenvalue, and pairs of complex ones, of
    # which one of each is enough.
    combine(method.back, 1.0, b.motion, size, change_x)
    combine(method.back, 1.0, b.weighed, n, change_u)
    real = method.real / h
    square = real * real
    for k in range(size):  # what the velocities lack in weight acts as an inertial force
        given[k] = change_x[0, k] + real * change_u[0, k] if k < n else square * change_x[0, k]
    solve_slopes(matrices.pattern.layout, matrices.real, given, answer)
    for k in range(size):
        if k < n:
            change_x[0, k], change_u[0, k], change_a[0, k] = answer[k] / square, answer[k] / real, answer[k]
        else:
            change_x[0, k] = answer[k]
    # Real and imaginary part of a complex unknown are kept in the rows of two stages.
    for p in range(len(pairs)):
        pair, i, j = _scaled(pairs[p], h), 2 * p + 1, 2 * p + 2
        double, back = product(pair, pair), inverse(pair)
        for k in range(size):
            if k < n:
                x, y = times(pair, change_u[i, k], change_u[j, k])
                given[k], given[size + k] = change_x[i, k] + x, change_x[j, k] + y
            else:
                given[k], given[size + k] = times(double, change_x[i, k], change_x[j, k])
        solve_complex(matrices, p, given, answer)
        for k in range(size):
            x, y = answer[k], answer[size + k]
            if k < n:
                change_a[i, k], change_a[j, k] = x, y
                x, y = times(back, x, y)
                change_u[i, k], change_u[j, k] = x, y
                x, y = times(back, x, y)
            change_x[i, k], change_x[j, k] = x, y


@inner
def take_coordinates(n, size, h, method, start, b, s):
    """Take the corrections off the stages; ``moved`` becomes that of the coordinates."""
    change_x, change_u, moved, x, u, a = b.change_x, b.change_u, b.moved, s.x, s.u, s.a
    # Back from the eigenvectors to the stages. Rates are corrected, not coordinates: their integrals by A keep a
    # rounding that is h times smaller.
    combine(method.t, 1.0, change_x, size, moved)
    combine(method.t, 1.0, change_u, n, change_x)
    combine(method.t, 1.0, b.change_a, n, change_u)
    for i in range(len(x)):
        for k in range(n):
            u[i, k] -= change_x[i, k]
            a[i, k] -= change_u[i, k]
        for k in range(n, size):
            x[i, k] -= moved[i, k]
    integrate_stages(n, h, method, start, s)


@inner
def take_velocities(n, size, method, matrices, h, start, b, s):
    """Move the stages' velocities onto the constraints; ``moved`` becomes the size of the whole correction.

    M w + J^T m = -(M (q' - v) + J^T mu), J w = J v + Phi_t at each stage: the same matrix without C and K.
    """
    given, answer, change_x, change_u, moved = b.given, b.answer, b.change_x, b.change_u, b.moved
    weighed, rate, x, a, m = b.weighed, b.rate, s.x, s.a, s.m
    # The stages are not coupled at the level of velocities: one system with the masses alone each.
    for i in range(len(x)):
        for k in range(size):
            given[k] = -weighed[i, k] if k < n else rate[i, k]
        solve_slopes(matrices.pattern.layout, matrices.rigid, given, answer)
        for k in range(size):
            change_x[i, k] = answer[k]
            if k < n:
                moved[i, k] = size_of(moved[i, k]) + h * size_of(answer[k])
            else:
                m[i, k] += answer[k]
    # What the projection changes of the velocities, as a change of the rates of their polynomial and of the
    # multipliers, D w.
    combine(method.inverse, 1.0 / h, change_x, size, change_u)
    for i in range(len(x)):
        for k in range(n):
            a[i, k] -= change_u[i, k]
        for k in range(n, size):
            x[i, k] -= change_u[i, k]
    integrate_velocities(n, h, method, start, s)


@inner
def largest(n, scale, moves):
    """Largest correction of a coordinate against its scale, and which one."""
    norm, worst = 0.0, 0
    for i in range(len(moves)):
        for k in range(n):
            moved = abs(moves[i, k]) / scale[k]
            if norm == norm and not moved <= norm:  # the first that is not a number stays
                norm, worst = moved, k
    return norm, worst


@inner
def converge(n, scale, method, matrices, model, damped, works, h, start, s, b, tolerance, speed, limit):
    """Newton's iteration on the stages, which are given as predicted, with their integrals. Answers whether it
    converged, iterations, last contraction, unknown that moved most, and the estimated error of the step if there is a
    ``limit`` for it. Corrections end at ``tolerance`` times the way that the coordinates go in the step, by ``speed``
    (1/s) at least, in parts of their scales. It also ends where the estimated error is certain to be larger than
    ``limit``.
    """
    size, count = len(start.x) - 1, len(method.c)
    before, norm, rate, worst = 0.0, 1.0, 1.0, 0
    closed, seen, converged, error, rate_error, force = 0.0, False, False, 0.0, 0.0, 0.0
    for k in range(n):
        closed = max(closed, CLOSED * scale[k])
    given, motion, x, v, a, u, m = b.given, b.motion, s.x, s.v, s.a, s.u, s.m
    for iteration in range(1, MOST_ITERATIONS + 1):
        # First half: positions. The residuals of all stages by the kernels, then their solution along the eigenvectors.
        for i in range(count):
            residual(model, n, x[i], v[i], a[i], works[i], 1.0, motion[i])
            if iteration == 1:  # of the prediction, and of the constraints
                force = max(force, largest_entry(motion[i], 0, n), largest_entry(x[i], n, size))
            for k in range(n, size):  # what is left of it is rounding, and would disturb the rates at each iteration
                if iteration > 2 and abs(motion[i, k]) <= closed:
                    motion[i, k] = 0.0
            for k in range(n):
                given[k] = u[i, k] - v[i, k]
            for k in range(n, size + 1):
                given[k] = m[i, k]
            weigh(model, n, matrices, x[i], given, works[i], b.weighed[i], b.answer)
        correct_coordinates(n, size, method, matrices, h, b)
        take_coordinates(n, size, h, method, start, b, s)
        # Second half: velocities, at the coordinates that the first half has just moved.
        for i in range(count):
            constraint_rates(model, n, x[i], v[i], a[i], works[i], b.rate[i], given)
        take_velocities(n, size, method, matrices, h, start, b, s)
        norm, worst = largest(n, scale, b.moved)
        way = max(h * speed, largest(n, scale, s.dx)[0])
        if iteration > 1 and norm > NOISE * way:
            rate = norm / before
        # Not a number, or it diverges while far from rounding.
        lost = not norm < 1e100 or (iteration > 2 and rate > 2.0 and norm > 1e-9)
        # The sum of the corrections to come, as a part of the way of the step: an error of a coordinate is compared
        # with what the step moves it.
        done = not lost and (norm <= tolerance * way or (rate < 1.0 and norm * rate / (1.0 - rate) <= tolerance * way))
        stalled = iteration > 2 and norm <= ROUNDING and norm > 0.5 * before
        if not done and (stalled or (iteration == MOST_ITERATIONS and norm <= MAGNIFIED)):
            done = True
            for i in range(count):
                done = done and largest_entry(motion[i], 0, n) <= BALANCED * force
        ended, converged = lost or done or iteration == MOST_ITERATIONS, done
        # Once corrections are small against the tolerance, the estimate will not change much: a step that is certain to
        # be refused ends here, which saves its last iterations.
        visible = not lost and not done and not seen and norm <= _VISIBLE * limit * min(1.0, h * speed)
        if visible or (converged and limit > 0.0):
            seen = True
            error, rate_error = estimate(n, scale, method, matrices, damped, h, start, s, b)
        if visible and max(error, rate_error / speed) > 1.1 * limit:
            converged = ended = True
        if ended:
            break
        before = norm
    return converged, iteration, rate, worst, error, rate_error


@inner
def estimate(n, scale, method, matrices, damped, h, start, s, b):
    """Estimated error of a step, as a part of the scales: of coordinates, and of velocities, 1/s. It is the difference
    to the method of the order of the stages that also weighs the rates at the start, by the reciprocal of the real
    eigenvalue (Hairer and Wanner 1996, IV.8.18). Rates of the coordinates are the velocities of the stages: ``u`` also
    holds the rounding of constraints over h, and viscous forces C would turn it into velocities, C M^-1 times the
    rounding, whatever the step.
    """
    size, a = len(start.x) - 1, s.a
    real = method.real / h
    # The embedded formula is y_0 weighed by 1/gamma_0 with the stages, filtered by the real system of the step, so that
    # stiff components do not dominate it.
    q, v, given, answer = b.weighed[0], b.weighed[1], b.given, b.answer
    for k in range(n):
        q[k], v[k] = start.v[k], start.a[k]
        for i in range(len(a)):
            q[k] -= method.start[i] * s.v[i, k]
            v[k] -= method.start[i] * a[i, k]
        q[k] /= real
        v[k] /= real
    for k in range(size):
        given[k] = 0.0
        if k < n:
            v[k] = v[k] / real + q[k]
    # Coordinates: [M + C/s + K/s^2, J^T; J, 0] with M (v/s + q) + C q/s, s the real eigenvalue over h.
    add_inertia(matrices, v, given)
    if damped:
        add_product(n, matrices, matrices.damping, q, 1.0 / real, given)
    solve(matrices.pattern.layout, matrices.real, given, answer)
    error, rate_error = 0.0, 0.0
    for k in range(n):
        error = max(error, abs(answer[k]) / scale[k])
        # Velocities: what the same formula gives for them, projected onto the constraints by the masses.
        v[k] = real * (answer[k] - q[k])
        given[k] = 0.0
    add_inertia(matrices, v, given)
    solve(matrices.pattern.layout, matrices.rigid, given, answer)
    for k in range(n):
        rate_error = max(rate_error, abs(answer[k]) / scale[k])
    return error, rate_error
