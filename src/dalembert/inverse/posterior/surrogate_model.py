"""A Chebyshev surrogate in place of the model, within a box around the mode."""

from dataclasses import dataclass, replace

import numpy as np

from dalembert.forward.responses import Responses
from dalembert.forward.wrapped import Wrapped
from dalembert.inverse.posterior.target import Target
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.problem.surrogates import surrogate_of
from dalembert.surrogate import Surrogate
from dalembert.surrogate.scheme import Scheme

WIDTH = 6.0  # half width of the box in linear standard deviations, where the bounds are not closer
OUTSIDE = "outside the box of the surrogate"


@dataclass(frozen=True)
class SurrogateModel(Wrapped):
    """A forward model whose compared values are polynomials; the others are 0."""

    surrogate: Surrogate  # of the compared values, over search coordinates
    problem: MisfitProblem
    places: np.ndarray  # (values,): of the compared values in the response (samples, channels) of the data, flattened

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch; a vector outside the box is a failed sample."""
        points, polynomial = self.problem.search.points(np.atleast_2d(vectors)), self.surrogate.polynomial
        # Outside of its box a polynomial grows fast: a proposal there fails, and is rejected.
        inside = np.all((points >= polynomial.lower) & (points <= polynomial.upper), axis=1)
        compared = np.zeros((len(points), *self.problem.weights.shape))
        flat = compared.reshape(len(points), -1)
        flat[np.ix_(inside, self.places)] = self.surrogate(points[inside])
        values = np.zeros((len(points), len(self.coordinate.values), len(self.channels)))
        values[:, :, self.problem.columns] = compared
        return Responses(values, tuple(None if is_inside else OUTSIDE for is_inside in inside))


def box_of(problem: MisfitProblem, vector: np.ndarray, deviations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ends (parameters,) of the box in search coordinates: some deviations around a vector, within the bounds."""
    search = problem.search
    middle, radius = search.points(vector), WIDTH * deviations / np.abs(search.slope(vector))
    return np.maximum(search.lower, middle - radius), np.minimum(search.upper, middle + radius)


def with_surrogate(target: Target, vector: np.ndarray, deviations: np.ndarray, scheme: Scheme, seed: int) -> Target:
    """Return a target whose model is a surrogate around a vector with linear deviations, both (parameters,)."""
    problem, count = target.problem, len(target.problem.model.parameters)
    places = np.flatnonzero(problem.weights.ravel() > 0)
    lower, upper = box_of(problem, vector[:count], deviations[:count])

    def run(points: np.ndarray) -> np.ndarray:
        responses = problem.responses(problem.search.vectors(points))
        return responses.reshape(len(points), -1)[:, places]

    channels = places % problem.weights.shape[1]
    surrogate = surrogate_of(
        run, lower, upper, scheme, problem.journal, shape=(len(places), 1), seed=seed, groups=channels
    )
    model, journal = SurrogateModel(problem.model, surrogate, problem, places), Journal(problem.samples)
    return target.of(replace(problem, model=model, journal=journal))
