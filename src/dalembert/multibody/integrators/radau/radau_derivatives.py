"""Derivatives of the converged steps of Radau IIA along directions, and of the states at the ends of steps."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.duals import Dual
from dalembert.kernels.kernel import Compiled, inner
from dalembert.kernels.views import address_of, reals3
from dalembert.kernels.words import Address, Integers, Reals
from dalembert.multibody.integrators.radau.radau_coefficients import Coefficients
from dalembert.multibody.integrators.radau.radau_newton import (
    MOST_ITERATIONS,
    correct_coordinates,
    take_coordinates,
    take_velocities,
)
from dalembert.multibody.integrators.radau.radau_stages import (
    Buffers,
    Stages,
    begin,
    integrate_stages,
    read,
    set_stage_signals,
)
from dalembert.multibody.integrators.shared.convergence import has_settled
from dalembert.multibody.integrators.shared.matrices import Matrices
from dalembert.multibody.integrators.shared.outputs import Outputs
from dalembert.multibody.integrators.shared.problem import VELOCITY, IntegrationProblem
from dalembert.multibody.integrators.shared.settling import largest, settle_along, weigh_slopes
from dalembert.multibody.kernels.assembly import constraint_rates, residual, set_signals
from dalembert.multibody.kernels.elementary import size_of
from dalembert.multibody.kernels.slopes import (
    Number,
    SlopeWork,
    along_kernels,
    arrays_of,
    joined,
    maximum,
    read_states,
    share_of,
    slope_of,
    slope_work,
    state_of,
    write_states,
)
from dalembert.multibody.kernels.states import MotionStates, copy, row


class Along(NamedTuple):
    """For derivatives: calls of the stages, what rates of coordinates of a stage miss of its velocities (N + 1,), work,
    and the addresses of kernels, 0 without directions.
    """

    works: Integers
    missed: Reals
    work: SlopeWork
    differentiate: Address
    settle_end: Address


def along_workspace(count: int, width: int, works: np.ndarray, directions: int, together: bool) -> Along:
    """Workspace for derivatives of ``count`` stages; ``works`` are calls of the stages along directions."""
    kernels = (differentiate_together, settle_end_together) if together else (differentiate, settle_end_along)
    addresses = [kernel.address if directions else 0 for kernel in kernels]
    # States at both ends, vectors of systems, stages and their buffers.
    return Along(works, np.zeros(width), slope_work(width, 12 + 14 * count, 8, together), *addresses)


def kernels(derivatives: type | None) -> list[Compiled]:
    """Return what differentiates steps and their ends, in an arithmetic."""
    together = differentiate_together, settle_end_together
    pair = together if derivatives is Dual else (differentiate, settle_end_along)
    return [*pair] if derivatives else []


def _differentiate(
    like: Number, problem: IntegrationProblem, method: Coefficients, matrices: Matrices, directions: Integers,
    t: float, target: float, within: float, s: Stages, dnews: MotionStates, along: Along,
) -> None:  # fmt: skip
    """Derivatives of a step along all directions: those of the equations of its stages (`docs/theory/radau.md`)."""
    h, m, lanes, (at, slopes) = target - t, len(method.c), along.work.slopes, arrays_of(like, along.work)
    width = slopes.shape[1]
    dnew, dold, d, e = state_of(slopes), state_of(slopes[4:]), slopes[12:], slopes[12 + 7 * m :]
    ds = Stages(d[:m], d[m : 2 * m], d[2 * m : 3 * m], d[3 * m : 4 * m], d[4 * m : 5 * m], d[5 * m : 6 * m], d[6 * m :])
    # The vectors of systems are twice as long as the others.
    systems = arrays_of(
        like, SlopeWork(reals3(address_of(lanes[8:]), 2, 2 * width, lanes.shape[2]), along.work.numbers)
    )[1]
    b = Buffers(
        e[:m], e[m : 2 * m], e[2 * m : 3 * m], e[3 * m : 4 * m], e[4 * m : 5 * m], e[5 * m : 6 * m], e[6 * m :],
        systems[0], systems[1],
    )  # fmt: skip
    # Stages and buffers of slopes are those of the step, so that its formulas serve.
    for g in range(len(directions)):
        read_states(dnews, g, lanes)
        copy(dnew, dold)
        set_stage_signals(method, directions[g], t, h, target, within, along.works)
        _converge_along(problem, method, matrices, directions[g], h, s, dold, along, ds, b, at)
        read(problem.n, ds, dnew)
        write_states(lanes, g, dnews)


def _settle_end(
    like: Number, problem: IntegrationProblem, matrices: Matrices, directions: Integers, within: float,
    scratch: Outputs, j: int,
) -> None:  # fmt: skip
    """Settle the derivatives of end ``j`` along all directions."""
    last, work, memory = scratch.last, scratch.complex_work, scratch.slopes.slopes
    numbers, slopes = arrays_of(like, scratch.slopes)
    # Column j of the histories: as rows, one a direction.
    d = last.derivatives
    dstates = MotionStates(d.x[:, j], d.v[:, j], d.a[:, j], d.w[:, j])
    for g in range(len(directions)):
        read_states(dstates, g, memory)
        set_signals(directions[g], last.times[j], within, work)
        settle_along(
            problem, matrices, directions[g], row(last.states, j), state_of(slopes), scratch.moved, work, VELOCITY,
            numbers, slopes[4:],
        )  # fmt: skip
        write_states(memory, g, dstates)


differentiate, differentiate_together = along_kernels(_differentiate)
settle_end_along, settle_end_together = along_kernels(_settle_end)


@inner
def _converge_along(problem, method, matrices, perturbed, h, s, dstart, along, ds, b, at):
    """Derivatives ``ds`` of the converged stages along directions, by the same iteration on slopes.

    ``ds`` and ``b`` are stages and buffers of slopes, ``at`` (8, N + 1) numbers along directions.
    """
    n, size, count = problem.n, len(dstart.x) - 1, len(method.c)
    missed, works = along.missed, along.works
    # The derivative of the stages solves the same linear system for every direction. Its exact matrix couples all
    # stages, so the split iteration of the step serves again, with the matrices that the step has.
    begin(n, h, method, dstart, ds)
    integrate_stages(n, h, method, dstart, ds)
    before = 0.0
    for _ in range(4 * MOST_ITERATIONS):
        for i in range(count):
            for k in range(size + 1):
                at[0, k], at[1, k] = joined(s.x[i, k], ds.x[i, k]), joined(s.v[i, k], ds.v[i, k])
                at[2, k] = joined(s.a[i, k], ds.a[i, k])
                missed[k] = s.u[i, k] - s.v[i, k] if k < n else s.m[i, k]
                b.moved[i, k] = ds.u[i, k] - ds.v[i, k] if k < n else ds.m[i, k]
            # Exact residuals along the directions: the matrices only decide how fast the iteration converges.
            residual(perturbed, n, at[0], at[1], at[2], works[i], 1.0, at[3])
            for k in range(size + 1):
                b.motion[i, k] = slope_of(at[3, k])
            speed = largest(s.v[i], 0, n)
            weigh_slopes(perturbed, n, matrices, at[0], missed, b.moved[i], speed, works[i], at[3:], b.weighed[i])
        correct_coordinates(n, size, method, matrices, h, b)
        take_coordinates(n, size, h, method, dstart, b, ds)
        for i in range(count):
            for k in range(size + 1):
                at[0, k], at[1, k] = joined(s.x[i, k], ds.x[i, k]), joined(s.v[i, k], ds.v[i, k])
            constraint_rates(perturbed, n, at[0], at[1], at[2], works[i], at[4], at[5])
            for k in range(size + 1):
                b.rate[i, k] = slope_of(at[4, k])
        take_velocities(n, size, method, matrices, h, dstart, b, ds)
        norm = _share(n, problem.scale, b.moved, ds.dx)
        if has_settled(norm, before, 1e-14):
            break
        before = norm


@inner
def _share(n, scale, moved, ahead):
    """Largest correction of a coordinate's slope, as a part of the largest way of one in the step."""
    norm, length = 0.0 * moved[0, 0], 0.0 * moved[0, 0]  # of the type of slopes
    for i in range(len(moved)):
        for k in range(n):
            norm = maximum(norm, size_of(moved[i, k]) / scale[k])
            length = maximum(length, size_of(ahead[i, k]) / scale[k])
    return share_of(norm, length)
