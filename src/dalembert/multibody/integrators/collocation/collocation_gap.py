"""What remains of the equations of motion at a Gauss point of a collocation step.

There the polynomial gives independent coordinates, velocities and accelerations, and the constraints the dependent
ones. What remains is the gap between these accelerations and those that satisfy the equations of motion; the
multipliers are taken from the equations, so that their gap is zero (`docs/theory/collocation.md`).
"""

from dalembert.kernels.kernel import inner, kernel
from dalembert.multibody.integrators.collocation.collocation_rule import Rule
from dalembert.multibody.integrators.collocation.collocation_step import CollocationRun, ScheduleStep, place
from dalembert.multibody.integrators.shared.consistent import add_masses, differentiate_acceleration
from dalembert.multibody.integrators.shared.partitioning import settle
from dalembert.multibody.integrators.shared.problem import ACCELERATION, IntegrationProblem, SampleModels
from dalembert.multibody.kernels.assembly import constraint_rates, residual, set_signals
from dalembert.multibody.kernels.linear import factorise, solve
from dalembert.multibody.kernels.slopes import one
from dalembert.multibody.kernels.states import row, subtract


@inner
def _drive(problem, model, tangent_model, t, within, state, linear, constraints, c):
    """Accelerations and multipliers by the equations of motion; whether the matrix is regular. As `accelerate` does,
    for a state that `settle` has left, whose constraint Jacobian it takes: one tangent is enough where no force depends
    on the multipliers.
    """
    n, given, answer, rate = problem.n, c.vectors[0], c.vectors[1], c.vectors[2]
    set_signals(tangent_model, t, within, c.complex_work)
    for iteration in range(2 if linear else 6):
        # M a + J^T l = Q and J a = -(second rates without a) are linear in a and l, unless friction depends on l.
        if iteration == 0 or not linear:
            add_masses(problem, tangent_model, state, c.complex_work, constraints, c.exact.matrix)
            if not factorise(problem.exact_layout, c.exact):
                return False
        residual(model, n, state.x, state.v, state.a, c.work, 1.0, given)
        constraint_rates(model, n, state.x, state.v, state.a, c.work, rate, given)
        solve(problem.exact_layout, c.exact, given, answer)
        # A second iteration without a new matrix is for rounding.
        subtract(n, answer, state)
    return True


@inner
def _drive_along(problem, directions, t, within, state, dstates, c):
    """Derivatives of what `_drive` has found, by the matrix that it left."""
    numbers, slopes = one(c.slopes)
    for d in range(len(dstates.x)):
        set_signals(directions[d], t, within, c.complex_work)
        for _ in range(2):
            differentiate_acceleration(problem, directions[d], state, row(dstates, d), c, numbers, slopes)


@inner
def _perturb(columns, h, s, shape, unknowns, dolds, dstates):
    """Derivatives of a Gauss point's independent entries, by the unknown accelerations, then along the directions."""
    for d in range(len(dstates.x)):
        dstate = row(dstates, d)
        for i in range(len(dstate.x)):
            dstate.x[i], dstate.v[i], dstate.a[i], dstate.w[i] = 0.0, 0.0, 0.0, 0.0
        if d < unknowns:
            # The unknowns are ordered by powers, then by coordinates.
            k, own = d // len(columns), columns[d % len(columns)]
            dstate.x[own], dstate.v[own], dstate.a[own] = h * h * shape[0, k], h * shape[1, k], shape[2, k]
        else:
            dold = row(dolds, d - unknowns)
            for own in columns:
                dstate.x[own] = dold.x[own] + s * h * dold.v[own]
                dstate.v[own] = dold.v[own]


@kernel
def measure(
    problem: IntegrationProblem,
    rule: Rule,
    models: SampleModels,
    step: ScheduleStep,
    walk: CollocationRun,
    perturbs: bool,
    s: int,
) -> bool:
    """What remains at a Gauss point, and its derivatives by c and, where it ``perturbs``, along the directions.

    ``directions`` are the unperturbed model for each unknown, then the perturbed ones.
    """
    n, own, c, within, h = problem.n, walk.partition, walk.consistency, step.within, step.end - step.begin
    t, shape, state = step.begin + rule.nodes[s] * h, rule.shapes[s], row(walk.points, s)
    dstates = walk.dall if perturbs else walk.dpoint
    columns = own.columns[own.rank[0] : problem.n]
    place(columns, h, rule.nodes[s], shape, walk.old, walk.c, state)
    _perturb(columns, h, rule.nodes[s], shape, len(walk.c), walk.dold, dstates)
    if not settle(
        problem, models, t, within, ACCELERATION, state, dstates, c.work, c.complex_work, one(c.slopes)[0], own
    ):
        return False
    # First the accelerations by the polynomial, with the dependent ones by the constraints; then those by the equations
    # of motion are taken off.
    for i in range(n):
        walk.gaps[s, i] = state.a[i]
        for d in range(len(dstates.x)):
            walk.slopes[s, d, i] = dstates.a[d, i]
    if not _drive(problem, models.real, models.tangents, t, within, state, walk.linear, own.matrix, c):
        return False
    _drive_along(problem, models.directions, t, within, state, dstates, c)
    for i in range(n):
        walk.gaps[s, i] -= state.a[i]
        for d in range(len(dstates.x)):
            walk.slopes[s, d, i] -= dstates.a[d, i]
    return True
