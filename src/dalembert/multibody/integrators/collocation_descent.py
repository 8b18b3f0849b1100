"""Gauss and Newton's minimisation of what remains in a collocation step, and the derivatives of its minimum."""

import numpy as np

from dalembert.multibody.integrators.collocation_step import begin, finish, measure
from dalembert.multibody.integrators.problem import DONE, NEWTON_FAILED, SINGULAR
from dalembert.multibody.kernels.compiled import compiled, template
from dalembert.multibody.kernels.linear import Layout, factorise, solve, storage
from dalembert.multibody.kernels.vector import LANES

_ROUNDING = 1e-15  # change of a coordinate over the step, against its scale, that is none
_COARSE = 1e-6  # the same, after the last iteration, that is too much
_DIFFERENCE = 1e-5  # the same, for differences of the derivatives


@template
def _normal(problem, size):
    """Layout of a dense matrix of that size."""
    whole = problem.exact_layout
    return Layout(whole.kind, size, whole.reach, -(-size // LANES) * LANES, whole.order)


@compiled
def _square(n, rule, gaps, slopes, unknowns, count, matrix, lead, right):
    """Normal matrix, by columns, of the weighted squares, the gaps' and the other slopes' products with them."""
    matrix[:] = 0.0
    right[:] = 0.0
    for s in range(len(rule.nodes)):
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


@template
def descend(problem, rule, iterations, model, dual, directions, schedule, number, walk):
    """Gauss and Newton's iterations: status, how many they were, and the coordinate that moved most."""
    n, own, unknowns = problem.n, walk.partition, len(walk.c)
    layout = _normal(problem, unknowns)
    normal = storage(layout)
    right, change = np.zeros((1, unknowns)), np.zeros(unknowns)
    h = schedule.ends[number] - schedule.begins[number]
    rank = own.rank[0]
    largest, worst = 0.0, 0
    for iteration in range(1, iterations + 1):
        for s in range(len(rule.nodes)):
            if not measure(problem, rule, model, dual, directions, schedule, number, walk, walk.dpoint, s):
                return NEWTON_FAILED, iteration, worst
        _square(n, rule, walk.gaps, walk.slopes, unknowns, unknowns, normal.matrix, layout.lead, right)
        if not factorise(layout, normal):
            return SINGULAR, iteration, worst
        solve(layout, normal, right[0], change)
        largest = 0.0
        for k in range(unknowns):
            walk.c[k] -= change[k]
            column = own.columns[rank + k % (n - rank)]
            moved = h * h * abs(change[k]) / problem.scale[column]
            if largest == largest and not moved <= largest:
                largest, worst = moved, column
        if not largest > _ROUNDING:
            break
    return (DONE if largest <= _COARSE else NEWTON_FAILED), iteration, worst


@template
def respond(problem, rule, model, dual, directions, schedule, number, walk):
    """Derivatives of the minimum along the directions, by the derivative of its gradient.

    The first derivatives of what remains are exact. Its second ones, which stand beside what remains at the minimum,
    are central differences of the exact first ones; where the polynomial can satisfy the equations at all Gauss points
    nothing remains, and none are needed. Whether the minimum is regular.
    """
    n, own, unknowns = problem.n, walk.partition, len(walk.c)
    for s in range(len(rule.nodes)):
        if not measure(problem, rule, model, dual, directions, schedule, number, walk, walk.dall, s):
            return False
    count = walk.slopes.shape[1]
    layout = _normal(problem, unknowns)
    normal = storage(layout)
    right, change = np.zeros((1 + count - unknowns, unknowns)), np.zeros(unknowns)
    _square(n, rule, walk.gaps, walk.slopes, unknowns, count, normal.matrix, layout.lead, right)
    if len(rule.nodes) > len(rule.powers):
        remaining = walk.gaps.copy()
        h = schedule.ends[number] - schedule.begins[number]
        rank = own.rank[0]
        for k in range(unknowns):
            here = walk.c[k]
            push = _DIFFERENCE * problem.scale[own.columns[rank + k % (n - rank)]] / (h * h)
            for side in range(2):
                walk.c[k] = here + (2 * side - 1) * push
                for s in range(len(rule.nodes)):
                    if not measure(problem, rule, model, dual, directions, schedule, number, walk, walk.dall, s):
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
            walk.dc[d, k] = -change[k]
    return True


@compiled
def march(problem, rule, most, model, dual, directions, tilted, schedule, walk, out, dout, log):
    """All steps by at most so many iterations: status, time reached, the coordinate that moved most."""
    for number in range(len(schedule.begins)):
        t, taken, worst = schedule.begins[number], 0, 0
        for _ in range(2):  # from extrapolated accelerations; where that fails, from those at the step's beginning
            status = begin(problem, rule, model, dual, tilted, schedule, number, walk)
            if status == DONE:
                status, iterations, worst = descend(
                    problem, rule, most, model, dual, directions, schedule, number, walk
                )  # fmt: skip
                taken += iterations
            if status == DONE:
                break
            walk.chosen[1] = 0.0
        if status == DONE and len(walk.dc) > 0:
            if not respond(problem, rule, model, dual, directions, schedule, number, walk):
                status = SINGULAR
        if status == DONE:
            status = finish(problem, rule, model, dual, tilted, schedule, number, walk, out, dout)
        if status != DONE:
            return status, t, worst
        log.counts[0] += 1
        log.counts[1] += taken
        if number < len(log.iterations):
            log.iterations[number], log.ends[number] = taken, schedule.ends[number]
    return DONE, schedule.ends[-1], 0
