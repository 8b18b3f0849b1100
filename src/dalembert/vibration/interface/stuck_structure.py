r"""A structure whose contacts stick: its compliance at the rows of its elements, and its modes.

Each row of the elements gets a stiffness r, that of its contact if it sticks: :math:`K_r = K + B^T r B`. Parts that
contacts alone hold are then ordinary ones. Modes have :math:`V^T K_r V = 1` and :math:`V^T M V = \mu = 1/\omega^2`, so
that degrees of freedom without mass are modes with μ = 0.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_array, csr_array, diags_array, issparse

from dalembert.errors import SolveError
from dalembert.structure import Structure
from dalembert.structure.eigenmodes import dense, lanczos, real_part
from dalembert.structure.factorise import factorise
from dalembert.vibration.interface.condensation import COUPLED, DENSE, coupled
from dalembert.vibration.interface.free_motions import FLOATING, free_motions

FEWEST, MOST = 40, 1280
"""Modes of a structure that is not small."""
COUPLED_MODES = 300
"""Modes that a damping may couple: a matrix of them is inverted for each harmonic."""
STATIC = 1 / 400
"""(s/ω)² of the first mode that is left out where modes are computed. It follows its forces as in statics."""
ENOUGH = 4 * STATIC
"""The largest such part, above which more modes are computed."""
CHUNK = 256
"""Columns of the compliance that are solved for at a time."""
WHAT = "the stiffness of the structure whose contacts stick"


Solve = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class StuckStructure:
    """A structure with the reference stiffnesses of its elements' rows.

    ``rows`` (rows, n): B; ``reference`` (rows,): r, N/m; ``solve``: K_r⁻¹ times columns (n, -); ``shapes`` (n, modes):
    V; ``inertias`` (modes,): μ, s²; ``damping``, ``loss``: Vᵀ C V and Vᵀ D V, as diagonals (modes,) where they couple
    no modes, else (modes, modes); ``free`` (rows, motions): the rows in motions that the structure does not resist.
    """

    rows: Any
    reference: np.ndarray
    solve: Solve = field(repr=False)
    shapes: np.ndarray
    inertias: np.ndarray
    damping: np.ndarray
    loss: np.ndarray
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
    stiffness, mass = _stiffened(structure, rows, reference), real_part(structure.mass)
    solve = held(structure, rows, reference) if before is None else before.solve
    # All modes of a small structure: the receptance is then exact at every frequency.
    if structure.size <= DENSE:
        inertias, shapes = _all_modes(mass, stiffness)
    else:
        inertias, shapes = _slow_modes(csc_array(mass), csc_array(stiffness), solve, highest)
    damping, loss = _damping(structure, shapes)
    if max(damping.ndim, loss.ndim) == 2 and len(inertias) > COUPLED_MODES:
        # A full matrix of all modes for each harmonic costs too much: the slow ones, as of a large structure.
        count = max(COUPLED_MODES, int(np.sum(highest**2 * inertias > STATIC)))
        inertias, shapes = inertias[:count], np.ascontiguousarray(shapes[:, :count])
        damping, loss = _damping(structure, shapes)
    free = _free_rows(structure, rows) if before is None else before.free
    # What is static does not depend on the modes.
    kept = {} if before is None else before._kept
    return StuckStructure(rows, reference, solve, shapes, inertias, damping, loss, free, kept)


def _free_rows(structure: Structure, rows: Any) -> np.ndarray:
    """Return the rows in motions that the structure does not resist, orthonormal; without those that move none."""
    moved = np.asarray(rows @ free_motions(real_part(structure.stiffness)))
    shapes, sizes, _ = np.linalg.svd(moved, full_matrices=False)
    return shapes[:, sizes > FLOATING * sizes.max(initial=0.0)]


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


def _damping(structure: Structure, shapes: np.ndarray) -> list[np.ndarray]:
    """Return Vᵀ C V and Vᵀ D V."""
    return [
        np.zeros(shapes.shape[1]) if matrix is None else _among(shapes, real_part(matrix))
        for matrix in (structure.damping, structure.loss)
    ]


def held(structure: Structure, rows: csc_array, reference: np.ndarray) -> Solve:
    """Return K_r⁻¹ as a function of columns. SolveError if a part moves without being held, or K_r is not positive."""
    return factorise(_stiffened(structure, rows, reference), WHAT, positive=True)


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
        raise SolveError(f"{WHAT} is not positive definite. Clamp what moves, or use solver='stiffness'") from None
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


def _among(shapes: np.ndarray, matrix: Any) -> np.ndarray:
    """Return Vᵀ C V, or its diagonal where it couples no modes."""
    among = shapes.T @ (matrix @ shapes)
    return among if coupled(among) else np.diag(among).copy()
