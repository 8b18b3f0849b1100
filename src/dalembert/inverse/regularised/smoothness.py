"""Linear least squares with a penalty on differences, for all weights at once."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve, null_space

from dalembert.optimize.tikhonov import Regularised

# Singular value, relative to the largest one, below which data do not determine a combination of parameters.
BLIND = 1e-8


def differences(places: np.ndarray, count: int, order: int) -> np.ndarray:
    """Return the matrix D (rows, count) of differences of an order of the entries at ``places``, in their order.

    Examples
    --------
    >>> differences(np.array([0, 2, 3]), 4, 2).tolist()
    [[1.0, 0.0, -2.0, 1.0]]
    """
    chosen = np.eye(count)[places]
    return np.diff(chosen, n=order, axis=0)


@dataclass(frozen=True, eq=False)
class Smoothed:
    """All minima of ‖A z − b‖² + μ² ‖D z‖². In standard form, z = D⁺_A y + z₀ with z₀ in the null space of D and D⁺_A
    its A-weighted pseudoinverse, it is ‖Ā y − b̄‖² + μ² ‖y‖² with y = D z (Elden 1977).
    """

    matrix: np.ndarray  # (values, parameters): A
    right: np.ndarray  # (values,): b
    penalty: np.ndarray  # (rows, parameters): D

    @cached_property
    def _free(self) -> np.ndarray:
        """Basis of what the penalty does not see, (parameters, -)."""
        return null_space(self.penalty)

    @cached_property
    def _images(self) -> tuple[np.ndarray, np.ndarray]:
        """Q and R of A times that basis."""
        return np.linalg.qr(self.matrix @ self._free)

    @cached_property
    def blind(self) -> np.ndarray:
        """What neither the data nor the penalty sees, (parameters, -): z that moves there gives the same sum."""
        _, sizes, rows = np.linalg.svd(self._images[1])  # as large as the null space, not as the data
        seen = np.count_nonzero(sizes > BLIND * np.max(sizes, initial=0.0))
        return self._free @ rows[seen:].T

    @cached_property
    def standard(self) -> Regularised:
        """The problem in standard form."""
        a, (seen, _) = self.matrix, self._images
        images = a @ np.linalg.pinv(self.penalty)
        project = images - seen @ (seen.T @ images)
        return Regularised.of(project, self.right - seen @ (seen.T @ self.right))

    def solution(self, weight: float) -> np.ndarray:
        """z of a weight μ, (parameters,)."""
        return cho_solve(cho_factor(self.normal(weight)), self.matrix.T @ self.right)

    def decrease(self, z: np.ndarray, weight: float) -> float:
        """Part of the sum at z (parameters,) by which that of the minimum is lower.

        The sum is quadratic: f(z) − f(z*) = (z − z*)ᵀ (AᵀA + μ² DᵀD) (z − z*).
        """
        away = z - self.solution(weight)
        total = np.sum((self.matrix @ z - self.right) ** 2) + weight**2 * np.sum((self.penalty @ z) ** 2)
        return float(away @ self.normal(weight) @ away / total) if total else 0.0

    def normal(self, weight: float) -> np.ndarray:
        """AᵀA + μ² DᵀD, (parameters, parameters)."""
        return self.matrix.T @ self.matrix + weight**2 * self.penalty.T @ self.penalty

    def effective(self, weight: float) -> float:
        """Number of parameters that the data determine: trace of A (AᵀA + μ² DᵀD)⁻¹ Aᵀ."""
        return float(np.trace(cho_solve(cho_factor(self.normal(weight)), self.matrix.T @ self.matrix)))
