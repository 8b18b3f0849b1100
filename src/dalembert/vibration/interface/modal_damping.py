"""Damping, and the matrices of rotors, among the modes of a structure."""

import numpy as np

from dalembert.structure import Structure
from dalembert.structure.eigenmodes import real_part
from dalembert.structure.structure import OPTIONAL
from dalembert.vibration.interface.condensation import COUPLED, coupled


def couples(structure: Structure) -> bool:
    """Whether the damping of a structure, or a rotor, couples its modes, whatever the stiffnesses of its contacts."""
    damping, mass = structure.damping, real_part(structure.mass)
    if structure.rotates:
        return True
    if structure.loss is not None and abs(real_part(structure.loss)).max() > 0:
        return True
    if damping is None or not abs(damping).max():
        return False
    # Damping in proportion to the mass alone, C = αM, does not.
    damping = real_part(damping)
    factor = damping.diagonal().sum() / mass.diagonal().sum()
    return bool(abs(damping - factor * mass).max() > COUPLED * abs(damping).max())


def modal_damping(structure: Structure, shapes: np.ndarray) -> dict[str, np.ndarray]:
    """Return Vᵀ C V and the like, by the names of the matrices that a structure has besides stiffness and mass:
    diagonals (modes,) where none of them couples modes, else all as (modes, modes).
    """
    matrices = {name: matrix for name in OPTIONAL if (matrix := getattr(structure, name)) is not None}
    modal = {name: shapes.T @ (real_part(matrix) @ shapes) for name, matrix in matrices.items()}
    return modal if any(map(coupled, modal.values())) else {name: np.diag(part).copy() for name, part in modal.items()}
