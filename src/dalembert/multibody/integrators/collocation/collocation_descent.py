"""Gauss and Newton's minimisation of what remains in a collocation step, and the derivatives of its minimum."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Reals, Reals2
from dalembert.multibody.integrators.collocation.collocation_gap import measure
from dalembert.multibody.integrators.collocation.collocation_rule import Rule
from dalembert.multibody.integrators.collocation.collocation_step import (
    CollocationRun,
    Schedule,
    ScheduleStep,
    begin,
    finish,
    step_of,
)
from dalembert.multibody.integrators.shared.problem import (
    DONE,
    NEWTON_FAILED,
    SINGULAR,
    IntegrationProblem,
    Log,
    SampleModels,
    note_step,
)
from dalembert.multibody.kernels.linear import Factors, factorise, resized, solve, storage
from dalembert.multibody.kernels.states import Histories, MotionStates, clear

_ROUNDING = 1e-15  # change of a coordinate over the step, against its scale, that is none
_COARSE = 1e-6  # the same, after the last iteration, that is too much
_DIFFERENCE = 1e-5  # the same, for differences of the derivatives


class Descent(NamedTuple):
    """Normal equations of a step: the matrix, right sides (1 + directions, u count), a solution, and the gaps kept.

    ``respond``: address of the kernel for the derivatives of the minimum, 0 if there are none.
    """

    normal: Factors
    right: Reals2
    change: Reals
    remaining: Reals2
    respond: Address


def descent(problem: IntegrationProblem, walk: CollocationRun) -> Descent:
    """Workspace for the normal equations of a run."""
    directions, unknowns = walk.dc.shape
    along = respond.address if directions else 0
    return Descent(
        storage(resized(problem.exact_layout, unknowns)), np.zeros((1 + directions, unknowns)), np.zeros(unknowns),
        np.zeros(walk.gaps.shape), along,
    )  # fmt: skip


@inner
def _square(n, rule, gaps, slopes, unknowns, count, matrix, lead, right):
    """Normal matrix, by columns, of the weighted squares, the gaps' and the other slopes' products with them."""
    clear(matrix)
    for j in range(len(right)):
        clear(right[j])
    for s in range(len(rule.nodes)):
        # slopes^T W slopes for the unknowns, slopes^T W (slopes along directions) for the derivatives, slopes^T W gaps.
        for k in range(unknowns):
            for j in range(count):
                product = 0.0
                for i in range(n):
                    product += slopes[s, k, i] * slopes[s, j, i]
                if j < unknowns:
                    matrix[j * lead + k] += rule.weights[s] * product
                else:
                    right[1 + j - unknowns, k] += rule.weights[s] * product
            product = 0.0
            for i in range(n):
                product += slopes[s, k, i] * gaps[s, i]
            right[0, k] += rule.weights[s] * product


@kernel
def descend(
    problem: IntegrationProblem,
    rule: Rule,
    iterations: int,
    models: SampleModels,
    step: ScheduleStep,
    walk: CollocationRun,
    scratch: Descent,
) -> tuple[int, int, int]:
    """Gauss and Newton's iterations: status, how many they were, and the coordinate that moved most."""
    n, own, unknowns = problem.n, walk.partition, len(walk.c)
    layout, normal, right, change = (
        resized(problem.exact_layout, unknowns),
        scratch.normal,
        scratch.right,
        scratch.change,
    )
    h = step.end - step.begin
    rank = own.rank[0]
    largest, worst = 0.0, 0
    for iteration in range(1, iterations + 1):
        for s in range(len(rule.nodes)):
            if not measure(problem, rule, models, step, walk, False, s):
                return NEWTON_FAILED, iteration, worst
        _square(n, rule, walk.gaps, walk.slopes, unknowns, unknowns, normal.matrix, layout.lead, right)
        if not factorise(layout, normal):
            return SINGULAR, iteration, worst
        solve(layout, normal, right[0], change)
        largest = 0.0
        for k in range(unknowns):
            walk.c[k] -= change[k]
            # What the change of an acceleration moves its coordinate over the step.
            column = int(own.columns[rank + k % (n - rank)])
            moved = h * h * abs(change[k]) / problem.scale[column]
            if largest == largest and not moved <= largest:
                largest, worst = moved, column
        if not largest > _ROUNDING:
            break
    return (DONE if largest <= _COARSE else NEWTON_FAILED), iteration, worst


@kernel
def respond(
    problem: IntegrationProblem,
    rule: Rule,
    models: SampleModels,
    step: ScheduleStep,
    walk: CollocationRun,
    scratch: Descent,
) -> bool:
    """Derivatives of the minimum along the directions, by the derivative of its gradient; whether the minimum is
    regular. The first derivatives of what remains are exact. Its second ones, which stand beside what remains at the
    minimum, are central differences of the exact first ones; where the polynomial can satisfy the equations at all
    Gauss points nothing remains, and none are needed.
    """
    n, own, unknowns, count = problem.n, walk.partition, len(walk.c), walk.slopes.shape[1]
    layout, normal, right, change = (
        resized(problem.exact_layout, unknowns),
        scratch.normal,
        scratch.right,
        scratch.change,
    )
    for s in range(len(rule.nodes)):
        if not measure(problem, rule, models, step, walk, True, s):
            return False
    _square(n, rule, walk.gaps, walk.slopes, unknowns, count, normal.matrix, layout.lead, right)
    # With more Gauss points than powers something remains at the minimum: its gradient, slopes^T W gaps = 0, changes by
    # the second derivatives too, sum_i gaps_i d(slopes_i).
    if len(rule.nodes) > len(rule.powers):
        remaining = scratch.remaining
        for s in range(len(rule.nodes)):
            for i in range(n):
                remaining[s, i] = walk.gaps[s, i]
        h = step.end - step.begin
        rank = own.rank[0]
        for k in range(unknowns):
            here = walk.c[k]
            # An acceleration that moves its coordinate by 1e-5 of its scale over the step.
            push = _DIFFERENCE * problem.scale[own.columns[rank + k % (n - rank)]] / (h * h)
            for side in range(2):
                walk.c[k] = here + (2 * side - 1) * push
                for s in range(len(rule.nodes)):
                    if not measure(problem, rule, models, step, walk, True, s):
                        return False
                    for j in range(count):
                        product = 0.0
                        for i in range(n):
                            product += remaining[s, i] * walk.slopes[s, j, i]
                        product *= (2 * side - 1) * rule.weights[s] / (2.0 * push)
                        if j < unknowns:
                            normal.matrix[j * layout.lead + k] += product
                        else:
                            right[1 + j - unknowns, k] += product
            walk.c[k] = here
    if not factorise(layout, normal):
        return False
    for d in range(count - unknowns):
        solve(layout, normal, right[1 + d], change)
        for k in range(unknowns):
            # d(gradient)/dc dc + d(gradient)/dp = 0.
            walk.dc[d, k] = -change[k]
    return True


_respond_at = respond.at


@kernel
def march(
    problem: IntegrationProblem, rule: Rule, most: int, moving: SampleModels, models: SampleModels,
    schedule: Schedule, walk: CollocationRun,
    out: MotionStates, dout: Histories, log: Log, scratch: Descent,
) -> tuple[int, float, int]:  # fmt: skip
    """All steps by at most so many iterations: status, time reached, the coordinate that moved most.

    ``moving``: the same models with directions of the unknown accelerations before those of the parameters.
    """
    for number in range(len(schedule.begins)):
        step, taken, worst = step_of(schedule, number), 0, 0
        # Gauss and Newton may diverge from an extrapolation over an event; the accelerations at the start are never
        # far.
        for _ in range(2):  # from extrapolated accelerations; where that fails, from those at the step's beginning
            status = begin(problem, rule, models, step, walk)
            if status == DONE:
                status, iterations, worst = descend(problem, rule, most, moving, step, walk, scratch)
                taken += iterations
            if status == DONE:
                break
            walk.chosen[1] = 0.0
        if status == DONE and len(walk.dc) > 0:
            if not _respond_at(scratch.respond, problem, rule, moving, step, walk, scratch):
                status = SINGULAR
        if status == DONE:
            status = finish(problem, rule, models, step, walk, out, dout)
        if status != DONE:
            return status, step.begin, worst
        log.counts[1] += taken
        note_step(log, taken, step.end)
    return DONE, schedule.ends[-1], 0
