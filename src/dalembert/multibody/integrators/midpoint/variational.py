"""The constrained variational integrator of the midpoint rule, with the derivatives of its discrete solution."""

__all__ = ["Variational"]

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.arguments import limited
from dalembert.kernels.duals import Dual
from dalembert.kernels.kernel import Compiled
from dalembert.multibody.integrators.midpoint.energy_balance import Balance, balance_workspace
from dalembert.multibody.integrators.midpoint.lanes_loop import integrate_lanes, run_in_lanes
from dalembert.multibody.integrators.midpoint.midpoint_derivatives import KERNELS
from dalembert.multibody.integrators.midpoint.midpoint_loop import MidpointSettings, integrate, workspace
from dalembert.multibody.integrators.shared.batch import Batch
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.lane_groups import run_groups
from dalembert.multibody.integrators.shared.matrices import pattern_of
from dalembert.multibody.integrators.shared.outputs import settling_kernels
from dalembert.multibody.integrators.shared.problem import DONE
from dalembert.multibody.integrators.shared.run import Run, cut_down, explain
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.sample_lanes import solve_samples
from dalembert.multibody.kernels.states import MotionState, resting
from dalembert.multibody.model.directions import is_dual, widest
from dalembert.multibody.model.lane_models import lane_kernels
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.structure import Structure


@dataclass(frozen=True)
class Variational(Integrator):
    """Discrete Lagrange-d'Alembert principle with the midpoint rule and constraints, of second order.

    The motion makes the sum of h L((q0 + q1)/2, (q1 - q0)/h) stationary under the constraints, beside the work of loads
    and losses. So momenta that the mechanism's symmetries conserve stay to rounding, and the energy of a conservative
    mechanism swings about its value without drift for as long as the step resolves the motion. Coordinates and
    velocities fulfil their constraints at each step, accelerations and multipliers follow from the equations of motion,
    and between steps as with :class:`RadauIIA`: the constraints hold at all three levels to rounding.

    Parameters
    ----------
    step : float
        Step in s.
    newton_tolerance : float
        Of the coordinates at each step, relative to the way that they go in it; rounding by default, as constraints,
        momenta and derivatives need it.

    Notes
    -----
    M (v_m - v_0) + h/2 F(q_m, v_m) + J(q_0)^T n = 0, Phi(q_0 + h v_m) = 0, then
    M (v_1 - v_m) + h/2 F(q_m, v_m) + J(q_1)^T m = 0, J v_1 + Phi_t = 0, with F the forces on the left. J. E. Marsden
    and M. West, "Discrete mechanics and variational integrators" (2001), 3.2 and 3.5; friction takes the joints' forces
    by the mean of both ends. Armature inertias in space, whose masses change with the coordinates, are constant masses
    of additional coordinates that constraints tie to the joints. Where the constraints lose rank (a flat four-bar),
    their rates cannot be met and the run ends with the time; :class:`GeneralizedAlpha` passes such positions.

    Examples
    --------
    >>> Variational(step=1e-3).fixed_step
    0.001
    """

    step: float = limited(unit="s", above=0)
    newton_tolerance: float = limited(1e-14, unit="", above=0)
    constant_masses = True
    convergence = 2
    is_balanced = False  #: whether the energy is balanced

    def kernels(self, structure: Structure, derivatives: type | None = None) -> list[Compiled]:
        """The loop with its linear systems, and what differentiates a step."""
        step = KERNELS[self.is_balanced, derivatives is Dual]
        return [integrate, *structure.full.linear_kernels, *[step] * bool(derivatives), *settling_kernels(derivatives)]

    @property
    def takes_duals(self) -> bool:
        """Whether derivatives along many directions may be dual numbers."""
        return True

    @property
    def takes_lanes(self) -> bool:
        """Whether samples may run side by side."""
        return True

    def lane_kernels(self, sample: Lowered) -> list[Compiled]:
        """The loop for samples side by side, its solutions, and what components need."""
        return [integrate_lanes, solve_samples, *lane_kernels(sample.data, "residual", "rates")]

    def run(self, batch: Batch) -> list[Run]:
        """Runs of samples in compiled loops that leave the interpreter's lock free, in lanes where they can."""
        if not self.takes_lanes:
            return self._one_by_one(batch)
        return run_groups(batch, self._run_in_lanes, self._one_by_one)

    def _run_in_lanes(self, part: Batch) -> tuple[MotionState, np.ndarray]:
        """States of a group, and which samples have to run alone."""
        return run_in_lanes(part, float(self.step), float(self.newton_tolerance), self._damped)

    def _one_by_one(self, batch: Batch) -> list[Run]:
        """Runs of samples one after the other."""
        pattern, dout = pattern_of(batch.samples[0].structure), batch.derivatives()
        runs, directions = [], batch.directions(takes_duals=self.takes_duals)
        for lowered, edges, start, models in batch.along(directions):
            log = batch.log(self.step_ends(batch.end, lowered.jumps))
            states, middle = resting(*batch.shape), 0.5 * (edges[0] + edges[1])
            energy, denergies, balance = self._balance(
                lowered, batch.perturbed, directions, start, batch.dstates, middle
            )
            settings = MidpointSettings(float(self.step), float(self.newton_tolerance), self._damped(lowered), energy)
            along, together = widest(lowered.tangents, directions), is_dual(directions)
            calls, along_calls = ([own.call(), own.call()] for own in (lowered.real, along))
            scratch = workspace(
                batch.problem, pattern, calls, along_calls, balance, denergies, batch.dstates, together=together
            )
            status, time, unknown = integrate(
                batch.problem, edges, settings, models, start, batch.dstates, states, dout, log, *scratch
            )
            given = lowered, status, time, unknown, cut_down(self.step)
            reason = None if status == DONE else explain(*given)
            runs.append(batch.result(reason, states, dout, log))
        return runs

    def _damped(self, lowered: Lowered) -> bool:
        """Whether the forces of a step depend on its velocities."""
        return lowered.dissipates

    def _balance(
        self, lowered: Lowered, perturbed: Sequence[Lowered], directions: Sequence[BlockModel], start: MotionState,
        dstarts: MotionState, within: float,
    ) -> tuple[float, np.ndarray, Balance]:  # fmt: skip
        """Energy at the start with its derivatives, and what keeps it: here nothing does."""
        return 0.0, np.zeros(len(perturbed)), balance_workspace(len(start.x))
