"""What the compiled loop of Radau IIA works with: its settings, states, matrices and vectors."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.words import Address, Complexes2, Integers, Reals2, Reals3
from dalembert.multibody.integrators.consistent import Consistency, consistency
from dalembert.multibody.integrators.ends import Ends, ends
from dalembert.multibody.integrators.matrices import Matrices, Pattern, room
from dalembert.multibody.integrators.outputs import record_along
from dalembert.multibody.integrators.problem import Problem
from dalembert.multibody.integrators.radau_coefficients import Coefficients
from dalembert.multibody.integrators.radau_derivatives import differentiate, settle_end_along
from dalembert.multibody.integrators.radau_stages import Buffers, Stages, buffers, stages
from dalembert.multibody.kernels.model import Call
from dalembert.multibody.kernels.motion import MotionState, resting

_ENDS = 4  # of steps, through which outputs are interpolated


class Settings(NamedTuple):
    """What the compiled loop needs of `RadauIIA`; ``step`` 0: chosen by the error; whether forces may be ``damped``."""

    step: float
    tolerance: float
    newton_tolerance: float
    most_steps: int
    damped: bool


class Step(NamedTuple):
    """Stages of a step and of the one before, buffers, and the calls of the stages.

    ``weights`` (stages + 1, 2 stages) of the prediction and ``moved`` (6, N + 1) are room.
    """

    s: Stages
    past: Stages
    b: Buffers
    weights: Reals2
    moved: Reals2
    works: Integers
    complex_work: Address


class Along(NamedTuple):
    """For derivatives: a state, stages, calls of the stages, and the addresses of kernels, 0 without directions."""

    dold: MotionState
    ds: Stages
    works: Integers
    differentiate: Address
    settle_end: Address
    record: Address


class Outputs(NamedTuple):
    """For outputs: ends of steps, matrices ``apart`` from the kept ones, a state between and its derivative, room."""

    last: Ends
    apart: Matrices
    between: MotionState
    dbetween: MotionState
    shares: Reals3
    complex_state: Complexes2
    work: Address


class Workspace(NamedTuple):
    """Work of a run: the state, its step, outputs, derivatives, consistent accelerations."""

    new: MotionState
    matrices: Matrices
    step: Step
    outputs: Outputs
    along: Along
    consistency: Consistency


def workspace(
    problem: Problem, method: Coefficients, pattern: Pattern, dstates: MotionState, calls: list[Call],
    complex_calls: list[Call],
) -> Workspace:  # fmt: skip
    """Room for a run; ``calls`` in real and in complex numbers: one a stage, and one more before them."""
    directions, width = dstates.x.shape
    count, differs = len(method.c), directions > 0
    works, complex_works = (np.array([call.address for call in own]) for own in (calls, complex_calls))
    work, complex_work = int(works[0]), int(complex_works[0])
    matrices, apart = room(pattern, len(method.pairs)), room(pattern, 0)
    apart = apart._replace(heavy=matrices.heavy, mass=matrices.mass)  # which do not change in a motion
    step = Step(
        stages(count, width), stages(count, width), buffers(count, width),
        np.zeros((count + 1, 2 * count)), np.zeros((6, width)), works[1:], complex_work,
    )  # fmt: skip
    outputs = Outputs(
        ends(_ENDS, dstates), apart, resting(width), resting(width), np.zeros((4, _ENDS, 3)),
        np.zeros((10, width), complex), work,
    )  # fmt: skip
    along = Along(
        resting(width), stages(count, width), complex_works[1:], *(
            kernel.address if differs else 0 for kernel in (differentiate, settle_end_along, record_along)
        ),
    )  # fmt: skip
    consistent = consistency(problem, work, complex_work, directions)
    return Workspace(resting(width), matrices, step, outputs, along, consistent)
