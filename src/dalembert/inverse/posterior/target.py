"""The density that samplers sample: the posterior in preconditioned coordinates without bounds."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dalembert.errors import SolveError
from dalembert.inverse.noise.likelihood.likelihood import Likelihood
from dalembert.inverse.posterior.prior_density import PriorDensity
from dalembert.inverse.posterior.unbounded import UnboundedCoordinates
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.parameters import Parameters


@dataclass(frozen=True, eq=False)
class Target:
    """Log posterior density of y, with z = centre + factor y, and z the coordinates without bounds."""

    likelihood: Likelihood
    parameters: Parameters  # those of the likelihood, with their priors
    centre: np.ndarray  # (parameters,)
    # (parameters, parameters): for a normal posterior with the covariance factor factorᵀ, y has independent standard
    # normal components.
    factor: np.ndarray

    @cached_property
    def coordinates(self) -> UnboundedCoordinates:
        return UnboundedCoordinates(self.parameters)

    @cached_property
    def prior(self) -> PriorDensity:
        return PriorDensity(self.parameters)

    @property
    def problem(self) -> MisfitProblem:
        return self.likelihood.problem

    def of(self, problem: MisfitProblem) -> "Target":
        """The same density with the model of another problem."""
        return replace(self, likelihood=replace(self.likelihood, problem=problem))

    def points(self, places: np.ndarray) -> np.ndarray:
        """Coordinates z of y, both (..., parameters)."""
        return self.centre + places @ self.factor.T

    def places(self, points: np.ndarray) -> np.ndarray:
        """Return y at coordinates z, both (..., parameters)."""
        return np.linalg.solve(self.factor, (points - self.centre)[..., None])[..., 0]

    def vectors(self, places: np.ndarray) -> np.ndarray:
        """Parameter vectors of y, both (..., parameters)."""
        return self.coordinates.vectors(self.points(places))

    def evaluate(self, places: np.ndarray) -> np.ndarray:
        """Log density (batch,) at y (batch, parameters); −∞ where the simulation failed."""
        points = self.points(places)
        vectors = self.coordinates.vectors(points)
        return self.density(points, vectors, self.likelihood.evaluate(vectors))

    def density(self, points: np.ndarray, vectors: np.ndarray, likelihoods: np.ndarray) -> np.ndarray:
        """Log density (batch,) from log-likelihoods (batch,) at coordinates z and vectors (batch, parameters) each."""
        density = likelihoods + self.prior(vectors) + self.coordinates.log_slope(points)
        return np.where(np.isnan(density), -np.inf, density)

    def linearise(self, place: np.ndarray) -> tuple[float, np.ndarray]:
        """Log density and its gradient (parameters,) at y (parameters,); −∞ and 0 where the simulation failed."""
        point = self.points(place)
        vector = self.coordinates.vectors(point)
        try:
            value, gradient = self.likelihood.linearise(vector)
        except SolveError:
            return -np.inf, np.zeros(len(place))
        # ln p(y) = ln p(data | p) + ln p(p) + Σ ln dp/dz; the constant ln det factor is left out.
        value = value + float(self.prior(vector)) + float(self.coordinates.log_slope(point))
        # Chain rule from p to z, then to y = factor⁻¹ (z − centre).
        slope = self.coordinates.slope(point) * (gradient + self.prior.gradient(vector))
        result = self.factor.T @ (slope + self.coordinates.log_slope_gradient(point))
        return (
            (value, result) if np.isfinite(value) and np.all(np.isfinite(result)) else (-np.inf, np.zeros(len(place)))
        )
