"""Outputs at asked times: states between the ends of a step, moved onto the constraints, with their derivatives."""

from dalembert.multibody.integrators.lifting import set_signals
from dalembert.multibody.integrators.settling import COORDINATES, settle, settle_along
from dalembert.multibody.kernels.compiled import compiled, kernel
from dalembert.multibody.kernels.model import select
from dalembert.multibody.kernels.motion import copy, row


@kernel
def hermite(n, h, s, old, new, state):
    """State at the fraction ``s`` of a step: quintic in coordinates, by both ends' velocities and accelerations."""
    r = 1.0 - s
    s2, r2 = s * s, r * r
    s3, r3 = s2 * s, r2 * r
    a0, b0, c0 = r3 * (1 + 3 * s + 6 * s2), s * r3 * (1 + 3 * s), 0.5 * s2 * r3
    a1, b1, c1 = s3 * (1 + 3 * r + 6 * r2), -r * s3 * (1 + 3 * r), 0.5 * r2 * s3
    da, db0, db1 = 30 * s2 * r2, r2 * (1 + 2 * s - 15 * s2), s2 * (1 + 2 * r - 15 * r2)
    dc0, dc1 = 0.5 * s * r2 * (2 - 5 * s), -0.5 * r * s2 * (2 - 5 * r)
    for i in range(len(state.x)):
        state.x[i] = r * old.x[i] + s * new.x[i]
        if i < n:
            gap = new.x[i] - old.x[i]
            state.x[i] = (
                a0 * old.x[i] + a1 * new.x[i] + h * (b0 * old.v[i] + b1 * new.v[i]
                + h * (c0 * old.a[i] + c1 * new.a[i]))
            )  # fmt: skip
            state.v[i] = da * gap / h + db0 * old.v[i] + db1 * new.v[i] + h * (dc0 * old.a[i] + dc1 * new.a[i])
            state.a[i] = r * old.a[i] + s * new.a[i]


@compiled
def record(
    problem, pattern, matrices, model, directions, h, t, within, old, new, dolds, dnews, out, dout, due, state, dstate,
    moved, work, dual_work, lifted,
):  # fmt: skip
    """Write the state at an output time ``t`` + part of the step: on the constraints, with its accelerations."""
    n = problem.n
    share = 1.0 if h == 0.0 else min(1.0, (problem.times[due] - t) / h)
    whole = share > 1.0 - 1e-9
    if whole:
        copy(new, state)
    else:
        hermite(n, h, share, old, new, state)
        set_signals(model, problem.times[due], within, work)
        if not settle(problem, pattern, matrices, model, state, moved, work, COORDINATES):
            return False
    out.x[due], out.v[due], out.a[due] = state.x, state.v, state.a
    for d in range(len(dnews.x)):
        if whole:
            copy(row(dnews, d), dstate)
        else:
            tilted = select(directions, d)
            hermite(n, h, share, row(dolds, d), row(dnews, d), dstate)
            set_signals(tilted, problem.times[due], within, dual_work)
            settle_along(problem, pattern, matrices, tilted, state, dstate, moved, dual_work, lifted, COORDINATES)
        dout.x[d, due], dout.v[d, due], dout.a[d, due] = dstate.x, dstate.v, dstate.a
    return True
