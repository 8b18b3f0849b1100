"""A motion by generalized-alpha with the states of all its steps, for the adjoint."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from dalembert.errors import InputError
from dalembert.multibody.adjoint.checkpoints import ReplayedMotion, Stretch, checkpoints
from dalembert.multibody.integrators.generalized_alpha.adjoint_sweep import StateHistory, Steps
from dalembert.multibody.integrators.generalized_alpha.generalized_alpha import GeneralizedAlpha
from dalembert.multibody.integrators.shared.batch import Batch, make_batch, restarts
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.integrators.shared.run import Run
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.turns import CountedAngle

ROOM = 20_000_000
"""Numbers up to which the states of all steps are kept; beyond, checkpoints."""


class Keeper(Protocol):
    """What keeps the states of all steps, or computes them again."""

    def backwards(self, stretch: Stretch) -> Iterator[tuple[slice, StateHistory]]:
        """Yield the steps of a stretch in blocks from the last to the first, with the states at their ends."""
        ...


@dataclass(frozen=True, eq=False)
class Stored:
    """The states at the ends of all steps, (steps, N + 1)."""

    path: StateHistory

    def backwards(self, stretch: Stretch) -> Iterator[tuple[slice, StateHistory]]:
        """Yield all steps of a stretch."""
        own = slice(stretch.first, stretch.last)
        yield own, StateHistory(*(part[own] for part in self.path))


@dataclass(frozen=True, eq=False)
class StoredMotion:
    """A motion whose states can be passed from the last to the first. ``starts``: state at the start of each stretch,
    with its accelerations; ``samples`` (samples, N + 1); ``turns`` (samples, angles): of the angles that were counted;
    ``owners``, ``shares`` (samples,): step that each sample lies in, -1 for the start, and the share of that step.
    """

    problem: IntegrationProblem
    steps: Steps
    stretches: tuple[Stretch, ...]
    starts: tuple[MotionState, ...]
    keeper: Keeper
    samples: MotionState
    turns: np.ndarray
    owners: np.ndarray
    shares: np.ndarray


def stored_motion(
    lowered: Lowered,
    solver: GeneralizedAlpha,
    problem: IntegrationProblem,
    times: np.ndarray,
    counted: Sequence[CountedAngle] = (),
) -> StoredMotion:
    """Integrate until the last of the times, s, and keep the state of each step, or checkpoints beyond `ROOM`."""
    end, width = float(times[-1]), len(lowered.x)
    expected = solver.step_ends(end, lowered.jumps)
    if expected is not None and 4 * width * len(expected) > ROOM:
        expected = None
    grid = np.union1d(times, [0.0] if expected is None else expected)
    run, batch = _run(lowered, solver, problem, grid, end, counted)
    ends = run.ends
    if run.counts[0] > len(ends):
        raise InputError(
            f"the adjoint keeps the ends of at most {len(ends)} steps; this motion has {run.counts[0]}. "
            "Use larger steps or a shorter motion"
        )
    steps, stretches = _steps(solver, batch, ends)
    player = ReplayedMotion(lowered, solver, batch.problem, steps)
    start = MotionState(*(part[0].copy() for part in run.states))
    keeper: Keeper
    if 4 * width * len(ends) > ROOM:
        keeper, starts = checkpoints(player, stretches, start)
    else:
        if expected is None or len(ends) != len(expected) - 1:
            expected = np.concatenate([[0.0], ends])
            grid = np.union1d(times, expected)
            run, batch = _run(lowered, solver, problem, grid, end, counted)
        rows = np.searchsorted(grid, expected)
        path = StateHistory(*(part[1:] if len(rows) == len(part) else part[rows[1:]] for part in run.states[:3]))
        before = (MotionState(*(part[s.first - 1].copy() for part in (*path, path.a))) for s in stretches[1:])
        starts = (start, *(player.begun(*pair) for pair in zip(stretches[1:], before, strict=True)))
        keeper = Stored(path)
    picked = np.searchsorted(grid, times)
    samples = MotionState(*(part[picked] for part in run.states))
    turns = batch.counters[0].turns[picked] if counted else np.zeros((len(times), 0))
    return StoredMotion(batch.problem, steps, stretches, starts, keeper, samples, turns, *_owners(times, steps))


def _run(
    lowered: Lowered, solver: GeneralizedAlpha, problem: IntegrationProblem, grid: np.ndarray, end: float,
    counted: Sequence[CountedAngle],
) -> tuple[Run, Batch]:  # fmt: skip
    batch = make_batch([lowered], (), problem._replace(times=grid), end, True, counted)
    (run,) = solver.run(batch)
    if run.reason:
        raise run.reason
    return run, batch


def _steps(solver: GeneralizedAlpha, batch: Batch, ends: np.ndarray) -> tuple[Steps, tuple[Stretch, ...]]:
    """The steps of a motion and its stretches, as the integrator cuts them."""
    problem = batch.problem
    edges = problem.edges[0, : problem.stretches[0] + 1]
    opens = restarts(batch.samples, problem)[0, : problem.stretches[0]] == 1
    numbers = np.searchsorted(edges[1:], ends)  # stretch of each step
    lasting = np.diff(edges)
    within = edges[:-1] + 0.5 * lasting
    closes = np.append(opens[1:], True)
    lengths = np.diff(ends, prepend=0.0)
    if not solver.adaptive:
        counts = np.maximum(1, np.ceil(lasting / solver.step - 1e-6))
        nominal = (lasting / counts)[numbers]
        lengths = nominal / 2.0 ** np.round(np.log2(nominal / lengths))
    at_change = ~closes[numbers] & (ends >= edges[numbers + 1])
    sides = np.where(at_change, ends, within[numbers])
    firsts = np.searchsorted(numbers, np.arange(len(lasting)))
    fresh = np.flatnonzero(opens)
    lasts = np.append(firsts[fresh[1:]], len(ends))
    consistent = solver.initial_acceleration == "consistent"
    stretches = tuple(
        Stretch(int(firsts[k]), int(last), float(edges[k]), float(within[k]), bool(k > 0 or consistent))
        for k, last in zip(fresh, lasts, strict=True)
    )
    return Steps(lengths, ends, sides), stretches


def _owners(times: np.ndarray, steps: Steps) -> tuple[np.ndarray, np.ndarray]:
    """Step that holds each of the times, and the share of it, as the integrator interpolates."""
    owners = np.searchsorted(steps.ends + 1e-9 * steps.lengths, times)
    owners = np.where(times <= 0.0, -1, np.minimum(owners, len(steps.ends) - 1))
    begins = np.append(0.0, steps.ends)[owners]
    shares = np.where(owners < 0, 1.0, np.minimum(1.0, (times - begins) / steps.lengths[owners]))
    return owners.astype(np.int64), shares
