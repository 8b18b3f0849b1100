"""What a run of an integrator leaves, the problem that its samples share, and why a run ended early."""

from dataclasses import dataclass, field
from functools import partial

import numpy as np

from dalembert.errors import SolveError
from dalembert.multibody.integrators.shared.problem import (
    DIVERGED,
    SINGULAR,
    TOO_MANY_STEPS,
    IntegrationProblem,
    Reduced,
)
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.lowered import Lowered, scales


@dataclass(frozen=True)
class Run:
    """What a run of an integrator left. ``reason``: why the run ended early; ``times`` (samples,); ``states``
    (samples, N + 1); ``derivatives`` (directions, samples, N + 1); ``counts`` (4,): steps, Newton iterations,
    factorisations, rejected steps; ``iterations``, ``ends``: Newton iterations of each step, and the step's end, s;
    ``turns`` (samples, angles): whole turns of the angles that were counted.
    """

    reason: SolveError | None
    times: np.ndarray
    states: MotionState
    derivatives: MotionState
    counts: np.ndarray
    iterations: np.ndarray
    ends: np.ndarray
    turns: np.ndarray = field(default_factory=partial(np.zeros, (0, 0)))


def make_problem(lowered: Lowered, times: np.ndarray) -> IntegrationProblem:
    """What all samples of a structure share."""
    structure = lowered.structure
    reduced = Reduced(structure.reduction.increments, *structure.reduced.kept, *structure.reduced.fresh)
    return IntegrationProblem(
        structure.n, scales(lowered), *structure.full.fresh, reduced, np.asarray(times, dtype=float), np.zeros((0, 0)),
        np.zeros(0, dtype=np.int64),
    )  # fmt: skip


def cut_down(step: float) -> str:
    """Clause for a fixed step that Newton's iteration does not converge on."""
    return f"the step of {step:g} s was cut down to 1/256 for it"


def users_error(lowered: Lowered, time: float) -> SolveError | None:
    """Return the error of a function of the user's, if one failed in the step after a time of the motion, in s."""
    return lowered.failures.after(float(np.real(lowered.signal_data[0])) + time)


def explain(lowered: Lowered, status: int, time: float, unknown: int, step: str, most_steps: int = 0) -> SolveError:
    """Return the error of a run that ended early; ``step`` describes the step that was too long."""
    owner = lowered.structure.owners[min(unknown, lowered.structure.size - 1)]
    if error := users_error(lowered, time):
        return error
    why = {
        SINGULAR: f"the equations of motion became singular at t = {time:.6g} s, at component {owner!r}: redundant "
        "constraints, a massless part, or a singular position; start from another position or take a constraint out",
        TOO_MANY_STEPS: f"the adaptive step reached most_steps = {most_steps} at t = {time:.6g} s; raise tolerance or "
        "most_steps",
        DIVERGED: f"the motion grew without bound before t = {time:.6g} s: {step}, too long for an explicit method on "
        "the fastest vibration of the model; take a smaller step, or an implicit method such as GeneralizedAlpha",
    }
    unsolved = (
        f"Newton's iteration did not converge at t = {time:.6g} s, worst at component {owner!r}, though {step}; "
        "take a smaller step, or check the component's stiffness, loads and dimensions"
    )
    return SolveError(why.get(status, unsolved))
