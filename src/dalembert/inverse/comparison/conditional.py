"""The density of some values from all others, where the noise is correlated or has estimated parameters."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import minimize

from dalembert.errors import InputError
from dalembert.inverse.comparison.predictive import LEAST, log_density
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.least_squares.estimate import UNSEEN
from dalembert.inverse.noise.correlation.series import Series, series_of_record
from dalembert.inverse.noise.likelihood.estimated_noise import EstimatedNoise
from dalembert.inverse.problem.prior import prior_residual, prior_slopes
from dalembert.inverse.problem.search_coordinates import off_bounds

if TYPE_CHECKING:
    from scipy.sparse import csc_array

STEP = 1e-2  # step of differences by noise parameters, in their standard deviations
FAR = 1.0  # largest move of a noise parameter, in its standard deviations, that follows from second derivatives


@dataclass(frozen=True, eq=False)
class Conditional:
    """Normal noise of a known covariance, and the linearised model of its mean."""

    whitening: "csc_array"  # W with the precision WᵀW of the noise; values are flat from (samples, channels)
    basis: np.ndarray  # (whitened, columns): B, orthonormal with the rows of priors, which it leaves out; it spans W J
    white: np.ndarray  # (whitened,): (I − B Bᵀ) W (data − R): what remains at the best parameters
    information: float  # ½ log |I| of the information I on the parameters, priors included

    @property
    def restricted(self) -> float:
        """Restricted log-likelihood of the noise, up to a constant: the log density of all values over all parameters.

        W is triangular, so that its determinant is the product of its diagonal.
        """
        diagonal = self.whitening.diagonal()
        return float(np.sum(np.log(diagonal[diagonal > 0])) - 0.5 * self.white @ self.white - self.information)

    def without(self, rows: np.ndarray) -> float:
        """Return the log predictive density of the values at ``rows`` from all others, exact for a linear model.

        Where nothing is known of the parameters beforehand, the precision of all values is P = Wᵀ (I − B Bᵀ) W. Given
        the others, the values of the rows S are normal, with the precision P_SS and the error P_SS⁻¹ (P r)_S. Source:
        C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning (2006), sections 2.7 and 5.4.2;
        S. Sundararajan, S. S. Keerthi, Predictive approaches for choosing hyperparameters in Gaussian processes, Neural
        Computation 13 (2001).
        """
        columns = self.whitening[:, rows]
        places = np.unique(columns.indices)
        rows_of_places = columns.tocsr()[places].toarray()
        along = self.basis[places].T @ rows_of_places
        values, vectors = np.linalg.eigh(rows_of_places.T @ rows_of_places - along.T @ along)
        if np.min(values) < LEAST * np.max(np.sum(rows_of_places**2, axis=0)):
            return -np.inf  # the others do not determine all that these values depend on
        square = float(np.sum((vectors.T @ (rows_of_places.T @ self.white[places])) ** 2 / values))
        return 0.5 * float(np.sum(np.log(values))) + log_density(square, len(rows), 1.0, None)


@dataclass(frozen=True, eq=False)
class WithNoise:
    """The linearisation of a fit with a noise model, for the density of values that are left out."""

    fit: Fit  # its values, Jacobian and noise are used
    weights: np.ndarray  # (samples, channels): positive where a value counts; 1/variance for known noise

    @property
    def noise(self) -> EstimatedNoise:
        assert self.fit.noise is not None
        return self.fit.noise

    @property
    def fitted(self) -> np.ndarray:
        return self.weights.ravel() > 0

    @property
    def residual(self) -> np.ndarray:
        """Standardised residuals (values,), 0 where a value does not count."""
        return np.where(self.fitted, -np.sqrt(self.weights).ravel() * np.nan_to_num(self.fit.residuals.ravel()), 0.0)

    @property
    def parameters(self) -> int:
        """Number of free parameters, those of the noise among them."""
        return self._best.basis.shape[1] + len(self.noise.parameters)

    def log_likelihood(self) -> float:
        return self.noise.log_likelihood

    def predicted(self, rows: np.ndarray) -> float:
        """Return the log predictive density of the values at ``rows`` with the noise of this fit."""
        return self._best.without(rows)

    def without(self, rows: np.ndarray) -> float:
        """Return the same with the noise that the other values alone determine.

        With the gradient g and the second derivatives H of the group's log density by the noise parameters η, and the
        covariance C of η, the others have their maximum at η + d, d = −(C⁻¹ + H)⁻¹ g. The log density changes by gᵀ d +
        ½ dᵀ H d. Where d is larger than a standard deviation, the maximum is searched for: the restricted likelihood of
        the others is that of all values divided by the density of the group. Source: K. R. Rad, A. Maleki, A scalable
        estimate of the out-of-sample prediction error via approximate leave-one-out cross-validation, Journal of the
        Royal Statistical Society B 82 (2020).
        """
        conditional = self._best.without(rows)
        if self.noise.known or not np.isfinite(conditional):
            return conditional
        if any(np.all(np.isin(places, rows)) for places in self._described):
            return -np.inf  # nothing else determines a noise parameter
        self._check_deviations()
        if not self._determined:
            return self._searched(rows).without(rows)
        count = len(self.noise.parameters)
        ends = {pair: [end.without(rows) - conditional for end in both] for pair, both in self._moved.items()}
        gradient = np.array([(ends[k, k][0] - ends[k, k][1]) / (2 * STEP) for k in range(count)])
        square = np.zeros((count, count))
        for (k, j), (up, down) in ends.items():
            alone = 0.0 if k == j else sum(ends[k, k]) + sum(ends[j, j])
            square[k, j] = square[j, k] = (up + down - alone) / ((1 if k == j else 2) * STEP**2)
        left = np.linalg.inv(self.noise.correlation) + square
        move = -np.linalg.solve(left, gradient)
        if np.min(np.linalg.eigvalsh(left)) < LEAST or np.max(np.abs(move)) > FAR:
            return self._searched(rows).without(rows)
        return conditional + float(gradient @ move + 0.5 * move @ square @ move)

    def _searched(self, rows: np.ndarray) -> Conditional:
        """Return the linearisation with the noise at the largest restricted likelihood of all values but ``rows``."""

        def cost(steps: np.ndarray) -> float:
            at = self._moved_by(steps)
            return at.without(rows) - at.restricted

        minimum = minimize(cost, np.zeros(len(self.noise.values)), method="L-BFGS-B", bounds=self._room)
        return self._moved_by(minimum.x)

    @cached_property
    def _room(self) -> list[tuple[float, float]]:
        """Least and largest step of each noise parameter."""
        places = self._placed(np.array([(item.lower, item.upper) for item in self.noise.parameters]).T)
        return list(zip(*((places - self._placed(self.noise.values)) / self._units), strict=True))

    def _placed(self, values: np.ndarray) -> np.ndarray:
        """Return noise parameters (..., parameters) in the coordinates of their steps: positive ones as logarithms."""
        return np.where(self._logarithmic, np.log(np.where(self._logarithmic, values, 1.0)), values)

    @cached_property
    def _logarithmic(self) -> np.ndarray:
        return np.array([bool(item.log) for item in self.noise.parameters])

    @cached_property
    def _units(self) -> np.ndarray:
        """Length of a step of each noise parameter: its standard deviation, at most 1 of a logarithm."""
        noise = self.noise
        return np.where(self._logarithmic, np.minimum(noise.deviations / noise.values, 1.0), noise.deviations)

    @property
    def _determined(self) -> bool:
        """Whether each noise parameter that is positive has a standard deviation below its value."""
        return bool(np.all(self.noise.deviations[self._logarithmic] < self.noise.values[self._logarithmic]))

    def _check_deviations(self) -> None:
        if not np.all(np.isfinite(self.noise.deviations)):
            raise InputError(
                "compare_models: a noise parameter has no standard deviation, because the data do not determine it; "
                "fit with a simpler noise model"
            )

    @cached_property
    def _described(self) -> list[np.ndarray]:
        """Places of the values that each free noise parameter describes."""
        described = []
        for name in self.noise.parameters.names:
            base = name.rpartition(".")[0]
            rows = [series.rows for series in self._series if self.noise.bases[series.name] == base]
            described.append(np.concatenate([np.zeros(0, dtype=int), *rows]))
        return described

    @cached_property
    def _best(self) -> Conditional:
        return self._conditional(self.noise.values)

    @cached_property
    def _moved(self) -> dict[tuple[int, int], tuple[Conditional, ...]]:
        """With each noise parameter, and each two, moved up and down by a part of their deviations."""
        units = np.eye(len(self.noise.parameters))
        return {
            (k, j): (
                self._moved_by(STEP * np.maximum(units[k], units[j])),
                self._moved_by(-STEP * np.maximum(units[k], units[j])),
            )
            for k in range(len(units))
            for j in range(k, len(units))
        }

    def _moved_by(self, steps: np.ndarray) -> Conditional:
        """With the noise parameters moved by steps in their standard deviations, positive ones in their logarithm."""
        noise, apart = self.noise, steps * self._units
        factors = np.exp(np.where(self._logarithmic, apart, 0.0))
        return self._conditional(np.where(self._logarithmic, noise.values * factors, noise.values + apart))

    def _conditional(self, noise: np.ndarray) -> Conditional:
        fit, parameters = self.fit, self.fit.parameters
        assert fit.jacobian is not None
        whitening = self._whitening(self.noise.parameters.mapping(noise))
        residual = np.nan_to_num(fit.residuals.ravel())
        slopes = whitening @ np.nan_to_num(fit.jacobian.reshape(len(residual), -1))
        prior = prior_slopes(parameters, fit.values, np.ones(len(fit.values)))
        full = np.concatenate([slopes, prior])[:, off_bounds(parameters, fit.values)]
        left = np.concatenate([-(whitening @ residual), -prior_residual(parameters, fit.values)])
        size = np.linalg.norm(full, axis=0)
        basis, singular, _ = np.linalg.svd(full / np.where(size > 0, size, 1.0), full_matrices=False)
        seen = singular > UNSEEN * (singular[0] if len(singular) else 1.0)
        basis = basis[:, seen]
        left -= basis @ (basis.T @ left)
        information = float(np.sum(np.log(singular[seen])) + np.sum(np.log(size[size > 0])))
        return Conditional(whitening, basis[: len(residual)], left[: len(residual)], information)

    def _whitening(self, values: Mapping[str, float]) -> "csc_array":
        """Return W with a row and a column for each value, 0 where it does not count."""
        from scipy.sparse import coo_array, eye_array

        response = self.fit.response.ravel()
        whitening = coo_array((response.size, response.size))
        for series in self._series:
            model, values_of_channel = self.noise.models[series.name], self.noise.of_channel(series.name, values)
            deviations = self.weights.ravel()[series.rows] ** -0.5
            sizes = np.broadcast_to(
                model.deviations(response[series.rows], deviations, values_of_channel), deviations.shape
            )
            process = model.whitening(series)
            matrix = eye_array(len(deviations), format="csr") if process is None else process.matrix(values_of_channel)
            part = coo_array(matrix.multiply(1 / sizes))
            whitening += coo_array((part.data, (series.rows[part.row], series.rows[part.col])), shape=whitening.shape)
        return whitening.tocsc()

    @cached_property
    def _series(self) -> list[Series]:
        return list(series_of_record(self.fit.data, self.weights, self.fit.parts, fewest=1))
