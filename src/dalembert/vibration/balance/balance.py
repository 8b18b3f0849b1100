r"""The equations of harmonic balance and their exact Jacobian.

The unknowns are the harmonics U of the retained coordinates q. With Λ the harmonics of the elements' forces over
sampled displacements (alternating frequency and time), :math:`R(U, \omega) = Z_q U + L^T \Lambda - F_q`.

Elements with their own compliance see D = L U. A rigid contact sees a predicted displacement: with
:math:`R_0` the residual without rigid contacts and ε the penalty, :math:`D = U - R_0/\varepsilon` at its own
coordinates. Where the equations hold, :math:`-R_0` is the contact's force, and the law of a slider of stiffness ε at D
says of that force and of U what the rigid law says. The velocity kind takes as its trial force
:math:`-R_0 + \varepsilon\, \partial U/\partial\tau` at once, without a slider; since this does not see the place of a
contact that sticks all period, the mean of such a one is held at zero, as by the displacement kind.

The Jacobian is :math:`J = Z_q + L^T G\, \partial D/\partial U` with G block-diagonal: one block for each contact.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.vibration.balance.tangents import BlockTangent, DenseTangent, StiffnessTangent
from dalembert.vibration.fourier import Fourier, real_blocks
from dalembert.vibration.interface.condensed_structure import CondensedStructure, norm
from dalembert.vibration.interface.free_motions import HeldByElements
from dalembert.vibration.interface.lowering import ELASTIC, FrictionBlock, Lowered, law_numbers, penalties
from dalembert.vibration.laws.contact_sums import ContactSums, Shape, contact_sums
from dalembert.vibration.laws.friction_law import GAP, NORMAL, STUCK, TANGENTIAL
from dalembert.vibration.laws.law_block import LawSums

LARGE = 500
"""Unknowns above which the Jacobian is kept by its structure. Measured where all of a row of sliders slip, the dearest
case for it: a point of 480 unknowns took 28 ms densely and 31 by the structure, one of 555 took 43 and 25."""


@dataclass(frozen=True)
class Evaluation:
    """Residual, forces and states of contacts at a point. ``residual`` (q, coefficients); ``forces``
    (rows, coefficients): of all elements, by the rows that they see; ``states`` (cells, samples): by friction block;
    ``size``: what residuals are parts of; ``terms``: norm of terms that cancel in the residual, where it is larger than
    that of the structure's stiffness times the unknowns.
    """

    residual: np.ndarray
    forces: np.ndarray
    states: tuple[np.ndarray, ...]
    size: float
    terms: float = 0.0

    @property
    def scale(self) -> float:
        """What residuals are parts of: 1 where nothing acts."""
        return self.size or 1.0


@dataclass(frozen=True)
class Balance:
    """The elements of a system and a series, ready to be balanced with a condensed structure.

    ``events``: whether the sums of contacts and stops are corrected at the events between samples.
    """

    lowered: Lowered
    series: Fourier
    events: bool = True

    @property
    def shape(self) -> tuple[int, int]:
        """Retained coordinates and coefficients."""
        return self._combination.shape[1], self.series.count

    @cached_property
    def _combination(self) -> np.ndarray:
        return self.lowered.coordinates.combination

    @cached_property
    def _retained(self) -> np.ndarray:
        """Retained coordinate of each row, -1 where it is none."""
        place = np.full(len(self.lowered.row_names), -1)
        place[self.lowered.coordinates.rows] = np.arange(self.shape[0])
        return place

    @cached_property
    def _terms(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Retained coordinates and factors that make up each row."""
        return [(np.flatnonzero(row), row[np.flatnonzero(row)]) for row in self._combination]

    def displacements(self, unknowns: np.ndarray) -> np.ndarray:
        """Of all rows that elements see, (rows, coefficients)."""
        return self._combination @ unknowns

    def linear(self, stiffness: np.ndarray, force: np.ndarray, unknowns: np.ndarray) -> np.ndarray:
        """Z_q U - F_q, or the same of their derivatives, (q, coefficients)."""
        # A linear structure does not couple harmonics: one complex matrix for each, in place of a real one of twice the
        # size.
        phasors = self.series.phasors(unknowns)
        return self.series.coefficients((stiffness @ phasors[:, :, None])[:, :, 0] - force)

    def linearised(self, point: CondensedStructure, unknowns: np.ndarray) -> tuple[Evaluation, StiffnessTangent]:
        """Residual at a point, with its exact Jacobian and its derivative by ω."""
        tangent = self.tangent(point, unknowns)
        return self.at(point, unknowns, tangent), tangent

    def at(
        self, point: CondensedStructure, unknowns: np.ndarray, tangent: StiffnessTangent | None = None
    ) -> Evaluation:
        """Residual at a point; see :meth:`residual`."""
        linear = self.linear(point.stiffness, point.force, unknowns)
        return self.residual(linear, unknowns, point.omega, tangent, point.rate, point.load)

    def tangent(self, point: CondensedStructure, unknowns: np.ndarray) -> StiffnessTangent:
        """The tangent of the structure alone, to which :meth:`residual` adds the elements."""
        # ∂R/∂ω of the structure at fixed U; laws that see velocities add their part in `_add_laws`.
        slope = self.linear(point.slope, point.force_slope, unknowns)
        support = None if point.held else self._held_by_elements(point)
        # Elements that share a coordinate, or see velocities as trial forces, have no separate blocks: those stay
        # dense.
        if unknowns.size > LARGE and self._separate:
            return BlockTangent(point, self.series, slope, self._reference(point), self._rigid, support)
        return DenseTangent(real_blocks(point.stiffness, self.series.mean), slope, support)

    def stuck(self, point: CondensedStructure) -> np.ndarray:
        """Unknowns where all elastic contacts are closed and stick, without preload, (q, coefficients)."""
        stiffness, force = point.stiffness.copy(), point.force.copy()
        for block in self.lowered.blocks:
            if block.kind != ELASTIC:
                continue
            for rows, stuck, numbers in zip(block.rows, penalties(block), block.numbers, strict=True):
                shapes = self._combination[rows]
                # Z_q + L^T k L: all sliders stick, as under a friction limit without bound.
                stiffness += shapes.T @ (stuck[:, None] * shapes)
                if block.normal and self.series.mean:
                    # k_n (u_N - g): the gap of a closed contact is a force on the mean.
                    force[0] += numbers[NORMAL] * numbers[GAP] * shapes[-1]
        # Least squares, not a solution: contacts may leave a motion free, and the matrix is singular along it.
        phasors = np.stack([np.linalg.lstsq(matrix, right)[0] for matrix, right in zip(stiffness, force, strict=True)])
        return self.series.coefficients(phasors)

    def touching(self, unknowns: np.ndarray) -> np.ndarray:
        """Unknowns with the mean positions at which rigid contacts just touch: near motions that bounce on them."""
        result = unknowns.copy()
        for block in self.lowered.blocks:
            if block.kind == ELASTIC or not block.normal or not self.series.mean:
                continue
            places = self._retained[block.rows[:, -1]]
            # The mean is g - max u_N of the varying part, so that the highest position just reaches the contact.
            varying = unknowns[places, 1:] @ self.series.synthesis[:, 1:].T
            result[places, 0] = block.numbers[:, GAP] - varying.max(axis=1)
        return result

    def residual(
        self, linear: np.ndarray, unknowns: np.ndarray, omega: float, tangent: StiffnessTangent | None = None,
        rate: float = 1.0, load: float = 0.0,
    ) -> Evaluation:  # fmt: skip
        """Return the residual from its linear part; the elements' part of the tangent is added to ``tangent``. Without
        a tangent, in complex numbers where the linear part or the elements' numbers are complex. ``rate``: derivative
        of ω by the parameter of the tangent's slope; ``load``: norm of the loads.
        """
        kind = np.result_type(linear, unknowns, self._kind)
        acting = np.zeros((len(self.lowered.row_names), self.series.count), dtype=kind)
        states = [np.zeros((0, 0), dtype=np.uint8)] * len(self.lowered.blocks)
        self._add_functions(acting, unknowns, tangent)
        self._add_laws(acting, unknowns, omega, tangent, rate)
        for rigid in (False, True):  # rigid contacts last: their prediction needs the residual without them
            blocks = [number for number, block in enumerate(self.lowered.blocks) if (block.kind != ELASTIC) == rigid]
            total = linear + self._combination.T @ acting if blocks and rigid else linear
            # J_0 and R_0 are without all rigid contacts: both are taken once, before the first of these blocks adds its
            # part.
            before = tangent.copy() if isinstance(tangent, DenseTangent) and blocks and rigid else None
            for number in blocks:
                states[number] = self._add_friction(number, acting, unknowns, total, tangent, before)
        # Of load and element forces, since a free or self-excited motion has no load.
        size = load + norm(acting)
        return Evaluation(linear + self._combination.T @ acting, acting, tuple(states), size)

    def _add_functions(self, acting: np.ndarray, unknowns: np.ndarray, tangent: StiffnessTangent | None) -> None:
        series = self.series
        for rows, element in self.lowered.functions:
            force, slopes = element.law((self._combination[rows] @ unknowns) @ series.synthesis.T)
            acting[rows] += force @ series.analysis.T
            if tangent is not None:
                # G = A diag(∂λ/∂u) S by the chain rule through the samples, with the synthesis S and the analysis A
                # (alternating frequency and time: Cameron and Griffin, Journal of Applied Mechanics 56, 1989).
                blocks = series.analysis @ (slopes[:, :, :, None] * series.synthesis)
                local = np.swapaxes(blocks, 1, 2).reshape(1, len(rows) * series.count, -1)
                self._spread(rows[None], local, tangent)

    def _add_laws(
        self, acting: np.ndarray, unknowns: np.ndarray, omega: float, tangent: StiffnessTangent | None, rate: float
    ) -> None:
        for block, sums in zip(self.lowered.laws, self._law_sums, strict=True):
            displacements = (self._combination @ unknowns)[block.rows]
            if tangent is None:
                force = sums.forces(displacements, omega)
            else:
                force, local, by_omega = sums.with_slopes(displacements, omega)
                self._spread(block.rows, local, tangent)
                # Velocities are ω ∂u/∂τ: forces of rated laws depend on ω at fixed U.
                shapes = self._combination[block.rows.ravel()]
                tangent.slope[:] += rate * shapes.T @ by_omega.reshape(len(shapes), -1)
            np.add.at(acting, block.rows, force)

    def _spread(
        self, rows: np.ndarray, local: np.ndarray, tangent: StiffnessTangent, stuck: np.ndarray | None = None
    ) -> None:
        """J += L^T G L, with local Jacobians G (cells, columns · coefficients, columns · coefficients).

        ``stuck`` (cells, columns): stiffnesses of each cell if it sticks, where several cells share a row.
        """
        if isinstance(tangent, BlockTangent):
            places = self._retained[rows]
            tangent.add(places, local, tangent.reference[places] if stuck is None else stuck)
            return
        cells, columns = rows.shape
        split = local.reshape(cells, columns, self.series.count, columns, self.series.count)
        for cell in range(cells):
            for i, row in enumerate(rows[cell]):
                for j, column in enumerate(rows[cell]):
                    self._scatter(tangent.jacobian, row, column, split[cell, i, :, j, :])

    def _scatter(self, jacobian: np.ndarray, row: int, column: int, block: np.ndarray) -> None:
        """Add the derivative of the force of one row by the displacement of another."""
        for a, factor in zip(*self._terms[row], strict=True):
            for b, other in zip(*self._terms[column], strict=True):
                jacobian[a, :, b, :] += block if factor == other == 1.0 else factor * other * block

    def _add_friction(
        self,
        number: int,
        acting: np.ndarray,
        unknowns: np.ndarray,
        total: np.ndarray,
        tangent: StiffnessTangent | None,
        before: DenseTangent | None,
    ) -> np.ndarray:
        """Forces of a block's cells, and its part of the tangent; the states (cells, samples)."""
        block = self.lowered.blocks[number]
        displacements = self._predicted(block, unknowns, total)
        if tangent is None:
            result, states = self._sums[number].forces(displacements)
        else:
            result, states, local = self._sums[number].with_slopes(displacements)
            if isinstance(tangent, DenseTangent) and before is not None:
                self._spread_rigid(block, local, tangent, before)
            else:
                self._spread(block.rows, local, tangent, penalties(block))
        for cell in self._undetermined(block, states):
            places = self._retained[block.rows[cell, : block.tangents]]
            # A stuck contact that sees velocities: ε U_0 in place of its mean force holds the mean at zero.
            penalty = block.numbers[cell, TANGENTIAL]
            result[cell, : block.tangents, 0] += penalty * unknowns[places, 0]
            if isinstance(tangent, DenseTangent):
                tangent.jacobian[places, 0, places, 0] += penalty
        # Cells of an Iwan contact share their rows: `+=` with an index array would add only one of them.
        np.add.at(acting, block.rows, result)
        return states

    def _predicted(self, block: FrictionBlock, unknowns: np.ndarray, total: np.ndarray) -> np.ndarray:
        """Return the displacements (cells, columns, coefficients) that the law sees."""
        if block.kind == ELASTIC:
            return (self._combination @ unknowns)[block.rows]
        places = self._retained[block.rows]
        # D = U - R_0/ε; velocities along tangents: p = ε ∂U/∂τ - R_0.
        moved = unknowns[places] - total[places] / penalties(block)[:, :, None]
        if block.memory:
            return moved
        tangents = places[:, : block.tangents]
        penalty = block.numbers[:, TANGENTIAL, None, None]
        trial = penalty * (unknowns[tangents] @ self.series.derivative.T) - total[tangents]
        return np.concatenate([trial, moved[:, block.tangents :]], axis=1)

    @cached_property
    def _sums(self) -> list[ContactSums]:
        return [
            contact_sums(
                law_numbers(block), Shape(block.tangents, block.normal, block.memory), self.series, self.events
            )
            for block in self.lowered.blocks
        ]

    @cached_property
    def _law_sums(self) -> list[LawSums]:
        return [block.sums(self.series, self.events) for block in self.lowered.laws]

    def _undetermined(self, block: FrictionBlock, states: np.ndarray) -> np.ndarray:
        """Cells of the velocity kind that stick all period: nothing else determines their mean position."""
        if block.memory or not self.series.mean:
            return np.zeros(0, dtype=int)
        return np.flatnonzero(np.all(states == STUCK, axis=1))

    def _spread_rigid(
        self, block: FrictionBlock, local: np.ndarray, tangent: DenseTangent, before: DenseTangent
    ) -> None:
        """J += G ∂D/∂U with ∂D/∂U = 1 - J_0/ε, or ε ∂/∂τ - J_0 for trial forces; the same for ω."""
        count, columns = self.series.count, block.rows.shape[1]
        prediction = np.tile(np.eye(count), (columns, 1, 1))
        weights = 1 / penalties(block)
        if not block.memory:
            weights[:, : block.tangents] = 1.0
        for places, weight, numbers, gradient in zip(
            self._retained[block.rows], weights, block.numbers, local, strict=True
        ):
            if not block.memory:
                prediction[: block.tangents] = numbers[TANGENTIAL] * self.series.derivative
            motion = -weight[:, None, None, None] * before.jacobian[places]
            motion[np.arange(columns), :, places] += prediction
            # J = J_0 + G (1 - J_0/ε) for displacements, J_0 + G (ε ∂/∂τ - J_0) for trial forces.
            change = gradient @ motion.reshape(columns * count, -1)
            tangent.jacobian[places] += change.reshape(motion.shape)
            change = gradient @ (weight[:, None] * before.slope[places]).ravel()
            tangent.slope[places] -= change.reshape(columns, count)

    @cached_property
    def _separate(self) -> bool:
        """Whether elements are coupled by the structure alone, so that the Jacobian has blocks."""
        return self.shape[0] == len(self.lowered.row_names) and all(block.memory for block in self.lowered.blocks)

    @cached_property
    def _stuck(self) -> np.ndarray:
        """Stiffness of the contact of each row if it is closed and sticks, (rows,); 0 where there is no contact."""
        stiffness = np.zeros(len(self.lowered.row_names))
        for block in self.lowered.blocks:
            np.add.at(stiffness, block.rows, penalties(block))
        return stiffness

    @cached_property
    def _closed(self) -> np.ndarray:
        """Stiffness of the mean of each row's element where it is closed, (rows,); NaN where none is known.

        0 for elements that remember: after the turns of a period, their forces do not depend on the mean.
        """
        stiffness = np.full(len(self.lowered.row_names), np.nan)
        for block in self.lowered.blocks:
            stiffness[block.rows] = 0.0
            if block.normal:
                np.add.at(stiffness, block.rows[:, -1], block.numbers[:, NORMAL])
        for block in self.lowered.laws:
            stiffness[block.rows] = 0.0 if block.states else block.element.closed_stiffness(block)
        return stiffness

    @cached_property
    def _rigid(self) -> np.ndarray:
        """Whether the contact of each retained coordinate is rigid, (q,)."""
        rigid = np.zeros(self.shape[0], dtype=bool)
        for block in self.lowered.blocks:
            rigid[self._retained[block.rows]] = block.kind != ELASTIC
        return rigid

    def _reference(self, point: CondensedStructure) -> np.ndarray:
        """Stiffness of the element of each retained coordinate, (q,), with which no motion of the structure is free."""
        stiffness = self._stuck
        if not point.held:
            # A must be regular where the structure alone leaves a part free: stops count as closed, and an element of
            # unknown stiffness as stiff as the structure. J itself does not depend on this choice.
            closed = self._mean_stiffness(point)
            stiffness = np.where(stiffness > 0, stiffness, np.where(closed > 0, closed, point.stiffest))
        return stiffness[self.lowered.coordinates.rows]

    def _mean_stiffness(self, point: CondensedStructure) -> np.ndarray:
        """Stiffness of the mean of each row's element where it is closed, (rows,); of the structure if not known."""
        return np.where(np.isnan(self._closed), point.stiffest, self._closed)

    def _held_by_elements(self, point: CondensedStructure) -> HeldByElements:
        moved = self._combination @ point.free_motions
        return HeldByElements(point.free_motions, moved.T @ (self._mean_stiffness(point)[:, None] * moved))

    @cached_property
    def _kind(self) -> np.dtype:
        blocks = (*self.lowered.blocks, *self.lowered.laws)
        return np.result_type(float, *(block.numbers for block in blocks))
