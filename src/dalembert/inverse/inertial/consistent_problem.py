"""The misfit of torques and the distance from prior inertias, over parameters without bounds, with exact derivatives.

Links: relative to the factor U₀ of the prior, the pseudo-inertia is U₀ W Wᵀ U₀ᵀ with W upper triangular. The unknowns
are the logarithms of the diagonal of W and its other entries: log-Cholesky parameters, zero at the prior and free of
units. Upper triangular matrices are a group, so these reach the same bodies as those of Rucker and Wensing. The
distance is D = ‖W‖² − 2 log det W − 4. Positive parameters: p = p₀ e^x, with the distance e^x − 1 − x. Other
parameters: p = p₀ + x.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.inverse.inertial.log_cholesky import of_ordered, parameters_of_factor, upper_factor
from dalembert.inverse.inertial.pseudo_inertia import bregman_distances, smallest_eigenvalues

LEAST = 1e-12  # smallest eigenvalue relative to the prior that rounding errors do not hide
_ROWS, _COLUMNS = np.triu_indices(4)
_DIAGONAL = _ROWS == _COLUMNS


@dataclass(frozen=True, eq=False)
class ConsistentProblem:
    """Minimise ½ ‖R θ − c‖² + ½ γ Σ D over unknowns z, ten a link, then one for each other parameter."""

    triangle: np.ndarray  # (rows, parameters)
    right: np.ndarray  # (rows,)
    prior: np.ndarray  # (parameters,)
    links: int  # the first ten parameters are those of the first link, and so on
    positive: np.ndarray  # (parameters,): other parameters that are positive; False for those of links
    regularisation: float  # γ

    @cached_property
    def factors(self) -> np.ndarray:
        """U₀ (links, 4, 4) of the prior."""
        return upper_factor(self.prior[: 10 * self.links].reshape(self.links, 10))

    @cached_property
    def _forms(self) -> np.ndarray:
        """Matrices E (links, 10, 4, 4) with θ_i = ⟨E_i, W Wᵀ⟩."""
        units = np.zeros((10, 4, 4))
        units[range(10), _ROWS, _COLUMNS] = units[range(10), _COLUMNS, _ROWS] = 1.0
        forms = np.empty((self.links, 10, 4, 4))
        for k, factor in enumerate(self.factors):
            slopes = of_ordered(factor @ units @ factor.T).T  # of θ by the ten entries of the symmetric matrix
            forms[k][:, _ROWS, _COLUMNS] = forms[k][:, _COLUMNS, _ROWS] = np.where(_DIAGONAL, slopes, slopes / 2)
        return forms

    def parameters(self, unknowns: np.ndarray) -> np.ndarray:
        """θ (parameters,) of unknowns z (parameters,)."""
        inertial, other_parameters = self._split(unknowns)
        of_links = parameters_of_factor(self.factors @ _triangular(inertial)).ravel()
        positive, prior = self.positive[10 * self.links :], self.prior[10 * self.links :]
        moved = prior + other_parameters
        moved[positive] = prior[positive] * np.exp(other_parameters[positive])
        return np.concatenate([of_links, moved])

    def value(self, unknowns: np.ndarray) -> float | complex:
        """Objective; complex for complex unknowns."""
        rest = self.triangle @ self.parameters(unknowns) - self.right
        return 0.5 * ((rest @ rest).item() + self.regularisation * self.distance(unknowns))

    def distance(self, unknowns: np.ndarray) -> float | complex:
        """Sum of the distances from the prior."""
        inertial, other_parameters = self._split(unknowns)
        matrices, logs = _triangular(inertial), other_parameters[self.positive[10 * self.links :]]
        links = np.sum(matrices**2) - 2.0 * np.sum(inertial[:, _DIAGONAL]) - 4.0 * self.links
        return (links + np.sum(np.exp(logs) - 1.0 - logs)).item()

    def derivatives(self, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Gradient (parameters,) and Hessian (parameters, parameters) of the objective."""
        inertial, other_parameters = self._split(unknowns)
        gamma, count = self.regularisation, 10 * self.links
        slope = self.triangle.T @ (self.triangle @ self.parameters(unknowns) - self.right)
        jacobian = np.zeros((len(unknowns), len(unknowns)))
        extra, pull = np.zeros_like(jacobian), np.zeros(len(unknowns))
        for k, matrix in enumerate(_triangular(inertial)):
            block, scale = slice(10 * k, 10 * k + 10), np.where(_DIAGONAL, matrix[_ROWS, _COLUMNS], 1.0)
            jacobian[block, block] = 2.0 * (self._forms[k] @ matrix)[:, _ROWS, _COLUMNS] * scale
            weight = np.einsum("i,ijk->jk", slope[block], self._forms[k])
            same = _COLUMNS[:, None] == _COLUMNS
            second = 2.0 * weight[_ROWS[:, None], _ROWS] * same * np.outer(scale, scale)
            second += np.diag(np.where(_DIAGONAL, 2.0 * (weight @ matrix)[_ROWS, _COLUMNS] * scale, 0.0))
            entries = matrix[_ROWS, _COLUMNS]
            pull[block] = np.where(_DIAGONAL, entries**2 - 1.0, entries)
            extra[block, block] = second + gamma * np.diag(np.where(_DIAGONAL, 2.0 * entries**2, 1.0))
        tail = np.arange(count, len(unknowns))
        positive = self.positive[count:]
        grown = np.exp(np.where(positive, other_parameters, 0.0))
        jacobian[tail, tail] = np.where(positive, self.prior[count:] * grown, 1.0)
        pull[tail] = np.where(positive, 0.5 * (grown - 1.0), 0.0)
        extra[tail, tail] = np.where(positive, slope[count:] * self.prior[count:] * grown + 0.5 * gamma * grown, 0.0)
        half = self.triangle @ jacobian
        return jacobian.T @ slope + gamma * pull, half.T @ half + extra

    def start(self, parameters: np.ndarray, least: float) -> np.ndarray:
        """Unknowns of the consistent parameters next to given ones. Eigenvalues of pseudo-inertias relative to the
        prior, and positive parameters relative to theirs, become at least ``least``.
        """
        unknowns = np.zeros(len(self.prior))
        for k, factor in enumerate(self.factors):
            block = slice(10 * k, 10 * k + 10)
            target = np.linalg.solve(self._linear(k), parameters[block])
            matrix = np.zeros((4, 4))
            matrix[_ROWS, _COLUMNS] = matrix[_COLUMNS, _ROWS] = target
            sizes, vectors = np.linalg.eigh(matrix)
            raised = (vectors * np.maximum(sizes, least)) @ vectors.T
            factor = np.linalg.cholesky(raised[::-1, ::-1])[::-1, ::-1]
            unknowns[block] = np.where(
                _DIAGONAL, np.log(np.where(_DIAGONAL, factor[_ROWS, _COLUMNS], 1.0)), factor[_ROWS, _COLUMNS]
            )
        tail = slice(10 * self.links, None)
        positive, prior = self.positive[tail], self.prior[tail]
        ratio = np.maximum(parameters[tail] / np.where(positive, prior, 1.0), least)
        unknowns[tail] = np.where(positive, np.log(ratio), parameters[tail] - prior)
        return unknowns

    def _linear(self, k: int) -> np.ndarray:
        """Matrix (10, 10) from the upper entries of W Wᵀ to the parameters of link k."""
        return self._forms[k][:, _ROWS, _COLUMNS] * np.where(_DIAGONAL, 1.0, 2.0)

    def slope(self, parameters: np.ndarray) -> np.ndarray:
        """Gradient of the objective by θ (parameters,)."""
        gradient = self.triangle.T @ (self.triangle @ parameters - self.right)
        for k in range(self.links):
            block = slice(10 * k, 10 * k + 10)
            gradient[block] += 0.5 * self.regularisation * np.einsum("ij,kij->k", *self._pulls(parameters, k))
        tail, kept = slice(10 * self.links, None), self.positive[10 * self.links :]
        gradient[tail] += (
            0.5
            * self.regularisation
            * np.where(kept, 1 / np.where(kept, self.prior[tail], 1.0) - 1 / np.where(kept, parameters[tail], 1.0), 0.0)
        )
        return gradient

    def _pulls(self, parameters: np.ndarray, k: int) -> tuple[np.ndarray, np.ndarray]:
        """1 − X⁻¹ of X = U₀⁻¹ P U₀⁻ᵀ, and the derivatives (10, 4, 4) of X by the parameters of link k."""
        slopes = self._slopes(k)
        ratio = np.einsum("i,ijk->jk", parameters[10 * k : 10 * k + 10], slopes)
        return np.eye(4) - np.linalg.inv(ratio), slopes

    def _slopes(self, k: int) -> np.ndarray:
        """Derivatives (10, 4, 4) of X by the parameters of link k."""
        slopes = np.zeros((10, 4, 4))
        slopes[:, _ROWS, _COLUMNS] = slopes[:, _COLUMNS, _ROWS] = np.linalg.inv(self._linear(k)).T
        return slopes

    def curvature(self, parameters: np.ndarray) -> np.ndarray:
        """Hessian (parameters, parameters) of the objective by θ: the inverse of the covariance."""
        hessian = self.triangle.T @ self.triangle
        for k in range(self.links):
            block = slice(10 * k, 10 * k + 10)
            pull, slopes = self._pulls(parameters, k)
            inverse = np.eye(4) - pull
            half = inverse @ slopes
            hessian[block, block] += 0.5 * self.regularisation * np.einsum("iab,jba->ij", half, half)
        tail = np.flatnonzero(self.positive)
        hessian[tail, tail] += 0.5 * self.regularisation / parameters[tail] ** 2
        return hessian

    def linearised(self, parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """S (rows, parameters) and b (rows,): by θ, SᵀS is the Hessian of the objective and Sᵀb its gradient.

        With a factor L of X = U₀⁻¹ P U₀⁻ᵀ, the rows of a link are L⁻¹ dX L⁻ᵀ, and b is Lᵀ L − 1.
        """
        root = np.sqrt(0.5 * self.regularisation)
        count, rows, right = len(parameters), [self.triangle], [self.triangle @ parameters - self.right]
        for k in range(self.links):
            link = slice(10 * k, 10 * k + 10)
            slopes = self._slopes(k)
            factor = np.linalg.cholesky(np.einsum("i,ijk->jk", parameters[link], slopes))
            both = np.linalg.solve(factor, np.swapaxes(np.linalg.solve(factor, slopes), 1, 2))
            block = np.zeros((16, count))
            block[:, link] = root * both.reshape(10, 16).T
            rows.append(block)
            right.append(root * (factor.T @ factor - np.eye(4)).ravel())
        tail = np.flatnonzero(self.positive)
        block = np.zeros((len(tail), count))
        block[np.arange(len(tail)), tail] = root / parameters[tail]
        return np.vstack([*rows, block]), np.concatenate([*right, root * (parameters[tail] / self.prior[tail] - 1.0)])

    def value_at(self, parameters: np.ndarray) -> float:
        """Objective at θ; infinite where a link cannot exist or a parameter is not positive."""
        tail, count = np.flatnonzero(self.positive), 10 * self.links
        if np.any(parameters[tail] <= 0):
            return np.inf
        if smallest_eigenvalues(parameters[:count].reshape(-1, 10), self.prior[:count].reshape(-1, 10)).min() < LEAST:
            return np.inf
        ratio, rest = parameters[tail] / self.prior[tail], self.triangle @ parameters - self.right
        links = bregman_distances(parameters[:count].reshape(-1, 10), self.prior[:count].reshape(-1, 10))
        distance = np.sum(links) + np.sum(ratio - 1.0 - np.log(ratio))
        return float(0.5 * (rest @ rest + self.regularisation * distance))

    def rounding(self, parameters: np.ndarray) -> float:
        """Half the square of the rounding errors of R θ − c: the objective is not known better.

        They are about √n ε |R| |θ| for n parameters (Higham, Accuracy and Stability of Numerical Algorithms, 2002).
        """
        size = np.abs(self.triangle) @ np.abs(parameters)
        return 0.5 * len(parameters) * float(np.sum((np.finfo(float).eps * size) ** 2))

    def _split(self, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        count = 10 * self.links
        return unknowns[:count].reshape(self.links, 10), unknowns[count:]


def _triangular(inertial: np.ndarray) -> np.ndarray:
    """W (links, 4, 4) of unknowns (links, 10)."""
    factors = np.zeros((len(inertial), 4, 4), dtype=inertial.dtype)
    entries = np.array(inertial)
    entries[:, _DIAGONAL] = np.exp(entries[:, _DIAGONAL])
    factors[:, _ROWS, _COLUMNS] = entries
    return factors
