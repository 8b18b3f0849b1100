"""Outputs at asked times: states between the ends of a step, moved onto the constraints, with their derivatives."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.duals import Dual
from dalembert.kernels.kernel import Compiled, kernel
from dalembert.kernels.words import Address, Integers, Reals2, Reals3
from dalembert.multibody.integrators.shared.consistent import accelerate_along, accelerate_together
from dalembert.multibody.integrators.shared.ends import Ends, ends, interpolate_ends, support, weigh_ends, write
from dalembert.multibody.integrators.shared.matrices import Matrices, renew
from dalembert.multibody.integrators.shared.problem import POSITION, IntegrationProblem, SampleModels
from dalembert.multibody.integrators.shared.settling import settle, settle_along
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.slopes import (
    Number,
    SlopeWork,
    along_kernels,
    arrays_of,
    read_states,
    slope_work,
    state_of,
    write_states,
)
from dalembert.multibody.kernels.states import Histories, MotionState, MotionStates, copy, resting, row, rows
from dalembert.multibody.model.turns import count_turns


class Outputs(NamedTuple):
    """Work of outputs: ends of the last steps, a state between them, weights (4, ends, 3), calls.
    ``moved`` and ``slopes`` are workspace, see `settle_along`. ``along``: address of
    `record_along` or of `record_together`, 0 if there are no directions.
    """

    last: Ends
    between: MotionState
    weights: Reals3
    moved: Reals2
    work: Address
    complex_work: Address
    slopes: SlopeWork
    along: Address


def outputs(count: int, dstates: MotionState, work: int, complex_work: int, together: bool) -> Outputs:
    """Workspace for outputs between ``count`` ends, with derivatives as ``dstates`` (directions, N + 1).

    Directions are taken one by one, or eight ``together``.
    """
    directions, width = dstates.x.shape
    kernel = record_together if together else record_along
    return Outputs(
        ends(count, dstates), resting(width), np.zeros((4, count, 3)), np.zeros((6, width)), work, complex_work,
        slope_work(width, 8, 8, together), kernel.address if directions else 0,
    )  # fmt: skip


@kernel
def record(
    problem: IntegrationProblem, matrices: Matrices, far: bool, models: SampleModels, scratch: Outputs, within: float,
    out: MotionStates,
    dout: Histories, due: int,
) -> bool:  # fmt: skip
    """Write the state at an output time in the last step or at its end: on the constraints, with its accelerations.

    Matrices that are from ``far``, or that do not serve, are renewed between the ends.
    """
    ends, state = scratch.last, scratch.between
    newest = oldest = len(ends.times) - 1
    share, t = 1.0, problem.times[due]
    if ends.known[0] > 1:
        share = (t - ends.times[newest - 1]) / (ends.times[newest] - ends.times[newest - 1])
    whole = share > 1.0 - 1e-9
    if whole:
        copy(row(ends.states, newest), state)
    else:
        oldest = support(ends)
        weigh_ends(ends, oldest, t, scratch.weights)
        # The interpolated state is near the constraints, so that kept matrices correct it unless they are from far
        # away, or fail.
        fresh, settled = far, False
        while not settled:
            interpolate_ends(problem.n, oldest, scratch.weights, ends.states, state)
            if fresh and not renew(problem, matrices, models.tangents, False, t, within, state, scratch.complex_work):
                return False
            set_signals(models.real, t, within, scratch.work)
            settled = settle(problem, matrices, models.real, state, scratch.moved, scratch.work, POSITION)
            if fresh and not settled:
                return False
            fresh = True
    write(state, row(out, due))
    count_turns(models.turns, t, state, due)
    if len(models.directions) > 0:
        _record_along_at(scratch.along, problem, matrices, models.directions, scratch, whole, oldest, within, dout, due)
    return True


def _record_along(
    like: Number, problem: IntegrationProblem, matrices: Matrices, directions: Integers, scratch: Outputs,
    whole: bool, oldest: int, within: float, dout: Histories, due: int,
) -> None:  # fmt: skip
    """Write the derivatives of the state at an output time along all directions.

    ``whole``: at the end of the step; else between ends from ``oldest`` on, with the weights and moves of the state.
    """
    memory, (numbers, slopes) = scratch.slopes.slopes, arrays_of(like, scratch.slopes)
    dstates = MotionStates(dout.x[:, due], dout.v[:, due], dout.a[:, due], dout.w[:, due])
    # Interpolated slopes have left the constraints as the interpolated state had; both are moved back alike.
    for d in range(len(dout.x)):
        derivatives = rows(scratch.last.derivatives, d)
        if whole:
            write(row(derivatives, len(scratch.last.times) - 1), row(dstates, d))
        else:
            interpolate_ends(problem.n, oldest, scratch.weights, derivatives, row(dstates, d))
    for g in range(0 if whole else len(directions)):
        read_states(dstates, g, memory)
        set_signals(directions[g], problem.times[due], within, scratch.complex_work)
        settle_along(
            problem, matrices, directions[g], scratch.between, state_of(slopes), scratch.moved, scratch.complex_work,
            POSITION, numbers, slopes[4:],
        )  # fmt: skip
        write_states(memory, g, dstates)


record_along, record_together = along_kernels(_record_along)
_record_along_at = record_along.at


def settling_kernels(derivatives: type | None) -> list[Compiled]:
    """Return what differentiates states that are settled at starts and outputs, in an arithmetic."""
    pair = (accelerate_together, record_together) if derivatives is Dual else (accelerate_along, record_along)
    return [*pair] if derivatives else []
