"""The equations of index 1 as a field of rates over the states, for solvers that call it from Python."""

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dalembert.multibody.integrators.index1.completion import complete, make_tools, partition
from dalembert.multibody.integrators.index1.index1 import PARTITIONED, PROJECTED, Terms
from dalembert.multibody.integrators.shared.batch import Sample
from dalembert.multibody.integrators.shared.problem import DONE, IntegrationProblem, SampleModels
from dalembert.multibody.kernels.states import MotionState, resting
from dalembert.multibody.model.turns import STEP_END, count_turns


class _Along(NamedTuple):
    """Models, derivatives of the state along them, and `complete` of time, stretch, and whether to project."""

    models: SampleModels
    dstates: MotionState
    complete: Callable[[float, float, bool], int]


class RateField:
    """Rates of a sample's coordinates and velocities, and of their derivatives along directions. The vectors hold
    coordinates (n,) and velocities (n,), then those of each direction. The state that was asked for last is kept: its
    accelerations and multipliers are the first guess of the next. ``dstates``: derivatives of the state at the start;
    overwritten; ``implicit``: whether the `jacobian` is needed.
    """

    def __init__(
        self, problem: IntegrationProblem, terms: Terms, sample: Sample, dstates: MotionState, implicit: bool
    ) -> None:
        self.problem, self.terms, self.lowered = problem, terms, sample.lowered
        self.n, self.width, self.count = problem.n, len(sample.start.x), len(dstates.x)
        shape = len(problem.times), self.width
        self.out, self.dout = resting(*shape), resting(self.count, *shape)
        self.moves = terms.way == PROJECTED and self.width - 1 > self.n
        self.within = 0.0
        self.evaluations = 0
        self.state, self._dstates = sample.start, dstates
        self._calls = self.lowered.real.call(), self.lowered.tangents.call()
        works = self._calls[0].address, self._calls[1].address
        self._tools = make_tools(problem, terms, *works, self.count + implicit)
        self._perturbed = self._along(sample.models, dstates)

    def __call__(self, t: float, y: np.ndarray) -> np.ndarray:
        """Rates, not numbers where there are none: a solver then takes a shorter step."""
        self.put(y)
        return self.rates() if self.complete(t, projected=False) == DONE else np.full_like(y, np.nan)

    def jacobian(self, t: float, y: np.ndarray) -> np.ndarray:
        """Derivative of the motion's rates by coordinates and velocities, (2n, 2n)."""
        n = self.n
        self.put(y)
        dstates = self._units.dstates
        for values in dstates:
            values.fill(0.0)
        dstates.x[:n, :n] = dstates.v[n:, :n] = np.eye(n)
        if self._complete(self._units, t, projected=False) != DONE:
            return np.full((2 * n, 2 * n), np.nan)
        return np.concatenate([dstates.v[:, :n], dstates.a[:, :n]], axis=1).T

    def put(self, y: np.ndarray) -> None:
        """Take coordinates and velocities, and their derivatives, from a vector."""
        parts = y.reshape(1 + self.count, 2, self.n)
        self.state.x[: self.n], self.state.v[: self.n] = parts[0]
        self._dstates.x[:, : self.n], self._dstates.v[:, : self.n] = parts[1:, 0], parts[1:, 1]

    def gathered(self) -> np.ndarray:
        """The vector of the present state."""
        return self._joined(self.state.x, self.state.v, self._dstates.x, self._dstates.v)

    def rates(self) -> np.ndarray:
        """The rates of the present state."""
        return self._joined(self.state.v, self.state.a, self._dstates.v, self._dstates.a)

    def complete(self, t: float, *, projected: bool) -> int:
        """Bring the state to the constraints, then find what it demands: status."""
        return self._complete(self._perturbed, t, projected=projected and self.moves)

    def choose(self, t: float) -> bool:
        """Choose independent coordinates if they are parted and that is needed; whether it was done."""
        if self.terms.way != PARTITIONED:
            return False
        tangent_model, tools = self.lowered.tangents.address, self._tools
        return partition(
            self.problem, self.terms, tangent_model, float(t), self.within, self.state, tools.complex_work,
            tools.partition,
        )  # fmt: skip

    def record(self, due: int) -> None:
        """Write the present state as that of an output time, into ``out`` and ``dout``."""
        for target, values in zip(self.out, self.state, strict=True):
            target[due] = values
        for target, values in zip(self.dout, self._dstates, strict=True):
            target[:, due] = values
        self.count_turns(self.problem.times[due], due)

    def count_turns(self, t: float, due: int = STEP_END) -> None:
        """Count the turns of angles at the present state: an output by its number, or the end of a step."""
        count_turns(self._perturbed.models.turns, t, self.state, due)

    def _joined(self, first: np.ndarray, second: np.ndarray, dfirst: np.ndarray, dsecond: np.ndarray) -> np.ndarray:
        n = self.n
        slopes = np.concatenate([dfirst[:, :n], dsecond[:, :n]], axis=1)
        return np.concatenate([first[:n], second[:n], slopes.ravel()])

    @cached_property
    def _units(self) -> _Along:
        """Coordinates and velocities, one after the other, as directions."""
        directions = np.full(2 * self.n, self.lowered.unperturbed.need("rates").address)
        return self._along(self._perturbed.models._replace(directions=directions), resting(2 * self.n, self.width))

    def _along(self, models: SampleModels, dstates: MotionState) -> _Along:
        own = complete.given(self.problem, self.terms, models, self.state, dstates, self._tools)
        return _Along(models, dstates, own)

    def _complete(self, along: _Along, t: float, *, projected: bool) -> int:
        self.evaluations += 1
        return along.complete(float(t), self.within, projected)
