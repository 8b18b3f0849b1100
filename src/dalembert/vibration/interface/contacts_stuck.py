"""Which contacts stick before the vibration, and the receptances of the structure with them."""

import hashlib
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.sparse import issparse

from dalembert.errors import SolveError
from dalembert.structure.structure import MATRICES
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.loads import Loads
from dalembert.vibration.interface.lowering import FrictionBlock, Lowered, penalties
from dalembert.vibration.interface.receptances import Receptances
from dalembert.vibration.interface.stuck_structure import StuckStructure, held, stuck_structure
from dalembert.vibration.laws.friction_law import GAP, LOAD, NORMAL
from dalembert.vibration.system.harmonic_force import StaticForce

ROUNDS = 12
"""Solutions of the static contact, at most. With any reference the equations are correct."""
MARGIN = 2.0
"""Frequency, as a multiple of the highest one, for which modes are computed."""


@dataclass
class KnownStructures:
    """The last structure whose contacts stick, for systems that differ in other numbers than its own, such as the
    friction. Where all of them have the same highest frequency, results do not depend on which were computed before.
    """

    key: bytes = b""
    structure: StuckStructure | None = None


@dataclass
class ContactsStuck:
    """A system whose contacts stick, but for those that its static forces leave open. ``highest``: largest angular
    frequency of its motions, rad/s, as far as it is known.
    """

    lowered: Lowered
    highest: float = 0.0
    known: KnownStructures = field(default_factory=KnownStructures, repr=False)
    _structure: StuckStructure | None = field(default=None, repr=False)
    _of_series: dict[tuple[int, ...], Receptances] = field(default_factory=dict, repr=False)

    @cached_property
    def reference(self) -> np.ndarray:
        """Stiffness of each row, N/m, (rows,): that of its contact, or 0 where this is open or the row has none.

        SolveError if a part moves even with closed contacts and stops.
        """
        return self.at_rest[0]

    @cached_property
    def of_contacts(self) -> np.ndarray:
        """The reference without what springs and stops would add where contacts alone leave a part free."""
        closed = self._stiffnesses([np.ones(len(block.rows), dtype=bool) for block in self.lowered.blocks])
        return np.where(closed > 0, self.reference, 0.0)

    @cached_property
    def at_rest(self) -> tuple[np.ndarray, np.ndarray]:
        """The reference, and displacements of all degrees of freedom (n,) under the static forces with it."""
        closed = self._stiffnesses([np.ones(len(block.rows), dtype=bool) for block in self.lowered.blocks])
        try:
            return self._at_rest(closed)
        except SolveError:
            # A part that only open contacts, stops or springs that are not linear may hold: all of them count as
            # closed.
            with_laws = closed + self._law_stiffnesses()
            solve = held(self.lowered.structure, self.lowered.matrix, with_laws)
            return with_laws, solve(self.static_forces)

    @cached_property
    def static_forces(self) -> np.ndarray:
        """On all degrees of freedom, N, (n,)."""
        lowered = self.lowered
        force = np.zeros(lowered.structure.size)
        for entry in lowered.forces:
            if isinstance(entry, StaticForce):
                force[lowered.structure.dofs.index(entry.dof)] += np.real(entry.value)
        return force

    def receptances(self, series: Fourier, loads: Loads, omega: float) -> Receptances:
        """Receptances at ω, and near it, with the harmonics of a series. ``loads``: forces in these."""
        highest, lowered, known = max(series.orders) * max(omega, self.highest), self.lowered, self.known
        if self._structure is None and known.key == self._key:
            self._structure = known.structure
        if self._structure is None or not self._structure.is_fast_enough(highest):
            self._structure = stuck_structure(
                lowered.structure, lowered.matrix, self.reference, MARGIN * highest, self._structure
            )
            self._of_series.clear()
            known.key, known.structure = self._key, self._structure
        if series.orders not in self._of_series:
            self._of_series[series.orders] = Receptances(self._structure, series, loads, lowered.spin)
        return self._of_series[series.orders]

    @cached_property
    def _key(self) -> bytes:
        """Hash of all that the structure depends on."""
        structure, digest = self.lowered.structure, hashlib.sha256()
        for name, matrix in [*((name, getattr(structure, name)) for name in MATRICES), ("rows", self.lowered.matrix)]:
            if matrix is not None:
                digest.update(name.encode())
                parts = (matrix.data, matrix.indices, matrix.indptr) if issparse(matrix) else (matrix,)
                for part in parts:
                    digest.update(np.ascontiguousarray(part).tobytes())
        digest.update(self.reference.tobytes())
        return digest.digest()

    def _law_stiffnesses(self) -> np.ndarray:
        """Stiffness of each row by laws where these are closed; that of the structure where it is not known."""
        result, stiffest = np.zeros(len(self.lowered.row_names)), abs(self.lowered.structure.stiffness).max()
        for block in self.lowered.laws:
            closed = np.real(block.element.closed_stiffness(block))
            np.add.at(result, block.rows, np.where(closed > 0, closed, stiffest))
        for rows, _ in self.lowered.functions:
            result[rows] += stiffest
        return result

    def _at_rest(self, closed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The reference where contacts are closed under the static forces, and none slips, and displacements."""
        lowered, reference = self.lowered, closed
        for _ in range(ROUNDS):
            pushed = np.zeros(len(reference))
            for block in lowered.blocks:
                if block.normal:
                    # r u - λ of a contact that stays in its state: k_n g where it is closed, N_0 where it is open.
                    rows, numbers = block.rows[:, -1], block.numbers
                    still = np.where(reference[rows] > 0, numbers[:, NORMAL] * numbers[:, GAP], numbers[:, LOAD])
                    np.add.at(pushed, rows, still)
            # Contacts that the solution opens lose their stiffness, those that it closes get it: the active set of a
            # problem with a unique solution settles after few rounds.
            solve = held(lowered.structure, lowered.matrix, reference)
            displaced = solve(self.static_forces + lowered.matrix.T @ pushed)
            moved = lowered.matrix @ displaced
            better = self._stiffnesses([_closed(block, moved) for block in lowered.blocks])
            if np.array_equal(better, reference):
                return reference, displaced
            reference = better
        # The search goes round in a circle: with all contacts closed, the equations are correct too.
        return closed, held(lowered.structure, lowered.matrix, closed)(self.static_forces)

    def _stiffnesses(self, closed: list[np.ndarray]) -> np.ndarray:
        """Stiffnesses of the rows (rows,) where some contacts of each block are closed."""
        result = np.zeros(len(self.lowered.row_names))
        for block, which in zip(self.lowered.blocks, closed, strict=True):
            np.add.at(result, block.rows, which[:, None] * penalties(block))
        return result


def _closed(block: FrictionBlock, moved: np.ndarray) -> np.ndarray:
    """Whether contacts are closed where the rows are displaced like this, (cells,)."""
    if not block.normal:
        return np.ones(len(block.rows), dtype=bool)
    numbers = block.numbers
    return numbers[:, LOAD] + numbers[:, NORMAL] * (moved[block.rows[:, -1]] - numbers[:, GAP]) > 0
