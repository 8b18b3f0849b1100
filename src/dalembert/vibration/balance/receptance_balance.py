r"""The equations of harmonic balance at the rows of the elements alone, by receptances.

With the receptance G of the structure whose contacts stick, with stiffnesses r, the displacements u of all rows obey

.. math:: R(u, \omega) = u - u_\mathrm{lin}(\omega) + G(\omega)\,[\lambda(u) - r u] = 0,

where :math:`u_\mathrm{lin}` are those by the loads while all contacts stick. An elastic contact that does what its
reference says has :math:`\lambda - r u` constant: it adds no column to the Jacobian
:math:`1 + G\,(\partial\lambda/\partial u - r)`. The solution does not depend on r.

The unknowns of a rigid contact with the penalty ε are the displacements that its law predicts,
:math:`w = u + \lambda/\epsilon` with :math:`\lambda = \lambda(w)`, so that :math:`u = w - \lambda(w)/\epsilon`.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dalembert.vibration.balance.balance import Evaluation
from dalembert.vibration.balance.receptance_tangent import ActiveCells, ReceptanceTangent
from dalembert.vibration.balance.row_elements import Elements
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.condensed_structure import norm
from dalembert.vibration.interface.lowering import ELASTIC, FrictionBlock, Lowered, penalties
from dalembert.vibration.interface.receptances import ReceptancePoint
from dalembert.vibration.laws.friction_law import SEPARATED, STUCK

GUESSED = 1e-3
"""Accuracy of a guess."""
ACTIVE = 1e-11
"""Varying force beyond that of the reference, as part of that, above which a contact is active."""


@dataclass(frozen=True)
class ReceptanceBalance:
    """The elements of a system and a series, ready to be balanced by receptances. Rigid contacts predict displacements.

    ``reference`` (rows,): stiffness of each row while its contact sticks; ``events``: as `Balance` takes it; ``bare``:
    rows with a reference on which no element acts.
    """

    lowered: Lowered
    series: Fourier
    reference: np.ndarray
    events: bool = True
    bare: tuple[int, ...] = ()

    @cached_property
    def elements(self) -> Elements:
        """The elements at their rows."""
        return Elements(self.lowered, self.series, self.events)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and coefficients."""
        return len(self.reference), self.series.count

    def displacements(self, unknowns: np.ndarray) -> np.ndarray:
        """Of all rows that elements see, (rows, coefficients): the unknowns themselves, but for rigid contacts."""
        if not self._flexibility.any():
            return unknowns
        return unknowns - self._flexibility[:, None] * self.elements.forces(0.0, unknowns)[0]

    def unknowns(self, displacements: np.ndarray, forces: np.ndarray) -> np.ndarray:
        """Unknowns where rows have displacements and forces of their elements, (rows, coefficients) each."""
        return displacements + self._flexibility[:, None] * forces

    @cached_property
    def _flexibility(self) -> np.ndarray:
        """1/ε of the rows of rigid contacts, 0 of others, (rows,)."""
        rigid = [block for block in self.lowered.blocks if block.kind != ELASTIC]
        result = np.zeros(len(self.reference), np.result_type(float, *(block.numbers for block in rigid)))
        for block in rigid:
            result[block.rows] = 1 / penalties(block)
        return result

    def stuck(self, point: ReceptancePoint) -> np.ndarray:
        """Unknowns where all elements do what their reference says, with the penalty as a spring of rigid contacts."""
        return point.linear * (1 + self._flexibility * self.reference)[:, None]

    def without_contacts(self, point: ReceptancePoint) -> np.ndarray:
        """Unknowns where no element acts: (1 - G r) u = u_lin. LinAlgError where elements alone hold a part."""
        rows = np.flatnonzero(self.reference)
        blocks = -self.reference[rows, None, None] * np.eye(self.series.count)
        tangent = ReceptanceTangent(point, np.zeros_like(point.linear), (ActiveCells(rows[:, None], blocks),))
        return tangent.solve(point.linear[:, :, None], GUESSED)[:, :, 0]

    def linearised(self, point: ReceptancePoint, unknowns: np.ndarray) -> tuple[Evaluation, ReceptanceTangent]:
        """Residual at a point, with its exact Jacobian and its derivative by ω."""
        evaluation, deviation = self._evaluated(point, unknowns)
        # ∂R/∂ω at fixed u: G' (λ - r u) - u_lin', and G ∂λ/∂ω of laws that see velocities.
        slope = point.rate * point.respond_slope(deviation) - point.linear_slope
        cells, by_omega = self._active(point.omega, unknowns, deviation, evaluation.states)
        if np.any(by_omega):
            slope += point.rate * point.respond(by_omega)
        return evaluation, ReceptanceTangent(point, slope, cells)

    def at(self, point: ReceptancePoint, unknowns: np.ndarray) -> Evaluation:
        """Residual at a point."""
        return self._evaluated(point, unknowns)[0]

    def deviation(self, omega: float, unknowns: np.ndarray) -> np.ndarray:
        """Forces of the elements beyond those of their reference, λ - r u, (rows, coefficients)."""
        forces = self.elements.forces(omega, unknowns)[0]
        return forces - self.reference[:, None] * (unknowns - self._flexibility[:, None] * forces)

    def active(self, point: ReceptancePoint, unknowns: np.ndarray) -> Lowered:
        """The system without the contacts that do what their reference says at a point."""
        evaluation, deviation = self._evaluated(point, unknowns)
        moving = self._moving(unknowns, deviation, evaluation.states)
        blocks = (
            replace(block, rows=block.rows[which], contacts=block.contacts[which], numbers=block.numbers[which])
            for block, which in zip(self.lowered.blocks, moving, strict=True)
            if which.any()
        )
        return replace(self.lowered, blocks=tuple(blocks))

    def _evaluated(self, point: ReceptancePoint, unknowns: np.ndarray) -> tuple[Evaluation, np.ndarray]:
        # Displacements by the loads and by what contacts do beyond their reference are in balance: the residual is one
        # of displacements, and needs no stiffness of the structure.
        forces, states = self.elements.forces(point.omega, unknowns)
        displacements = unknowns - self._flexibility[:, None] * forces
        deviation = forces - self.reference[:, None] * displacements
        moved = point.respond(deviation)
        residual = displacements - point.linear + moved
        # Parts of the motion, and not of that by the loads: near a resonance of the stuck structure this is far larger.
        size, terms = norm(unknowns) + norm(residual), point.load + norm(moved)
        return Evaluation(residual, forces, states, size, terms), deviation

    def _active(
        self, omega: float, unknowns: np.ndarray, deviation: np.ndarray, states: tuple[np.ndarray, ...]
    ) -> tuple[tuple[ActiveCells, ...], np.ndarray]:
        """Jacobians of the elements that do not do what their reference says, and slopes of all forces by ω."""
        moving = self._moving(unknowns, deviation, states)
        slopes = self.elements.slopes(omega, unknowns, moving)
        cells = [self._beyond(rows, local, self.reference[rows]) for rows, local in slopes.laws]
        if self.bare:
            rows, size = np.array(self.bare)[:, None], self.series.count
            cells.append(self._beyond(rows, np.zeros((len(rows), size, size)), self.reference[rows]))
        for block, which, (rows, local) in zip(self.lowered.blocks, moving, slopes.contacts, strict=True):
            if which.any():
                # Cells of an Iwan contact have parts of the reference of their rows.
                shares = penalties(block)[which] / self._penalties[rows]
                cells.append(self._beyond(rows, local, self.reference[rows] * shares, block.kind != ELASTIC))
        return tuple(cells), slopes.by_omega

    def _moving(self, unknowns: np.ndarray, deviation: np.ndarray, states: tuple[np.ndarray, ...]) -> list[np.ndarray]:
        """Whether contacts of each block are active, (cells,): their force differs from that of their reference by more
        than a constant normal one, or they are in another state. A slider that moves before the motion is periodic, or
        slips between two samples, shows in the force alone.
        """
        return [
            self._moving_ones(block, unknowns, deviation, seen)
            for block, seen in zip(self.lowered.blocks, states, strict=True)
        ]

    def _moving_ones(
        self, block: FrictionBlock, unknowns: np.ndarray, deviation: np.ndarray, states: np.ndarray
    ) -> np.ndarray:
        if block.kind != ELASTIC:  # its force is one beyond the reference, whatever it does
            return np.ones(len(block.rows), dtype=bool)
        rows = block.rows
        reference, size = self.reference[rows], np.abs(unknowns[rows]).max(axis=(1, 2))
        beyond = np.abs(deviation[rows])
        if block.normal:
            beyond[:, -1, : self.series.mean] = 0.0
        expected = np.where(reference[:, -1] > 0, STUCK, SEPARATED)
        varies = beyond.max(axis=(1, 2)) > ACTIVE * self._penalties[rows].max(axis=1) * size
        moving = varies | np.any(states != expected[:, None], axis=1)
        # Cells of a contact share its rows: all of them are active, or none.
        return np.isin(block.contacts, block.contacts[moving])

    def _beyond(self, rows: np.ndarray, local: np.ndarray, reference: np.ndarray, rigid: bool = False) -> ActiveCells:
        """Cells with their Jacobians (cells, columns · coefficients, ...), less their references (cells, columns)."""
        blocks, displaced = local.copy(), None
        diagonal = np.arange(blocks.shape[1])
        stiffness = np.repeat(reference, self.series.count, axis=1)
        if rigid:
            # ∂u/∂w = 1 - λ'/ε, and ∂(λ - r u)/∂w = λ' - r + r λ'/ε.
            displaced = -np.repeat(self._flexibility[rows], self.series.count, axis=1)[:, :, None] * local
            blocks -= stiffness[:, :, None] * displaced
        blocks[:, diagonal, diagonal] -= stiffness
        return ActiveCells(rows, blocks, displaced)

    @cached_property
    def _penalties(self) -> np.ndarray:
        """Stiffness of each row if all of its cells stick, (rows,)."""
        result = np.zeros(len(self.reference))
        for block in self.lowered.blocks:
            np.add.at(result, block.rows, penalties(block))
        return result
