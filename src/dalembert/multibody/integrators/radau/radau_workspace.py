"""What the compiled loop of Radau IIA works with: its settings, states, matrices and vectors."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.words import Address, Integers, Reals2
from dalembert.multibody.integrators.radau.radau_coefficients import Coefficients
from dalembert.multibody.integrators.radau.radau_derivatives import Along, along_workspace
from dalembert.multibody.integrators.radau.radau_stages import Buffers, Stages, buffers, stages
from dalembert.multibody.integrators.shared.consistent import Consistency, consistency
from dalembert.multibody.integrators.shared.matrices import Matrices, Pattern, scratch
from dalembert.multibody.integrators.shared.outputs import Outputs, outputs
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.kernels.block_table import Call
from dalembert.multibody.kernels.states import MotionState, resting

_ENDS = 4  # of steps, through which outputs are interpolated


class RadauSettings(NamedTuple):
    """What the compiled loop needs of `RadauIIA`. ``step`` 0: chosen by the error; ``damped``: whether forces may be;
    ``slow``: velocity in parts of the scales, 1/s, that errors of velocities are relative to, if it is less than the
    largest velocity of the motion.
    """

    step: float
    tolerance: float
    newton_tolerance: float
    most_steps: int
    damped: bool
    slow: float


class RadauStep(NamedTuple):
    """Stages of a step and of the one before, buffers, and the calls of the stages.

    ``weights`` (stages + 1, 2 stages) of the prediction and ``moved`` (4, N + 1) are workspace.
    """

    s: Stages
    past: Stages
    b: Buffers
    weights: Reals2
    moved: Reals2
    works: Integers
    complex_work: Address


class RadauWorkspace(NamedTuple):
    """Work of a run: the state, its step, outputs, derivatives, consistent accelerations.

    ``apart``: matrices apart from the kept ones, for outputs.
    """

    new: MotionState
    matrices: Matrices
    apart: Matrices
    step: RadauStep
    outputs: Outputs
    along: Along
    consistency: Consistency


def workspace(
    problem: IntegrationProblem, method: Coefficients, pattern: Pattern, dstates: MotionState, calls: list[Call],
    along_calls: list[Call], together: bool,
) -> RadauWorkspace:  # fmt: skip
    """Workspace for a run; ``calls`` in real numbers and along directions: one a stage, and one more before them."""
    directions, width = dstates.x.shape
    count = len(method.c)
    works, along_works = (np.array([call.address for call in own]) for own in (calls, along_calls))
    work, along_work = int(works[0]), int(along_works[0])
    matrices, apart = scratch(pattern, len(method.pairs)), scratch(pattern, 0)
    if not pattern.varies:
        apart = apart._replace(heavy=matrices.heavy, mass=matrices.mass)  # which do not change in a motion
    out = outputs(_ENDS, dstates, work, along_work, together)
    step = RadauStep(
        stages(count, width), stages(count, width), buffers(count, width), np.zeros((count + 1, 2 * count)),
        out.moved[2:], works[1:], along_work,
    )  # fmt: skip
    along = along_workspace(count, width, along_works[1:], directions, together)
    consistent = consistency(problem, work, along_work, directions, together)
    return RadauWorkspace(resting(width), matrices, apart, step, out, along, consistent)
