"""Damping of a structure among its modes."""

from typing import Any

import numpy as np

from dalembert.structure import Structure
from dalembert.structure.eigenmodes import real_part
from dalembert.vibration.interface.condensation import COUPLED, coupled


def couples(structure: Structure) -> bool:
    """Whether the damping of a structure couples its modes, whatever the stiffnesses of its contacts."""
    damping, mass = structure.damping, real_part(structure.mass)
    if structure.loss is not None and abs(real_part(structure.loss)).max() > 0:
        return True
    if damping is None or not abs(damping).max():
        return False
    # Damping in proportion to the mass alone, C = αM, does not.
    damping = real_part(damping)
    factor = damping.diagonal().sum() / mass.diagonal().sum()
    return bool(abs(damping - factor * mass).max() > COUPLED * abs(damping).max())


def modal_damping(structure: Structure, shapes: np.ndarray) -> list[np.ndarray]:
    """Return Vᵀ C V and Vᵀ D V: diagonals (modes,) where they couple no modes, else (modes, modes)."""
    return [
        np.zeros(shapes.shape[1]) if matrix is None else _among(shapes, real_part(matrix))
        for matrix in (structure.damping, structure.loss)
    ]


def _among(shapes: np.ndarray, matrix: Any) -> np.ndarray:
    """Return Vᵀ C V, or its diagonal where it couples no modes."""
    among = shapes.T @ (matrix @ shapes)
    return among if coupled(among) else np.diag(among).copy()
