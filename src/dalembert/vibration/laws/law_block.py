"""Elements of one kind and one law, as arrays."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from dalembert.vibration.fourier import Fourier
from dalembert.vibration.laws.law import Law


class LawSums(Protocol):
    """Forces of the elements of a block from their displacements (elements, columns, coefficients) and ω."""

    def forces(self, displacements: np.ndarray, omega: float) -> np.ndarray:
        """Coefficients of forces, as those of displacements; complex numbers too."""
        ...

    def with_slopes(self, displacements: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The same, Jacobians (elements, columns · coefficients, columns · coefficients), and derivatives by ω."""
        ...


@dataclass(frozen=True)
class LawBlock:
    """Elements of one kind and one law. ``element``: one of them: law, events and internal numbers are those of all;
    ``names``: of the elements; ``rows`` (elements, columns): among the rows of all elements; ``numbers``
    (elements, numbers).
    """

    element: Any
    names: tuple[str, ...]
    rows: np.ndarray
    numbers: np.ndarray

    @property
    def law(self) -> Law:
        """The law of all elements."""
        return self.element.law

    @property
    def states(self) -> int:
        """Internal numbers of each element."""
        return self.element.states

    @property
    def remembers(self) -> bool:
        """Whether forces depend on more than displacements, which Hill's method does not see."""
        return self.states > 0 or self.element.rated

    def sums(self, series: Fourier, events: bool = True) -> LawSums:
        """Fourier coefficients of the forces."""
        return self.element.sums(self, series, events)

    @property
    def complex_numbers(self) -> np.ndarray:
        """The numbers as laws take them, (elements, numbers)."""
        return np.ascontiguousarray(self.numbers, dtype=complex)
