"""A step of Radau IIA: prediction, matrices, Newton's iteration, estimated error."""

from dalembert.kernels.kernel import inner, kernel
from dalembert.multibody.integrators.radau import radau_stages as stages
from dalembert.multibody.integrators.radau.radau_coefficients import Coefficients
from dalembert.multibody.integrators.radau.radau_newton import converge, factorise
from dalembert.multibody.integrators.radau.radau_workspace import RadauSettings, RadauStep
from dalembert.multibody.integrators.shared.matrices import Matrices, renew
from dalembert.multibody.integrators.shared.problem import (
    DONE,
    NEWTON_FAILED,
    SINGULAR,
    IntegrationProblem,
    SampleModels,
)
from dalembert.multibody.integrators.shared.settling import accelerate_roughly
from dalembert.multibody.kernels.states import MotionState

_NEAR = 1.25  # ratio of a step to the one that the kept systems were factorised for
_FAR = 1.5  # ratio of a step to the one before, from which the latter alone predicts


@inner
def speed_of(n, scale, v):
    """Largest velocity against the scales, 1/s."""
    speed = 0.0
    for i in range(n):
        speed = max(speed, abs(v[i]) / scale[i])
    return speed


@kernel
def attempt(
    problem: IntegrationProblem, method: Coefficients, models: SampleModels, settings: RadauSettings, t: float,
    target: float, within: float,
    before: float, earlier: float, stale: bool, made: float, speed: float, new: MotionState, matrices: Matrices,
    scratch: RadauStep,
) -> tuple[int, float, float, float, int, float, int]:  # fmt: skip
    """A step from ``new``, which moves if the step is good. Status, step that the kept systems are for, error against
    the tolerance, largest velocity, iterations, contraction, unknown that moved most.
    """
    n, scale, h = problem.n, problem.scale, target - t
    s, past, b, weights, works = scratch.s, scratch.past, scratch.b, scratch.weights, scratch.works
    if before > 0.0:
        stages.extrapolate(n, h, method, before, earlier if h <= _FAR * before else 0.0, past, s, b, weights)
    else:
        stages.begin(n, h, method, new, s)
    stages.integrate_stages(n, h, method, new, s)
    if stale:
        # The matrices are those of the middle stage, which is nearest to all of them.
        m = len(method.c) // 2
        middle, place = t + method.c[m] * h, MotionState(s.x[m], s.v[m], s.a[m], s.a[m])
        if not renew(problem, matrices, models.tangents, settings.damped, middle, within, place, scratch.complex_work):
            return SINGULAR, made, 0.0, speed, 0, 1.0, 0
    if stale or not (made <= _NEAR * h and h <= _NEAR * made):
        made = h
        if not factorise(n, method, matrices, h):
            return SINGULAR, made, 0.0, speed, 0, 1.0, 0
    stages.set_stage_signals(method, models.real, t, h, target, within, works)
    converged, iterations, rate, worst, gap, rate_error = converge(
        n, scale, method, matrices, models.real, settings.damped, works, h, new, s, b, settings.newton_tolerance, speed,
        settings.tolerance if settings.step == 0.0 else 0.0,
    )  # fmt: skip
    error, end = 0.0, len(method.c) - 1
    if converged and settings.step == 0.0:
        speed = max(speed, speed_of(n, scale, s.v[end]))
        # An error of velocities counts as one of coordinates after the time that the motion takes for a scale.
        error = max(gap, rate_error / min(speed, settings.slow)) / settings.tolerance
    if converged and error <= 1.0:
        stages.read(n, s, new)
        # Accelerations at the end by one solution: they serve as a prediction and for outputs, which settle them
        # exactly.
        accelerate_roughly(problem, matrices, models.real, new, works[end], scratch.moved)
    else:
        stages.recall(past.x, past.u, past.a, s)
    return DONE if converged else NEWTON_FAILED, made, error, speed, iterations, rate, worst
