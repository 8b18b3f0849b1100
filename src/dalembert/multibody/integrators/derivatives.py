"""Derivatives of a converged step of generalized-alpha: one exact tangent, and one linear solution a direction."""

from dalembert.kernels.kernel import kernel
from dalembert.kernels.words import Address, Integers
from dalembert.multibody.integrators.consistent import Consistency
from dalembert.multibody.integrators.lifting import lift
from dalembert.multibody.integrators.problem import Problem
from dalembert.multibody.kernels.assembly import residual, set_signals, tangent
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.linear import factorise, solve
from dalembert.multibody.kernels.motion import Coefficients, Motion, Motions, advance, copy, row, subtract


@kernel
def differentiate(
    problem: Problem, dual: Address, directions: Integers, c: Coefficients, t: float, within: float, new: Motion,
    dolds: Motions, dnews: Motions, room: Consistency,
) -> bool:  # fmt: skip
    """Derivatives of the converged step along all directions; whether the tangent is regular."""
    n, size, lifted, exact = problem.n, len(new.x) - 1, room.lifted, room.exact
    r, delta, answer = lifted[3], room.vectors[0], room.vectors[1]
    set_signals(dual, t, within, room.dual_work)
    tangent(
        dual, problem.exact_slots, n, new.x, new.v, new.a, (c.dq, c.dv, 1.0), (1.0, 1.0 / c.dq), room.dual_work,
        exact.matrix,
    )  # fmt: skip
    if not factorise(problem.exact_layout, exact):
        return False
    for d in range(len(directions)):
        dold, dnew = row(dolds, d), row(dnews, d)
        copy(dnew, dold)
        advance(n, c, dold, dnew)
        lift(n, new, dnew, lifted)
        set_signals(directions[d], t, within, room.dual_work)
        residual(directions[d], n, lifted[0], lifted[1], lifted[2], room.dual_work, 1.0 / c.dq, r)
        for i in range(size):
            delta[i] = r[i].imag / STEP
        solve(problem.exact_layout, exact, delta, answer)
        subtract(n, answer, dnew)
        advance(n, c, dold, dnew)
    return True
