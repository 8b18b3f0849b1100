"""What harmonic balance needs of the elements of a block."""

from typing import Protocol

import numpy as np


class Sums(Protocol):
    """Forces of the elements of a block from their displacements (elements, columns, coefficients) and ω."""

    def forces(self, displacements: np.ndarray, omega: float) -> np.ndarray:
        """Coefficients of forces, as those of displacements; complex numbers too."""
        ...

    def with_slopes(self, displacements: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The same, Jacobians (elements, columns · coefficients, columns · coefficients), and derivatives by ω."""
        ...
