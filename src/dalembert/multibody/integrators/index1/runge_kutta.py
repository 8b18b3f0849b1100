"""The classical method of Runge and Kutta for the equations of index 1, with exact derivatives."""

__all__ = ["RungeKutta4"]

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from dalembert.arguments import limited
from dalembert.kernels.kernel import Compiled, inner, kernel
from dalembert.kernels.words import Integers, Reals
from dalembert.multibody.integrators.index1.completion import complete, kernels, make_tools, partition
from dalembert.multibody.integrators.index1.index1 import PARTITIONED, PROJECTED, Terms, Tools
from dalembert.multibody.integrators.index1.stabilisation import Projection, Stabilisation, posed
from dalembert.multibody.integrators.shared.batch import Batch
from dalembert.multibody.integrators.shared.ends import write
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.problem import (
    DIVERGED,
    DONE,
    SINGULAR,
    IntegrationProblem,
    Log,
    SampleModels,
)
from dalembert.multibody.integrators.shared.run import Run, explain
from dalembert.multibody.kernels.states import (
    Histories,
    MotionState,
    MotionStates,
    copy,
    interpolate,
    resting,
    row,
    rows,
)
from dalembert.multibody.model.directions import is_dual, widest
from dalembert.multibody.model.structure import Structure
from dalembert.multibody.model.turns import STEP_END, count_turns

_UNBOUNDED = 1e8  # m or rad: no mechanism, but a step that is too long


@dataclass(frozen=True)
class RungeKutta4(Integrator):
    """The classical method of Runge and Kutta, of fourth order, for the equations of index 1.

    The constraints are differentiated twice; what keeps positions and velocities to them is the ``stabilisation``. The
    method is explicit: the step must resolve the fastest vibration (h times its angular frequency below 2.8), so that
    it is meant for rigid and soft models. Redundant constraints are allowed; their multipliers are those of least norm.

    Parameters
    ----------
    step : float
        s.
    stabilisation : Stabilisation
        `Augmented`, `Baumgarte`, `Projection` or `Partitioning`.

    Notes
    -----
    Between the ends of steps coordinates and velocities are cubic, of the method's own order, and accelerations and
    multipliers those that they demand.

    Examples
    --------
    >>> RungeKutta4(step=1e-3).stabilisation
    Projection()
    """

    step: float = limited(unit="s", above=0)
    stabilisation: Stabilisation = field(default_factory=Projection)
    takes_redundancy = True
    convergence = 4

    def kernels(self, structure: Structure, derivatives: type | None = None) -> list[Compiled]:
        """The loop with its linear systems, and what completes states."""
        return [integrate, *structure.full.linear_kernels, *kernels(self.stabilisation.way, derivatives)]

    @property
    def takes_duals(self) -> bool:
        """Whether derivatives along many directions may be dual numbers."""
        return self.stabilisation.way != PARTITIONED

    def run(self, batch: Batch) -> list[Run]:
        """Runs of samples in one compiled loop that leaves the interpreter's lock free."""
        samples, count = batch.samples, len(batch.perturbed)
        problem, terms = posed(self.stabilisation, samples, batch.problem, self.step)
        directions = batch.directions(takes_duals=self.takes_duals and not terms.redundant)
        works = samples[0].real.call(), widest(samples[0].tangents, directions).call()
        work, along = (own.address for own in works)
        tools = make_tools(problem, terms, work, along, count, together=is_dual(directions))
        scratch = _workspace(batch.shape[1], count, tools)
        _fill(scratch.stage.dstates, batch.dstates)
        steps = self.step_ends(batch.end, samples[0].jumps)
        ends = np.zeros(0) if steps is None or not batch.logged else steps[1:]
        runs = []
        for lowered, edges, start, models in batch.along(directions):
            _fill(scratch.stage.state, start)
            tools.partition.rank[0] = 0  # independent coordinates are chosen anew
            out = resting(1 + count, *batch.shape)
            counts = np.zeros(4, dtype=np.int64)
            status, time = integrate(problem, edges, float(self.step), terms, models, out, counts, scratch)
            if status == SINGULAR and not np.max(np.abs(scratch.stage.state.x)) < _UNBOUNDED:
                status = DIVERGED
            reason = None if status == DONE else explain(lowered, status, time, 0, f"the step is {self.step:g} s")
            parts = MotionState(*(values[0] for values in out)), MotionState(*(values[1:] for values in out))
            runs.append(batch.result(reason, *parts, Log(counts, np.zeros(len(ends), dtype=np.int64), ends)))
        return runs


class Stage(NamedTuple):
    """A state and its derivatives: one after the other in a stack (1 + directions, N + 1), and apart, in its memory."""

    stack: MotionStates
    state: MotionState
    dstates: MotionStates


class RungeKuttaWorkspace(NamedTuple):
    """States of a step with their derivatives: at a stage, between steps, at the step's begin, and their sum.

    And the ``tools`` that complete states.
    """

    stage: Stage
    between: Stage
    old: MotionStates
    total: MotionStates
    tools: Tools


def _workspace(width: int, directions: int, tools: Tools) -> RungeKuttaWorkspace:
    stages, shape = [], (1 + directions, width)
    for _ in range(2):
        stack = MotionStates(*resting(*shape))
        parts = MotionState(*(values[0] for values in stack)), MotionStates(*(values[1:] for values in stack))
        stages.append(Stage(stack, *parts))
    return RungeKuttaWorkspace(
        stages[0], stages[1], MotionStates(*resting(*shape)), MotionStates(*resting(*shape)), tools
    )


def _fill(target: NamedTuple, source: NamedTuple) -> None:
    """Copy states, or stacks of them."""
    for values, given in zip(target, source, strict=True):
        values[:] = given


@inner
def _push(n, share, weight, old, stage, total):
    """Add a stage's rates times ``weight`` to the total; from the old state go along them by ``share`` for the next."""
    for d in range(len(stage.x)):
        for i in range(n):
            # Derivatives along directions go the same way as the states: one stack.
            v, a = stage.v[d, i], stage.a[d, i]
            total.x[d, i] += weight * v
            total.v[d, i] += weight * a
            stage.x[d, i] = old.x[d, i] + share * v
            stage.v[d, i] = old.v[d, i] + share * a


@inner
def _take(n, total, stage):
    """Coordinates and velocities of other states."""
    for d in range(len(stage.x)):
        for i in range(n):
            stage.x[d, i], stage.v[d, i] = total.x[d, i], total.v[d, i]


@inner
def _interpolate(n, h, share, old, new, between):
    """States at a fraction of a step."""
    for d in range(len(new.x)):
        own = row(between, d)
        interpolate(n, h, share, row(old, d), row(new, d), own.x, own.v, own.a)


@inner
def _record(stack, out, due):
    """Write the states at an output time."""
    for d in range(len(stack.x)):
        write(row(stack, d), row(rows(out, d), due))


_partition_at = partition.at


@inner
def _choose(problem, terms, models, t, within, state, tools):
    """Choose independent coordinates if they are parted and that is needed."""
    if terms.way == PARTITIONED:
        _partition_at(
            tools.choose, problem, terms, models.tangents, t, within, state, tools.complex_work, tools.partition
        )


@kernel
def integrate(
    problem: IntegrationProblem, edges: Reals, step: float, terms: Terms, models: SampleModels, out: Histories,
    counts: Integers,
    scratch: RungeKuttaWorkspace,
) -> tuple[int, float]:  # fmt: skip
    """Run one sample: status and time reached. ``edges``: of the smooth stretches, s; ``out``: at the output times,
    (1 + directions, times, N + 1): states, then their derivatives; ``counts`` (4,): steps, and zeros; ``scratch``: with
    the state at the start, and its derivatives, in ``stage``; overwritten.
    """
    n, tools, stage, between = problem.n, scratch.tools, scratch.stage, scratch.between
    projects = terms.way == PROJECTED and len(stage.state.x) - 1 > n
    due = 0
    for stretch in range(len(edges) - 1):
        begin, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (begin + end)
        _choose(problem, terms, models, begin, within, stage.state, tools)
        status = complete(problem, terms, models, stage.state, stage.dstates, tools, begin, within, False)
        if status != DONE:
            return status, begin
        count_turns(models.turns, begin, stage.state, STEP_END)
        while stretch == 0 and due < len(problem.times) and problem.times[due] <= begin:
            _record(stage.stack, out, due)
            due += 1
        steps = max(1, int(np.ceil((end - begin) / step - 1e-6)))
        h = (end - begin) / steps
        for number in range(steps):
            t = begin + number * h
            target = end if number + 1 == steps else begin + (number + 1) * h
            for d in range(len(stage.stack.x)):
                copy(row(stage.stack, d), row(scratch.old, d))
            _take(n, stage.stack, scratch.total)
            # y_{n+1} = y_n + h (k_1 + 2 k_2 + 2 k_3 + k_4) / 6 with y = (q, v) and the rates k of the four stages
            for share, weight in ((0.5, 1 / 6), (0.5, 1 / 3), (1.0, 1 / 3), (0.0, 1 / 6)):
                last = share == 0.0  # the stage after it is the end of the step
                _push(n, share * h, weight * h, scratch.old, stage.stack, scratch.total)
                if last:
                    _take(n, scratch.total, stage.stack)
                    _choose(problem, terms, models, target, within, stage.state, tools)
                # Times of the stages: t, t + h/2, t + h/2, t + h; the loop completes the state at the time of the next
                # one.
                now = target if last else t + share * h
                status = complete(
                    problem, terms, models, stage.state, stage.dstates, tools, now, within, last and projects
                )
                if status != DONE:
                    return status, t
            counts[0] += 1
            while due < len(problem.times) and problem.times[due] <= target + 1e-9 * h:
                share = min(1.0, (problem.times[due] - t) / h)
                # Cubic between both ends, by coordinates and rates there: of the order of the method.
                _interpolate(n, h, share, scratch.old, stage.stack, between.stack)
                if share < 1.0 - 1e-9:
                    status = complete(
                        problem, terms, models, between.state, between.dstates, tools, problem.times[due], within,
                        projects,
                    )  # fmt: skip
                    if status != DONE:
                        return status, t
                _record(between.stack, out, due)
                count_turns(models.turns, problem.times[due], between.state, due)
                due += 1
            count_turns(models.turns, target, stage.state, STEP_END)
    return DONE, edges[-1]
