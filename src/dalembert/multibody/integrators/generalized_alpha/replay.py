"""Known steps of generalized-alpha once more, from a state between them: what checkpoints of an adjoint need."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import kernel
from dalembert.multibody.integrators.generalized_alpha.adjoint_sweep import StateHistory, Steps
from dalembert.multibody.integrators.generalized_alpha.newton import Newton, converge, keep_slope, newton
from dalembert.multibody.integrators.shared.problem import DONE, IntegrationProblem, Log, SampleModels
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.states import MotionState, clear, coefficients, copy, resting


class ReplayWorkspace(NamedTuple):
    """States of a step, and Newton's iteration."""

    old: MotionState
    new: MotionState
    newton: Newton
    log: Log


def replay_workspace(problem: IntegrationProblem, work: int, complex_work: int) -> ReplayWorkspace:
    """Workspace for a replay, with calls in real and in complex numbers."""
    width, none = len(problem.scale), np.zeros(0)
    log = Log(np.zeros(4, np.int64), none.astype(np.int64), none)
    return ReplayWorkspace(resting(width), resting(width), newton(problem, work, complex_work), log)


@kernel
def replay(
    problem: IntegrationProblem, models: SampleModels, radius: float, tolerance: float, steps: Steps,
    state: MotionState, path: StateHistory,
    scratch: ReplayWorkspace,
) -> int:  # fmt: skip
    """Take the steps from a state, which is overwritten with the last one; return the status, or the reason.
    ``radius``, ``tolerance``: spectral radius, and tolerance of Newton's iteration; ``state``: (N + 1,); ``path``:
    filled with the states at the ends of the steps, (steps, N + 1); with none of them, (0, N + 1).
    """
    n, old, new, own = problem.n, scratch.old, scratch.new, scratch.newton
    copy(state, new)
    clear(own.slope)
    own.memory[0], own.memory[1] = 0.0, 0.0
    for k in range(len(steps.ends)):
        copy(new, old)
        c = coefficients(steps.lengths[k], radius)
        set_signals(models.real, steps.ends[k], steps.sides[k], own.work)
        status, _ = converge(
            problem,
            models.real,
            models.tangents,
            c,
            steps.ends[k],
            steps.sides[k],
            tolerance,
            old,
            new,
            own,
            scratch.log,
        )
        if status != DONE:
            return status
        keep_slope(n, c, old, new, own.slope)
        if len(path.x) > 0:
            for i in range(len(new.x)):
                path.x[k, i], path.v[k, i], path.a[k, i] = new.x[i], new.v[i], new.a[i]
    copy(new, state)
    return DONE
