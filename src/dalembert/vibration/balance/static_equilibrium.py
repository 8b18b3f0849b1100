r"""Static equilibrium of a structure with contacts and friction: :math:`K x + B^T \lambda(B x) = f`.

All loads grow together from nothing: each slider starts without force, and slips where its spring would exceed the
limit under the final normal load.
"""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import splu

from dalembert.errors import SolveError
from dalembert.structure.eigenmodes import real_part
from dalembert.vibration.balance.newton import line_search
from dalembert.vibration.balance.row_elements import Elements
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.condensed_structure import norm
from dalembert.vibration.interface.contacts_stuck import ContactsStuck
from dalembert.vibration.interface.lowering import Lowered

STEPS = 60
"""Newton steps, at most."""
BALANCED = 1e-13
"""Residual, as part of the forces, at which the equilibrium is found; rounding of stiff structures may be larger."""
ENOUGH = 1e-10
"""The same where no step makes it smaller."""
SOFT = 1e-9
"""Stiffness of stuck contacts, as a part, that is added where a step has no other stiffness."""


@dataclass(frozen=True)
class Equilibrium:
    """Displacements of all degrees of freedom (n,), forces of the elements by rows (rows,), Newton steps,
    and the residual as part of the forces.
    """

    displacements: np.ndarray
    forces: np.ndarray
    steps: int
    error: float


def static_equilibrium(lowered: Lowered) -> Equilibrium:
    """Return the equilibrium of a real system with elastic contacts under its static forces.

    SolveError where none is found, as where the static forces exceed what friction holds.
    """
    # A motion that does not change: the sums of all laws take it as any other.
    elements, stuck = Elements(lowered, Fourier((0,), 4), events=False), ContactsStuck(lowered)
    stiffness, rows, force = csc_array(real_part(lowered.structure.stiffness)), lowered.matrix, stuck.static_forces

    def place(displacements: np.ndarray, steps: int) -> "_Place":
        acting, _ = elements.forces(0.0, (rows @ displacements)[:, None])
        residual = stiffness @ displacements + rows.T @ acting[:, 0] - force
        error = norm(residual) / (norm(force) + norm(acting) or 1.0)
        return _Place(Equilibrium(displacements, acting[:, 0], steps, error), residual)

    def moved(at: "_Place", change: np.ndarray, part: float) -> "_Place":
        known = at.equilibrium
        return place(known.displacements - part * change, known.steps + 1)

    reference, displaced = stuck.at_rest
    support = SOFT * rows.T @ coo_array((reference, (np.arange(len(reference)),) * 2)) @ rows
    at = place(displaced, 0)
    while at.error > BALANCED and at.equilibrium.steps < STEPS:
        tangent = stiffness + rows.T @ _slopes(elements, at.equilibrium.displacements, len(reference)) @ rows
        try:
            change = splu(csc_array(tangent)).solve(at.residual)
        except RuntimeError:  # contacts that slip or open leave a part free here
            change = splu(csc_array(tangent + support)).solve(at.residual)
        best = line_search(partial(moved, at, change), at.error)
        if best is None or (best.error >= at.error and at.error <= ENOUGH):
            break
        at = best
    if at.error > ENOUGH:
        raise SolveError(
            f"the static forces found no equilibrium: after {at.equilibrium.steps} steps {at.error:.1e} of the forces "
            "are not balanced. Friction may not hold them; change the static forces, or hold the structure"
        )
    return at.equilibrium


@dataclass(frozen=True)
class _Place:
    """A place of Newton's method, with the residual of all degrees of freedom (n,)."""

    equilibrium: Equilibrium
    residual: np.ndarray

    @property
    def error(self) -> float:
        """Residual as part of the forces."""
        return self.equilibrium.error


def _slopes(elements: Elements, displacements: np.ndarray, count: int) -> Any:
    """Derivatives of the forces by the displacements of the rows, (rows, rows), sparse."""
    motion = (elements.lowered.matrix @ displacements)[:, None]
    every = [np.ones(len(block.rows), dtype=bool) for block in elements.lowered.blocks]
    slopes = elements.slopes(0.0, motion, every)
    entries, first, second = [np.zeros(0)], [np.zeros(0, dtype=int)], [np.zeros(0, dtype=int)]
    for rows, local in (*slopes.laws, *slopes.contacts):
        entries.append(local.ravel())
        first.append(np.broadcast_to(rows[:, :, None], local.shape).ravel())
        second.append(np.broadcast_to(rows[:, None, :], local.shape).ravel())
    return csc_array(
        coo_array((np.concatenate(entries), (np.concatenate(first), np.concatenate(second))), shape=(count, count))
    )
