"""A step of collocation: independent coordinates as a polynomial, the others by the constraints; what remains.

At a Gauss point the polynomial gives independent coordinates, velocities and accelerations, and the constraints the
dependent ones. What remains of the equations of motion is the gap between these accelerations and those that satisfy
the equations; the multipliers are taken from the equations, so that their gap is zero.
"""

from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators.consistent import accelerate
from dalembert.multibody.integrators.lifting import lift, set_signals
from dalembert.multibody.integrators.partitioning import (
    ACCELERATION,
    VELOCITY,
    Partition,
    choose,
    dependence,
    invert,
    linearise,
    room,
    settle,
)
from dalembert.multibody.integrators.problem import DONE, NEWTON_FAILED, SINGULAR
from dalembert.multibody.kernels.assembly import constraint_rates, residual, tangent
from dalembert.multibody.kernels.compiled import compiled, kernel, template
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import Factors, factorise, solve, storage
from dalembert.multibody.kernels.model import Work, select, workspace
from dalembert.multibody.kernels.motion import Motion, copy, row, still, subtract

_GROWN = 4.0  # dependence, against that of the first choice, at which other coordinates are chosen


class Schedule(NamedTuple):
    """Begins and ends of the steps, a time within each one's smooth stretch, whether it opens one, its first output."""

    begins: np.ndarray
    ends: np.ndarray
    within: np.ndarray
    opens: np.ndarray
    due: np.ndarray


class Walk(NamedTuple):
    """State and work of a run.

    ``c`` (count u,): the unknown accelerations of u independent coordinates; ``dc`` (directions, count u). ``points``
    (g, N + 1): states at the Gauss points. ``dpoint``: a state's derivatives by c, ``dall``: by c and along the
    directions. ``gaps`` (g, N + 1), ``slopes`` (g, directions of dall, N + 1): what remains, and its derivatives.
    ``chosen``: dependence at the choice of the independent coordinates; 0: none was made, or the last step had another.
    """

    old: Motion
    new: Motion
    between: Motion
    dold: Motion
    dnew: Motion
    dbetween: Motion
    c: np.ndarray
    dc: np.ndarray
    points: Motion
    dpoint: Motion
    dall: Motion
    gaps: np.ndarray
    slopes: np.ndarray
    shape: np.ndarray
    chosen: np.ndarray
    partition: Partition
    exact: Factors
    work: Work
    dual_work: Work
    lifted: np.ndarray


@compiled
def _rest(count, width):
    shape = count, width
    return Motion(np.zeros(shape), np.zeros(shape), np.zeros(shape), np.zeros(shape))


@compiled
def prepare(problem, rule, model, dual, directions):
    """Work of a run along that many directions."""
    width = problem.exact_layout.size + 1
    count, points = len(rule.powers), len(rule.nodes)
    unknowns = count * (2 * problem.n - width + 1)
    return Walk(
        still(width), still(width), still(width),
        _rest(directions, width), _rest(directions, width), _rest(directions, width),
        np.zeros(unknowns), np.zeros((directions, unknowns)),
        _rest(points, width), _rest(unknowns, width), _rest(unknowns + directions, width),
        np.zeros((points, width)), np.zeros((points, unknowns + directions, width)),
        np.zeros((3, count)), np.zeros(2), room(problem), storage(problem.exact_layout), workspace(model),
        workspace(dual), np.zeros((7, width), np.complex128),
    )  # fmt: skip


@template
def _choose(problem, dual, within, t, walk):
    """Keep the independent coordinates, or choose others; whether there are as many as at first."""
    own = walk.partition
    set_signals(dual, t, within, walk.dual_work)
    linearise(problem, dual, walk.old, walk.dual_work, own)
    if walk.chosen[0] > 0.0 and invert(problem, own) and dependence(problem, own) <= walk.chosen[0]:
        return True
    choose(problem, own)
    walk.chosen[1] = 0.0  # accelerations of the last step are those of other coordinates
    if own.rank[0] < len(own.rows) or not invert(problem, own):
        return False
    walk.chosen[0] = _GROWN * max(1.0, dependence(problem, own))
    return True


@kernel
def _predict(rule, n, walk):
    """Accelerations of the step: extrapolated, or those at its beginning."""
    rank, count = walk.partition.rank[0], len(rule.powers)
    independent = n - rank
    for i in range(independent):
        now = walk.old.a[walk.partition.columns[rank + i]]
        for k in range(count):
            walk.shape[0, k] = walk.c[k * independent + i]
        for k in range(count):
            ahead = rule.ahead[k, count] * now
            for j in range(count):
                ahead += rule.ahead[k, j] * walk.shape[0, j]
            walk.c[k * independent + i] = ahead if walk.chosen[1] > 0.0 else now
    walk.chosen[1] = 1.0


@kernel
def _guess(n, h, old, state):
    """All coordinates after a time h of constant accelerations."""
    copy(old, state)
    for i in range(n):
        state.x[i] += h * (old.v[i] + 0.5 * h * old.a[i])
        state.v[i] += h * old.a[i]


@kernel
def place(n, partition, h, s, shape, old, c, state):
    """Independent coordinates, velocities and accelerations by the polynomial at the fraction s of the step."""
    rank = partition.rank[0]
    independent = n - rank
    for i in range(independent):
        own = partition.columns[rank + i]
        x, v, a = 0.0, 0.0, 0.0
        for k in range(shape.shape[1]):
            x += shape[0, k] * c[k * independent + i]
            v += shape[1, k] * c[k * independent + i]
            a += shape[2, k] * c[k * independent + i]
        state.x[own] = old.x[own] + h * (s * old.v[own] + h * x)
        state.v[own] = old.v[own] + h * v
        state.a[own] = a


@kernel
def _shape(powers, s, shape):
    """The double and the single integral of Lagrange's polynomials, and themselves, at s."""
    for k in range(len(powers)):
        shape[0, k], shape[1, k], shape[2, k] = 0.0, 0.0, 0.0
        power = 1.0
        for j in range(len(powers)):
            shape[0, k] += powers[k, j] * power * s * s / ((j + 1) * (j + 2))
            shape[1, k] += powers[k, j] * power * s / (j + 1)
            shape[2, k] += powers[k, j] * power
            power *= s


@kernel
def _clear(state):
    for i in range(len(state.x)):
        state.x[i], state.v[i], state.a[i], state.w[i] = 0.0, 0.0, 0.0, 0.0


@template
def begin(problem, rule, model, dual, tilted, schedule, number, walk):
    """Begin a step: accelerations at a jump of the loads, independent coordinates, a prediction."""
    t, within = schedule.begins[number], schedule.within[number]
    if schedule.opens[number]:
        walk.chosen[1] = 0.0
        if not accelerate(
            problem, model, dual, tilted, t, within, walk.old, walk.dold, walk.work, walk.dual_work, walk.lifted,
            walk.exact,
        ):  # fmt: skip
            return SINGULAR
    if not _choose(problem, dual, within, t, walk):
        return SINGULAR
    _predict(rule, problem.n, walk)
    for s in range(len(rule.nodes)):
        _guess(problem.n, rule.nodes[s] * (schedule.ends[number] - t), walk.old, row(walk.points, s))
    return DONE


@template
def _drive(problem, model, dual, directions, t, within, state, dstates, walk):
    """Accelerations and multipliers by the equations of motion, and their derivatives; whether the matrix is regular.

    As `accelerate` does, for a state that `settle` has left, whose constraint Jacobian it takes: one tangent is enough
    where no friction depends on the multipliers.
    """
    n, last, exact, work = problem.n, len(state.x) - 1, walk.exact, walk.work
    given, answer, rate, second = np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1), np.zeros(last + 1)
    linear = len(model.frictions.index) == 0
    set_signals(dual, t, within, walk.dual_work)
    for iteration in range(2 if linear else 6):
        if iteration == 0 or not linear:
            tangent(
                dual, problem.exact_slots, n, state.x, state.v, state.a, (0.0, 0.0, 1.0), (1.0, 0.0), walk.dual_work,
                exact.matrix,
            )  # fmt: skip
            for i in range(len(exact.matrix)):
                exact.matrix[i] += walk.partition.matrix[i]
            if not factorise(problem.exact_layout, exact):
                return False
        residual(model, n, state.x, state.v, state.a, work, 1.0, given)
        constraint_rates(model, n, state.x, state.v, state.a, work, rate, second)
        for i in range(n, last):
            given[i] = second[i]
        solve(problem.exact_layout, exact, given, answer)
        subtract(n, answer, state)
    r, rates, seconds = walk.lifted[3], walk.lifted[4], walk.lifted[5]
    for d in range(len(dstates.x)):
        along, dstate = select(directions, d), row(dstates, d)
        set_signals(along, t, within, walk.dual_work)
        for _ in range(2):
            lift(n, state, dstate, walk.lifted)
            residual(along, n, walk.lifted[0], walk.lifted[1], walk.lifted[2], walk.dual_work, 1.0, r)
            constraint_rates(
                along, n, walk.lifted[0], walk.lifted[1], walk.lifted[2], walk.dual_work, rates, seconds
            )  # fmt: skip
            for i in range(last):
                given[i] = (r[i].imag if i < n else seconds[i].imag) / STEP
            solve(problem.exact_layout, exact, given, answer)
            subtract(n, answer, dstate)
    return True


@compiled
def measure(problem, rule, model, dual, directions, schedule, number, walk, dstates, s):
    """What remains at a Gauss point, and its derivatives by c and, in ``walk.dall``, along the directions.

    ``directions`` are the untilted model for each unknown, then the tilted ones.
    """
    n, own = problem.n, walk.partition
    begins, within = schedule.begins[number], schedule.within[number]
    h = schedule.ends[number] - begins
    t, shape, state = begins + rule.nodes[s] * h, rule.shapes[s], row(walk.points, s)
    place(n, own, h, rule.nodes[s], shape, walk.old, walk.c, state)
    rank, unknowns = own.rank[0], len(walk.c)
    independent = n - rank
    for d in range(len(dstates.x)):
        dstate = row(dstates, d)
        _clear(dstate)
        if d < unknowns:
            k, column = d // independent, own.columns[rank + d % independent]
            dstate.x[column], dstate.v[column] = h * h * shape[0, k], h * shape[1, k]
            dstate.a[column] = shape[2, k]
        else:
            dold = row(walk.dold, d - unknowns)
            for i in range(rank, n):
                column = own.columns[i]
                dstate.x[column] = dold.x[column] + rule.nodes[s] * h * dold.v[column]
                dstate.v[column] = dold.v[column]
    if not settle(
        problem, model, dual, directions, t, within, ACCELERATION, state, dstates, walk.work, walk.dual_work,
        walk.lifted, own,
    ):  # fmt: skip
        return False
    for i in range(n):
        walk.gaps[s, i] = state.a[i]
        for d in range(len(dstates.x)):
            walk.slopes[s, d, i] = dstates.a[d, i]
    if not _drive(problem, model, dual, directions, t, within, state, dstates, walk):
        return False
    for i in range(n):
        walk.gaps[s, i] -= state.a[i]
        for d in range(len(dstates.x)):
            walk.slopes[s, d, i] -= dstates.a[d, i]
    return True


@compiled
def _reach(problem, rule, model, dual, tilted, schedule, number, walk, share, state, dstates):
    """The state at a fraction of a step, consistent at all levels, with its derivatives."""
    n, own = problem.n, walk.partition
    begins, within = schedule.begins[number], schedule.within[number]
    h = schedule.ends[number] - begins
    t = schedule.ends[number] if share == 1.0 else begins + share * h
    _shape(rule.powers, share, walk.shape)
    _guess(n, share * h, walk.old, state)
    place(n, own, h, share, walk.shape, walk.old, walk.c, state)
    for d in range(len(dstates.x)):
        dold, dstate = row(walk.dold, d), row(dstates, d)
        copy(dold, dstate)
        place(n, own, h, share, walk.shape, dold, walk.dc[d], dstate)
    if not settle(
        problem, model, dual, tilted, t, within, VELOCITY, state, dstates, walk.work, walk.dual_work, walk.lifted, own
    ):
        return NEWTON_FAILED
    regular = accelerate(
        problem, model, dual, tilted, t, within, state, dstates, walk.work, walk.dual_work, walk.lifted,
        walk.exact,
    )  # fmt: skip
    return DONE if regular else SINGULAR


@kernel
def _record(state, dstates, out, dout, due):
    for i in range(len(state.x)):
        out.x[due, i], out.v[due, i], out.a[due, i] = state.x[i], state.v[i], state.a[i]
        for d in range(len(dstates.x)):
            dout.x[d, due, i], dout.v[d, due, i], dout.a[d, due, i] = dstates.x[d, i], dstates.v[d, i], dstates.a[d, i]


@template
def finish(problem, rule, model, dual, tilted, schedule, number, walk, out, dout):
    """End a step with the accelerations that were found: the next state, and those at the output times."""
    status = _reach(problem, rule, model, dual, tilted, schedule, number, walk, 1.0, walk.new, walk.dnew)
    if status != DONE:
        return status
    begins, ends = schedule.begins[number], schedule.ends[number]
    for due in range(schedule.due[number], schedule.due[number + 1]):
        share = (problem.times[due] - begins) / (ends - begins)
        if share <= 0.0:
            _record(walk.old, walk.dold, out, dout, due)
        elif share > 1.0 - 1e-9:
            _record(walk.new, walk.dnew, out, dout, due)
        else:
            status = _reach(
                problem, rule, model, dual, tilted, schedule, number, walk, share, walk.between, walk.dbetween
            )
            if status != DONE:
                return status
            _record(walk.between, walk.dbetween, out, dout, due)
    copy(walk.new, walk.old)
    for d in range(len(walk.dold.x)):
        copy(row(walk.dnew, d), row(walk.dold, d))
    return DONE
