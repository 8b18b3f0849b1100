"""Generalized-alpha for the index-3 equations, with the derivatives of its discrete solution."""

__all__ = ["GeneralizedAlpha"]

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dalembert.arguments import limited
from dalembert.errors import require_known
from dalembert.kernels.duals import Dual
from dalembert.kernels.kernel import Compiled, inlined, inner, kernel
from dalembert.kernels.words import Integers, Integers2, Reals2
from dalembert.multibody.integrators.generalized_alpha.derivatives import (
    Differentiation,
    differentiate,
    differentiate_together,
    differentiation,
    gather,
    scatter,
)
from dalembert.multibody.integrators.generalized_alpha.lanes_run import integrate_lanes, run_in_lanes
from dalembert.multibody.integrators.generalized_alpha.newton import Newton, converge, keep_slope, newton
from dalembert.multibody.integrators.shared.batch import Batch, restarts
from dalembert.multibody.integrators.shared.consistent import (
    Consistency,
    accelerate,
    accelerate_along,
    accelerate_together,
    consistency,
)
from dalembert.multibody.integrators.shared.convergence import HALVINGS
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.lane_groups import run_groups
from dalembert.multibody.integrators.shared.problem import (
    DONE,
    NEWTON_FAILED,
    SINGULAR,
    TOO_MANY_STEPS,
    IntegrationProblem,
    Log,
    SampleModels,
    note_step,
)
from dalembert.multibody.integrators.shared.run import Run, explain
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.block_table import addresses
from dalembert.multibody.kernels.sample_lanes import solve_samples
from dalembert.multibody.kernels.states import (
    Histories,
    MotionState,
    MotionStates,
    clear,
    coefficients,
    copy,
    interpolate,
    resting,
    row,
    rows,
)
from dalembert.multibody.model.directions import is_dual, widest
from dalembert.multibody.model.lane_models import lane_kernels, lane_node_kernels
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.structure import Structure
from dalembert.multibody.model.turns import STEP_END, count_turns

STARTS = ("consistent", "zero")
_UNITS = 1 << HALVINGS


@dataclass(frozen=True)
class GeneralizedAlpha(Integrator):
    """Generalized-alpha integrator for index 3 (Arnold and Bruels 2007), of second order.

    Parameters
    ----------
    step : float
        Step in s; the first one when ``adaptive``.
    spectral_radius : float
        At infinity, in [0, 1]: 1 damps nothing, 0 damps the highest frequencies in one step. At 1 the index-3 method
        would keep an error of the multipliers for ever, with alternating sign; there velocities and accelerations are
        projected on the constraints after each step, which doubles its price.
    initial_acceleration : {"consistent", "zero"}
        Accelerations and multipliers at the start: those that satisfy the equations of motion, or none (a start of
        first order).
    adaptive : bool
        Choose the step by the estimated local error.
    tolerance : float
        Of the local error, relative to each coordinate's scale (the extent of the mechanism for positions, 1 for angles
        and gradients); for ``adaptive``.
    newton_tolerance : float
        Of the coordinates at each step, relative to their scale. An error of a coordinate is 2 / step times as large in
        the velocity and adds up over the steps; so the default is near the rounding error.
    most_steps : int
        After which an adaptive run gives up.

    Examples
    --------
    >>> GeneralizedAlpha(step=1e-3).spectral_radius
    0.8
    """

    step: float = limited(unit="s", above=0)
    spectral_radius: float = limited(0.8, unit="", least=0, most=1)
    initial_acceleration: str = "consistent"
    adaptive: bool = False
    tolerance: float = limited(1e-6, unit="", above=0)
    newton_tolerance: float = limited(2e-15, unit="", above=0)
    most_steps: int = 1_000_000

    def __post_init__(self) -> None:
        require_known("initial_acceleration", self.initial_acceleration, STARTS, "GeneralizedAlpha")

    @property
    def convergence(self) -> int:
        """Order in the step: 2; 1 without accelerations at the start."""
        return 2 if self.initial_acceleration == "consistent" else 1

    @property
    def takes_lanes(self) -> bool:
        """Whether samples may run side by side: with fixed steps, and without projections of velocities."""
        return not self.adaptive and self.spectral_radius < 1.0

    @property
    def takes_duals(self) -> bool:
        """Whether derivatives along many directions may be dual numbers."""
        return True

    @property
    def fixed_step(self) -> float | None:
        """The step in s, None if adaptive."""
        return None if self.adaptive else self.step

    def kernels(self, structure: Structure, derivatives: type | None = None) -> list[Compiled]:
        """The loop with its linear systems, and what differentiates a step."""
        eight = derivatives is Dual
        along = [differentiate_together, accelerate_together] if eight else [differentiate, accelerate_along]
        reduced = structure.reduced_kernels(derivatives is not None)
        return [integrate, *structure.full.linear_kernels, *reduced, *along * (derivatives is not None)]

    def lane_kernels(self, sample: Lowered) -> list[Compiled]:
        """The loop for samples side by side, its solutions, and what components need."""
        reduction = sample.structure.reduction
        own = lane_kernels(reduction.index, "residual")
        return [integrate_lanes, solve_samples, *own, *lane_node_kernels(reduction)]

    def run(self, batch: Batch) -> list[Run]:
        """Runs of samples in compiled loops that leave the interpreter's lock free: in lanes, or one after the other.

        A sample has the same bits in both.
        """
        if not self.takes_lanes:
            return self._one_by_one(batch)
        consistent = self.initial_acceleration == "consistent"
        return run_groups(
            batch,
            lambda part: run_in_lanes(part, self.step, self.spectral_radius, consistent, self.newton_tolerance),
            self._one_by_one,
        )

    def _one_by_one(self, batch: Batch) -> list[Run]:
        """Runs of samples one after the other."""
        # at spectral radius 1 velocities leave the constraints and nothing damps what grows from there
        problem = batch.problem._replace(projected=self.spectral_radius == 1.0)
        samples, perturbed = batch.samples, batch.perturbed
        ends_of_steps = self.step_ends(batch.end, samples[0].jumps) if batch.logged else None
        dout, log = batch.derivatives(), batch.log(ends_of_steps)
        opens, turns = restarts(samples, problem), batch.begin_counting()
        out = resting(len(samples), *dout.x.shape[1:])
        steps = self.step, self.spectral_radius, self.initial_acceleration == "consistent", self.adaptive
        settings = AlphaSettings(*steps, self.tolerance, self.newton_tolerance, self.most_steps)
        ends = np.zeros((len(samples), 3))
        real = [entry.real.need("rates").reduced() for entry in samples]
        tangent_models = [entry.tangents.reduced(spreads=len(perturbed) > 0) for entry in samples]
        directions = [entry.reduced() for entry in batch.directions(takes_duals=self.takes_duals)]
        call, along_call = real[0].call(), widest(tangent_models[0], directions).call()
        groups = len(directions), is_dual(directions)
        scratch = _workspace(problem, call.address, along_call.address, len(perturbed), *groups)
        integrate(
            problem, opens, settings, addresses(real), addresses(tangent_models), addresses(directions), turns,
            batch.states, batch.dstates, out, dout, log, ends, scratch,
        )  # fmt: skip
        runs, shortened = [], f"the step of {self.step:g} s was cut down {'' if self.adaptive else 'to 1/256 '}for it"
        for number, (lowered, (status, time, moved)) in enumerate(zip(samples, ends, strict=True)):
            given = lowered, int(status), time, int(moved), shortened, self.most_steps
            reason = None if status == DONE else explain(*given)
            runs.append(batch.result(reason, MotionState(*(part[number] for part in out)), dout, log))
        return runs


class AlphaSettings(NamedTuple):
    """What the compiled loop needs of `GeneralizedAlpha`."""

    step: float
    spectral_radius: float
    consistent: bool
    adaptive: bool
    tolerance: float
    newton_tolerance: float
    most_steps: int


class AlphaWorkspace(NamedTuple):
    """States of a step, Newton's iteration, consistent accelerations, derivatives."""

    old: MotionState
    new: MotionState
    dolds: MotionStates
    newton: Newton
    consistency: Consistency
    differentiation: Differentiation


def _workspace(
    problem: IntegrationProblem, work: int, along_work: int, directions: int, groups: int, together: bool
) -> AlphaWorkspace:
    width = len(problem.scale)
    return AlphaWorkspace(
        resting(width), resting(width), resting(directions, width), newton(problem, work, along_work),
        consistency(problem, work, along_work, directions, together),
        differentiation(problem, along_work, groups, together),
    )  # fmt: skip


@kernel
def integrate(
    problem: IntegrationProblem, opens: Integers2, settings: AlphaSettings, models: Integers, tangent_models: Integers,
    directions: Integers, turns: Integers, states: MotionStates, dstates: MotionStates, out: Histories,
    dout: Histories, log: Log, ends: Reals2, scratch: AlphaWorkspace,
) -> None:  # fmt: skip
    """Run a stack of samples from ``problem.edges[sample, 0]`` to the last edge; fill the states at the output times.
    ``opens`` (samples, -): whether each stretch starts anew; else the motion goes on, and held tables have their mean
    where it begins; ``models``, ``tangent_models`` (samples,): in real numbers, and with tangents; ``directions``:
    complex models, one a direction of differentiation; empty if there is more than one sample; ``turns`` (samples,):
    what counts the turns of angles, 0 for none; ``states`` (samples, N + 1), ``dstates`` (directions, N + 1): at the
    start, and its derivatives; overwritten; ``out``, ``dout``: arrays (samples, times, N + 1) and
    (directions, times, N + 1); ``w`` is not used; ``log``: of the last sample; ``ends`` (samples, 3): status (`DONE`,
    or the reason), time reached, unknown that moved most.
    """
    for sample in range(len(models)):
        clear(log.counts)
        edges = problem.edges[sample, : problem.stretches[sample] + 1]
        ends[sample, 0], ends[sample, 1], ends[sample, 2] = _integrate(
            problem, edges, opens[sample], settings,
            SampleModels(models[sample], tangent_models[sample], directions, turns[sample]), row(states, sample),
            dstates,
            rows(out, sample), dout, log, scratch,
        )  # fmt: skip


@inner
def _integrate(problem, edges, opens, settings, models, state, dstates, out, dout, log, scratch):
    """Run one sample: status, time reached, and the unknown that moved most."""
    n, width = problem.n, len(state.x)
    old, new, dolds, own = scratch.old, scratch.new, scratch.dolds, scratch.newton
    copy(state, new)
    own.memory[0], own.memory[1] = 0.0, 0.0
    along, due = scratch.differentiation, 0
    # The formulas of a step act on slopes side by side; rows of derivatives are filled for starts and outputs alone.
    differentiated = along.differentiate != 0
    length = settings.step
    for stretch in range(len(edges) - 1):
        begin, end = edges[stretch], edges[stretch + 1]
        within = 0.5 * (begin + end)
        fresh, ends = opens[stretch] == 1, stretch + 2 == len(edges) or opens[stretch + 1] == 1
        if fresh:
            clear(own.slope)
        # At the start and behind a jump of the loads the accelerations satisfy M a + J^T l = Q with the second rates of
        # the constraints. Within a held table they do not: the step passes its changes with the mean of both sides, and
        # w keeps its memory.
        if differentiated and fresh and stretch > 0:
            gather(along.new, dstates)
        if fresh and (stretch > 0 or settings.consistent):
            if not accelerate(problem, models, begin, within, new, dstates, scratch.consistency):
                return SINGULAR, begin, 0
        if differentiated and fresh:
            scatter(dstates, along.new)
        if stretch == 0:
            count_turns(models.turns, begin, new, STEP_END)
            while due < len(problem.times) and problem.times[due] <= begin:
                _record(n, 1.0, 1.0, new, new, dstates, dstates, out, dout, due)
                due += 1
        # Fixed steps are counted in units of 2^-16 of the nominal one, so that halved steps end where the grid of
        # output times expects them, without sums of rounded lengths.
        steps = max(1, int(np.ceil((end - begin) / settings.step - 1e-6)))
        nominal = (end - begin) / steps
        unit, level = 0, 0
        t = begin
        if not settings.adaptive:
            length = nominal
        while (settings.adaptive and t < end) or (not settings.adaptive and unit < steps * _UNITS):
            if settings.adaptive:
                if t + length * 1.0001 >= end:
                    length = end - t
                target = t + length if length < end - t else end
            else:
                stride = _UNITS >> level
                length = nominal / (1 << level)
                target = end if unit + stride == steps * _UNITS else begin + nominal * ((unit + stride) / _UNITS)
            copy(new, old)
            c = coefficients(length, settings.spectral_radius)
            # The signals of a step that ends at a jump are those before the jump.
            side = within if ends or target < end else end
            set_signals(models.real, target, side, own.work)
            status, detail = converge(
                problem, models.real, models.tangents, c, target, side, settings.newton_tolerance, old, new, own, log
            )
            error = 0.0
            # The quadrature of Newmark, q_{n+1} = ... + h^2 ((1/2 - beta) w_n + beta w_{n+1}), differs from the Taylor
            # polynomial with the third derivative (w_{n+1} - w_n) / h by h^2 (beta - 1/6) (w_{n+1} - w_n).
            if status == DONE and settings.adaptive:  # estimated local error: h^2 |beta - 1/6| |w_{n+1} - w_n|
                for i in range(n):
                    gap = abs(c.beta - 1 / 6) * length * length * abs(new.w[i] - old.w[i])
                    error = max(error, gap / (settings.tolerance * problem.scale[i]))
            if status != DONE or error > 1.0:
                log.counts[3] += 1
                copy(old, new)
                clear(own.slope)
                if settings.adaptive:
                    # The local error is of third order in the step.
                    length *= max(0.2, 0.9 * error ** (-1 / 3)) if status == DONE else 0.25
                    if length < 1e-12 * (end - begin):
                        return NEWTON_FAILED, t, detail
                elif level == HALVINGS:
                    return status, t, detail
                else:
                    level += 1
                continue
            note_step(log, detail, target)
            keep_slope(n, c, old, new, own.slope)
            if differentiated and not _differentiate_at(
                along.differentiate, problem, models.tangents, models.directions, c, target, side, new, along
            ):
                return SINGULAR, target, 0
            # At spectral radius 1 errors of the multipliers alternate without decay: accelerations and multipliers are
            # solved for again, and velocities move onto the constraints.
            if problem.projected and width - 1 > n:
                if differentiated:
                    gather(along.new, dstates)
                if not accelerate(problem, models, target, side, new, dstates, scratch.consistency):
                    return SINGULAR, target, 0
                if differentiated:
                    scatter(dstates, along.new)
            if differentiated and due < len(problem.times) and problem.times[due] <= target + 1e-9 * length:
                gather(along.old, dolds)
                gather(along.new, dstates)
            while due < len(problem.times) and problem.times[due] <= target + 1e-9 * length:
                share = min(1.0, (problem.times[due] - t) / length)
                _record(n, length, share, old, new, dolds, dstates, out, dout, due)
                count_turns(models.turns, problem.times[due], row(out, due), due)
                due += 1
            count_turns(models.turns, target, new, STEP_END)
            t = target
            if settings.adaptive:
                if log.counts[0] >= settings.most_steps:
                    return TOO_MANY_STEPS, t, 0
                # Small changes of the step would cost a factorisation each and gain little.
                growth = min(2.0, 0.9 * (error + 1e-30) ** (-1 / 3))
                if growth < 1.0 or growth > 1.2:
                    length *= growth
            else:
                unit += stride
                # After a halving the step doubles again as soon as it ends on the coarser grid.
                if level > 0 and unit % (2 * stride) == 0:
                    level -= 1
    if differentiated:
        gather(along.new, dstates)
    copy(new, state)
    return DONE, edges[-1], 0


_differentiate_at = differentiate.at


@inlined
def _record(n, length, share, old, new, dolds, dnews, out, dout, due):
    """Write the states at an output time."""
    interpolate(n, length, share, old, new, out.x[due], out.v[due], out.a[due])
    for d in range(len(dnews.x)):
        interpolate(n, length, share, row(dolds, d), row(dnews, d), dout.x[d, due], dout.v[d, due], dout.a[d, due])
