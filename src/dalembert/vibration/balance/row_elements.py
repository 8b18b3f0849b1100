"""The elements of a system at their rows: forces over a motion of these, and derivatives of the forces."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.lowering import FrictionBlock, Lowered, law_numbers
from dalembert.vibration.laws.contact_sums import ContactSums, Shape, sums_for
from dalembert.vibration.laws.law_block import LawSums

Local = tuple[np.ndarray, np.ndarray]
"""Rows of cells (cells, columns), and their Jacobians (cells, columns · coefficients, columns · coefficients)."""


class Slopes(NamedTuple):
    """Jacobians of the laws, of the chosen contacts of each block, and slopes of forces by ω (rows, coefficients)."""

    laws: list[Local]
    contacts: list[Local]
    by_omega: np.ndarray


@dataclass(frozen=True)
class Elements:
    """The elements of a system, whose contacts see displacements, and a series. ``events``: as `Balance` takes it."""

    lowered: Lowered
    series: Fourier
    events: bool = True

    def forces(self, omega: float, motion: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
        """Forces over a motion of the rows, (rows, coefficients) both, and states of contacts (cells, samples).

        Forces are complex where a number of an element is.
        """
        series, parts, states = self.series, [], []
        for rows, element in self.lowered.functions:
            parts.append((rows, element.law(motion[rows] @ series.synthesis.T)[0] @ series.analysis.T))
        for block, sums in zip(self.lowered.laws, self._law_sums, strict=True):
            parts.append((block.rows, sums.forces(motion[block.rows], omega)))
        for block, sums in zip(self.lowered.blocks, self._sums, strict=True):
            force, block_states = sums.forces(motion[block.rows])
            parts.append((block.rows, force))
            states.append(block_states)
        acting = np.zeros(motion.shape, np.result_type(float, *(force for _, force in parts)))
        for rows, force in parts:
            # Cells of an Iwan contact share their rows: `+=` with an index array would add only one of them.
            np.add.at(acting, rows, force)
        return acting, tuple(states)

    def slopes(self, omega: float, motion: np.ndarray, chosen: Sequence[np.ndarray]) -> Slopes:
        """Derivatives of the forces. ``chosen``: whether those of each contact of a block are wanted, (cells,)."""
        series, laws, contacts, by_omega = self.series, [], [], np.zeros_like(motion)
        for rows, element in self.lowered.functions:
            slopes = element.law(motion[rows] @ series.synthesis.T)[1]
            # G = A diag(∂λ/∂u) S, as in `Balance`.
            local = np.swapaxes(series.analysis @ (slopes[:, :, :, None] * series.synthesis), 1, 2)
            laws.append((rows[None], local.reshape(1, len(rows) * series.count, -1)))
        for block, sums in zip(self.lowered.laws, self._law_sums, strict=True):
            _, local, slope = sums.with_slopes(motion[block.rows], omega)
            np.add.at(by_omega, block.rows, slope)
            laws.append((block.rows, local))
        for block, which in zip(self.lowered.blocks, chosen, strict=True):
            rows, size = block.rows[which], block.rows.shape[1] * series.count
            local = np.zeros((0, size, size))
            if len(rows):
                _, _, local = self._sums_of(block, which).with_slopes(motion[rows])
            contacts.append((rows, local))
        return Slopes(laws, contacts, by_omega)

    @cached_property
    def _sums(self) -> list[ContactSums]:
        return [self._sums_of(block, slice(None)) for block in self.lowered.blocks]

    def _sums_of(self, block: FrictionBlock, cells: np.ndarray | slice) -> ContactSums:
        # The way of the sums is that of the whole block, so that some contacts alone are summed as among all.
        numbers, shape = law_numbers(block), Shape(block.tangents, block.normal, block.memory)
        return sums_for(numbers, shape, self.events)(numbers[cells], shape, self.series)

    @cached_property
    def _law_sums(self) -> list[LawSums]:
        return [block.sums(self.series, self.events) for block in self.lowered.laws]
