"""Coordinates parted into independent ones and those that the constraints make follow (Wehage and Haug 1982).

With q = (u, d) and J = [J_u, J_d]: d from Phi(u, d, t) = 0 by Newton's iteration, d' from J_d d' = -J_u u' - Phi_t,
and d'' from the second rate of the constraints alike (`docs/theory/index-1.md`).
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Complexes2, Integers, Reals, Reals2
from dalembert.multibody.integrators.shared.problem import POSITION, VELOCITY, IntegrationProblem, SampleModels
from dalembert.multibody.kernels.assembly import constraint_forces, constraint_rates, set_signals, tangent
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.linear import DENSE, Factors, factorise, resized, solve, storage
from dalembert.multibody.kernels.slopes import perturb
from dalembert.multibody.kernels.states import MotionState, MotionStates, clear, row

DEPENDENT = 1e-9  # pivot, against the first one, of a constraint that follows from the others
_MOST_ITERATIONS = 20
_CLOSED = 1e-9  # correction against the scale after which a quadratic iteration is at rounding


class Partition(NamedTuple):
    """Which coordinates depend on which constraints, and the work of solving for them. ``columns`` (n,) and ``rows``
    (m,): coordinates and constraints in the order of their pivots; the first ``rank[0]`` of them are the dependent
    coordinates and the independent constraints. ``matrix``: the constraint Jacobian in the dense layout of the problem.
    ``pivots`` (m, n): what elimination leaves. ``dependent``: inverse of the dependent part. ``along``: address of the
    kernel for derivatives of a settled state, 0 if there are none.
    """

    columns: Integers
    rows: Integers
    rank: Integers
    matrix: Reals
    pivots: Reals2
    dependent: Factors
    gap: Reals
    second: Reals
    change: Reals
    along: Address


def scratch(problem: IntegrationProblem, directions: int) -> Partition:
    """Workspace for a partition, for a dense matrix of the problem (`Structure.dense`); else for its Jacobian only."""
    layout, n = problem.exact_layout, problem.n
    m = layout.size - n if layout.kind == DENSE else 0
    along, vector = settle_along.address if directions else 0, np.zeros((3, layout.size + 1))
    return Partition(
        np.arange(n), np.arange(m), np.zeros(1, np.int64), np.zeros(layout.lead * layout.size), np.zeros((m, n)),
        storage(resized(layout, m)), vector[0], vector[1], vector[2], along,
    )  # fmt: skip


@inner
def linearise(problem, tangent_model, state, complex_work, partition):
    """The constraint Jacobian of a state; the signals in ``complex_work`` hold the time."""
    tangent(
        tangent_model, problem.exact_slots, problem.n, state.x, state.v, state.a, (1.0, 0.0, 0.0), (0.0, 1.0),
        complex_work, partition.matrix,
    )  # fmt: skip


@kernel
def choose(problem: IntegrationProblem, partition: Partition, dependent: float) -> None:
    """Order coordinates and constraints by complete pivoting of the constraint Jacobian, in units of their scales.

    A constraint whose pivot, against the first one, is at most ``dependent`` follows from the others.
    """
    n, lead, a = problem.n, problem.exact_layout.lead, partition.pivots
    rows, columns = partition.rows, partition.columns
    m = len(rows)
    for j in range(n):
        columns[j] = j
    for i in range(m):
        rows[i] = i
        # Each column in the unit of its coordinate, each row with its largest entry one: pivots compare independent of
        # units.
        largest = 0.0
        for j in range(n):
            a[i, j] = partition.matrix[j * lead + n + i] * problem.scale[j]
            largest = max(largest, abs(a[i, j]))
        for j in range(n):
            a[i, j] /= largest + 1e-300
    first = 1.0
    partition.rank[0] = 0
    for k in range(min(m, n)):
        p, q = k, k
        # Complete pivoting (Wehage and Haug 1982): the largest entry left says which coordinate follows best from which
        # constraint.
        for i in range(k, m):
            for j in range(k, n):
                if abs(a[i, j]) > abs(a[p, q]):
                    p, q = i, j
        if k == 0:
            first = abs(a[p, q])
        if not abs(a[p, q]) > dependent * first:
            return
        rows[k], rows[p] = rows[p], rows[k]
        columns[k], columns[q] = columns[q], columns[k]
        for j in range(n):
            a[k, j], a[p, j] = a[p, j], a[k, j]
        for i in range(m):
            a[i, k], a[i, q] = a[i, q], a[i, k]
        # Gaussian elimination below the pivot.
        for i in range(k + 1, m):
            factor = a[i, k] / a[k, k]
            for j in range(k, n):
                a[i, j] -= factor * a[k, j]
        partition.rank[0] = k + 1


@inner
def invert(problem, partition):
    """Invert the dependent part of the Jacobian; whether it is regular."""
    rank, lead = partition.rank[0], problem.exact_layout.lead
    layout = resized(problem.exact_layout, rank)
    for j in range(rank):
        for i in range(rank):
            entry = partition.matrix[partition.columns[j] * lead + problem.n + partition.rows[i]]
            partition.dependent.matrix[j * layout.lead + i] = entry
        for i in range(rank, layout.lead):
            partition.dependent.matrix[j * layout.lead + i] = 0.0
    return factorise(layout, partition.dependent)


@inner
def dependence(problem, partition):
    """Largest change of a dependent coordinate by an independent one, in units of their scales.

    It grows without bound where the dependent part becomes singular: time to choose others.
    """
    rank, lead, scale = partition.rank[0], problem.exact_layout.lead, problem.scale
    largest = 0.0
    for k in range(rank, problem.n):
        own = partition.columns[k]
        for i in range(rank):
            partition.gap[i] = partition.matrix[own * lead + problem.n + partition.rows[i]]
        # A column of J_d^-1 J_u.
        solve(resized(problem.exact_layout, rank), partition.dependent, partition.gap, partition.change)
        for i in range(rank):
            largest = max(largest, abs(partition.change[i]) * scale[own] / scale[partition.columns[i]])
    return largest


@inner
def fill_gap(model, n, level, x, v, a, work, gap, second):
    """The constraints, or their first or second rates, into the entries of ``gap`` from n on."""
    if level == POSITION:
        clear(gap)
        constraint_forces(model, x, v, a, work, gap)
    elif level == VELOCITY:
        constraint_rates(model, n, x, v, a, work, gap, second)
    else:
        constraint_rates(model, n, x, v, a, work, second, gap)


@inner
def _shift(problem, partition, level, state):
    """Correct the dependent entries of a level by the gaps in ``partition.second``; the largest correction."""
    n, rank, columns = problem.n, partition.rank[0], partition.columns
    for i in range(rank):
        partition.gap[i] = partition.second[n + partition.rows[i]]
    solve(resized(problem.exact_layout, rank), partition.dependent, partition.gap, partition.change)
    values, largest = state.x if level == POSITION else (state.v if level == VELOCITY else state.a), 0.0
    for i in range(rank):
        moved, c = partition.change[i], columns[i]
        size = abs(moved) / problem.scale[c]
        if largest == largest and not size <= largest:  # the first that is not a number stays
            largest = size
        values[c] -= moved
    return largest


@inner
def _close(problem, model, tangent_model, state, work, complex_work, partition):
    """Newton's iteration on the dependent coordinates; whether it arrived."""
    for _ in range(_MOST_ITERATIONS):
        linearise(problem, tangent_model, state, complex_work, partition)
        if not invert(problem, partition):
            return False
        fill_gap(model, problem.n, POSITION, state.x, state.v, state.a, work, partition.second, partition.gap)
        moved = _shift(problem, partition, POSITION, state)
        # The next correction would be the square of this one.
        if moved <= _CLOSED:
            return True
        if not moved < 1e100:
            return False
    return False


@kernel
def settle(
    problem: IntegrationProblem, models: SampleModels, t: float, within: float, levels: int, state: MotionState,
    dstates: MotionStates,
    work: Address, complex_work: Address, complex_state: Complexes2, partition: Partition,
) -> bool:  # fmt: skip
    """Make the dependent entries of a state satisfy the constraints, and those of its derivatives along directions. The
    independent entries stay as they are. ``levels``: `POSITION`, `VELOCITY` or `ACCELERATION`, each with those before
    it. ``complex_state``: complex work (5, N + 1). Whether the constraints could be satisfied.
    """
    n = problem.n
    set_signals(models.real, t, within, work)
    set_signals(models.tangents, t, within, complex_work)
    if not _close(problem, models.real, models.tangents, state, work, complex_work, partition):
        return False
    for level in range(POSITION, levels + 1):
        for _ in range(1 if level == POSITION else 2):  # linear from the velocities on; once more for rounding
            fill_gap(models.real, n, level, state.x, state.v, state.a, work, partition.second, partition.gap)
            _shift(problem, partition, level, state)
    if len(dstates.x) > 0:
        _settle_along_at(
            partition.along, problem, models.directions, t, within, levels, state, dstates, complex_work, complex_state,
            partition,
        )  # fmt: skip
    return True


@kernel
def settle_along(
    problem: IntegrationProblem, directions: Integers, t: float, within: float, levels: int, state: MotionState,
    dstates: MotionStates, complex_work: Address, complex_state: Complexes2, partition: Partition,
) -> None:  # fmt: skip
    """Derivatives of the dependent entries of a settled state, one direction for each of ``dstates``."""
    n = problem.n
    for d in range(len(dstates.x)):
        perturbed, dstate = directions[d], row(dstates, d)
        set_signals(perturbed, t, within, complex_work)
        for level in range(POSITION, levels + 1):
            # J_d is exact, so the first solution is the derivative; the second one takes its rounding.
            for _ in range(2):
                perturb(n, state, dstate, complex_state)
                fill_gap(
                    perturbed, n, level, complex_state[0], complex_state[1], complex_state[2], complex_work,
                    complex_state[3], complex_state[4],
                )  # fmt: skip
                for i in range(n, len(state.x) - 1):
                    partition.second[i] = complex_state[3, i].imag / STEP
                _shift(problem, partition, level, dstate)


_settle_along_at = settle_along.at
