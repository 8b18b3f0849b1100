r"""A structure whose contacts stick: its compliance at the rows of its elements, and its modes.

Each row of the elements gets a stiffness r, that of its contact if it sticks: :math:`K_r = K + B^T r B`. Parts that
contacts alone hold are then ordinary ones. Modes have :math:`V^T K_r V = 1` and :math:`V^T M V = \mu = 1/\omega^2`, so
that degrees of freedom without mass are modes with μ = 0.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_array, csr_array, diags_array, issparse

from dalembert.errors import SolveError
from dalembert.structure import Structure
from dalembert.structure.eigenmodes import dense, lanczos, real_part
from dalembert.structure.factorise import factorise
from dalembert.vibration.interface.condensation import DENSE, coupled

FEWEST, MOST = 40, 320
"""Modes of a sparse structure."""
STATIC = 1 / 400
"""(s/ω)² of the first mode that is left out: it follows its forces as in statics, with an error of this part."""
ENOUGH = 4 * STATIC
"""The same where modes are computed anew, for twice the frequency at once."""
CHUNK = 256
"""Columns of the compliance that are solved for at a time."""
WHAT = "the stiffness of the structure whose contacts stick"


Solve = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class StuckStructure:
    """A structure with the reference stiffnesses of its elements' rows.

    ``rows`` (rows, n): B; ``reference`` (rows,): r, N/m; ``solve``: K_r⁻¹ times columns (n, -); ``compliance``
    (rows, rows): B K_r⁻¹ Bᵀ; ``shapes`` (n, modes): V; ``inertias`` (modes,): μ, s²; ``damping``, ``loss``: Vᵀ C V and
    Vᵀ D V, as diagonals (modes,) where they couple no modes, else (modes, modes).
    """

    rows: Any
    reference: np.ndarray
    solve: Solve = field(repr=False)
    compliance: np.ndarray
    shapes: np.ndarray
    inertias: np.ndarray
    damping: np.ndarray
    loss: np.ndarray
    _recoveries: dict[bytes, np.ndarray] = field(default_factory=dict, repr=False)

    @cached_property
    def row_shapes(self) -> np.ndarray:
        """B V, (rows, modes)."""
        return np.ascontiguousarray(self.rows @ self.shapes)

    @cached_property
    def single(self) -> np.ndarray:
        """The compliance in single precision, with half of the memory to read."""
        return self.compliance.astype(np.float32)

    def is_fast_enough(self, highest: float) -> bool:
        """Whether the modes reach far enough above an angular frequency, rad/s."""
        every = len(self.inertias) in (self.rows.shape[1], MOST)
        return every or highest**2 * self.inertias.min() <= ENOUGH

    def recovery(self, dofs: np.ndarray) -> np.ndarray:
        """Static displacements of degrees of freedom (dofs,) under unit forces on the rows, (dofs, rows)."""
        key = dofs.tobytes()
        if key not in self._recoveries:
            units = np.zeros((self.rows.shape[1], len(dofs)))
            units[dofs, np.arange(len(dofs))] = 1.0
            self._recoveries[key] = np.asarray(self.rows @ self.solve(units)).T
        return self._recoveries[key]


def stuck_structure(
    structure: Structure, rows: csc_array, reference: np.ndarray, highest: float, before: StuckStructure | None = None
) -> StuckStructure:
    """Return a structure with reference stiffnesses (rows,). ``highest``: largest angular frequency of its motions,
    rad/s; ``before``: the same with fewer modes, if it is known. SolveError if a part moves without being held.
    """
    stiffness, mass = _stiffened(structure, rows, reference), real_part(structure.mass)
    # All modes of a small structure: the receptance is then exact at every frequency, and damping may be any.
    if structure.size <= DENSE:
        inertias, shapes = _all_modes(mass, stiffness)
        solve: Solve = partial(_by_modes, shapes)
    else:
        solve = held(structure, rows, reference) if before is None else before.solve
        inertias, shapes = _slow_modes(csc_array(mass), csc_array(stiffness), solve, highest)
    damping, loss = (
        np.zeros(len(inertias)) if matrix is None else _among(shapes, real_part(matrix))
        for matrix in (structure.damping, structure.loss)
    )
    compliance = _compliance(rows, solve) if before is None else before.compliance
    return StuckStructure(rows, reference, solve, compliance, shapes, inertias, damping, loss)


def _by_modes(shapes: np.ndarray, columns: np.ndarray) -> np.ndarray:
    # With all modes, V Vᵀ = K_r⁻¹.
    return shapes @ (shapes.T @ columns)


def held(structure: Structure, rows: csc_array, reference: np.ndarray) -> Solve:
    """Return K_r⁻¹ as a function of columns. SolveError if a part of the structure moves without being held."""
    return factorise(_stiffened(structure, rows, reference), WHAT)


def _compliance(rows: Any, solve: Solve) -> np.ndarray:
    rows, columns, count = csr_array(rows), csc_array(rows.T), rows.shape[0]
    result = np.empty((count, count))
    for first in range(0, count, CHUNK):
        result[:, first : first + CHUNK] = rows @ solve(columns[:, first : first + CHUNK].toarray())
    # Symmetric but for rounding, and then exactly: products may read rows in place of columns.
    result += result.T
    result *= 0.5
    return result


def _stiffened(structure: Structure, rows: csc_array, reference: np.ndarray) -> Any:
    added = rows.T @ diags_array(reference) @ rows
    stiffness = real_part(structure.stiffness)
    return csc_array(stiffness + added) if issparse(stiffness) else stiffness + added.toarray()


def _all_modes(mass: Any, stiffness: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return all modes, the slowest first: M v = μ K_r v."""
    # In this order, and not K_r φ = ω² M φ: rounding is a part of the largest eigenvalue, which is here that of the
    # slowest mode. Of a lap joint's response 2e-10 is lost, in the other order 8e-8.
    try:
        inertias, shapes = eigh(dense(mass), dense(stiffness))
    except np.linalg.LinAlgError:
        raise SolveError(f"{WHAT} is singular: a part of the structure moves without being held; clamp it") from None
    return np.clip(inertias[::-1], 0.0, None), np.ascontiguousarray(shapes[:, ::-1])


def _slow_modes(mass: Any, stiffness: Any, solve: Any, highest: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the slowest modes, as many as the highest frequency needs."""
    count = FEWEST
    while True:
        squares, shapes = lanczos(mass, stiffness, count, solve)
        if highest**2 <= STATIC * squares.max() or count >= MOST:
            order = np.argsort(squares)
            # From φᵀ M φ = 1 to Vᵀ K_r V = 1: V = φ/ω, μ = 1/ω².
            return 1 / squares[order], np.ascontiguousarray(shapes[:, order] / np.sqrt(squares[order]))
        count *= 2


def _among(shapes: np.ndarray, matrix: Any) -> np.ndarray:
    """Return Vᵀ C V, or its diagonal where it couples no modes."""
    among = shapes.T @ (matrix @ shapes)
    return among if coupled(among) else np.diag(among).copy()
