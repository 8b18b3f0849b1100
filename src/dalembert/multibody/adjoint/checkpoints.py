"""States of a motion that are computed again from checkpoints, so that memory grows with the root of the steps."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dalembert.kernels.preparation import prepare
from dalembert.multibody.integrators.generalized_alpha.adjoint_sweep import StateHistory, Steps
from dalembert.multibody.integrators.generalized_alpha.generalized_alpha import GeneralizedAlpha
from dalembert.multibody.integrators.generalized_alpha.replay import ReplayWorkspace, replay, replay_workspace
from dalembert.multibody.integrators.shared.consistent import accelerate, consistency
from dalembert.multibody.integrators.shared.problem import DONE, IntegrationProblem, SampleModels
from dalembert.multibody.integrators.shared.run import cut_down, explain
from dalembert.multibody.kernels.block_table import Call
from dalembert.multibody.kernels.states import MotionState, resting
from dalembert.multibody.model.lowered import Lowered


class Stretch(NamedTuple):
    """Steps between two starts of the integration: their numbers, the start, s, and a time within the motion there.

    ``consistent``: whether accelerations are solved for at the start.
    """

    first: int
    last: int
    begin: float
    within: float
    consistent: bool


@dataclass(frozen=True, eq=False)
class ReplayedMotion:
    """A motion whose steps are known: it starts its stretches, and repeats some of its steps."""

    lowered: Lowered
    solver: GeneralizedAlpha
    problem: IntegrationProblem
    steps: Steps

    @cached_property
    def _models(self) -> SampleModels:
        real, tangents = self.lowered.real.need("rates"), self.lowered.tangents
        return SampleModels(real.address, tangents.address, np.zeros(0, np.int64))

    @cached_property
    def _calls(self) -> tuple[Call, Call]:
        return self.lowered.real.call(), self.lowered.tangents.call()

    @cached_property
    def _workspace(self) -> ReplayWorkspace:
        prepare([replay])
        real, complex_ = self._calls
        return replay_workspace(self.problem, real.address, complex_.address)

    def begun(self, stretch: Stretch, before: MotionState) -> MotionState:
        """Return the state at the start of a stretch from that at the end of the stretch before, which changes."""
        if stretch.consistent:
            still = resting(0, len(before.x))
            real, complex_ = self._calls
            scratch = consistency(self.problem, real.address, complex_.address, 0)
            accelerate(self.problem, self._models, stretch.begin, stretch.within, before, still, scratch)
        return before

    def play(self, state: MotionState, own: slice, kept: bool) -> StateHistory:
        """Take steps from a state, which is overwritten; return the states at their ends, none if not ``kept``."""
        count = own.stop - own.start if kept else 0
        path = StateHistory(*np.zeros((3, count, len(state.x))))
        solver, steps = self.solver, Steps(*(part[own] for part in self.steps))
        status = replay(
            self.problem,
            self._models,
            solver.spectral_radius,
            solver.newton_tolerance,
            steps,
            state,
            path,
            self._workspace,
        )
        if status != DONE:
            raise explain(self.lowered, status, float(steps.ends[0]), 0, cut_down(solver.step))
        return path


@dataclass(frozen=True, eq=False)
class Checkpoints:
    """States before some of the steps, by the number of the step."""

    player: ReplayedMotion
    states: dict[int, MotionState]

    def backwards(self, stretch: Stretch) -> Iterator[tuple[slice, StateHistory]]:
        """Yield the steps of a stretch in blocks from the last to the first, with the states at their ends."""
        last = stretch.last
        for first in sorted((k for k in self.states if stretch.first <= k < stretch.last), reverse=True):
            state, own = copied(self.states[first]), slice(first, last)
            yield own, self.player.play(state, own, kept=True)
            last = first


def copied(state: MotionState) -> MotionState:
    """Return a copy of a state."""
    return MotionState(*(part.copy() for part in state))


def checkpoints(
    player: ReplayedMotion, stretches: tuple[Stretch, ...], start: MotionState
) -> tuple[Checkpoints, tuple[MotionState, ...]]:
    """Repeat a motion; return the states each root of the number of steps, and those at the starts of the stretches."""
    distance = int(np.ceil(np.sqrt(len(player.steps.ends))))
    state, states, starts = copied(start), {}, []
    state.w[:] = state.a
    for stretch in stretches:
        state = player.begun(stretch, state) if stretch.first else state
        starts.append(copied(state))
        for first in range(stretch.first, stretch.last, distance):
            states[first] = copied(state)
            player.play(state, slice(first, min(first + distance, stretch.last)), kept=False)
    return Checkpoints(player, states), tuple(starts)
