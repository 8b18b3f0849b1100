r"""A structure whose contacts stick: its compliance at the rows of its elements, and its modes.

Each row of the elements gets a stiffness r, that of its contact if it sticks: :math:`K_r = K + B^T r B`. Parts that
contacts alone hold are then ordinary ones. Modes have :math:`V^T K_r V = 1` and :math:`V^T M V = \mu = 1/\omega^2`, so
that degrees of freedom without mass are modes with μ = 0.
"""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array, issparse

from dalembert.structure import Structure
from dalembert.structure.eigenmodes import real_part
from dalembert.structure.factorise import factorise
from dalembert.vibration.interface.free_motions import FLOATING, free_motions
from dalembert.vibration.interface.stuck_modes import STATIC, Solve, stuck_modes

ENOUGH = 4 * STATIC
"""The largest such part, above which more modes are computed."""
CHUNK = 256
"""Columns of the compliance that are solved for at a time."""
WHAT = "the stiffness of the structure whose contacts stick"


@dataclass(frozen=True)
class StuckStructure:
    """A structure with the reference stiffnesses of its elements' rows.

    ``rows`` (rows, n): B; ``reference`` (rows,): r, N/m; ``solve``: K_r⁻¹ times columns (n, -); ``shapes`` (n, modes):
    V; ``inertias`` (modes,): μ, s²; ``damping``: Vᵀ C V, and the same of hysteretic damping and of rotors, by the names
    of the matrices, as diagonals (modes,) where none of them couples modes, else (modes, modes); ``free``
    (rows, motions): the rows in motions that the structure does not resist.
    """

    rows: Any
    reference: np.ndarray
    solve: Solve = field(repr=False)
    shapes: np.ndarray
    inertias: np.ndarray
    damping: dict[str, np.ndarray]
    free: np.ndarray
    _kept: dict[str, np.ndarray] = field(default_factory=dict, repr=False)

    @property
    def compliance(self) -> np.ndarray:
        """B K_r⁻¹ Bᵀ, (rows, rows)."""
        if "compliance" not in self._kept:
            self._kept["compliance"] = _compliance(self.rows, self.solve)
        return self._kept["compliance"]

    @cached_property
    def row_shapes(self) -> np.ndarray:
        """B V, (rows, modes)."""
        return np.ascontiguousarray(self.rows @ self.shapes)

    @property
    def single(self) -> np.ndarray:
        """The compliance in single precision, with half of the memory to read."""
        if "single" not in self._kept:
            self._kept["single"] = self.compliance.astype(np.float32)
        return self._kept["single"]

    def is_fast_enough(self, highest: float) -> bool:
        """Whether the modes reach far enough above an angular frequency, rad/s."""
        return len(self.inertias) == self.rows.shape[1] or highest**2 * self.inertias.min() <= ENOUGH

    def recovery(self, dofs: np.ndarray) -> np.ndarray:
        """Static displacements of degrees of freedom (dofs,) under unit forces on the rows, (dofs, rows)."""
        key = f"recovery {dofs.tobytes()!r}"
        if key not in self._kept:
            units = np.zeros((self.rows.shape[1], len(dofs)))
            units[dofs, np.arange(len(dofs))] = 1.0
            self._kept[key] = np.asarray(self.rows @ self.solve(units)).T
        return self._kept[key]


def stuck_structure(
    structure: Structure, rows: csc_array, reference: np.ndarray, highest: float, before: StuckStructure | None = None
) -> StuckStructure:
    """Return a structure with reference stiffnesses (rows,). ``highest``: largest angular frequency of its motions,
    rad/s; ``before``: the same with fewer modes, if it is known. SolveError if a part moves without being held, or if
    the highest frequency lies among too many modes.
    """
    stiffness, mass = stiffened(structure, rows, reference), real_part(structure.mass)
    solve = held(structure, rows, reference) if before is None else before.solve
    modes = stuck_modes(structure, stiffness, mass, solve, highest)
    # The rows in motions that the structure does not resist, orthonormal; without those that move none.
    moved = np.asarray(rows @ free_motions(real_part(structure.stiffness)))
    left, sizes, _ = np.linalg.svd(moved, full_matrices=False)
    free = left[:, sizes > FLOATING * sizes.max(initial=0.0)]
    # What is static does not depend on the modes.
    kept = {} if before is None else before._kept
    return StuckStructure(rows, reference, solve, *modes, free, kept)


def held(structure: Structure, rows: csc_array, reference: np.ndarray) -> Solve:
    """Return K_r⁻¹ as a function of columns. SolveError if a part moves without being held, or K_r is not positive."""
    return factorise(stiffened(structure, rows, reference), WHAT, positive=True)


def _compliance(rows: Any, solve: Solve) -> np.ndarray:
    rows, columns, count = csr_array(rows), csc_array(rows.T), rows.shape[0]
    result = np.empty((count, count))
    for first in range(0, count, CHUNK):
        result[:, first : first + CHUNK] = rows @ solve(columns[:, first : first + CHUNK].toarray())
    # Symmetric but for rounding, and then exactly: products may read rows in place of columns.
    result += result.T
    result *= 0.5
    return result


def stiffened(structure: Structure, rows: csc_array, reference: np.ndarray) -> Any:
    """Return K_r, (n, n)."""
    added = rows.T @ diags_array(reference) @ rows
    stiffness = real_part(structure.stiffness)
    return csc_array(stiffness + added) if issparse(stiffness) else stiffness + added.toarray()
