"""Log predictive densities of values that were left out of a fit, from its linearisation."""

from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln

from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.least_squares.estimate import UNSEEN
from dalembert.inverse.problem.prior import prior_slopes
from dalembert.inverse.problem.search_coordinates import off_bounds

LEAST = 1e-12  # 1 − leverage below which a value is not predicted by the others


@dataclass(frozen=True, eq=False)
class Linearised:
    """Weighted residuals of a fit and its linearisation, flat from (samples, channels)."""

    residual: np.ndarray  # (values,): W^½ (data − R); 0 where a value was not fitted
    basis: np.ndarray  # (values, columns): orthonormal with the rows of priors, which it leaves out
    roots: np.ndarray  # (values,): W^½
    freedom: float  # number of fitted values and priors, less that of the columns
    squares: float  # sum of squares that the variance of a weighted residual follows from
    known: bool  # whether that variance is 1
    # Whether densities are normal, with the variance that the other values have, as those of fits with a noise model;
    # otherwise Student's t where the variance is not known.
    normal: bool = False

    @classmethod
    def of(cls, fit: Fit) -> "Linearised":
        """Return the linearisation of a fit with independent noise, with a Jacobian."""
        assert fit.jacobian is not None
        roots = np.sqrt(fit.weights).ravel()
        scale, free = fit.parameters.scale, off_bounds(fit.parameters, fit.values)
        residual = np.where(roots > 0, -roots * np.nan_to_num(fit.residuals.ravel()), 0.0)
        slopes = np.where(roots[:, None] > 0, roots[:, None] * fit.jacobian.reshape(-1, len(scale)) * scale, 0.0)
        slopes = np.concatenate([slopes, prior_slopes(fit.parameters, fit.values, scale)])[:, free]
        left, singular, _ = np.linalg.svd(slopes, full_matrices=False)
        basis = left[: len(roots), singular > UNSEEN * (singular[0] if len(singular) else 1.0)]
        freedom = float(np.count_nonzero(roots) + len(slopes) - len(roots) - basis.shape[1])
        return cls(residual, basis, roots, freedom, float(residual @ residual), fit.noise_is_known)

    @property
    def fitted(self) -> np.ndarray:
        return self.roots > 0

    @property
    def parameters(self) -> int:
        """Number of free parameters, an unknown variance among them."""
        return self.basis.shape[1] + (not self.known)

    def log_likelihood(self) -> float:
        """Return the largest log-likelihood: of independent normal noise, its unknown variance at its maximum."""
        count = np.count_nonzero(self.fitted)
        square = float(self.residual @ self.residual)
        variance = 1.0 if self.known else square / count
        if not variance > 0:
            return np.inf
        roots = float(np.sum(np.log(self.roots[self.fitted])))
        return roots - count / 2 * np.log(2 * np.pi * variance) - square / (2 * variance)

    def without(self, rows: np.ndarray) -> float:
        """Return the log predictive density of the values at ``rows`` from all others, exact for a linear model.

        With the hat matrix H of the rows, the prediction error is (I − H)⁻¹ e and its covariance s² (I − H)⁻¹. An
        unknown s has the prior 1/s, so that the density is Student's t of n − m − p degrees of freedom for n values, m
        of them left out. Source: D. M. Allen, The relationship between variable selection and data augmentation and a
        method for prediction, Technometrics 16 (1974); A. Gelman et al., Bayesian Data Analysis (2013), section 14.2.
        """
        basis, residual = self.basis[rows], self.residual[rows]
        remaining = np.eye(len(rows)) - basis @ basis.T
        values, vectors = np.linalg.eigh(remaining)
        if np.min(values) < LEAST:
            return -np.inf  # the others do not determine all that these values depend on
        square = float(np.sum((vectors.T @ residual) ** 2 / values))
        logs = 0.5 * float(np.sum(np.log(values))) + float(np.sum(np.log(self.roots[rows])))
        return logs + log_density(square, len(rows), *self._scale(square, len(rows)))

    def _scale(self, square: float, count: int) -> tuple[float, float | None]:
        """Variance of a weighted residual without these values, and its degrees of freedom; None where it is known."""
        if self.known:
            return 1.0, None
        freedom = self.freedom - count
        variance = max(self.squares - square, 0.0) / freedom if freedom > 0 else np.nan
        return variance, None if self.normal else freedom


def log_density(square: float, count: int, variance: float, freedom: float | None) -> float:
    """Return the log density of ``count`` values with the sum of squares ``square``: normal, or Student's t."""
    if not variance > 0:
        return -np.inf
    if freedom is None:
        return float(-0.5 * (square / variance + count * np.log(2 * np.pi * variance)))
    shape = gammaln((freedom + count) / 2) - gammaln(freedom / 2) - count / 2 * np.log(np.pi * freedom * variance)
    return float(shape - (freedom + count) / 2 * np.log1p(square / (freedom * variance)))
