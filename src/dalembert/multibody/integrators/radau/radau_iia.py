"""Radau IIA for the stabilised index-2 equations, with the derivatives of its discrete solution."""

__all__ = ["RadauIIA"]

from dataclasses import dataclass

import numpy as np

from dalembert.arguments import limited
from dalembert.errors import InputError, SolveError
from dalembert.kernels.kernel import Compiled
from dalembert.multibody.integrators.radau.radau_coefficients import coefficients
from dalembert.multibody.integrators.radau.radau_derivatives import kernels
from dalembert.multibody.integrators.radau.radau_loop import integrate
from dalembert.multibody.integrators.radau.radau_workspace import RadauSettings, workspace
from dalembert.multibody.integrators.shared.batch import Batch
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.matrices import pattern_of
from dalembert.multibody.integrators.shared.outputs import settling_kernels
from dalembert.multibody.integrators.shared.problem import DONE, INEXACT
from dalembert.multibody.integrators.shared.run import Run, cut_down, explain, users_error
from dalembert.multibody.kernels.states import resting
from dalembert.multibody.model.directions import is_dual, widest
from dalembert.multibody.model.lowered import Lowered, slip_scale
from dalembert.multibody.model.structure import Structure
from dalembert.multibody.start.singular_positions import singular_position

_ABOVE = 100.0  # times the smallest error: a tolerance at which rounding hardly changes the step
_FINEST = 1e-12  # tolerance from which rounding does not limit the steps of stiff mechanisms (measured)
_ROUNDED = 1e-7  # tolerance that no rounding asks for
_STICKING = 0.01  # of the slip rate: error of velocities in a step, so that dry friction can hold a joint


@dataclass(frozen=True)
class RadauIIA(Integrator):
    """Radau IIA of order 5, 9 or 13 for the equations of index 2 that Gear, Gupta and Leimkuhler stabilised.

    Three, five or seven implicit stages a step. Coordinates and velocities fulfil their constraints at the end of each
    step; those of an output between steps lie on the polynomial through coordinates, velocities and accelerations at
    the ends of up to three steps of similar size, and are moved onto the constraints by the smallest amount in the
    metric of the mass. Accelerations and multipliers always follow from the equations of motion. So the constraints
    hold at all three levels to rounding.

    Parameters
    ----------
    tolerance : float
        Of the estimated error of a step, relative to each coordinate's scale: the extent of the mechanism for
        positions, 1 for angles and gradients. The scale of a velocity is that of its coordinate times the largest
        velocity so far relative to the scale of its coordinate, 1/s. Where joints have dry friction, errors of
        velocities are below 1 % of the smallest slip rate, so that friction can hold a joint. The estimate is of the
        order of the stages, so errors of fine steps are much smaller. Rounding allows 1e-12 and more for stiff
        mechanisms.
    step : float, optional
        Fixed step in s; chosen by ``tolerance`` if not given.
    stages : {5, 3, 7}
        The order is twice as many, less one. Five were measured to be the cheapest at all errors from 1e-4 to
        1e-11, for rigid and flexible mechanisms; seven are for the last digits.
    newton_tolerance : float
        Of the coordinates at each stage, relative to the way that they go in the step; rounding by default, as
        constraints and derivatives need it.
    most_steps : int
        After which an error-controlled run gives up.

    Notes
    -----
    M q' = M v - J^T mu, M v' = Q - J^T lambda, Phi = 0, J v + Phi_t = 0; C. W. Gear, B. Leimkuhler and G. K. Gupta,
    "Automatic integration of Euler-Lagrange equations with constraints" (1985); stages, error estimate and the split of
    Newton's matrix by E. Hairer and G. Wanner, "Solving Ordinary Differential Equations II" (1996), IV.8, and "Stiff
    differential equations solved by Radau methods" (1999). The estimate is that of q and v alone. M in the first
    equation only weighs mu, which vanishes in the exact motion: where masses change with the coordinates, it is that of
    the place where Newton's matrix was evaluated last. Where the constraints lose rank (a flat four-bar), their rates
    cannot be met and as a rule the run ends with the time and the joints; :class:`GeneralizedAlpha` passes such
    positions.

    Examples
    --------
    >>> RadauIIA(tolerance=1e-8).order
    9
    """

    tolerance: float = limited(1e-7, unit="", above=0)
    step: float | None = limited(None, unit="s", above=0)
    stages: int = 5
    newton_tolerance: float = limited(1e-14, unit="", above=0)
    most_steps: int = 1_000_000

    def __post_init__(self) -> None:
        if self.stages not in (3, 5, 7):
            raise InputError(f"RadauIIA: stages is {self.stages}; expected 3, 5 or 7")

    @property
    def order(self) -> int:
        """Order of coordinates and velocities in the step."""
        return 2 * self.stages - 1

    @property
    def convergence(self) -> int:
        return self.order

    def kernels(self, structure: Structure, derivatives: type | None = None) -> list[Compiled]:
        """The loop with its linear systems, and what differentiates a step and an output."""
        return [integrate, *structure.full.linear_kernels, *kernels(derivatives), *settling_kernels(derivatives)]

    @property
    def takes_duals(self) -> bool:
        """Whether derivatives along many directions may be dual numbers."""
        return True

    def run(self, batch: Batch) -> list[Run]:
        """Runs of samples in one compiled loop that leaves the interpreter's lock free."""
        problem, dout = batch.problem, batch.derivatives()
        first = batch.samples[0]
        pattern, method = pattern_of(first.structure), coefficients(self.stages)
        fixed = self.step_ends(batch.end, first.jumps)
        directions = batch.directions(takes_duals=self.takes_duals)
        models = first.real, widest(first.tangents, directions)
        calls, along_calls = ([model.call() for _ in range(1 + self.stages)] for model in models)
        spare = workspace(problem, method, pattern, batch.dstates, calls, along_calls, is_dual(directions))
        run = integrate.given(problem, method, batch.dstates, dout, *spare)
        runs = []
        for lowered, edges, start, models in batch.along(directions):
            log, states = batch.log(fixed), resting(*batch.shape)
            slow = _STICKING * slip_scale(lowered) / self.tolerance
            steps = self.step or 0.0, self.tolerance, self.newton_tolerance, self.most_steps
            settings = RadauSettings(*steps, lowered.dissipates, slow)
            status, time, unknown, least = run(edges, settings, models, start, states, log)
            reason = None if status == DONE else self._explain(lowered, status, time, unknown, least, spare.new.x)
            runs.append(batch.result(reason, states, dout, log))
        return runs

    def _explain(
        self, lowered: Lowered, status: int, time: float, unknown: int, least: float, x: np.ndarray
    ) -> SolveError:
        if error := users_error(lowered, time) or singular_position(lowered, x, time):
            return error
        if status == INEXACT:
            return self._explain_inexact(time, least)
        shortened = "the step was cut down for it" if self.step is None else cut_down(self.step)
        return explain(lowered, status, time, unknown, shortened, self.most_steps)

    def _explain_inexact(self, time: float, least: float) -> SolveError:
        floor = least * self.tolerance
        enough = max(_FINEST, 10.0 ** np.ceil(np.log10(_ABOVE * floor)))
        rounded = enough <= _ROUNDED
        cause = "by rounding, or by a load" if rounded else "by a load"
        return SolveError(
            f"no step meets tolerance = {self.tolerance:g} at t = {time:.6g} s: its estimated error is {floor:.1e} or "
            f"more, {cause} that jumps or grows without bound; "
            + (f"use tolerance = {enough:g} or more, or check the loads" if rounded else "check the loads")
        )
