"""Modes of a structure whose contacts stick: all of a small one, the slow ones of a large one."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_array

from dalembert.errors import SolveError
from dalembert.structure import Structure
from dalembert.structure.eigenmodes import dense, lanczos
from dalembert.vibration.interface.condensation import DENSE
from dalembert.vibration.interface.modal_damping import modal_damping

FEWEST, MOST = 40, 1280
"""Modes of a structure that is not small."""
COUPLED_MODES = 300
"""Modes that a damping may couple: a matrix of them is inverted for each harmonic."""
STATIC = 1 / 400
"""(s/ω)² of the first mode that is left out where modes are computed. It follows its forces as in statics."""
Solve = Callable[[np.ndarray], np.ndarray]


class StuckModes(NamedTuple):
    """Modes with Vᵀ K_r V = 1: V (n, modes), μ (modes,) and damping, as `StuckStructure` has them."""

    shapes: np.ndarray
    inertias: np.ndarray
    damping: dict[str, np.ndarray]


def stuck_modes(structure: Structure, stiffness: Any, mass: Any, solve: Solve, highest: float) -> StuckModes:
    """Return modes of a structure with K_r and M. ``solve``: K_r⁻¹; ``highest``: largest angular frequency, rad/s."""
    # All modes of a small structure: the receptance is then exact at every frequency.
    if structure.size <= DENSE:
        inertias, shapes = _all_modes(mass, stiffness)
    else:
        inertias, shapes = _slow_modes(csc_array(mass), csc_array(stiffness), solve, highest)
    damping = modal_damping(structure, shapes)
    if any(part.ndim == 2 for part in damping.values()) and len(inertias) > COUPLED_MODES:
        # A full matrix of all modes for each harmonic costs too much: the slow ones, as of a large structure.
        count = max(COUPLED_MODES, int(np.sum(highest**2 * inertias > STATIC)))
        inertias, shapes = inertias[:count], np.ascontiguousarray(shapes[:, :count])
        damping = modal_damping(structure, shapes)
    return StuckModes(shapes, inertias, damping)


def _all_modes(mass: Any, stiffness: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return all modes, the slowest first: M v = μ K_r v."""
    # In this order, and not K_r φ = ω² M φ: rounding is a part of the largest eigenvalue, which is here that of the
    # slowest mode. Of a lap joint's response 2e-10 is lost, in the other order 8e-8.
    try:
        inertias, shapes = eigh(dense(mass), dense(stiffness))
    except np.linalg.LinAlgError:
        raise SolveError(
            "the stiffness of the structure whose contacts stick is not positive definite. Clamp what moves, or use "
            "solver='stiffness'"
        ) from None
    return np.clip(inertias[::-1], 0.0, None), np.ascontiguousarray(shapes[:, ::-1])


def _slow_modes(mass: Any, stiffness: Any, solve: Any, highest: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the slowest modes, as many as the highest frequency needs."""
    count = FEWEST
    while True:
        squares, shapes = lanczos(mass, stiffness, min(count, mass.shape[0] - 1), solve)
        # Degrees of freedom without mass have no frequency.
        order = [place for place in np.argsort(squares) if 0 < squares[place] < np.inf]
        fastest = squares[order[-1]]
        if highest**2 <= STATIC * fastest or len(order) < len(squares):
            # From φᵀ M φ = 1 to Vᵀ K_r V = 1: V = φ/ω, μ = 1/ω².
            return 1 / squares[order], np.ascontiguousarray(shapes[:, order] / np.sqrt(squares[order]))
        if count >= MOST:
            raise SolveError(
                f"the highest harmonic, {highest / (4 * np.pi):.4g} Hz, needs more than {MOST} modes of the structure; "
                "use fewer harmonics, a coarser mesh, or solver='stiffness'"
            )
        count *= 2
