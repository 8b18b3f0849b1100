"""The midpoint rule with the energy balanced to rounding, with the derivatives of its discrete solution."""

__all__ = ["EnergyMomentum"]

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.kernels.kernel import Compiled
from dalembert.multibody.integrators.midpoint.energy_balance import (
    Balance,
    balance_workspace,
    converge,
    first_energies,
)
from dalembert.multibody.integrators.midpoint.lanes_balance import balance_lanes
from dalembert.multibody.integrators.midpoint.lanes_loop import run_in_lanes
from dalembert.multibody.integrators.midpoint.symmetries import rigid_motions
from dalembert.multibody.integrators.midpoint.variational import Variational
from dalembert.multibody.integrators.shared.batch import Batch
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.histories import energy_history
from dalembert.multibody.kernels.states import MotionState, resting, row
from dalembert.multibody.model.directions import is_dual
from dalembert.multibody.model.lane_models import lane_kernels
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.structure import Structure

_ROLES = "energy", "mean", "mean_power"
"""Roles of components that the balance needs."""


@dataclass(frozen=True)
class EnergyMomentum(Variational):
    """Conserve energy and momenta to rounding: constrained midpoint rule with Gonzalez's correction, second order.

    The step is that of :class:`Variational` with an additional small force c M v'. The number c makes the energy at the
    end of each step equal to the initial energy plus the work of loads and losses at the midpoints of the steps. v' are
    the velocities without the rigid motions that gravity and ground leave free. The force does no work on these, so
    the momenta of free mechanisms, and of those that rotate about one point of the ground, are conserved to rounding;
    of rigid mechanisms in space the linear momenta alone. The constraints on positions, velocities and accelerations
    are satisfied to rounding.

    Mechanisms with beams or cables in space have mean forces of both ends of a step, and the constraint forces of its
    middle. Such forces neither take nor give energy, so that slender and damped beams need no shorter steps. The energy
    that velocities lose where they are moved onto the constraints is balanced by c. It is of the order h^4 in a step,
    and so is the change of the angular momentum. Mechanisms with armature inertias in space take the step of
    :class:`Variational`.

    Parameters
    ----------
    step : float
        Step in s.
    newton_tolerance : float
        Error of the coordinates at each step, relative to their change in the step. The default is rounding, which
        constraints, energy and derivatives need.

    Notes
    -----
    O. Gonzalez, "Time integration and discrete Hamiltonian systems" (1996), section 3: the gradient of the midpoint and
    a part along the motion that makes it exact in energy, here for forces and constraint forces together. The
    force is of the order h^2. If all velocities at the midpoint of a step are zero, c is not defined; it is then set
    to zero, and the next steps correct the energy.

    Examples
    --------
    >>> EnergyMomentum(step=1e-3).fixed_step
    0.001
    """

    is_balanced = True

    def kernels(self, structure: Structure, derivatives: type | None = None) -> list[Compiled]:
        """Those of `Variational`, of the balance, and of the components' energies."""
        own = [*super().kernels(structure, derivatives), converge, energy_history]
        arithmetics = (float, derivatives) if derivatives else (float,)
        roles = [(kind, role) for kind in structure.index for role in _ROLES if kind.has(role)]
        own += [kind.kernel("mean_tangent", float) for kind in structure.index if kind.has("mean")]
        return [*own, *(kind.kernel(role, dtype) for dtype in arithmetics for kind, role in roles)]

    def lane_kernels(self, sample: Lowered) -> list[Compiled]:
        """Those of `Variational`, of the balance, and of the components' energies."""
        return [*super().lane_kernels(sample), balance_lanes, *lane_kernels(sample.data, *_ROLES)]

    def _damped(self, lowered: Lowered) -> bool:
        """Whether the forces of a step depend on its velocities: mean forces do, through both ends."""
        return lowered.dissipates or lowered.structure.takes_means

    def _run_in_lanes(self, part: Batch) -> tuple[MotionState, np.ndarray]:
        """States of a group, and which samples have to run alone: all, if they do not share their rigid motions."""
        balances = []
        for number, lowered in enumerate(part.samples):
            within = 0.5 * (part.problem.edges[number, 0] + part.problem.edges[number, 1])
            energy, _, balance = self._balance(lowered, (), (), row(part.states, number), part.dstates, within)
            balances.append((energy, balance.rigid))
        if any(not np.array_equal(rigid.spin, balances[0][1].spin) for _, rigid in balances):
            return resting(len(balances), *part.shape), np.ones(len(balances), dtype=bool)
        return run_in_lanes(part, float(self.step), float(self.newton_tolerance), self._damped, balances)

    def _balance(
        self, lowered: Lowered, perturbed: Sequence[Lowered], directions: Sequence[BlockModel], start: MotionState,
        dstarts: MotionState, within: float,
    ) -> tuple[float, np.ndarray, Balance]:  # fmt: skip
        """Energy at the start with its derivatives, and the force that keeps it."""
        means = lowered.structure.takes_means
        for model in (lowered.real, *directions):
            model.need("energy").averaged(means)
        lowered.tangents.averaged(means)
        energies = first_energies(lowered, directions, start, dstarts, within)
        rigid = rigid_motions(lowered, perturbed)
        return *energies, balance_workspace(len(start.x), rigid, together=is_dual(directions))
