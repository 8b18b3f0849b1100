"""Derivatives of a converged step of generalized-alpha: one exact tangent, and one linear solution a direction."""

from dalembert.multibody.integrators.lifting import lift, set_signals
from dalembert.multibody.kernels.assembly import residual_here, tangent
from dalembert.multibody.kernels.compiled import inlined
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import factorise, solve
from dalembert.multibody.kernels.model import glance as glance_at_model
from dalembert.multibody.kernels.motion import advance, copy, glance, subtract


@inlined
def differentiate(problem, dual, directions, c, t, within, old, new, dolds, dnews, exact, dual_work, lifted, buffers):
    """Derivatives of the converged step: one exact tangent, and one linear solution a direction."""
    n, size = problem.n, len(old.x) - 1
    r, delta, answer = buffers
    set_signals(dual, t, within, dual_work)
    tangent(
        dual, problem.exact_slots, n, new.x, new.v, new.a, (c.dq, c.dv, 1.0), (1.0, 1.0 / c.dq), dual_work, exact.matrix
    )
    if not factorise(problem.exact_layout, exact):
        return False
    for d in range(len(dolds.x)):
        model = glance_at_model(directions, d)
        dold, dnew = glance(dolds, d), glance(dnews, d)
        copy(dnew, dold)
        advance(n, c, dold, dnew)
        lift(n, new, dnew, lifted)
        set_signals(model, t, within, dual_work)
        residual_here(model, n, lifted[0], lifted[1], lifted[2], dual_work, 1.0 / c.dq, r)
        for i in range(size):
            delta[i] = r[i].imag / STEP
        solve(problem.exact_layout, exact, delta, answer)
        subtract(n, answer, dnew)
        advance(n, c, dold, dnew)
    return True
