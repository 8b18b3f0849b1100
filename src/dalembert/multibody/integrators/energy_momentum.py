"""The midpoint rule with the energy balanced to rounding, with the derivatives of its discrete solution."""

__all__ = ["EnergyMomentum"]

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.kernels.kernel import Compiled
from dalembert.multibody.integrators.energy_balance import (
    Balance,
    balance_room,
    converge,
    converge_along,
    first_energies,
)
from dalembert.multibody.integrators.symmetries import rigid_motions
from dalembert.multibody.integrators.variational import Variational
from dalembert.multibody.kernels.histories import energy_history
from dalembert.multibody.kernels.motion import MotionState
from dalembert.multibody.lowered import Lowered
from dalembert.multibody.structure import Structure


@dataclass(frozen=True)
class EnergyMomentum(Variational):
    """Energy and momenta to rounding: the constrained midpoint rule with Gonzalez's correction, of second order.

    The step is that of :class:`Variational`. Beside it acts a small force c M v', with c such that the energy at the
    end of each step is that of the start of the motion and the work that loads and losses have done in the middles of
    the steps. v' are the velocities less the rigid motions that gravity and ground leave free, so the force does no
    work on these, and the momenta of free mechanisms, and of those that turn about one point of the ground, stay to
    rounding. The constraints hold at all three levels to rounding.

    Parameters
    ----------
    step : float
        Step in s.
    newton_tolerance : float
        Of the coordinates at each step, relative to the way that they go in it; rounding by default, as constraints,
        energy and derivatives need it.

    Notes
    -----
    O. Gonzalez, "Time integration and discrete Hamiltonian systems" (1996), section 3: the gradient of the midpoint and
    a part along the motion that makes it exact in energy, here for forces and constraint forces together. Of the order
    h^2, the force vanishes where nothing moves: at a standstill that falls on the middle of a step c would not be
    defined; it is then zero, and the next steps make up for the energy.

    Examples
    --------
    >>> EnergyMomentum(step=1e-3).fixed_step
    0.001
    """

    def kernels(self, structure: Structure, derivatives: bool) -> list[Compiled]:
        """Those of `Variational`, of the balance, and of the components' energies."""
        own = [*super().kernels(structure, derivatives), converge, energy_history, *[converge_along] * derivatives]
        arithmetics = (float, complex) if derivatives else (float,)
        kinds = [kind for kind in structure.index if kind.has("energy")]
        return [*own, *(kind.kernel("energy", dtype) for dtype in arithmetics for kind in kinds)]

    def _balance(
        self, lowered: Lowered, perturbed: Sequence[Lowered], start: MotionState, dstarts: MotionState, within: float
    ) -> tuple[float, np.ndarray, Balance]:
        """Energy at the start with its derivatives, and the force that keeps it."""
        for model in (lowered.real, *(entry.complex_model for entry in perturbed)):
            model.need("energy")
        energies = first_energies(lowered, perturbed, start, dstarts, within)
        return *energies, balance_room(rigid_motions(lowered, perturbed), len(start.x))
