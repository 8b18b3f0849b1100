"""Calls of the compiled integrators with lowered models."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.multibody.assemble import scales
from dalembert.multibody.integrators.generalized_alpha import GeneralizedAlpha, integrate
from dalembert.multibody.integrators.problem import DONE, SINGULAR, TOO_MANY_STEPS, Log, Problem, Settings
from dalembert.multibody.kernels.dual import STEP
from dalembert.multibody.kernels.model import KINDS, Block, Model, Signals
from dalembert.multibody.kernels.motion import Motion
from dalembert.multibody.lowering import Lowered


@dataclass(frozen=True)
class Run:
    """What a run of an integrator left.

    Parameters
    ----------
    status : int
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


def run(
    lowered: Lowered,
    solver: GeneralizedAlpha,
    times: np.ndarray,
    end: float,
    tilted: Sequence[Lowered] = (),
    problem: Problem | None = None,
) -> Run:
    """Integrate from 0 to ``end``; ``tilted`` are the models along the directions of differentiation."""
    steps = 0 if solver.adaptive else int(np.ceil(end / solver.step)) + 2 * len(lowered.jumps) + 2
    return _call([lowered], tilted, solver, times, end, problem or make_problem(lowered, times), max(steps, 100_000))[0]


def run_ensemble(
    samples: Sequence[Lowered], solver: GeneralizedAlpha, times: np.ndarray, end: float, problem: Problem
) -> list[Run]:
    """Runs of samples that share a structure, in one compiled loop that leaves the interpreter's lock free."""
    return _call(samples, (), solver, times, end, problem, 0) if samples else []


def _call(
    samples: Sequence[Lowered],
    tilted: Sequence[Lowered],
    solver: GeneralizedAlpha,
    times: np.ndarray,
    end: float,
    problem: Problem,
    logged: int,
) -> list[Run]:
    first, width = samples[0], samples[0].structure.size + 1
    stretches = [[0.0, *(time for time in entry.jumps if 0 < time < end), end] for entry in samples]
    edges = np.zeros((len(samples), max(map(len, stretches))))
    for own, given in zip(edges, stretches, strict=True):
        own[: len(given)] = given
    problem = problem._replace(edges=edges, stretches=np.array([len(given) - 1 for given in stretches]))
    states, dstates = _zeros(len(samples), width), _zeros(len(tilted), width)
    for number, entry in enumerate(samples):
        states.x[number], states.v[number] = np.real(entry.x), np.real(entry.v)
    for number, entry in enumerate(tilted):
        dstates.x[number], dstates.v[number] = np.imag(entry.x) / STEP, np.imag(entry.v) / STEP
    out, dout = _zeros(len(samples), len(times), width), _zeros(len(tilted), len(times), width)
    log = Log(np.zeros(4, dtype=np.int64), np.zeros(logged, dtype=np.int64), np.zeros(logged))
    ends = np.zeros((len(samples), 3))
    integrate(
        problem, settings(solver), stack([entry.real for entry in samples], first.real),
        stack([entry.dual for entry in samples], first.dual), stack([entry.dual for entry in tilted], first.dual),
        states, dstates, out, dout, log, ends,
    )  # fmt: skip
    taken = min(int(log.counts[0]), logged)
    runs = []
    for number, (lowered, (status, time, unknown)) in enumerate(zip(samples, ends, strict=True)):
        reason = None if status == DONE else explain(lowered, solver, int(status), time, int(unknown))
        own = Motion(out.x[number], out.v[number], out.a[number], out.w[number])
        runs.append(Run(reason, times, own, dout, log.counts, log.iterations[:taken].copy(), log.ends[:taken].copy()))
    return runs


def make_problem(lowered: Lowered, times: np.ndarray) -> Problem:
    """What all samples of a structure share."""
    structure = lowered.structure
    slots, layout = structure.kept
    exact_slots, exact_layout = structure.fresh
    return Problem(
        structure.n, scales(lowered), slots, layout, exact_slots, exact_layout, np.asarray(times, dtype=float),
        np.zeros((0, 0)), np.zeros(0, dtype=np.int64),
    )  # fmt: skip


def settings(solver: GeneralizedAlpha) -> Settings:
    """The solver's numbers, as the compiled loop takes them."""
    return Settings(
        float(solver.step),
        float(solver.spectral_radius),
        solver.initial_acceleration == "consistent",
        bool(solver.adaptive),
        float(solver.tolerance),
        float(solver.newton_tolerance),
        int(solver.most_steps),
    )


def stack(models: Sequence[Model], like: Model) -> Model:
    """Models with one more leading axis on their numbers and callbacks; ``like`` gives the shapes of an empty stack."""

    def joined(arrays: list[np.ndarray], pattern: np.ndarray) -> np.ndarray:
        return np.stack(arrays) if arrays else np.zeros((0, *pattern.shape), dtype=pattern.dtype)

    blocks = {}
    for kind in KINDS:
        first: Block = getattr(like, kind)
        blocks[kind] = Block(
            first.index, first.meta, joined([getattr(model, kind).data for model in models], first.data)
        )
    signals = Signals(
        like.signals.index, like.signals.knots, joined([m.signals.data for m in models], like.signals.data)
    )
    return Model(**blocks, signals=signals, callbacks=joined([m.callbacks for m in models], like.callbacks))


def explain(lowered: Lowered, solver: GeneralizedAlpha, status: int, time: float, unknown: int) -> str:
    """Sentence for a run that ended early."""
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
        return (
            f"the adaptive step reached most_steps = {solver.most_steps} at t = {time:.6g} s; "
            "raise tolerance or most_steps"
        )
    return (
        f"Newton's iteration did not converge at t = {time:.6g} s, worst at component {owner!r}, though the step of "
        f"{solver.step:g} s was cut down {'' if solver.adaptive else 'to 1/256 '}for it; take a smaller step, or check "
        "the component's stiffness, loads and dimensions"
    )


def _zeros(*shape: int) -> Motion:
    return Motion(np.zeros(shape), np.zeros(shape), np.zeros(shape), np.zeros(shape))
