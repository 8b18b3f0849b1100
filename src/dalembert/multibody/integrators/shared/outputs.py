"""Outputs at asked times: states between the ends of a step, moved onto the constraints, with their derivatives."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import kernel
from dalembert.kernels.words import Address, Complexes2, Integers, Reals2, Reals3
from dalembert.multibody.integrators.shared.ends import Ends, ends, interpolate_ends, support, weigh_ends, write
from dalembert.multibody.integrators.shared.matrices import Matrices, renew
from dalembert.multibody.integrators.shared.problem import POSITION, IntegrationProblem, SampleModels
from dalembert.multibody.integrators.shared.settling import settle, settle_along
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.states import Histories, MotionState, MotionStates, copy, resting, row, rows
from dalembert.multibody.model.turns import count_turns


class Outputs(NamedTuple):
    """Work of outputs: ends of the last steps, a state between them and its derivative, weights (4, ends, 3), calls.
    ``moved`` and ``complex_state`` are workspace, see `settle_along`. ``along``: address of `record_along`, 0 if there
    are no directions.
    """

    last: Ends
    between: MotionState
    dbetween: MotionState
    weights: Reals3
    moved: Reals2
    work: Address
    complex_work: Address
    complex_state: Complexes2
    along: Address


def outputs(count: int, dstates: MotionState, work: int, complex_work: int) -> Outputs:
    """Workspace for outputs between ``count`` ends, with derivatives as ``dstates`` (directions, N + 1)."""
    directions, width = dstates.x.shape
    return Outputs(
        ends(count, dstates), resting(width), resting(width), np.zeros((4, count, 3)), np.zeros((6, width)), work,
        complex_work, np.zeros((10, width), complex), record_along.address if directions else 0,
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


@kernel
def record_along(
    problem: IntegrationProblem, matrices: Matrices, directions: Integers, scratch: Outputs, whole: bool, oldest: int,
    within: float,
    dout: Histories, due: int,
) -> None:  # fmt: skip
    """Write the derivatives of the state at an output time along all directions.

    ``whole``: at the end of the step; else between ends from ``oldest`` on, with the weights and moves of the state.
    """
    t, ends, dstate = problem.times[due], scratch.last, scratch.dbetween
    for d in range(len(directions)):
        derivatives = rows(ends.derivatives, d)
        if whole:
            copy(row(derivatives, len(ends.times) - 1), dstate)
        else:
            interpolate_ends(problem.n, oldest, scratch.weights, derivatives, dstate)
            set_signals(directions[d], t, within, scratch.complex_work)
            settle_along(
                problem, matrices, directions[d], scratch.between, dstate, scratch.moved, scratch.complex_work,
                scratch.complex_state, POSITION,
            )  # fmt: skip
        write(dstate, row(rows(dout, d), due))


_record_along_at = record_along.at
