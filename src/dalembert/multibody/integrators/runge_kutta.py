"""The classical method of Runge and Kutta for the equations of index 1, with exact derivatives."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from dalembert.errors import InputError
from dalembert.kernels.kernel import Compiled, inner, kernel
from dalembert.kernels.words import Address, Integers, Reals
from dalembert.multibody.integrators.completion import Completion, complete, completion, kernels, partition
from dalembert.multibody.integrators.index1 import PARTITIONED, PROJECTED, Terms
from dalembert.multibody.integrators.integrator import Integrator
from dalembert.multibody.integrators.problem import DIVERGED, DONE, SINGULAR, Problem
from dalembert.multibody.integrators.run import Run, cut, explain, starts
from dalembert.multibody.integrators.stabilisation import Projection, Stabilisation, posed
from dalembert.multibody.kernels.model import addresses
from dalembert.multibody.kernels.motion import Histories, Motion, Motions, copy, interpolate, resting, row
from dalembert.multibody.lowering import Lowered
from dalembert.multibody.structure import Structure

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

    step: float = field(metadata={"unit": "s"})
    stabilisation: Stabilisation = field(default_factory=Projection)
    takes_redundancy = True

    def __post_init__(self) -> None:
        if not (np.isfinite(self.step) and self.step > 0):
            raise InputError(f"RungeKutta4: step is {self.step}; expected a positive number of seconds")

    def kernels(self, structure: Structure, derivatives: bool) -> list[Compiled]:
        """The loop with its linear systems, and what completes states."""
        return [integrate, *structure.linear_kernels, *kernels(self.stabilisation.way, derivatives)]

    def integrate(
        self,
        samples: Sequence[Lowered],
        tilted: Sequence[Lowered],
        problem: Problem,
        end: float,
        *,
        logged: bool = True,
    ) -> list[Run]:
        """Runs of samples in one compiled loop that leaves the interpreter's lock free; see `Integrator`."""
        problem, terms = posed(self.stabilisation, samples, cut(samples, problem, end), self.step)
        states, dstates = starts(samples, tilted)
        directions = addresses(entry.dual.need("rates") for entry in tilted)
        calls = samples[0].real.call(), samples[0].dual.call()
        works = calls[0].address, calls[1].address
        room = _workspace(states.x.shape[1], len(tilted), completion(problem, terms, *works, len(tilted)))
        steps = self.step_ends(end, samples[0].jumps)
        ends = np.zeros(0) if steps is None or not logged else steps[1:]
        runs = []
        for number, lowered in enumerate(samples):
            shape = len(problem.times), states.x.shape[1]
            out, dout = resting(*shape), resting(len(tilted), *shape)
            edges = problem.edges[number, : problem.stretches[number] + 1]
            counts = np.zeros(4, dtype=np.int64)
            status, time = integrate(
                problem, edges, float(self.step), terms, lowered.real.need("rates").address, lowered.dual.address,
                directions, row(states, number), dstates, out, dout, counts, room,
            )  # fmt: skip
            if status == SINGULAR and not np.max(np.abs(states.x[number])) < _UNBOUNDED:
                status = DIVERGED
            reason = None if status == DONE else explain(lowered, status, time, 0, f"the step is {self.step:g} s")
            taken = ends[: counts[0]]
            counts[1] = 0
            runs.append(Run(reason, problem.times, out, dout, counts, np.zeros(len(taken), dtype=np.int64), taken))
        return runs


class Workspace(NamedTuple):
    """States of a step and their derivatives, and the work of completing states."""

    old: Motion
    total: Motion
    between: Motion
    dolds: Motions
    dtotals: Motions
    dbetween: Motions
    completion: Completion


def _workspace(width: int, directions: int, own: Completion) -> Workspace:
    states = resting(width), resting(width), resting(width)
    shape = directions, width
    return Workspace(*states, resting(*shape), resting(*shape), resting(*shape), own)


@inner
def _push(n, share, weight, old, stage, total):
    """Add a stage's rates times ``weight`` to the total; from the old state go along them by ``share`` for the next."""
    for i in range(n):
        v, a = stage.v[i], stage.a[i]
        total.x[i] += weight * v
        total.v[i] += weight * a
        stage.x[i] = old.x[i] + share * v
        stage.v[i] = old.v[i] + share * a


@inner
def _take(n, total, state):
    """Coordinates and velocities of another state."""
    for i in range(n):
        state.x[i], state.v[i] = total.x[i], total.v[i]


@inner
def _record(state, dstates, out, dout, due):
    """Write the states at an output time."""
    copy(state, row(out, due))
    for d in range(len(dstates.x)):
        for i in range(len(state.x)):
            dout.x[d, due, i], dout.v[d, due, i] = dstates.x[d, i], dstates.v[d, i]
            dout.a[d, due, i] = dstates.a[d, i]


_partition_at = partition.at


@kernel
def integrate(
    problem: Problem, edges: Reals, step: float, terms: Terms, model: Address, dual: Address, directions: Integers,
    state: Motion, dstates: Motions, out: Motions, dout: Histories, counts: Integers, room: Workspace,
) -> tuple[int, float]:  # fmt: skip
    """Run one sample: status and time reached.

    Parameters
    ----------
    problem : Problem
    edges : array
        Of the smooth stretches, s.
    step : float
    terms : Terms
    model, dual : address
        Models in real and in complex numbers.
    directions : array of addresses
        Complex models, one a direction of differentiation.
    state, dstates : Motion, Motions
        At the start, (N + 1,), and its derivatives, (directions, N + 1); overwritten.
    out, dout : Motions, Histories
        At the output times, (times, N + 1) and (directions, times, N + 1).
    counts : array (2,)
        Steps, and how often independent coordinates were chosen anew.
    room : Workspace
    """
    n, width = problem.n, len(state.x)
    projects = terms.way == PROJECTED and width - 1 > n
    own, tools = room.completion, room.completion.tools
    old, total, between = room.old, room.total, room.between
    dolds, dtotals, dbetween = room.dolds, room.dtotals, room.dbetween
    tools.partition.rank[0] = 0
    due = 0
    for stretch in range(len(edges) - 1):
        begin, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (begin + end)
        if terms.way == PARTITIONED:
            _partition_at(own.partition, problem, terms, dual, begin, within, state, tools)
        status = complete(problem, terms, model, dual, directions, begin, within, state, dstates, False, own)
        if status != DONE:
            return status, begin
        while stretch == 0 and due < len(problem.times) and problem.times[due] <= begin:
            _record(state, dstates, out, dout, due)
            due += 1
        steps = max(1, int(np.ceil((end - begin) / step - 1e-6)))
        h = (end - begin) / steps
        for number in range(steps):
            t = begin + number * h
            target = end if number + 1 == steps else begin + (number + 1) * h
            copy(state, old)
            copy(state, total)
            for d in range(len(dstates.x)):
                copy(row(dstates, d), row(dolds, d))
                copy(row(dstates, d), row(dtotals, d))
            for share, weight in ((0.5, 1 / 6), (0.5, 1 / 3), (1.0, 1 / 3), (0.0, 1 / 6)):
                last = share == 0.0  # the stage after it is the end of the step
                _push(n, share * h, weight * h, old, state, total)
                for d in range(len(dstates.x)):
                    _push(n, share * h, weight * h, row(dolds, d), row(dstates, d), row(dtotals, d))
                    if last:
                        _take(n, row(dtotals, d), row(dstates, d))
                if last:
                    _take(n, total, state)
                    if terms.way == PARTITIONED and _partition_at(
                        own.partition, problem, terms, dual, target, within, state, tools
                    ):
                        counts[1] += 1
                now = target if last else t + share * h
                status = complete(
                    problem, terms, model, dual, directions, now, within, state, dstates, last and projects, own
                )
                if status != DONE:
                    return status, t
            counts[0] += 1
            while due < len(problem.times) and problem.times[due] <= target + 1e-9 * h:
                share = min(1.0, (problem.times[due] - t) / h)
                interpolate(n, h, share, old, state, between.x, between.v, between.a)
                for d in range(len(dstates.x)):
                    along = row(dbetween, d)
                    interpolate(n, h, share, row(dolds, d), row(dstates, d), along.x, along.v, along.a)
                if share < 1.0 - 1e-9:
                    now = problem.times[due]
                    status = complete(
                        problem, terms, model, dual, directions, now, within, between, dbetween, projects, own
                    )
                    if status != DONE:
                        return status, t
                _record(between, dbetween, out, dout, due)
                due += 1
    return DONE, edges[-1]
