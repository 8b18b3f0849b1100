"""What a run of an integrator leaves, and what all integrators make of lowered models before it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.multibody.integrators.problem import DIVERGED, SINGULAR, TOO_MANY_STEPS, Problem, Reduced
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.motion import Motion, resting
from dalembert.multibody.lowering import Lowered
from dalembert.multibody.scales import scales

_ROUNDING = 1e-9  # of differences of times, relative to the motion's end


@dataclass(frozen=True)
class Run:
    """What a run of an integrator left.

    Parameters
    ----------
    reason : str or None
        Why the run ended early.
    times : array (samples,)
    states : Motion of arrays (samples, N + 1)
    derivatives : Motion of arrays (directions, samples, N + 1)
    counts : array (4,)
        Steps, Newton iterations, factorisations, rejected steps.
    iterations, ends : array
        Newton iterations of each step, and the step's end, s.
    """

    reason: str | None
    times: np.ndarray
    states: Motion
    derivatives: Motion
    counts: np.ndarray
    iterations: np.ndarray
    ends: np.ndarray


def smooth_stretches(jumps: Sequence[float], end: float) -> np.ndarray:
    """Start, the increasing jumps of loads within the motion, and its end, s; those that rounding parts are one."""
    times, close = np.asarray(jumps, dtype=float), _ROUNDING * end
    times = times[(times > close) & (times < end - close)]
    return np.concatenate([[0.0], times[np.diff(times, prepend=0.0) > close], [end]])


def restarts(samples: Sequence[Lowered], problem: Problem) -> np.ndarray:
    """Whether each stretch of each sample opens at the start or at a jump that is no change of a held table."""
    opens = np.ones((len(samples), problem.edges.shape[1]), dtype=np.int64)
    for own, edges, count, entry in zip(opens, problem.edges, problem.stretches, samples, strict=True):
        close = _ROUNDING * edges[count]
        kept = np.append(np.array([time for time in entry.jumps if time not in entry.changes]), np.inf)
        inner = edges[1:count]
        own[1:count] = kept[np.searchsorted(kept, inner - close)] <= inner + close
    return opens


def cut(samples: Sequence[Lowered], problem: Problem, end: float) -> Problem:
    """The problem with the smooth stretches of each sample's motion, between the jumps of its loads."""
    stretches: list[np.ndarray] = [smooth_stretches(entry.jumps, end) for entry in samples]
    edges = np.zeros((len(samples), max(map(len, stretches))))
    for own, given in zip(edges, stretches, strict=True):
        own[: len(given)] = given
    return problem._replace(edges=edges, stretches=np.array([len(given) - 1 for given in stretches]))


def starts(samples: Sequence[Lowered], tilted: Sequence[Lowered]) -> tuple[Motion, Motion]:
    """States of the samples at time 0, (samples, N + 1), and their derivatives along the directions."""
    width = samples[0].structure.size + 1
    states, dstates = resting(len(samples), width), resting(len(tilted), width)
    for number, entry in enumerate(samples):
        states.x[number], states.v[number] = np.real(entry.x), np.real(entry.v)
    for number, entry in enumerate(tilted):
        dstates.x[number], dstates.v[number] = np.imag(entry.x) / STEP, np.imag(entry.v) / STEP
    return states, dstates


def make_problem(lowered: Lowered, times: np.ndarray) -> Problem:
    """What all samples of a structure share."""
    structure = lowered.structure
    reduced = Reduced(structure.reduction.increments, *structure.reduced.kept, *structure.reduced.fresh)
    return Problem(
        structure.n, scales(lowered), *structure.full.fresh, reduced, np.asarray(times, dtype=float), np.zeros((0, 0)),
        np.zeros(0, dtype=np.int64),
    )  # fmt: skip


def explain(lowered: Lowered, status: int, time: float, unknown: int, step: str, most_steps: int = 0) -> str:
    """Sentence for a run that ended early; ``step`` tells the step that was too long."""
    owner = lowered.structure.owners[min(unknown, lowered.structure.size - 1)]
    if lowered.failures.errors:
        error = lowered.failures.errors[0]
        return f"a function of the user's failed near t = {time:.6g} s: {type(error).__name__}: {error}"
    if status == SINGULAR:
        return (
            f"the equations of motion became singular at t = {time:.6g} s, at component {owner!r}: redundant "
            "constraints, a massless part, or a singular position; start from another position or take a constraint out"
        )
    if status == TOO_MANY_STEPS:
        return f"the adaptive step reached most_steps = {most_steps} at t = {time:.6g} s; raise tolerance or most_steps"
    if status == DIVERGED:
        return (
            f"the motion grew without bound before t = {time:.6g} s: {step}, too long for an explicit method on the "
            "fastest vibration of the model; take a smaller step, or an implicit method such as GeneralizedAlpha"
        )
    return (
        f"Newton's iteration did not converge at t = {time:.6g} s, worst at component {owner!r}, though {step}; "
        "take a smaller step, or check the component's stiffness, loads and dimensions"
    )
