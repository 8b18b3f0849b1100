"""Equilibrium under load, and small vibrations about a state."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy.linalg import eig, eigh, null_space
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import lsqr, splu

from dalembert.arguments import names_of, takes_checked
from dalembert.errors import SolveError
from dalembert.forward.complex_steps import SAFE
from dalembert.kernels.preparation import prepare
from dalembert.multibody.assemble import assembled, refuse_redundancy, scales
from dalembert.multibody.complex_steps import Along, check_forces
from dalembert.multibody.drawing import Drawing, draw
from dalembert.multibody.evaluate import residual, tangent
from dalembert.multibody.kernels.motion import Motion
from dalembert.multibody.lowering import Lowered, lower
from dalembert.multibody.observe import Observer, observer
from dalembert.multibody.system import System

_MOST_ITERATIONS = 30
_LAST_ITERATIONS = 300  # where loads in steps lead nowhere, as a torque that rolls a beam up
_SMALLEST_FRACTION = 1 / 1024


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A state of rest under the loads at time 0, as :func:`equilibrium` returns it.

    Parameters
    ----------
    system : System
    lowered : Lowered
    x : array, shape (N + 1,)
        Coordinates and multipliers.
    iterations : int
        Newton iterations.
    """

    system: System
    lowered: Lowered
    x: np.ndarray
    iterations: int

    def channels(self, names: Sequence[str]) -> np.ndarray:
        """Values of channels, (channels,)."""
        still = np.zeros((1, len(self.x)))
        own = observer(self.system, self.lowered, names_of(names, "Equilibrium", "channels"))
        return own.read(self.lowered, self.lowered.real, self.x[None], still, still)[0]

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
    shapes : complex array, shape (N + 1, modes)
        Of the coordinates, largest entry one.
    """

    frequencies: np.ndarray
    damping_ratios: np.ndarray
    shapes: np.ndarray


def equilibrium(system: System) -> Equilibrium:
    """State of rest under gravity and the loads at time 0, nearest to the first placement.

    Newton's method; where it does not converge at once, gravity, loads and springs are raised in steps from the
    undeformed state. Where these do not converge either, Newton's method under the whole load has more iterations.

    Parameters
    ----------
    system : System

    Returns
    -------
    Equilibrium

    Raises
    ------
    SolveError
        Where there is no equilibrium near the first placement, or a motion is free of stiffness.

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
    still = np.zeros_like(np.real(lowered.x))

    def forces(x: np.ndarray) -> np.ndarray:
        return residual(lowered, lowered.real, x, still, still)

    x = np.real(lowered.x).astype(float)
    start = forces(x)
    total, reached, fraction = 0, 0.0, 1.0
    while reached < 1.0:
        aim = min(1.0, reached + fraction)
        found, iterations = _newton(lowered, lambda y, aim=aim: forces(y) - (1.0 - aim) * start, x)
        total += iterations
        if found is None:
            fraction /= 2
            if fraction < _SMALLEST_FRACTION:
                x, iterations = _newton(lowered, forces, np.real(lowered.x).astype(float), _LAST_ITERATIONS)
                if x is not None:
                    return Equilibrium(system, lowered, x, total + iterations)
                raise SolveError(
                    f"no equilibrium was found: Newton's method stopped at {100 * reached:.3g} % of the loads. A "
                    "motion may be free of stiffness (add a joint or a spring), or the first placement is far from "
                    "the equilibrium"
                )
            continue
        x, reached, fraction = found, aim, 2 * fraction
    return Equilibrium(system, lowered, x, total)


def _newton(lowered: Lowered, forces, x: np.ndarray, most: int = _MOST_ITERATIONS) -> tuple[np.ndarray | None, int]:
    """Newton's method on coordinates and multipliers; None where it does not converge."""
    n, still, scale = lowered.structure.n, np.zeros_like(x), scales(lowered)[:-1]
    x = x.copy()
    for iteration in range(1, most + 1):
        step = _solution(tangent(lowered, x, still, (1.0, 0.0, 0.0)), forces(x))
        if step is None:
            return None, iteration
        size = np.max(np.abs(step[:n]) / scale[:n])
        if not np.isfinite(size) or size > 1e3:
            return None, iteration
        x[:-1] -= step * (0.5 / max(size, 0.5))  # at most half the scale at a time
        if size < 1e-11:
            return x, iteration
    return None, most


def _solution(matrix: csr_matrix, forces: np.ndarray) -> np.ndarray | None:
    """Newton step; the smallest one where a motion without stiffness is not loaded; None where it is loaded."""
    try:
        return splu(matrix.tocsc()).solve(forces)
    except RuntimeError:  # exactly singular, as beside a spring at its free length
        step = lsqr(matrix, forces, atol=1e-14, btol=1e-14)[0]
        balanced = np.linalg.norm(matrix @ step - forces) <= 1e-9 * np.linalg.norm(forces)
        return step if balanced else None


@takes_checked()
def modes(state: System | Equilibrium, count: int | None = None) -> Modes:
    """Frequencies, damping ratios and shapes of small vibrations that satisfy the joints.

    The equations of motion are linearised about the state, with damping and with the stiffness of the joint forces
    there, and projected on the motions that the joints leave free. Dense: for models to some thousand coordinates.

    Parameters
    ----------
    state : System or Equilibrium
        A system stands for its equilibrium.
    count : int, optional
        How many, from the lowest; all if not given.

    Returns
    -------
    Modes

    Raises
    ------
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
    still = np.zeros_like(x)
    _check_tangents(lowered, x)
    stiffness = tangent(lowered, x, still, (1.0, 0.0, 0.0)).toarray()
    damping = tangent(lowered, x, still, (0.0, 1.0, 0.0)).toarray()[:n, :n]
    mass = tangent(lowered, x, still, (0.0, 0.0, 1.0)).toarray()[:n, :n]
    free = null_space(stiffness[n:, :n] / scales(lowered)[n:-1, None]) if lowered.structure.size > n else np.eye(n)
    k, c, m = (free.T @ matrix @ free for matrix in (stiffness[:n, :n], damping, mass))
    roots, vectors = (
        _undamped(k, m) if not c.any() and np.allclose(k, k.T, 0, 1e-9 * abs(k).max()) else _damped(k, c, m)
    )
    kept = np.flatnonzero(np.imag(roots) > 0)
    kept = kept[np.argsort(np.imag(roots[kept]))][:count]
    shapes = np.zeros((len(x), len(kept)), dtype=complex)
    shapes[:n] = free @ vectors[:, kept]
    shapes /= shapes[np.argmax(np.abs(shapes), axis=0), np.arange(len(kept))]
    roots = roots[kept]
    return Modes(np.imag(roots) / (2 * np.pi), -np.real(roots) / np.abs(roots), shapes)


def _check_tangents(lowered: Lowered, x: np.ndarray) -> None:
    """Raise where stiffness or damping of a force would be wrong."""
    at_rest = np.zeros((1, len(x)))
    along = Along(Observer((), ()), np.zeros(1), Motion(x[None], at_rest, at_rest, at_rest))
    check_forces(lowered, along, scales(lowered), SAFE)


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
