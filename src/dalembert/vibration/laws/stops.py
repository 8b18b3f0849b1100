"""Stops on one side and on both sides."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import numpy as np

from dalembert.ranges import NOT_NEGATIVE, POSITIVE
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.laws.contact_sums import ContactSums, Shape, contact_sums
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.law import law
from dalembert.vibration.laws.law_block import LawBlock, LawSums


@law
def one_sided(u, v, z, numbers, force):
    """Force k (u - gap) where u exceeds the gap."""
    over = u[0] - numbers[1]
    force[0] = numbers[0] * over if over.real > 0.0 else 0.0 * over


@law
def two_sided(u, v, z, numbers, force):
    """Force k (u ∓ gap) where u exceeds the gap upwards or downwards."""
    side = 1.0 if u[0].real > 0.0 else -1.0
    over = u[0] - side * numbers[1]
    force[0] = numbers[0] * over if side * over.real > 0.0 else 0.0 * over


@dataclass(frozen=True)
class _Stop(LawElement):
    stiffness: Number = field(kw_only=True, metadata={"unit": "N/m", "range": POSITIVE})

    switches = True
    sides: ClassVar[tuple[float, ...]]

    def closed_stiffness(self, block: LawBlock) -> np.ndarray:
        """Stiffness of the stops."""
        return block.numbers[:, :1]

    def sums(self, block: LawBlock, series: Fourier, events: bool) -> LawSums:
        """Sums that are corrected where a side begins and ends to touch."""
        return StopSums(block.numbers, np.array(self.sides), series) if events else super().sums(block, series, events)


@dataclass(frozen=True)
class Gap(_Stop):
    """A stop on one side: force k (u - gap) where the displacement u of ``first`` less ``second`` exceeds the gap.

    Parameters
    ----------
    name : str
    first : str
        Degree of freedom.
    second : str, optional
        The ground if not given.
    stiffness : float
        N/m.
    gap : float
        m.
    """

    gap: Number = field(default=0.0, kw_only=True, metadata={"unit": "m"})

    law = one_sided
    sides = (1.0,)


@dataclass(frozen=True)
class BilinearStop(_Stop):
    """A stop on both sides: force k (u ∓ gap) where u exceeds the gap upwards or downwards, else none.

    Parameters
    ----------
    name : str
    first : str
        Degree of freedom.
    second : str, optional
        The ground if not given.
    stiffness : float
        N/m.
    gap : float
        Half the free way, m.
    """

    gap: Number = field(default=0.0, kw_only=True, metadata={"unit": "m", "range": NOT_NEGATIVE})

    law = two_sided
    sides = (1.0, -1.0)


@dataclass(frozen=True)
class StopSums:
    """Sums of stops by those of contacts without friction: a stop on both sides is two on one side.

    ``numbers`` (stops, 2): stiffness and gap; ``sides`` (sides,): signs of the displacements.
    """

    numbers: np.ndarray
    sides: np.ndarray
    series: Fourier

    @cached_property
    def _contacts(self) -> ContactSums:
        # k (u - g) for u > g is the normal force of a contact without friction and preload: the sums of contacts serve,
        # events included.
        zero = np.zeros(len(self.numbers))
        numbers = np.stack([zero, *self.numbers.T, zero, zero], axis=1)
        shape = Shape(tangents=0, normal=True, memory=True)
        return contact_sums(np.repeat(numbers, len(self.sides), axis=0), shape, self.series, True)

    def _sided(self, displacements: np.ndarray) -> np.ndarray:
        """Penetrations (stops · sides, 1, coefficients)."""
        return (displacements * self.sides[:, None]).reshape(-1, 1, self.series.count)

    def _together(self, force: np.ndarray) -> np.ndarray:
        """Forces of stops, (stops, 1, coefficients)."""
        sided = force.reshape(len(self.numbers), len(self.sides), -1)
        return np.sum(self.sides[:, None] * sided, axis=1, keepdims=True)

    def forces(self, displacements: np.ndarray, omega: float) -> np.ndarray:
        """Coefficients of forces."""
        return self._together(self._contacts.forces(self._sided(displacements))[0])

    def with_slopes(self, displacements: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of forces, Jacobians and derivatives by ω."""
        force, _, local = self._contacts.with_slopes(self._sided(displacements))
        jacobians = np.sum(local.reshape(len(self.numbers), len(self.sides), *local.shape[1:]), axis=1)
        return self._together(force), jacobians, np.zeros(displacements.shape)
