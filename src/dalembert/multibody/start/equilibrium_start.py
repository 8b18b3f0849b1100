"""The static equilibrium of a mechanism, with its derivatives, and motions that begin there."""

from collections.abc import Callable
from typing import cast

import numpy as np
from scipy.linalg import eigh, lstsq
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import lsqr, splu

from dalembert.errors import ModelError, SolveError
from dalembert.multibody.model.evaluate import residual, tangent
from dalembert.multibody.model.lowered import Lowered, scales
from dalembert.multibody.start.mixed_points import MixedPoints
from dalembert.multibody.start.static_stability import free_motions

_MOST_ITERATIONS = 30
_LAST_ITERATIONS = 300  # where loads in steps lead nowhere, as a torque that rolls a beam up
_SMALLEST_FRACTION = 1 / 1024
_FIRST_STEP = 0.2  # of the scale
_SLOW = 1e-9  # of the stiffness: enough for the constraints
_FAR = 1e3  # scales that a step of Newton's method does not go
_DENSE = 600  # unknowns up to which a dense matrix is decomposed
_WITHOUT = 1e-13  # of the largest singular value: what counts as no stiffness
_NEUTRAL = 1e-9  # of the largest stiffness: what counts as none

Forces = Callable[[np.ndarray], np.ndarray]


def begin_at_rest(lowered: Lowered) -> Lowered:
    """The same mechanism at rest in its equilibrium; in complex numbers with the derivative along the complex step.

    With the residual r(x, p) = 0 of the equilibrium, its derivative is dx/dp = -(dr/dx)^-1 dr/dp.
    """
    moving = np.any(lowered.stated & (np.real(lowered.rates) != 0.0), axis=1)
    if np.any(moving):
        name = list(lowered.bodies)[int(np.argmax(moving))]
        raise ModelError(
            f"the mechanism starts at its equilibrium, and {name!r} has a velocity at the start. Leave the velocity "
            "out, or start as placed: start='placed'"
        )
    place, _ = resting_place(lowered)
    if lowered.is_complex:
        still = np.zeros(len(place), dtype=complex)
        place = place.astype(complex)
        moved = np.imag(residual(lowered, lowered.complex_model, place, still, still))
        step = _solution(tangent(lowered, np.real(place), np.real(still), (1.0, 0.0, 0.0)), moved)
        if step is None:
            raise SolveError(
                "the equilibrium at the start has no derivative by the parameters: they change a force along a motion "
                "that has no stiffness; add a joint or a spring that holds it"
            )
        place[:-1] -= 1j * step
    place[lowered.structure.n :] = 0.0  # integrators find the multipliers of the start
    return lowered.moved(x=place, v=np.zeros_like(place))


def unstable_body(lowered: Lowered) -> str | None:
    """The body that moves most where a mechanism at rest leaves its place after the smallest push; None where it stays.

    The stiffness on the motions that the joints leave free has a negative direction there. Dense, once a model.
    """
    n, (x, _) = lowered.structure.n, resting_place(lowered)
    matrix = tangent(lowered, x, np.zeros_like(x), (1.0, 0.0, 0.0)).toarray()
    scale = scales(lowered)[:n]
    free = free_motions(matrix, n, scale)
    stiffness = free.T @ matrix[:n, :n] @ free
    values, vectors = eigh((stiffness + stiffness.T) / 2)
    if len(values) == 0 or values[0] >= -_NEUTRAL * np.abs(values).max():
        return None
    moved = np.abs(free @ vectors[:, 0]) / scale
    return lowered.structure.owners[int(np.argmax(moved))]


def resting_place(lowered: Lowered) -> tuple[np.ndarray, int]:
    """Coordinates and multipliers (N + 1,) of the equilibrium nearest to the first placement, and Newton iterations."""
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
                for way in (_settled, _newton):
                    x, iterations = way(lowered, forces, np.real(lowered.x).astype(float), _LAST_ITERATIONS)
                    total += iterations
                    if x is not None:
                        return x, total
                loaded = lowered.structure.owners[int(np.argmax(np.abs(start[: lowered.structure.n])))]
                raise lowered.failures.after(0.0) or SolveError(
                    f"no equilibrium was found: Newton's method stopped at {100 * reached:.3g} % of the loads, the "
                    f"largest of which acts on {loaded!r}. A motion may be free of stiffness (add a joint or a "
                    "spring), or the first placement is far from the equilibrium"
                )
            continue
        x, reached, fraction = found, aim, 2 * fraction
    return x, total


def _newton(
    lowered: Lowered, forces: Forces, x: np.ndarray, most: int = _MOST_ITERATIONS
) -> tuple[np.ndarray | None, int]:
    """Newton's method on coordinates and multipliers; None where it does not converge."""
    n, still, scale = lowered.structure.n, np.zeros_like(x), scales(lowered)[:-1]
    x, mixed = x.copy(), MixedPoints(lowered)
    for iteration in range(1, most + 1):
        matrix, left = tangent(mixed.lowered, x, still, (1.0, 0.0, 0.0)), forces(x)
        step = _solution(matrix, left)
        if step is None or not np.max(np.abs(step[:n]) / scale[:n]) < _FAR:
            step = _smallest_step(matrix, left, n)  # all but singular
        size = np.max(np.abs(step[:n]) / scale[:n]) if step is not None else np.inf
        if step is None or not size < _FAR:
            return None, iteration
        change = -step * (0.5 / max(size, 0.5))  # at most half the scale at a time
        mixed.step(x, change)
        x[:-1] += change
        if size < 1e-11:
            return x, iteration
    return None, most


def _settled(lowered: Lowered, forces: Forces, x: np.ndarray, most: int) -> tuple[np.ndarray | None, int]:
    """Follow the forces downhill, as a motion without inertia does; None where it does not settle. Pseudo-transient
    continuation (Kelley and Keyes 1998): Newton steps with K + s M in place of K, where s halves at each step and grows
    before a step uphill. It needs no stiffness where it begins, as of a chain of rigid bars.
    """
    n, still, scale = lowered.structure.n, np.zeros_like(x), scales(lowered)[:-1]
    x, s = x.copy(), 0.0
    for iteration in range(1, most + 1):
        left = forces(x)
        if not s:  # all inertia: the acceleration from rest
            fall = _solution(tangent(lowered, x, still, (_SLOW, 0.0, 1.0)), left)
            if fall is None:
                return None, iteration
            x[n:-1] -= fall[n:]  # the joints' forces
            s = float(np.max(np.abs(fall[:n]) / scale[:n])) / _FIRST_STEP or 1.0
            continue
        matrix = tangent(lowered, x, still, (1.0, 0.0, s))
        loads = np.concatenate([left[:n], np.zeros(len(left) - n)])  # without what closes the joints again
        fall, step = _solution(matrix, loads), _solution(matrix, left)
        if fall is None or step is None or loads @ fall < 0.0:  # uphill: to where the mechanism would fall
            s *= 4.0
            continue
        size = np.max(np.abs(step[:n]) / scale[:n])
        x[:-1] -= step * (_FIRST_STEP / max(size, _FIRST_STEP))
        s *= 0.5
        if size < 1e-6:
            found, more = _newton(lowered, forces, x)
            return found, iteration + more
    return None, most


def _solution(matrix: csr_matrix, forces: np.ndarray) -> np.ndarray | None:
    """Newton step; the smallest one where a motion without stiffness is not loaded; None where it is loaded."""
    try:
        return splu(matrix.tocsc()).solve(forces)
    except RuntimeError:  # exactly singular, as beside a spring at its free length
        step = lsqr(matrix, forces, atol=1e-14, btol=1e-14)[0]
        balanced = np.linalg.norm(matrix @ step - forces) <= 1e-9 * np.linalg.norm(forces)
        return step if balanced else None


def _smallest_step(matrix: csr_matrix, forces: np.ndarray, n: int) -> np.ndarray | None:
    """The smallest solution where some motions have no stiffness but rounding, as the free end of a hanging chain.

    None where they are loaded, and for many unknowns.
    """
    if len(forces) > _DENSE or not (np.isfinite(forces).all() and np.isfinite(matrix.data).all()):
        return None
    # Constraints as stiff as the stiffest motion: without that their singular values are its reciprocal.
    scale = np.ones(len(forces))
    scale[n:] = abs(matrix[:n, :n]).max()
    scaled, wanted = scale[:, None] * matrix.toarray() * scale, scale * forces
    step = cast(tuple[np.ndarray, ...], lstsq(scaled, wanted, cond=_WITHOUT))[0]
    left = np.abs(scaled @ step - wanted).max()
    rounding = np.finfo(float).eps * (np.abs(scaled) @ np.abs(step)).max()
    return scale * step if left <= 1e-9 * np.abs(wanted).max() + 10 * rounding else None
