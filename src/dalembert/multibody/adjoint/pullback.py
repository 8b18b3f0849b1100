"""Response of a motion and its pullback: gradients of sums of the response by the discrete adjoint."""

from dataclasses import dataclass

import numpy as np

from dalembert.errors import InputError
from dalembert.kernels.kernel import Compiled
from dalembert.kernels.preparation import prepare
from dalembert.multibody.adjoint.checkpoints import Stretch
from dalembert.multibody.adjoint.matrix_parts import matrices_of
from dalembert.multibody.adjoint.numbers import NumberGradient, NumberPulls, kernels_of
from dalembert.multibody.adjoint.readings import pull_readings, refuse_energies
from dalembert.multibody.adjoint.recorded_motion import StoredMotion, stored_motion
from dalembert.multibody.adjoint.start_adjoint import SecondRates, accelerations_back
from dalembert.multibody.integrators.generalized_alpha.adjoint_sweep import (
    Cotangents,
    StateHistory,
    Steps,
    SweepWorkspace,
    fixed_masses,
    pull_once,
    sweep,
)
from dalembert.multibody.integrators.generalized_alpha.generalized_alpha import GeneralizedAlpha
from dalembert.multibody.integrators.shared.consistent import accelerate
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.problem import SINGULAR, IntegrationProblem
from dalembert.multibody.integrators.shared.run import cut_down, explain
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.states import MotionState, resting
from dalembert.multibody.kernels.transposed import transposed
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.observe import Observer, beside

DIRECT = "take derivative='direct'"


def refuse(lowered: Lowered, solver: Integrator, observer: Observer) -> GeneralizedAlpha:
    """Return the integrator if a motion by it has an adjoint."""
    if not isinstance(solver, GeneralizedAlpha):
        raise InputError(f"{type(solver).__name__} has no adjoint. Use GeneralizedAlpha, or {DIRECT}")
    for kind in lowered.structure.reduction.nodes:
        if kind.chart is None or kind.chart.balance is None:
            raise InputError(
                f"the chart of kind {kind.name!r} has no function 'balance', which the adjoint needs. "
                f"Add it, or {DIRECT}"
            )
    if solver.spectral_radius == 1.0 and lowered.structure.size > lowered.structure.n:
        raise InputError(
            "GeneralizedAlpha with spectral_radius = 1 projects velocities after each step, which has no adjoint. "
            f"Take a radius below 1, or {DIRECT}"
        )
    if lowered.callbacks:
        raise InputError(
            "the adjoint has no derivative by parameters that a UserForce or a Custom function of time holds. "
            f"Use a BSpline, a Table or another function of time, or {DIRECT}"
        )
    refuse_energies(observer)
    return solver


def adjoint_kernels(lowered: Lowered, observer: Observer) -> list[Compiled]:
    """Kernels that only the adjoint needs."""
    layout = lowered.structure.full.fresh[1]
    rates = [kind.kernel("rates", complex) for kind in lowered.data if "rates" in kind.roles]
    balances = [kind.kernel("balance", float) for kind in lowered.structure.reduction.nodes]
    return [
        sweep, pull_once, fixed_masses, accelerate, transposed(layout), *kernels_of(lowered.data), *rates, *balances,
        *observer.kernels(lowered, True),
    ]  # fmt: skip


@dataclass(frozen=True, eq=False)
class MotionPullback:
    """The gradient of any weighted sum of a response, by the numbers of the model.

    ``times`` (samples,).
    """

    lowered: Lowered
    solver: GeneralizedAlpha
    observer: Observer
    motion: StoredMotion
    times: np.ndarray

    @classmethod
    def of(
        cls,
        lowered: Lowered,
        solver: GeneralizedAlpha,
        observer: Observer,
        problem: IntegrationProblem,
        times: np.ndarray,
    ) -> "MotionPullback":
        """Integrate a motion and keep its states."""
        return cls(lowered, solver, observer, stored_motion(lowered, solver, problem, times, observer.counted), times)

    def gradient(self, cotangent: np.ndarray, active: np.ndarray) -> np.ndarray:
        """Derivative of the sum of cotangent * response by all numbers of the model that are active, (numbers,).

        ``cotangent`` (samples, channels); ``active`` (numbers,).
        """
        prepare(adjoint_kernels(self.lowered, self.observer))
        lowered, motion, model = self.lowered, self.motion, self.lowered.model(complex, "residual")
        gradient = NumberGradient(lowered, self.observer, active)
        pulls = NumberPulls(gradient, model)
        bars = np.zeros((len(self.times), len(lowered.structure.signals), 3))
        given = pull_readings(gradient, model, motion.samples, self.times, cotangent, bars)
        call, tangent_call, bar = model.call(), lowered.tangents.call(), resting(lowered.structure.size + 1)
        matrices = matrices_of(lowered, call.address, tangent_call.address, motion.starts[0])
        scratch = matrices.scratch
        alone, still = pulls.pulls._replace(blocks=np.zeros((0, 3), np.int64)), np.zeros_like(bar.x)
        for sample in np.flatnonzero(bars.any(axis=(1, 2))):  # signals that channels read
            pulls.bars[:] = bars[sample]
            t, within = self.times[sample], beside(self.times, -1)[sample]
            pull_once(model.address, t, within, still, still, still, still, alone, call.address)
        for stretch, start in zip(motion.stretches[::-1], motion.starts[::-1], strict=True):
            for own, path in motion.keeper.backwards(stretch):
                self._sweep(own, path, model, given, pulls, bar, scratch)
            if stretch.first == 0:
                for sample in np.flatnonzero(motion.owners < 0):
                    for part, own in zip(bar[:3], given[:3], strict=True):
                        part += own[sample]
            if stretch.consistent:
                self._accelerations_back(stretch, start, model, gradient, pulls, bar, scratch)
        pulls.collect()
        gradient.x[:-1] += bar.x[:-1]
        gradient.v[:-1] += bar.v[:-1]
        return gradient.whole

    def _sweep(
        self, own: slice, path: StateHistory, model: BlockModel, given: MotionState, pulls: NumberPulls,
        bar: MotionState,
        scratch: SweepWorkspace,
    ) -> None:  # fmt: skip
        """Take the adjoint over a block of steps."""
        motion = self.motion
        held = slice(*np.searchsorted(motion.owners, [own.start, own.stop]))
        samples = Cotangents(given.x[held], given.v[held], given.a[held], motion.owners[held], motion.shares[held])
        steps = Steps(*(part[own] for part in motion.steps))
        radius = self.solver.spectral_radius
        status = sweep(
            motion.problem,
            model.address,
            self.lowered.tangents.address,
            radius,
            steps,
            own.start,
            path,
            samples,
            pulls.pulls,
            bar,
            scratch,
        )
        if status >= 0:
            raise explain(self.lowered, SINGULAR, float(steps.ends[status]), 0, cut_down(self.solver.step))

    def _accelerations_back(
        self, stretch: Stretch, state: MotionState, model: BlockModel, gradient: NumberGradient, pulls: NumberPulls,
        bar: MotionState, scratch: SweepWorkspace,
    ) -> None:  # fmt: skip
        """Take the adjoint through the accelerations at the start of a stretch."""
        mu = accelerations_back(self.lowered, state, stretch.begin, stretch.within, bar)
        SecondRates(self.lowered, model, state, stretch.begin, stretch.within, mu).pull(bar, gradient, pulls.bars)
        forces = mu.copy()
        forces[self.lowered.structure.n :] = 0.0
        place = model.address, stretch.begin, stretch.within
        pull_once(*place, state.x, state.v, state.a, forces, pulls.pulls, scratch.work)
