"""The adjoint of generalized-alpha: its steps in reverse order, one transposed solution each.

A step solves r(q, v, a, lambda; numbers) = 0, with q and v by the linear formulas of the step from the old state and a.
The adjoint of the new state goes in, that of the old state comes out (`docs/theory/adjoint.md`).
"""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inlined, kernel
from dalembert.kernels.views import address_of, call
from dalembert.kernels.words import Address, Integers, Integers2, Reals, Reals2
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.assembly import residual, set_signals
from dalembert.multibody.kernels.linear import Factors, Layout, factorise, storage
from dalembert.multibody.kernels.records import BLOCK_SIZE, block_at, call_at, model_at
from dalembert.multibody.kernels.states import MotionState, clear, coefficients
from dalembert.multibody.kernels.transposed import solve_transposed, transposed


class Steps(NamedTuple):
    """Steps of a motion: length, end, and the time that says on which side of a jump the end lies, s, (steps,)."""

    lengths: Reals
    ends: Reals
    sides: Reals


class StateHistory(NamedTuple):
    """Unknowns, velocities and accelerations of several states, (states, N + 1)."""

    x: Reals2
    v: Reals2
    a: Reals2


class Cotangents(NamedTuple):
    """Cotangents of sampled states, (samples, N + 1), the step that each lies in, and the share of it, (samples,)."""

    x: Reals2
    v: Reals2
    a: Reals2
    steps: Integers
    shares: Reals


class Pulls(NamedTuple):
    """What takes the gradients by the numbers of a model. ``blocks`` (blocks, 3): addresses of a block, of its kernel
    and of its record. ``signals``: address of the kernel of the signals, 0 if none matters, with that of its record.
    ``bars`` (signals, 3): adjoints of the signals.
    """

    blocks: Integers2
    signals: Address
    signal_record: Address
    bars: Reals2


class ResidualDerivatives(NamedTuple):
    """Derivatives of the residuals of some blocks, each entry once. ``blocks``: their numbers, with the ``slots`` of
    their entries. ``rows``, ``columns`` and ``values`` of the entries, and their ``places`` in the matrix that is
    factorised.
    """

    blocks: Integers
    slots: Integers
    rows: Integers
    columns: Integers
    places: Integers
    values: Reals


class InternalMultipliers(NamedTuple):
    """What finds the multipliers of internal constraints: a model in real numbers, and a call. ``nodes`` (kinds, 2) are
    the kernel of each kind of nodes, and its block. ``r`` is the residual.
    """

    model: Address
    work: Address
    nodes: Integers2
    r: Reals


class SweepWorkspace(NamedTuple):
    """Work of the sweep: a call for gradients by numbers, which are complex steps, and one for tangents, the matrix
    with its transposed solution, parts of it, vectors.
    ``masses`` are those that do not change, in the places of the matrix. ``by_x``, ``by_v`` and ``by_a`` are the parts
    along coordinates, velocities (of blocks that depend on them), and accelerations (of blocks whose masses vary).
    ``multipliers`` finds those of internal constraints.
    """

    work: Address
    tangent_work: Address
    factors: Factors
    solve: Address
    masses: Reals
    by_x: ResidualDerivatives
    by_v: ResidualDerivatives
    by_a: ResidualDerivatives
    right: Reals
    mu: Reals
    of_q: Reals
    of_v: Reals
    past: MotionState
    multipliers: InternalMultipliers


def sweep_workspace(
    layout: Layout, width: int, work: int, tangent_work: int,
    parts: tuple[ResidualDerivatives, ResidualDerivatives, ResidualDerivatives], multipliers: InternalMultipliers,
) -> SweepWorkspace:  # fmt: skip
    """Workspace for a sweep over vectors of ``width``; its masses are zero, and filled before the sweep. ``work``,
    ``tangent_work``: addresses of calls; ``parts``: derivatives of the residual by q, v and a.
    """
    right, mu, of_q, of_v, *past = np.zeros((8, width))
    factors = storage(layout)
    return SweepWorkspace(
        work, tangent_work, factors, transposed(layout).address, np.zeros(len(factors.matrix)), *parts, right, mu,
        of_q, of_v, MotionState(*past), multipliers,
    )  # fmt: skip


@inlined
def _fill(model, n, x, v, a, by, scratch, part):
    """Fill the values of a part with the derivative along ``by[0] dq + by[1] dv + by[2] da``, and the multipliers."""
    own, values = call_at(scratch.tangent_work), part.values
    for k in range(len(values)):
        values[k] = 0.0
    own.x, own.v, own.a = address_of(x), address_of(v), address_of(a)
    own.matrix, own.entries = address_of(values), len(values)
    own.increments, own.last_row = n, len(x) - 1
    own.by_x, own.by_v, own.by_a = by
    own.motion, own.constraint = 1.0, 1.0
    for k in range(len(part.blocks)):
        block = model_at(model).blocks + part.blocks[k] * BLOCK_SIZE
        own.slots = part.slots[k]
        call(block_at(block).tangent, scratch.tangent_work, block)


@inlined
def _add(n, part, factor, matrix):
    """Add a part, times a factor, to the matrix: the columns of coordinates alone."""
    for k in range(len(part.values)):
        if part.columns[k] < n:
            matrix[part.places[k]] += factor * part.values[k]


@inlined
def _fill_matrix(model, n, c, x, v, a, scratch):
    """Fill the matrix of a step, M + dv C + dq K beside the constraints, and its parts."""
    matrix, by_x = scratch.factors.matrix, scratch.by_x
    for k in range(len(matrix)):
        matrix[k] = scratch.masses[k]
    _fill(model, n, x, v, a, (1.0, 0.0, 0.0), scratch, by_x)
    for k in range(len(by_x.values)):
        # K is weighed by dq; J^T and J stay: the rows of the constraints are divided by dq after the solution, as the
        # forward step divides them before.
        scale = c.dq if by_x.rows[k] < n and by_x.columns[k] < n else 1.0
        matrix[by_x.places[k]] += scale * by_x.values[k]
    if len(scratch.by_v.blocks) > 0:
        _fill(model, n, x, v, a, (0.0, 1.0, 0.0), scratch, scratch.by_v)
        _add(n, scratch.by_v, c.dv, matrix)
    if len(scratch.by_a.blocks) > 0:
        _fill(model, n, x, v, a, (0.0, 0.0, 1.0), scratch, scratch.by_a)
        _add(n, scratch.by_a, 1.0, matrix)


@kernel
def fixed_masses(
    tangent_model: Address, n: int, x: Reals, v: Reals, a: Reals, part: ResidualDerivatives, scratch: SweepWorkspace
) -> None:
    """Fill the masses of the blocks of a part, which do not change, in the places of the matrix."""
    clear(scratch.masses)
    if len(part.blocks) > 0:
        _fill(tangent_model, n, x, v, a, (0.0, 0.0, 1.0), scratch, part)
        _add(n, part, 1.0, scratch.masses)


@inlined
def _take_samples(n, h, k, given, left, bar, past):
    """Add the cotangents of the samples in step ``k`` to those of its ends; return how many samples are left."""
    while left > 0 and given.steps[left - 1] == k:
        left -= 1
        s, cx, cv, ca = given.shares[left], given.x[left], given.v[left], given.a[left]
        if s > 1.0 - 1e-9:
            for i in range(len(cx)):
                bar.x[i] += cx[i]
                bar.v[i] += cv[i]
                bar.a[i] += ca[i]
            continue
        # The transpose of the cubic interpolation of `states.interpolate`: what a sample reads from both ends of the
        # step, it gives back to their adjoints with the same weights.
        s0, s1 = 1 - 3 * s * s + 2 * s**3, 3 * s * s - 2 * s**3
        t0, t1 = h * (s - 2 * s * s + s**3), h * (s**3 - s * s)
        for i in range(n):
            bar.x[i] += s1 * cx[i]
            bar.v[i] += t1 * cx[i] + s1 * cv[i]
            bar.a[i] += t1 * cv[i] + s * ca[i]
            past.x[i] += s0 * cx[i]
            past.v[i] += t0 * cx[i] + s0 * cv[i]
            past.a[i] += t0 * cv[i] + (1 - s) * ca[i]
        for i in range(n, len(cx)):
            bar.x[i] += s * cx[i]
            past.x[i] += (1 - s) * cx[i]
    return left


@inlined
def _fill_multipliers(n, t, within, x, v, a, own):
    """Give the multipliers of internal constraints their values, which a step of the reduced system leaves open."""
    # The step solves N^T r = 0 beside the internal constraints G. That is r + G^T l = 0 with multipliers l: the step of
    # the full system, whose derivatives hold G^T l differentiated by q.
    if len(own.nodes) > 0:
        set_signals(own.model, t, within, own.work)
        residual(own.model, n, x, v, a, own.work, 1.0, own.r)
        for k in range(len(own.nodes)):
            call(own.nodes[k, 0], own.work, own.nodes[k, 1])


@inlined
def _multiply_transposed(part, mu, answer):
    """Product of a transposed part with mu."""
    clear(answer)
    for k in range(len(part.values)):
        answer[part.columns[k]] += part.values[k] * mu[part.rows[k]]


@inlined
def _step_back(n, c, bar, past):
    """Take the adjoint through the linear formulas of the step, from its end to its start."""
    h = c.step
    scale = 1.0 / (1.0 - c.alpha_m)
    old_a, lag = c.alpha_f * scale, c.alpha_m * scale
    half, beta = h * h * (0.5 - c.beta), h * h * c.beta
    early, late = h * (1.0 - c.gamma), h * c.gamma
    # The transpose of `states.advance`: w_{n+1} enters q_{n+1}, v_{n+1} and the next step, so its adjoint is the sum of
    # all three, and is passed on to a_n and w_n.
    for i in range(n):
        q, v, w = bar.x[i], bar.v[i], bar.w[i]
        total = beta * q + late * v + w
        bar.x[i] = q + past.x[i]
        bar.v[i] = h * q + v + past.v[i]
        bar.a[i] = old_a * total + past.a[i]
        bar.w[i] = half * q + early * v - lag * total
    for i in range(n, len(bar.x)):
        bar.x[i] = past.x[i]


@kernel
def sweep(
    problem: IntegrationProblem, model: Address, tangent_model: Address, radius: float, steps: Steps, first: int,
    path: StateHistory, given: Cotangents,
    pulls: Pulls, bar: MotionState, scratch: SweepWorkspace,
) -> int:  # fmt: skip
    """Run the adjoint over steps in reverse order; return -1, or the number of a step whose matrix is singular.

    ``model``: in complex numbers without imaginary parts, for gradients by its numbers; ``tangent_model``: with the
    kernels of tangents; ``radius``: spectral radius of the method; ``first``: number of the first of these steps in the
    whole motion, as the cotangents count; ``path``: states at the ends of the steps, (steps, N + 1); ``given``: in the
    order of time; those of these steps; ``bar``: adjoint of the last state; overwritten with that of the state before
    the first step.
    """
    n, size, layout, past, mu = problem.n, len(bar.x) - 1, problem.exact_layout, scratch.past, scratch.mu
    left = len(given.steps)
    # From the last step to the first one. The residual of the step, r(q, v, a, l; numbers) = 0, defines a and l; the
    # formulas of the step define q, v and w from a.
    for k in range(len(steps.ends) - 1, -1, -1):
        c = coefficients(steps.lengths[k], radius)
        share = (1.0 - c.alpha_f) / (1.0 - c.alpha_m)
        x, v, a = path.x[k], path.v[k], path.a[k]
        clear(past.x)
        clear(past.v)
        clear(past.a)
        left = _take_samples(n, c.step, first + k, given, left, bar, past)
        _fill_multipliers(n, steps.ends[k], steps.sides[k], x, v, a, scratch.multipliers)
        set_signals(tangent_model, steps.ends[k], steps.sides[k], scratch.tangent_work)
        _fill_matrix(tangent_model, n, c, x, v, a, scratch)
        if not factorise(layout, scratch.factors):
            return k
        # All adjoints of the new state by the accelerations, through the formulas of the step: the right side of (M +
        # dv C + dq K, J)^T mu = ...
        for i in range(n):
            scratch.right[i] = bar.a[i] + share * bar.w[i] + c.dv * bar.v[i] + c.dq * bar.x[i]
        for i in range(n, size):
            scratch.right[i] = bar.x[i]
        solve_transposed(scratch.solve, layout, scratch.factors, scratch.right, mu)
        for i in range(n, size):
            mu[i] /= c.dq
        # What is left for q and v of the state at the end of the step: their own adjoint less r_q^T mu and r_v^T mu.
        _multiply_transposed(scratch.by_x, mu, scratch.of_q)
        for i in range(n):
            bar.x[i] -= scratch.of_q[i]
        if len(scratch.by_v.blocks) > 0:
            _multiply_transposed(scratch.by_v, mu, scratch.of_v)
            for i in range(n):
                bar.v[i] -= scratch.of_v[i]
        # Gradients by numbers before the state is left.
        set_signals(model, steps.ends[k], steps.sides[k], scratch.work)
        own = call_at(scratch.work)
        own.x, own.v, own.a = address_of(x), address_of(v), address_of(a)
        pull(model, pulls, scratch.mu, scratch.work)
        _step_back(n, c, bar, past)
    return -1


@inlined
def pull(model, pulls, mu, work):
    """Add mu^T times the derivatives of the residual to the gradients, at the state and the time of the call."""
    own = call_at(work)
    own.r = address_of(mu)
    for k in range(len(pulls.blocks)):
        own.slots = pulls.blocks[k, 2]
        call(pulls.blocks[k, 1], work, pulls.blocks[k, 0])
    if pulls.signals != 0:
        call(pulls.signals, work, pulls.signal_record)
        for s in range(len(pulls.bars)):
            for rate in range(3):
                pulls.bars[s, rate] = 0.0


@kernel
def pull_once(
    model: Address, t: float, within: float, x: Reals, v: Reals, a: Reals, mu: Reals, pulls: Pulls, work: Address
) -> None:
    """Add mu^T times the derivatives of the residual of one state to the gradients."""
    set_signals(model, t, within, work)
    own = call_at(work)
    own.x, own.v, own.a = address_of(x), address_of(v), address_of(a)
    pull(model, pulls, mu, work)
