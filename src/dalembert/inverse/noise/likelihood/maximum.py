"""The maximum of a likelihood over the parameters of the model and of the noise."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dalembert.errors import SolveError
from dalembert.inverse.noise.likelihood.expansion import Expansion, expanded, moved
from dalembert.inverse.noise.likelihood.likelihood import Likelihood
from dalembert.inverse.noise.likelihood.restricted import Restriction
from dalembert.inverse.problem.prior import prior_residual, prior_slopes
from dalembert.inverse.problem.problem import Linearisation
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.parameters import Parameters

TRIALS = 100
"""Most steps of scoring with one linearised response."""

ROUNDS = 30
"""Most linearisations."""

FLAT = 1e-9
"""Gain of the log-likelihood below which rounding hides it: such a step is taken as it is."""

CLOSE = 1e-16
"""Gain of a step at which scoring has converged; it is half the square of the step in standard deviations."""

NEAR = 1e-8
"""Gain of a step below which the rounds end where it does not become smaller: the response is not smoother."""

CURVED = 0.5
"""Gain of a step below which the curvature along the noise parameters is taken."""

DIFFERENCE = 1e-6
"""Step of its differences, in search coordinates."""

DEFINITE = 1e-9
"""Smallest eigenvalue of a positive definite matrix with ones on its diagonal."""

HALVINGS = 10
"""Of a step that the linearised response promised too much for."""


@dataclass(frozen=True, eq=False)
class Maximum:
    """Where a likelihood is largest."""

    vector: np.ndarray  # (parameters,): of the model, then of the noise
    value: float  # log-likelihood with priors and restriction
    expansion: Expansion
    restriction: Restriction
    success: bool
    message: str


@dataclass(frozen=True, eq=False)
class Objective:
    """Log-likelihood with priors and the restriction, as a function of search coordinates.

    Parameters
    ----------
    parameters : Parameters
        Of the model, then of the noise.
    own : Parameters
        Of the model.
    restriction : Restriction
    held : frozenset of int
        Parameters that keep their values.
    """

    parameters: Parameters
    own: Parameters
    restriction: Restriction | None
    held: frozenset[int] = frozenset()

    def value(self, expansion: Expansion) -> float:
        """Return the objective at an expansion; −inf where it is not defined."""
        prior = prior_residual(self.own, expansion.vector[: len(self.own)])
        total = expansion.value - 0.5 * prior @ prior
        total += 0.0 if self.restriction is None else self.restriction.value(expansion.vector)
        return float(total) if np.isfinite(total) else -np.inf

    def slopes(self, expansion: Expansion, unit: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return gradient (parameters,) and information (parameters, parameters) with respect to p/unit."""
        count = len(self.own)
        gradient = expansion.gradient
        if self.restriction is not None:
            gradient = gradient + self.restriction.gradient(expansion.vector)
        rows = np.zeros((len(prior := prior_slopes(self.own, expansion.vector[:count], np.ones(count))), len(unit)))
        rows[:, :count] = prior
        gradient = gradient - rows.T @ prior_residual(self.own, expansion.vector[:count])
        rows = np.concatenate([expansion.rows, rows]) * unit
        return gradient * unit, rows.T @ rows


def maximum(
    likelihood: Likelihood,
    start: np.ndarray,
    held: frozenset[int] = frozenset(),
    *,
    at: Linearisation | None = None,
    restriction: Restriction | None = None,
) -> Maximum:
    """Return the maximum of the restricted likelihood near ``start`` (parameters,), a vector of model and noise.
    ``held``: places of parameters that keep their values. ``at``: of the response at the start, if it is known.
    ``restriction``: a fixed one; if not given, that of each linearised response in turn.

    Fisher's scoring: the response is linearised, the likelihood of the linearised model made largest over all
    parameters by damped steps with the information matrix, and the response linearised there again. Model and noise are
    so estimated together, and a costly model is simulated only once a round.
    """
    problem, parameters = likelihood.problem, likelihood.parameters
    of_model, search = problem.model.parameters, SearchCoordinates(parameters)
    count = len(of_model)

    def expansion(vector: np.ndarray) -> Expansion:
        at = problem.linearise(vector[:count])
        return expanded(problem, likelihood.channels, parameters, at, vector)

    def restricted(expansion_there: Expansion) -> Restriction:
        return restriction or Restriction(problem, likelihood.channels, parameters, expansion_there.at)

    start = parameters.clip(start)
    if at is not None and np.array_equal(at.vector, start[:count]):
        here = expanded(problem, likelihood.channels, parameters, at, start)
    else:
        here = expansion(start)
    size = np.inf
    message, success = f"not settled after {ROUNDS} linearisations of the response", False
    for _ in range(ROUNDS):
        objective = Objective(parameters, of_model, restricted(here), held)
        linear, gain = scored(here, objective, search, linear_expansion(likelihood, here.at))
        step = search.points(linear.vector) - search.points(here.vector)
        # Half the square of the step in standard deviations.
        before, size = size, 0.5 * float(step @ objective.slopes(here, search.slope(here.vector))[1] @ step)
        settled = size < CLOSE or before / 4 < size < NEAR
        value = objective.value(here)
        try:
            here = _forward(expansion, objective, here, value, search, step, gain)
        except SolveError as error:
            message = str(error)
            break
        if settled:
            message, success = "the likelihood is largest", True
            break
    last = restricted(here)
    value = Objective(parameters, of_model, last, held).value(here)
    return Maximum(here.vector, value, here, last, success, message)


def linear_expansion(likelihood: Likelihood, at: Linearisation) -> Callable[[np.ndarray], Expansion]:
    """Return the expansion of the likelihood of a linearised model, which simulates nothing."""
    count = len(at.vector)

    def expansion(vector: np.ndarray) -> Expansion:
        linearised = moved(at, vector[:count])
        return expanded(likelihood.problem, likelihood.channels, likelihood.parameters, linearised, vector)

    return expansion


def _forward(
    expansion: Callable[[np.ndarray], Expansion],
    objective: Objective,
    here: Expansion,
    value: float,
    search: SearchCoordinates,
    step: np.ndarray,
    gain: float,
) -> Expansion:
    """Return the expansion after a step (parameters,), which is halved until it gains something."""
    reason = "no part of the last step increases the likelihood"
    origin = search.points(here.vector)
    for halving in range(HALVINGS):
        try:
            trial = expansion(search.vectors(origin + step / 2**halving))
        except SolveError as error:
            reason = str(error)
            continue
        if gain < FLAT or objective.value(trial) > value:
            return trial
    raise SolveError(reason)


def scored(
    here: Expansion, objective: Objective, search: SearchCoordinates, expansion: Callable[[np.ndarray], Expansion]
) -> tuple[Expansion, float]:
    """Return the maximum of an objective from damped steps, and how much larger it is than here. Far away the steps are
    those of Fisher's scoring. Close to the maximum the curvature along the noise parameters replaces their information,
    since scoring alone is slow where noise is strongly correlated.
    """
    begun = value = objective.value(here)
    damping, slopes, promised = 1e-3, None, np.inf
    for _ in range(TRIALS):
        if slopes is None:
            slopes = objective.slopes(here, search.slope(here.vector))
            if promised < CURVED:
                slopes = slopes[0], _curved(here, objective, search, expansion, slopes)
        step = _step(here, objective, search, slopes, damping)
        promised = 0.5 * float(step @ slopes[1] @ step)
        with np.errstate(all="ignore"):
            trial = expansion(search.vectors(search.points(here.vector) + step))
            reached = objective.value(trial)
        if reached > value or (promised < FLAT and np.isfinite(reached)):
            here, value, slopes = trial, max(value, reached), None
            damping = max(damping / 10, 1e-12)
        else:
            damping = 10 * damping
        if promised < CLOSE or damping > 1e12:
            break
    return here, value - begun


def _curved(
    here: Expansion,
    objective: Objective,
    search: SearchCoordinates,
    expansion: Callable[[np.ndarray], Expansion],
    slopes: tuple[np.ndarray, np.ndarray],
) -> np.ndarray:
    """Return the information with the curvature along the noise parameters, if that is positive definite."""
    gradient, information = slopes
    point, matrix = search.points(here.vector), information.copy()
    count = len(objective.own)
    for place in range(count, len(point)):
        move = np.zeros(len(point))
        move[place] = DIFFERENCE if point[place] < (search.lower + search.upper)[place] / 2 else -DIFFERENCE
        trial = expansion(search.vectors(point + move))
        row = (gradient - objective.slopes(trial, search.slope(trial.vector))[0]) / move[place]
        matrix[place, :count] = matrix[:count, place] = row[:count]
        matrix[place, count:] = row[count:]
    matrix[count:, count:] = (matrix[count:, count:] + matrix[count:, count:].T) / 2
    free = [place for place in range(len(point)) if place not in objective.held]
    diagonal = np.diag(matrix)[free]
    size = np.sqrt(np.maximum(diagonal, np.finfo(float).tiny))
    with np.errstate(all="ignore"):  # the data may determine nothing along a coordinate, or all of it
        scaled = matrix[np.ix_(free, free)] / (size[:, None] * size)
    usable = np.all(diagonal > 0) and np.all(np.isfinite(scaled))
    return matrix if usable and np.linalg.eigvalsh(scaled)[0] > DEFINITE else information


def _step(
    here: Expansion,
    objective: Objective,
    search: SearchCoordinates,
    slopes: tuple[np.ndarray, np.ndarray],
    damping: float,
) -> np.ndarray:
    """Return a damped scoring step in search coordinates, inside the bounds; those that press on one stay there."""
    gradient, information = slopes
    point = search.points(here.vector)
    width = search.upper - search.lower
    pressed = ((point - search.lower < 1e-12 * width) & (gradient < 0)) | (
        (search.upper - point < 1e-12 * width) & (gradient > 0)
    )
    free = np.flatnonzero(~pressed & ~np.isin(np.arange(len(point)), list(objective.held)))
    step = np.zeros(len(point))
    matrix = information[np.ix_(free, free)]
    size = np.maximum(np.diag(matrix), np.finfo(float).tiny)
    scaled = matrix / np.sqrt(size[:, None] * size) + damping * np.eye(len(free))
    step[free] = np.linalg.lstsq(scaled, gradient[free] / np.sqrt(size), rcond=1e-14)[0] / np.sqrt(size)
    return np.clip(point + step, search.lower, search.upper) - point
