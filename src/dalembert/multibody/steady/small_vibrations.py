"""Small vibrations about a state of rest or a steady rotation."""

from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy.linalg import eig, eigh, eigvalsh, null_space

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, require_known
from dalembert.forward.complex_steps import SAFE
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.evaluate import tangent
from dalembert.multibody.model.lowered import Lowered, scales
from dalembert.multibody.model.observe import Observer
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.motion.complex_steps import Along, check_forces
from dalembert.multibody.start.lost_freedom import refuse_locked
from dalembert.multibody.start.statics import Equilibrium, placed_at_start, resting
from dalembert.multibody.steady.steady_motion import FIXED, FRAMES, ROTATING, moves, steady_equations

_FREE = 3e-8
"""Frequency, as part of the largest one, that rounding of squares gives a motion without stiffness."""
_DEFINITE = 1e-12
"""Eigenvalue of a scaled stiffness, as part of the largest one, above which it is not rounding."""


@dataclass(frozen=True, eq=False)
class Modes:
    """Small vibrations about a state of rest or a steady rotation, as :func:`modes` returns them.

    Parameters
    ----------
    frequencies : array, shape (modes,)
        Hz, ascending; of the damped vibration, seen in the frame.
    damping_ratios : array, shape (modes,)
        Relative to critical damping.
    shapes : complex array, shape (N + 1, modes)
        Rows as in ``x`` of the :class:`Equilibrium`: the coordinates of all bodies in their order in the system, from
        row ``equilibrium.lowered.structure.first[name]`` on those of a body; the rows of multipliers and the last row
        are zero. Each shape is scaled so that its entry of largest magnitude is 1 + 0j. About a rotation: at the
        time 0, in the fixed axes; in a rotating frame the shape turns with the frame.
    roots : complex array, shape (modes,)
        1/s: decay rate and angular frequency.
    growth : float
        Largest growth rate of any motion, 1/s, also of those that do not oscillate; 0 about a stable state.
    speed : float
        Angular velocity of the fastest body, rad/s; 0 at rest.
    frame : {"fixed", "rotating"}
        Where the frequencies are observed: in the fixed axes, or in axes that turn with a body.
    frame_speed : float
        Angular velocity of the frame, rad/s.
    whirl : array, shape (modes,)
        1 for a mode whose bodies move forward on circles about the axis of the fastest body, -1 for backward, 0 for a
        motion along a line, and in between for ellipses; 0 at rest.
    """

    frequencies: np.ndarray
    damping_ratios: np.ndarray
    shapes: np.ndarray
    roots: np.ndarray
    growth: float
    speed: float
    frame: str
    frame_speed: float
    whirl: np.ndarray


@takes_checked()
def modes(state: BaseSystem | Equilibrium, count: int | None = None, *, frame: str | None = None) -> Modes:
    """Frequencies, damping ratios and shapes of small vibrations that satisfy the joints.

    The equations of motion are linearised about the state, with damping and with the stiffness of the joint forces
    there, and projected on the motions that the joints leave free. Motions without stiffness, such as the rotation of
    a body about a vertical axis on a ball joint, are left out. Dense: for models to some thousand coordinates.

    Where bodies of a system move at the start, the modes are those about its steady rotation, with gyroscopic and
    centrifugal terms: bodies keep their rates, and springs deflect until all forces are in balance. The equations have
    to be constant in the fixed frame, as those of axisymmetric rotors on any supports are, or in a frame that turns
    with a body, as those of any rotor on supports that are alike in all directions are.

    Parameters
    ----------
    state : Mechanism or Equilibrium
        A system stands for its equilibrium, or for its steady rotation where bodies move at the start.
    count : int, optional
        How many, from the lowest; all if not given.
    frame : {"fixed", "rotating"}, optional
        Where frequencies about a rotation are observed; the fixed frame if not given, if equations are constant there.

    Returns
    -------
    Modes

    Raises
    ------
    ModelError
        Where the joints leave no freedom, or a motion at the start is not steady.
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
    if frame is not None:
        require_known("frame", frame, FRAMES, "modes")
    if isinstance(state, BaseSystem):
        placed = placed_at_start(state)
        if moves(placed):
            return _about_rotation(placed, count, frame)
        state = resting(state, placed)
    if frame == ROTATING:
        raise InputError("modes: frame is 'rotating', but no body turns; leave it out")
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
    least = _FREE
    if not c.any() and np.allclose(k, k.T, 0, 1e-9 * abs(k).max()):
        # M x'' + K x = 0 with symmetric matrices: many times faster than the general problem.
        is_held = _is_definite(k)
        squares, vectors = _squares((k + k.T) / 2, (m + m.T) / 2, is_held)
        roots = np.emath.sqrt(-squares)
        least = 0.0 if is_held else least
    else:
        # M x'' + C x' + K x = 0.
        state_matrix = np.block([[np.zeros(m.shape), np.eye(len(m))], [-np.linalg.solve(m, np.hstack([k, c]))]])
        roots, vectors = cast(tuple[np.ndarray, np.ndarray], eig(state_matrix))
        vectors = vectors[: len(m)]
    largest = np.abs(roots).max(initial=0.0)
    growth = float(np.real(roots).max(initial=0.0))
    kept = np.flatnonzero(np.imag(roots) > least * largest)
    kept = kept[np.argsort(np.imag(roots[kept]))][:count]
    shapes = np.zeros((len(x), len(kept)), dtype=complex)
    shapes[:n] = free @ vectors[:, kept]
    shapes /= shapes[np.argmax(np.abs(shapes), axis=0), np.arange(len(kept))]
    growth = growth if growth > _FREE * largest else 0.0
    return _modes(roots[kept], shapes, growth, 0.0, FIXED, 0.0, np.zeros(len(kept)))


def _squares(stiffness: np.ndarray, mass: np.ndarray, is_held: bool) -> tuple[np.ndarray, np.ndarray]:
    """Squares of the frequencies in ascending order, and shapes. K x = s M x has errors in proportion to the largest
    square, which of a slender beam is 1e13 times the smallest; M x = K x / s has them in proportion to the smallest.
    The second problem needs a definite K (``is_held``).
    """
    squares, vectors = eigh(stiffness, mass)
    if not is_held:
        return squares, vectors
    inverse, shapes = eigh(mass, stiffness)
    low = squares < np.sqrt(np.abs(squares[-1] / inverse[-1]))  # below the mean of the smallest and the largest
    squares[low] = 1.0 / inverse[::-1][low]
    vectors[:, low] = shapes[:, ::-1][:, low] * np.sqrt(squares[low])  # as long by the mass as the others
    return squares, vectors


def _is_definite(stiffness: np.ndarray) -> bool:
    """Whether a stiffness is positive definite beyond rounding: no motion is free of it."""
    scale = np.sqrt(np.abs(np.diagonal(stiffness)))
    if not len(scale) or not scale.all():
        return False
    values = eigvalsh((stiffness + stiffness.T) / 2 / np.outer(scale, scale))
    return bool(values[0] > _DEFINITE * values[-1])


def _about_rotation(lowered: Lowered, count: int | None, frame: str | None) -> Modes:
    """Modes about the steady motion nearest to the start."""
    from dalembert.structure.complex_modes import complex_modes, whirl

    refuse_locked(lowered)
    equations = steady_equations(lowered, frame)
    found = complex_modes(equations.mass, equations.damping, equations.stiffness)
    kept = slice(count)
    shapes = equations.shapes @ found.shapes[:, kept]
    shapes = shapes / shapes[np.argmax(np.abs(shapes), axis=0), np.arange(shapes.shape[1])]
    direction = whirl(found.shapes[:, kept], equations.mass, equations.turn)
    return _modes(
        found.roots[kept], shapes, found.growth, equations.speed, equations.frame, equations.frame_speed, direction
    )


def _modes(
    roots: np.ndarray,
    shapes: np.ndarray,
    growth: float,
    speed: float,
    frame: str,
    frame_speed: float,
    whirl: np.ndarray,
) -> Modes:
    frequencies, ratios = np.imag(roots) / (2 * np.pi), -np.real(roots) / np.abs(roots)
    return Modes(frequencies, ratios, shapes, roots, growth, speed, frame, frame_speed, whirl)
