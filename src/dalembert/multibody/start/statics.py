"""Equilibrium under load."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.argument_readers import names_of
from dalembert.kernels.preparation import prepare
from dalembert.multibody.model.drawing import Drawing, draw
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.observe import observer
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.start.assemble import assembled, refuse_redundancy
from dalembert.multibody.start.equilibrium_start import resting_place


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A state of rest under the loads at time 0, as :func:`equilibrium` returns it.

    Parameters
    ----------
    system : Mechanism
    lowered : Lowered
    x : array, shape (N + 1,)
        The N coordinates and multipliers, and a last entry, 0, which stands for absent coordinates.
    iterations : int
        Newton iterations.
    """

    system: BaseSystem
    lowered: Lowered
    x: np.ndarray
    iterations: int

    INSTEAD = "give its system. To start a motion at the equilibrium, make the system with start='equilibrium'"

    def channels(self, names: Sequence[str]) -> np.ndarray:
        """Values of channels, (channels,)."""
        still = np.zeros((1, len(self.x)))
        own = observer(self.system, self.lowered, names_of(names, "Equilibrium", "channels"))
        return own.read(self.lowered, self.lowered.real, (self.x[None], still, still), np.zeros(1))[0]

    def drawing(self, points: int = 8) -> Drawing:
        """Lines of the bodies and places of the joints, in one frame."""
        return draw(self.system, self.lowered, np.zeros(1), self.x[None], points)


def equilibrium(system: BaseSystem) -> Equilibrium:
    """State of rest under gravity and the loads at time 0, nearest to the first placement.

    Newton's method; where it does not converge at once, gravity, loads and springs are raised in steps from the
    undeformed state. Where these do not converge either, Newton's method under the whole load has more iterations.

    Parameters
    ----------
    system : Mechanism

    Returns
    -------
    Equilibrium

    Raises
    ------
    SolveError
        Where there is no equilibrium near the first placement, or the system can move without any stiffness.

    Examples
    --------
    >>> from dalembert.multibody import PointMass, Spring, System, equilibrium
    >>> system = System()
    >>> bob = system.add(PointMass("bob", mass=1.0, position=(0.0, -1.0)))
    >>> spring = system.add(Spring("spring", system.ground.point(0, 0), bob.centre, stiffness=100.0, free_length=1.0))
    >>> equilibrium(system).channels(["bob.centre.y"]).round(4)
    array([-1.0981])
    """
    return resting(system, placed_at_start(system))


def placed_at_start(system: BaseSystem) -> Lowered:
    """Return the assembled mechanism, compiled and checked."""
    placed = lower(system)
    prepare(placed.kernels())
    lowered = assembled(system, placed=placed)
    refuse_redundancy(lowered)
    return lowered


def resting(system: BaseSystem, lowered: Lowered) -> Equilibrium:
    """Return the equilibrium nearest to an assembled placement."""
    x, iterations = resting_place(lowered)
    return Equilibrium(system, lowered, x, iterations)
