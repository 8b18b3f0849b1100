"""What is sampled: the likelihood of the data with the priors of all parameters, and where its search starts."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data import Measurements
from dalembert.forward import ForwardModel
from dalembert.inverse.events import OnEvent
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.experiments.joined import joined
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.noise.likelihood.guesses import guessed
from dalembert.inverse.noise.likelihood.likelihood import Likelihood, likelihood_of
from dalembert.inverse.noise.likelihood.placing import Noise
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.priors import AnyPrior, LogUniform


@dataclass(frozen=True, eq=False)
class PosedPosterior:
    """The factors of a posterior density."""

    likelihood: Likelihood
    parameters: Parameters  # those of the model, then those of the noise, with their priors
    known_noise: bool  # whether weights or deviations of the data give the noise level
    usual_noise: bool  # whether the noise is that of the data, without a noise model


@dataclass(frozen=True)
class Length:
    """How long chains are."""

    # chains, draws, warmup: ``draws`` of each chain are kept, after ``warmup`` that are not.
    chains: int
    draws: int
    warmup: int
    seed: int

    @property
    def total(self) -> int:
        """Draws of all chains, with those of the warm-up."""
        return self.chains * (self.warmup + self.draws)

    def chain_seed(self, chain: int) -> int:
        """Seed of one chain, independent of those of the others."""
        return int(np.random.SeedSequence([self.seed, chain]).generate_state(1)[0])


@dataclass(frozen=True, eq=False)
class SearchStart:
    """A vector (parameters,) at which the search for modes starts, and the fit that it comes from, if any."""

    vector: np.ndarray
    fit: Fit | None


def pose_posterior(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None,
    noise: Noise | None,
    weights: ArrayLike | Mapping[str, ArrayLike] | None,
    priors: Mapping[str, AnyPrior] | None,
    on_event: OnEvent | None,
) -> PosedPosterior:
    """Return the posterior of a model, or of experiments, by the arguments of :func:`sample`."""
    joint, measured, joint_weights, _ = joined("sample", model, data, weights)
    journal = Journal(len(measured.coordinate.values), on_event)
    problem = pose(joint, measured, joint_weights, journal, noise_known=True)
    likelihood = likelihood_of(problem, noise, weighted=weights is not None)
    known_noise = weights is not None or problem.data.deviations is not None
    return PosedPosterior(likelihood, with_priors(likelihood, priors), known_noise, noise is None)


def with_priors(likelihood: Likelihood, priors: Mapping[str, AnyPrior] | None) -> Parameters:
    """Return the parameters of a likelihood with ``priors`` in place of those that they declare."""
    priors = dict(priors or {})
    for name in priors:
        likelihood.parameters.check_name(name, where="sample: priors")
    noise = set(likelihood.noise_parameters.names)

    def prior_of(item: Parameter) -> Parameter:
        if item.name in priors:
            return replace(item, prior=priors[item.name], deviation=None)
        if item.name in noise and item.prior is None and item.logarithmic:
            # Jeffreys' prior of a scale, p(σ) ∝ 1/σ: uniform in ln σ, and proper between the bounds.
            return replace(item, prior=LogUniform(item.lower, item.upper))
        return item

    return Parameters(tuple(map(prior_of, likelihood.parameters.items)), likelihood.parameters.fixed)


def search_start(
    posed: PosedPosterior, start: Fit | Mapping[str, float] | ArrayLike | None, identified: Callable[[], Fit]
) -> SearchStart:
    """Return the start of the search: values of the model's parameters, by least squares if none are given. Parameters
    of the noise are those that ``start``, if it is a fit, has estimated; the others follow from the residuals at the
    start.
    """
    likelihood = posed.likelihood
    parameters, noise = likelihood.problem.model.parameters, likelihood.noise_parameters
    fit, estimated = None, dict[str, float]()
    if isinstance(start, Fit):
        fit, estimated = start, {} if start.noise is None else start.noise.estimates
        fit.needs_one_run("sample")
        values = fit.parameters.mapping(fit.values)
        vector = parameters.real_vector({name: values[name] for name in parameters.names})
    elif start is None:
        fit = identified()
        vector = fit.values
    else:
        vector = parameters.start_vector(start)
    vector = parameters.clip(vector)
    response, sizes = likelihood.problem.responses(vector[None])[0], noise.start
    if np.all(np.isfinite(response)):
        sizes = guessed(likelihood.channels, noise, likelihood.problem, response)
    levels = dict(zip(noise.names, sizes.tolist(), strict=True))
    levels |= {name: value for name, value in estimated.items() if name in levels}
    return SearchStart(np.concatenate([vector, noise.clip(noise.vector(levels))]), fit)
