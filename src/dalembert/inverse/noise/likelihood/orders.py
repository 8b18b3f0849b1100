"""The order of autoregressive noise by the corrected Akaike criterion."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.likelihood.guesses import guessed
from dalembert.inverse.noise.likelihood.likelihood import Likelihood
from dalembert.inverse.noise.likelihood.maximum import Objective, linear_expansion, scored
from dalembert.inverse.noise.likelihood.placing import base_of, noises_of
from dalembert.inverse.noise.models.correlated_noise import SAMPLES, AutoregressiveNoise
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.parameters import Parameters

MOST = 10
"""Highest order."""

PATIENCE = 3
"""Orders in a row that do not improve the criterion, after which the search ends."""


def ordered(
    problem: MisfitProblem, picked: Mapping[Series, NoiseModel], at: Linearisation, *, known: bool
) -> dict[Series, NoiseModel]:
    """Return the noise models with the order of each autoregressive one that leaves it open. ``at``: whose residuals
    are compared. ``known``: whether the weights of the problem are 1/variance.

    The order is that of the least AICc = −2 log p + 2k + 2k(k + 1)/(n − k − 1), with k parameters of model and noise
    and n values. Experiments that share noise parameters share the order. Source: C. M. Hurvich, C.-L. Tsai, Regression
    and time series model selection in small samples, Biometrika 76 (1989).
    """
    groups: dict[str, list[Series]] = {}
    for series, model in picked.items():
        if isinstance(model, AutoregressiveNoise) and model.order is None:
            groups.setdefault(base_of(series, model), []).append(series)
    models = dict(picked)
    for alike in groups.values():
        model = picked[alike[0]]
        order = _best(problem, alike, model, at, known=known)
        models.update({series: replace(picked[series], order=order) for series in alike})  # pyright: ignore[reportCallIssue]
    return models


def _best(problem: MisfitProblem, alike: Sequence[Series], model: NoiseModel, at: Linearisation, *, known: bool) -> int:
    most = min(MOST, min(len(series.rows) for series in alike) // SAMPLES)
    best, chosen = np.inf, 0
    for order, criterion in enumerate(_criteria(problem, alike, model, at, most, known=known)):
        if criterion < best:
            best, chosen = criterion, order
        elif order - chosen >= PATIENCE:
            break
    return chosen


def _criteria(
    problem: MisfitProblem, alike: Sequence[Series], model: NoiseModel, at: Linearisation, most: int, *, known: bool
) -> Iterator[float]:
    """Yield the corrected Akaike criterion (AICc) of the autoregressive orders 0 to ``most`` of some series."""
    number, own = sum(len(series.rows) for series in alike), problem.model.parameters
    held = frozenset(range(len(own)))
    for order in range(most + 1):
        channels, noise_parameters = noises_of(
            problem, {series: replace(model, order=order) for series in alike}, known=known
        )  # pyright: ignore[reportCallIssue]
        count = len(at.vector) + len(noise_parameters)
        parameters = Parameters((*own.items, *noise_parameters.items), (*own.fixed, *noise_parameters.fixed))
        expansion = linear_expansion(Likelihood(problem, {}, parameters, channels), at)
        here = expansion(np.concatenate([at.vector, guessed(channels, noise_parameters, problem, at.response)]))
        value = scored(here, Objective(parameters, own, None, held), SearchCoordinates(parameters), expansion)[0].value
        yield -2 * value + 2 * count + 2 * count * (count + 1) / max(number - count - 1, 1)
