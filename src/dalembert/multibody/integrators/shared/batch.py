"""Samples that an integrator runs together: their smooth stretches of motion, their states at the start, their logs."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from dalembert.errors import SolveError
from dalembert.multibody.integrators.shared.problem import IntegrationProblem, Log, SampleModels
from dalembert.multibody.integrators.shared.run import Run
from dalembert.multibody.kernels.block_table import BlockModel, addresses
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.states import MotionState, resting, row
from dalembert.multibody.model.directions import are_many, dual_models
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.turns import CountedAngle, TurnCounter

_ROUNDING = 1e-9  # of differences of times, relative to the motion's end
_ROOM = 100_000  # steps that are logged at least


class Sample(NamedTuple):
    """One sample: the edges of its smooth stretches, s, and its state at the start, which the integrator overwrites.

    The ``models`` have kernels of rates, but for the complex one.
    """

    lowered: Lowered
    edges: np.ndarray
    start: MotionState
    models: SampleModels


@dataclass(frozen=True, eq=False)
class Batch:
    """Samples of one structure, with what every integrator needs of them before its first step. ``perturbed``: the
    model along each direction of differentiation; empty if there is more than one sample; ``problem``: with the smooth
    stretches of each sample's motion; ``end``: s; ``logged``: keep what happened at each step; ``states``
    (samples, N + 1): at the start; integrators may overwrite them; ``dstates`` (directions, N + 1): derivatives of the
    states at the start; integrators may overwrite them; ``counters``: one a sample, of the turns of angles; empty if
    none are counted.
    """

    samples: Sequence[Lowered]
    perturbed: Sequence[Lowered]
    problem: IntegrationProblem
    end: float
    logged: bool
    states: MotionState
    dstates: MotionState
    counters: Sequence[TurnCounter] = ()

    def begin_counting(self) -> np.ndarray:
        """Reset the counters; return their addresses, (samples,), zeros if there are none."""
        counted = [counter.begin().address for counter in self.counters]
        return np.array(counted or [0] * len(self.samples), dtype=np.int64)

    def directions(self, *, takes_duals: bool = False) -> list[BlockModel]:
        """Models along the directions of differentiation, for a method that ``takes_duals`` or does not.

        They are in dual numbers, with eight directions each, where that pays; else complex ones.
        """
        if takes_duals and are_many(self.samples[0], len(self.perturbed)):
            models = dual_models(self.samples[0], self.perturbed)
        else:
            models = [entry.complex_model for entry in self.perturbed]
        return [model.need("rates") for model in models]

    def __iter__(self) -> Iterator[Sample]:
        return self.along(self.directions())

    def along(self, directions: Sequence[BlockModel]) -> Iterator[Sample]:
        """Return each sample, with models along directions."""
        along = addresses(directions)
        for number, (lowered, turns) in enumerate(zip(self.samples, self.begin_counting().tolist(), strict=True)):
            edges = self.problem.edges[number, : self.problem.stretches[number] + 1]
            models = SampleModels(lowered.real.need("rates").address, lowered.tangents.address, along, turns)
            yield Sample(lowered, edges, row(self.states, number), models)

    @property
    def shape(self) -> tuple[int, int]:
        """Output times, and entries of a state, N + 1."""
        return len(self.problem.times), self.states.x.shape[1]

    def derivatives(self) -> Any:
        """Return zeros for the derivatives at the output times: arrays (directions, times, N + 1)."""
        return resting(len(self.perturbed), *self.shape)

    def log(self, steps: np.ndarray | None) -> Log:
        """Return an empty log of one run, of these fixed ``steps`` if there are any; it keeps no step if not logged."""
        scratch = max(_ROOM, 0 if steps is None else 2 * len(steps)) if self.logged else 0
        return Log(np.zeros(4, dtype=np.int64), np.zeros(scratch, dtype=np.int64), np.zeros(scratch))

    def result(self, reason: SolveError | None, states: MotionState, derivatives: MotionState, log: Log) -> Run:
        """Return what a run left, with the part of the log that it filled."""
        taken = min(int(log.counts[0]), len(log.ends))
        iterations, ends = log.iterations[:taken].copy(), log.ends[:taken].copy()
        return Run(reason, self.problem.times, states, derivatives, log.counts, iterations, ends)

    def part(self, numbers: Sequence[int]) -> "Batch":
        """Return the batch of some of the samples, at the start."""
        samples = [self.samples[number] for number in numbers]
        batch = make_batch(samples, self.perturbed, self.problem, self.end, self.logged)
        return replace(batch, counters=[self.counters[number] for number in numbers if self.counters])


def make_batch(
    samples: Sequence[Lowered],
    perturbed: Sequence[Lowered],
    problem: IntegrationProblem,
    end: float,
    logged: bool,
    counted: Sequence[CountedAngle] = (),
) -> Batch:
    """Return the batch of samples that share a structure, from 0 to ``end`` (s), with the turns of angles."""
    counters = [TurnCounter(entry, counted, len(problem.times)) for entry in samples] if counted else ()
    return Batch(samples, perturbed, cut(samples, problem, end), end, logged, *_starts(samples, perturbed), counters)


def smooth_stretches(jumps: Sequence[float], end: float) -> np.ndarray:
    """Start, the increasing jumps of loads within the motion, and its end, s; those that rounding parts are one."""
    times, close = np.asarray(jumps, dtype=float), _ROUNDING * end
    times = times[(times > close) & (times < end - close)]
    return np.concatenate([[0.0], times[np.diff(times, prepend=0.0) > close], [end]])


def restarts(samples: Sequence[Lowered], problem: IntegrationProblem) -> np.ndarray:
    """Whether each stretch of each sample opens at the start or at a jump that is no change of a held table."""
    opens = np.ones((len(samples), problem.edges.shape[1]), dtype=np.int64)
    for own, edges, count, entry in zip(opens, problem.edges, problem.stretches, samples, strict=True):
        close = _ROUNDING * edges[count]
        kept = np.append(np.array([time for time in entry.jumps if time not in entry.changes]), np.inf)
        inner = edges[1:count]
        own[1:count] = kept[np.searchsorted(kept, inner - close)] <= inner + close
    return opens


def cut(samples: Sequence[Lowered], problem: IntegrationProblem, end: float) -> IntegrationProblem:
    """The problem with the smooth stretches of each sample's motion, between the jumps of its loads."""
    stretches: list[np.ndarray] = [smooth_stretches(entry.jumps, end) for entry in samples]
    edges = np.zeros((len(samples), max(map(len, stretches))))
    for own, given in zip(edges, stretches, strict=True):
        own[: len(given)] = given
    return problem._replace(edges=edges, stretches=np.array([len(given) - 1 for given in stretches]))


def _starts(samples: Sequence[Lowered], perturbed: Sequence[Lowered]) -> tuple[MotionState, MotionState]:
    """States of the samples at time 0, (samples, N + 1), and their derivatives along the directions."""
    width = samples[0].structure.size + 1
    states, dstates = resting(len(samples), width), resting(len(perturbed), width)
    for number, entry in enumerate(samples):
        states.x[number], states.v[number] = np.real(entry.x), np.real(entry.v)
    for number, entry in enumerate(perturbed):
        dstates.x[number], dstates.v[number] = np.imag(entry.x) / STEP, np.imag(entry.v) / STEP
    return states, dstates
