"""Whole states from coordinates and velocities: onto the constraints, then what the equations of index 1 demand."""

import numpy as np

from dalembert.kernels.duals import Dual
from dalembert.kernels.kernel import Compiled, inner, kernel
from dalembert.kernels.words import Address
from dalembert.multibody.integrators.index1.index1 import (
    PARTITIONED,
    PROJECTED,
    Terms,
    Tools,
    demand,
    demand_along,
    demand_together,
)
from dalembert.multibody.integrators.index1.least_squares import surplus_workspace
from dalembert.multibody.integrators.index1.projection import project, project_along, project_together
from dalembert.multibody.integrators.shared.partitioning import (
    DEPENDENT,
    Partition,
    choose,
    dependence,
    invert,
    linearise,
    scratch,
    settle,
    settle_along,
)
from dalembert.multibody.integrators.shared.problem import (
    DIVERGED,
    DONE,
    NEWTON_FAILED,
    SINGULAR,
    VELOCITY,
    IntegrationProblem,
    SampleModels,
)
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.linear import storage
from dalembert.multibody.kernels.slopes import one, slope_work
from dalembert.multibody.kernels.states import MotionState, MotionStates, resting


def make_tools(
    problem: IntegrationProblem, terms: Terms, work: int, along_work: int, directions: int, *, together: bool = False
) -> Tools:
    """Work for a model, with derivatives if there are any directions, one by one or eight ``together``."""
    width, parted, projected = problem.exact_layout.size + 1, terms.way == PARTITIONED, terms.way == PROJECTED
    vector = np.zeros((4, width))
    return Tools(
        work, along_work, storage(problem.exact_layout), slope_work(width, 7, 7, together), vector[0], vector[1],
        vector[2], vector[3], scratch(problem, directions if parted else 0),
        surplus_workspace(problem, terms.redundant, directions), resting(width), resting(width),
        (demand_together if together else demand_along).address if directions else 0,
        partition.address if parted else 0, settle.address if parted else 0, project.address if projected else 0,
        (project_together if together else project_along).address if projected and directions else 0,
    )  # fmt: skip


def kernels(way: int, derivatives: type | None) -> list[Compiled]:
    """Kernels that complete states under a stabilisation, and those for derivatives in an arithmetic.

    Those for redundant constraints are not among them.
    """
    together = derivatives is Dual
    own = {PARTITIONED: [partition, settle], PROJECTED: [project]}.get(way, [])
    projected = project_together if together else project_along
    along = {PARTITIONED: [settle_along], PROJECTED: [projected]}.get(way, [])
    return [complete, *own, *[demand_together if together else demand_along, *along] * bool(derivatives)]


@kernel
def partition(
    problem: IntegrationProblem, terms: Terms, tangent_model: Address, t: float, within: float, state: MotionState,
    work: Address,
    own: Partition,
) -> bool:  # fmt: skip
    """Choose the independent coordinates if that is needed: at first, or where the present ones have become bad.
    Whether there are now other dependent ones; never without constraints. ``work``: address of a call in complex
    numbers.
    """
    set_signals(tangent_model, t, within, work)
    linearise(problem, tangent_model, state, work, own)
    if own.rank[0] > 0 and invert(problem, own) and dependence(problem, own) <= terms.limit:
        return False
    choose(problem, own, DEPENDENT)
    return own.rank[0] > 0


@inner
def _finite(n, state):
    for i in range(n):
        if not abs(state.x[i]) + abs(state.v[i]) < 1e100:
            return False
    return True


@kernel
def complete(
    problem: IntegrationProblem, terms: Terms, models: SampleModels, state: MotionState, dstates: MotionStates,
    tools: Tools, t: float,
    within: float, projected: bool,
) -> int:  # fmt: skip
    """Bring a state to the constraints as its stabilisation has it, then find what it demands: status.

    ``projected``: whether a projection is due. What changes from call to call stands last, for `Field`.
    """
    if not _finite(problem.n, state):
        return DIVERGED
    if terms.way == PARTITIONED:
        if not _settle_at(
            tools.settle, problem, models, t, within, VELOCITY, state, dstates, tools.work, tools.complex_work,
            one(tools.slopes)[0], tools.partition,
        ):  # fmt: skip
            return NEWTON_FAILED
    if projected:
        if not _project_at(tools.project, problem, terms, models, t, within, state, dstates, tools):
            return NEWTON_FAILED
    return DONE if demand(problem, terms, models, t, within, state, dstates, tools) else SINGULAR


_settle_at, _project_at = settle.at, project.at
