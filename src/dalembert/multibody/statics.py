"""Equilibrium under load, and small vibrations about a state."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy.linalg import eig, eigh, null_space

from dalembert.arguments import names_of, takes_checked
from dalembert.forward.complex_steps import SAFE
from dalembert.kernels.preparation import prepare
from dalembert.multibody.assemble import assembled, refuse_redundancy
from dalembert.multibody.complex_steps import Along, check_forces
from dalembert.multibody.drawing import Drawing, draw
from dalembert.multibody.equilibrium_start import resting_place
from dalembert.multibody.evaluate import tangent
from dalembert.multibody.kernels.motion import MotionState
from dalembert.multibody.lost_freedom import refuse_locked
from dalembert.multibody.lowered import Lowered
from dalembert.multibody.lowering import lower
from dalembert.multibody.observe import Observer, observer
from dalembert.multibody.scales import scales
from dalembert.multibody.system import Mechanism

_FREE = 3e-8
"""Frequency, as part of the largest one, that rounding of squares gives a motion without stiffness."""


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

    system: Mechanism
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


@dataclass(frozen=True, eq=False)
class Modes:
    """Small vibrations about a state, as :func:`modes` returns them.

    Parameters
    ----------
    frequencies : array, shape (modes,)
        Hz, ascending; of the damped vibration.
    damping_ratios : array, shape (modes,)
        Relative to critical damping.
    shapes : complex array, shape (N + 1, modes)
        Rows as in ``x`` of the :class:`Equilibrium`: the coordinates of all bodies in their order in the system, from
        row ``equilibrium.lowered.structure.first[name]`` on those of a body; the rows of multipliers and the last row
        are zero. Each shape is scaled so that its entry of largest magnitude is 1 + 0j.
    """

    frequencies: np.ndarray
    damping_ratios: np.ndarray
    shapes: np.ndarray


def equilibrium(system: Mechanism) -> Equilibrium:
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
    placed = lower(system)
    prepare(placed.kernels(False))
    lowered = assembled(system, placed=placed)
    refuse_redundancy(lowered)
    x, iterations = resting_place(lowered)
    return Equilibrium(system, lowered, x, iterations)


@takes_checked()
def modes(state: Mechanism | Equilibrium, count: int | None = None) -> Modes:
    """Frequencies, damping ratios and shapes of small vibrations that satisfy the joints.

    The equations of motion are linearised about the state, with damping and with the stiffness of the joint forces
    there, and projected on the motions that the joints leave free. Motions without stiffness, such as the rotation of
    a body about a vertical axis on a ball joint, are left out. Dense: for models to some thousand coordinates.

    Parameters
    ----------
    state : Mechanism or Equilibrium
        A system stands for its equilibrium.
    count : int, optional
        How many, from the lowest; all if not given.

    Returns
    -------
    Modes

    Raises
    ------
    ModelError
        Where the joints leave no freedom.
    InputError
        Where the force of a function of the user's cannot run in complex numbers, or loses the imaginary part of the
        state: its stiffness and damping would be wrong.

    Examples
    --------
    >>> from dalembert.multibody import PointMass, Spring, System, modes
    >>> system = System(gravity=(0.0, 0.0))
    >>> bob = system.add(PointMass("bob", mass=1.0, position=(1.0, 0.0)))
    >>> for name, place in (("right", (2.0, 0.0)), ("top", (1.0, 1.0))):
    ...     _ = system.add(Spring(name, system.ground.point(*place), bob.centre, stiffness=400.0))
    >>> modes(system).frequencies.round(4)  # sqrt(400) rad/s
    array([3.1831, 3.1831])
    """
    state = state if isinstance(state, Equilibrium) else equilibrium(state)
    lowered, x, n = state.lowered, state.x, state.lowered.structure.n
    refuse_locked(lowered)
    still = np.zeros_like(x)
    at_rest = still[None]
    along = Along(Observer((), ()), np.zeros(1), MotionState(x[None], at_rest, at_rest, at_rest))
    check_forces(lowered, along, scales(lowered), SAFE)  # else stiffness or damping would be wrong
    stiffness = tangent(lowered, x, still, (1.0, 0.0, 0.0)).toarray()
    damping = tangent(lowered, x, still, (0.0, 1.0, 0.0)).toarray()[:n, :n]
    mass = tangent(lowered, x, still, (0.0, 0.0, 1.0)).toarray()[:n, :n]
    free = null_space(stiffness[n:, :n] / scales(lowered)[n:-1, None]) if lowered.structure.size > n else np.eye(n)
    k, c, m = (free.T @ matrix @ free for matrix in (stiffness[:n, :n], damping, mass))
    roots, vectors = (
        _undamped(k, m) if not c.any() and np.allclose(k, k.T, 0, 1e-9 * abs(k).max()) else _damped(k, c, m)
    )
    kept = np.flatnonzero(np.imag(roots) > _FREE * np.abs(roots).max(initial=0.0))
    kept = kept[np.argsort(np.imag(roots[kept]))][:count]
    shapes = np.zeros((len(x), len(kept)), dtype=complex)
    shapes[:n] = free @ vectors[:, kept]
    shapes /= shapes[np.argmax(np.abs(shapes), axis=0), np.arange(len(kept))]
    roots = roots[kept]
    return Modes(np.imag(roots) / (2 * np.pi), -np.real(roots) / np.abs(roots), shapes)


def _undamped(k: np.ndarray, m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Roots and shapes of M x'' + K x = 0 with symmetric matrices, many times faster than the general problem."""
    squares, vectors = eigh((k + k.T) / 2, (m + m.T) / 2)
    return np.emath.sqrt(-squares), vectors


def _damped(k: np.ndarray, c: np.ndarray, m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Roots and shapes of M x'' + C x' + K x = 0."""
    size = len(k)
    state_matrix = np.block([[np.zeros((size, size)), np.eye(size)], [-np.linalg.solve(m, np.hstack([k, c]))]])
    roots, vectors = cast(tuple[np.ndarray, np.ndarray], eig(state_matrix))
    return roots, vectors[:size]
