"""Outputs at asked times: states between the ends of a step, moved onto the constraints, with their derivatives."""

from dalembert.multibody.integrators.ends import interpolate_ends, support, weigh_ends
from dalembert.multibody.integrators.lifting import set_signals
from dalembert.multibody.integrators.matrices import renew
from dalembert.multibody.integrators.settling import COORDINATES, settle, settle_along
from dalembert.multibody.kernels.compiled import template
from dalembert.multibody.kernels.model import select
from dalembert.multibody.kernels.motion import copy, row


@template
def record(
    problem, pattern, matrices, far, model, dual, directions, ends, within, out, dout, due, state, dstate, weights,
    moved, work, dual_work, lifted,
):  # fmt: skip
    """Write the state at an output time in the last step or at its end: on the constraints, with its accelerations.

    Matrices that are from ``far`` are renewed between the ends; ``weights`` (4, ends, 3) is room.
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
        if far and not renew(problem, pattern, matrices, dual, False, t, within, state, dual_work):
            return False
        set_signals(model, t, within, work)
        if not settle(problem, pattern, matrices, model, state, moved, work, COORDINATES):
            return False
    out.x[due], out.v[due], out.a[due] = state.x, state.v, state.a
    for d in range(len(directions.callbacks)):
        derivatives = row(ends.derivatives, d)
        if whole:
            copy(row(derivatives, newest), dstate)
        else:
            tilted = select(directions, d)
            interpolate_ends(n, oldest, weights, derivatives, dstate)
            set_signals(tilted, t, within, dual_work)
            settle_along(problem, pattern, matrices, tilted, state, dstate, moved, dual_work, lifted, COORDINATES)
        dout.x[d, due], dout.v[d, due], dout.a[d, due] = dstate.x, dstate.v, dstate.a
    return True
