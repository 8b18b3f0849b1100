"""Outputs at asked times: states between the ends of a step, moved onto the constraints, with their derivatives."""

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Complexes2, Integers, Reals2, Reals3
from dalembert.multibody.integrators.ends import Ends, interpolate_ends, support, weigh_ends
from dalembert.multibody.integrators.matrices import Matrices, renew
from dalembert.multibody.integrators.problem import Problem
from dalembert.multibody.integrators.settling import COORDINATES, settle, settle_along
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.motion import Histories, MotionState, MotionStates, copy, row, rows


@kernel
def record(
    problem: Problem, matrices: Matrices, far: bool, model: Address, complex_model: Address,
    directions: Integers, ends: Ends, within: float, out: MotionStates, dout: Histories, due: int, state: MotionState,
    dstate: MotionState, weights: Reals3, moved: Reals2, work: Address, complex_work: Address,
    complex_state: Complexes2, along: Address,
) -> bool:  # fmt: skip
    """Write the state at an output time in the last step or at its end: on the constraints, with its accelerations.

    Matrices that are from ``far`` are renewed between the ends. ``weights`` (4, ends, 3) is room, and so are ``moved``
    and ``complex_state``, see `settle_along`. ``along`` is the address of `record_along`, 0 if there are no directions.
    """
    n, newest, oldest = problem.n, len(ends.times) - 1, len(ends.times) - 1
    share, t = 1.0, problem.times[due]
    if ends.known[0] > 1:
        share = (t - ends.times[newest - 1]) / (ends.times[newest] - ends.times[newest - 1])
    whole = share > 1.0 - 1e-9
    if whole:
        copy(row(ends.states, newest), state)
    else:
        oldest = support(ends)
        weigh_ends(ends, oldest, t, weights)
        interpolate_ends(n, oldest, weights, ends.states, state)
        if far and not renew(problem, matrices, complex_model, False, t, within, state, complex_work):
            return False
        set_signals(model, t, within, work)
        if not settle(problem, matrices, model, state, moved, work, COORDINATES):
            return False
    _write(state, row(out, due))
    if len(directions) > 0:
        _record_along_at(
            along, problem, matrices, directions, ends, whole, oldest, within, dout, due, state, dstate,
            weights, moved, complex_work, complex_state,
        )  # fmt: skip
    return True


@kernel
def record_along(
    problem: Problem, matrices: Matrices, directions: Integers, ends: Ends, whole: bool, oldest: int,
    within: float, dout: Histories, due: int, state: MotionState, dstate: MotionState, weights: Reals3, moved: Reals2,
    complex_work: Address, complex_state: Complexes2,
) -> None:  # fmt: skip
    """Write the derivatives of the state at an output time along all directions.

    ``whole``: at the end of the step; else between ends from ``oldest`` on, with the weights and moves of the state.
    """
    t = problem.times[due]
    for d in range(len(directions)):
        derivatives = rows(ends.derivatives, d)
        if whole:
            copy(row(derivatives, len(ends.times) - 1), dstate)
        else:
            interpolate_ends(problem.n, oldest, weights, derivatives, dstate)
            set_signals(directions[d], t, within, complex_work)
            settle_along(
                problem, matrices, directions[d], state, dstate, moved, complex_work, complex_state,
                COORDINATES,
            )  # fmt: skip
        _write(dstate, row(rows(dout, d), due))


_record_along_at = record_along.at


@inner
def _write(state, target):
    """Copy what is an output."""
    for k in range(len(state.x)):
        target.x[k], target.v[k], target.a[k] = state.x[k], state.v[k], state.a[k]
