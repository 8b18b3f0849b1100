"""The profile of a likelihood: its largest value over all parameters but one, those of the noise among them."""

from dataclasses import dataclass, field, replace

import numpy as np

from dalembert.errors import DalembertError
from dalembert.inverse.noise.correlation.series import series_of
from dalembert.inverse.noise.likelihood.estimated_noise import EstimatedNoise
from dalembert.inverse.noise.likelihood.expansion import expanded
from dalembert.inverse.noise.likelihood.likelihood import Likelihood
from dalembert.inverse.noise.likelihood.maximum import Objective, maximum
from dalembert.inverse.noise.likelihood.placing import noises_of
from dalembert.inverse.noise.likelihood.restricted import Restriction
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.parameters import Parameters


@dataclass(frozen=True, eq=False)
class ProfiledLikelihood:
    """Restricted likelihood of model and noise, relative to its value at a fit."""

    likelihood: Likelihood
    value: float  # at the fit
    noise: np.ndarray  # (noise parameters,): at the fit
    restriction: Restriction  # at the fit, and kept: the fit is then the largest value
    _last: list[np.ndarray] = field(default_factory=list)

    def fresh(self) -> "ProfiledLikelihood":
        """Return the same, as it is before its first value: each side of a profile begins with the fit's noise."""
        return replace(self, _last=[])

    def least(self, problem: MisfitProblem, k: int, guess: np.ndarray) -> tuple[float, np.ndarray] | str:
        """Return twice the loss of log-likelihood with search coordinate k as in ``guess``, and the search point. The
        noise parameters are estimated again with the other parameters: they are unknown, and in noise that depends on
        the response they are correlated with the others.
        """
        search = problem.search
        vector = search.vectors(np.clip(guess, search.lower, search.upper))
        restricted = replace(
            self.likelihood, problem=replace(self.likelihood.problem, model=problem.model, journal=problem.journal)
        )
        try:
            start = np.concatenate([vector, self._last[-1] if self._last else self.noise])
            best = maximum(restricted, start, frozenset({k}), restriction=self.restriction)
        except DalembertError as error:
            return str(error)
        if not best.success:
            return best.message
        self._last[:] = [best.vector[len(vector) :]]
        return 2 * (self.value - best.value), search.points(best.vector[: len(vector)])


def profiled_likelihood(problem: MisfitProblem, at: Linearisation, noise: EstimatedNoise) -> ProfiledLikelihood:
    """Return the likelihood of a fit whose noise was estimated: ``problem`` with its weights, ``at`` its values."""
    picked = {series: noise.models[series.name] for series in series_of(problem, fewest=1)}
    channels, _ = noises_of(problem, picked, known=True)
    series = problem.model.parameters
    parameters = Parameters((*series.items, *noise.parameters.items), (*series.fixed, *noise.parameters.fixed))
    restriction = Restriction(problem, channels, parameters, at)
    expansion = expanded(problem, channels, parameters, at, np.concatenate([at.vector, noise.values]))
    value = Objective(parameters, series, restriction).value(expansion)
    return ProfiledLikelihood(Likelihood(problem, noise.models, parameters, channels), value, noise.values, restriction)
