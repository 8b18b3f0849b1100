"""The Jacobian of the balance, dense or in blocks, alone or bordered by a row."""

from dataclasses import dataclass

import numpy as np

from dalembert.vibration.balance.block_tangent import EXACT, BlockTangent
from dalembert.vibration.balance.receptance_tangent import ReceptanceTangent
from dalembert.vibration.interface.free_motions import HeldByElements


@dataclass(frozen=True)
class DenseTangent:
    """Derivatives of the residual. ``jacobian`` (q, coefficients, q, coefficients); ``slope`` (q, coefficients): by ω;
    ``held``: mean motions that the elements alone may hold, if there are any.
    """

    jacobian: np.ndarray
    slope: np.ndarray
    held: HeldByElements | None = None

    #: Residual of a linear system: rounding.
    forcing = EXACT

    def copy(self) -> "DenseTangent":
        """Return a copy of the arrays."""
        return DenseTangent(self.jacobian.copy(), self.slope.copy(), self.held)

    @property
    def matrix(self) -> np.ndarray:
        """The Jacobian as a matrix, (unknowns, unknowns)."""
        return self.jacobian.reshape(self.slope.size, self.slope.size)

    @property
    def sign(self) -> float:
        """Sign of the determinant of the Jacobian."""
        return float(np.linalg.slogdet(self.supported)[0])

    @property
    def supported(self) -> np.ndarray:
        """The matrix with a support of the mean motions that no element resists."""
        motions = self.unresisted
        if self.held is None or not motions.size:
            return self.matrix
        jacobian = self.jacobian.copy()
        # Only the mean, coefficient 0, has motions without resistance; harmonics have inertia.
        jacobian[:, 0, :, 0] += self.held.support(motions, self._largest)
        return jacobian.reshape(self.slope.size, self.slope.size)

    @property
    def unresisted(self) -> np.ndarray:
        """Mean motions (q, motions) that neither the structure nor an element resists."""
        if self.held is None:
            return np.zeros((len(self.slope), 0))
        forces = self.jacobian[:, :, :, 0].reshape(self.slope.size, -1) @ self.held.motions
        return self.held.unresisted(forces, self._largest)

    def unbalanced(self, residual: np.ndarray) -> np.ndarray:
        """Mean forces along :attr:`unresisted` at a residual, N, (motions,)."""
        return self.unresisted.T @ residual[:, 0]

    @property
    def _largest(self) -> float:
        return float(np.abs(self.jacobian).max())

    def solve(self, right: np.ndarray, tolerance: float = EXACT) -> np.ndarray:
        """J⁻¹ times right-hand sides (q, coefficients, columns); to rounding, whatever the tolerance."""
        return np.linalg.solve(self.supported, right.reshape(self.slope.size, right.shape[2])).reshape(right.shape)


StiffnessTangent = DenseTangent | BlockTangent
Tangent = StiffnessTangent | ReceptanceTangent


def bordered(
    tangent: Tangent,
    direction: np.ndarray,
    scales: tuple[float, float, float],
    top: np.ndarray,
    bottom: float,
    tolerance: float = EXACT,
) -> tuple[np.ndarray, float]:
    """Return the solution of the bordered system, which is regular at folds: changes of U/size and ω/width.
    ``direction`` (unknowns + 1,): the row; ``top`` (q, coefficients): right-hand side, as part of the force;
    ``tolerance``: as :class:`BlockTangent` takes it.
    """
    size, width, force = scales
    if isinstance(tangent, DenseTangent):
        # The whole bordered matrix, which is regular where J is singular at a fold (Keller, in Applications of
        # Bifurcation Theory, 1977). Rows and columns have the scales of forces, U and ω, as pivots compare entries.
        matrix = _with_row(tangent, direction, scales)
        change = np.linalg.solve(matrix, np.append(top.ravel(), bottom))
        return change[:-1].reshape(top.shape), float(change[-1])
    # Elimination of the block of J: with J a = top and J b = ∂R/∂ω, turned = (bottom - t·a)/(t_ω - t·b) and
    # change = a - turned b.
    right = np.stack([top * (force / size), tangent.slope * (width / size)], axis=2)
    solved = tangent.solve(right, tolerance)
    # Near a fold a and b are large and cancel in part; Newton's next iteration corrects what this loses. The factors of
    # A are those of the ordinary solution, which a bordered matrix could not use.
    row, (still, moving) = direction[:-1], np.moveaxis(solved, 2, 0)
    turned = (bottom - float(row @ still.ravel())) / (float(direction[-1]) - float(row @ moving.ravel()))
    return still - turned * moving, turned


def orientation(tangent: Tangent, direction: np.ndarray, scales: tuple[float, float, float]) -> float:
    """Return the sign of the determinant of the bordered tangent, which is constant along a path; 0 if it is 0."""
    if isinstance(tangent, DenseTangent):
        return float(np.linalg.slogdet(_with_row(tangent, direction, scales))[0])
    size, width, _ = scales
    if not tangent.sign:
        return 0.0
    # det of the bordered matrix = det J (t_ω - t · J⁻¹ ∂R/∂ω), by its Schur complement; only signs are kept.
    moving = tangent.solve(tangent.slope[:, :, None])[:, :, 0] * (width / size)
    return tangent.sign * float(np.sign(direction[-1] - direction[:-1] @ moving.ravel()))


def _with_row(tangent: DenseTangent, direction: np.ndarray, scales: tuple[float, float, float]) -> np.ndarray:
    size, width, force = scales
    matrix = np.empty((len(direction), len(direction)))
    matrix[:-1, :-1] = tangent.supported * (size / force)
    matrix[:-1, -1] = tangent.slope.ravel() * (width / force)
    matrix[-1] = direction
    return matrix
