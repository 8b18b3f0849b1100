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
    converge_along,
    first_energies,
)
from dalembert.multibody.integrators.midpoint.symmetries import rigid_motions
from dalembert.multibody.integrators.midpoint.variational import Variational
from dalembert.multibody.kernels.histories import energy_history
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.structure import Structure


@dataclass(frozen=True)
class EnergyMomentum(Variational):
    """Conserve energy and momenta to rounding: constrained midpoint rule with Gonzalez's correction, second order.

    The step is that of :class:`Variational` with an additional small force c M v'. The number c makes the energy at the
    end of each step equal to the initial energy plus the work of loads and losses at the midpoints of the steps. v' are
    the velocities without the rigid motions that gravity and ground leave free. The force does no work on these, so
    the momenta of free mechanisms, and of those that rotate about one point of the ground, are conserved to rounding.
    The constraints on positions, velocities and accelerations are satisfied to rounding.

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

    def kernels(self, structure: Structure, derivatives: bool) -> list[Compiled]:
        """Those of `Variational`, of the balance, and of the components' energies."""
        own = [*super().kernels(structure, derivatives), converge, energy_history, *[converge_along] * derivatives]
        arithmetics = (float, complex) if derivatives else (float,)
        kinds = [kind for kind in structure.index if "energy" in kind.roles]
        return [*own, *(kind.kernel("energy", dtype) for dtype in arithmetics for kind in kinds)]

    def _balance(
        self, lowered: Lowered, perturbed: Sequence[Lowered], start: MotionState, dstarts: MotionState, within: float
    ) -> tuple[float, np.ndarray, Balance]:
        """Energy at the start with its derivatives, and the force that keeps it."""
        for model in (lowered.real, *(entry.complex_model for entry in perturbed)):
            model.need("energy")
        energies = first_energies(lowered, perturbed, start, dstarts, within)
        return *energies, balance_workspace(len(start.x), rigid_motions(lowered, perturbed))
