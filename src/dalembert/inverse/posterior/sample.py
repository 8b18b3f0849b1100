"""Draws of the posterior distribution of parameters."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import check_whole
from dalembert.data import Measurements
from dalembert.errors import InputError, require_known, shown
from dalembert.forward import Executor, ForwardModel, check_derivatives, takes_executor
from dalembert.forward.provenance import provenance
from dalembert.inverse.events import Drawn, OnEvent
from dalembert.inverse.experiments.blocks import USUAL, blocks_of_records
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.experiments.experiments import placed
from dalembert.inverse.experiments.joined import joined
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.identify import identify
from dalembert.inverse.likelihood.guesses import guessed
from dalembert.inverse.likelihood.likelihood import Likelihood, likelihood_of
from dalembert.inverse.likelihood.placing import Noise
from dalembert.inverse.posterior.conclusions import contradictions, findings, inherited
from dalembert.inverse.posterior.convergence import convergence
from dalembert.inverse.posterior.modes import Modes, modes
from dalembert.inverse.posterior.posterior import Posterior
from dalembert.inverse.posterior.preconditioning import centred, has_jacobian
from dalembert.inverse.posterior.remembered import Remembered
from dalembert.inverse.posterior.samplers.affine_invariant import AffineInvariant
from dalembert.inverse.posterior.samplers.delayed_acceptance import DelayedAcceptance
from dalembert.inverse.posterior.samplers.nuts import NUTS
from dalembert.inverse.posterior.samplers.sampler import Chains, Length, OnDraws, Sampler
from dalembert.inverse.posterior.separate_modes import separate_modes
from dalembert.inverse.posterior.unprior import without_priors
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose
from dalembert.kinds import named
from dalembert.parameters import Parameter, Parameters
from dalembert.priors import AnyPrior, LogUniform
from dalembert.surrogate.scheme import Scheme

MOST_VALUES = 2e7  # log-likelihoods of single values that are kept: 160 MB
REPLICAS = 400  # draws whose responses with simulated noise are kept
TOGETHER = 256  # draws of which log-likelihoods are computed at once
SAMPLERS = "dalembert.inverse.posterior.samplers"


@takes_executor
def sample(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None = None,
    *,
    noise: Noise | None = None,
    weights: ArrayLike | Mapping[str, ArrayLike] | None = None,
    priors: Mapping[str, AnyPrior] | None = None,
    sampler: Sampler | str | None = None,
    surrogate: Scheme | bool | None = None,
    start: Fit | Mapping[str, float] | ArrayLike | None = None,
    chains: int = 4,
    draws: int = 1000,
    warmup: int = 500,
    seed: int = 0,
    blocks: int = USUAL,
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> Posterior:
    """Draw parameters from their posterior distribution p(parameters | data) ∝ p(data | parameters) p(parameters).

    Parameters
    ----------
    model : ForwardModel or sequence of Experiment
        Its parameters have the priors that they declare (``Parameter.prior``); uniform ones within their bounds if they
        declare none.
    data : Measurements, optional
        Left out with experiments, which have their own.
    noise : NoiseModel, its name, mapping of channel to NoiseModel, or EstimatedNoise, optional
        As in :func:`likelihood`. Parameters of the noise are sampled, too.
    weights : array, or mapping of experiments to arrays, optional
        1/variance of the values, in place of the data's deviations.
    priors : mapping of str to prior, optional
        In place of those that parameters declare, also of noise parameters: ``{"noise.x.deviation": HalfNormal(0.1)}``.
        Deviations of noise are log-uniform within their bounds if nothing is given.
    sampler : NUTS, AffineInvariant, DelayedAcceptance or their names, optional
        :class:`NUTS` for models with a jacobian, else :class:`AffineInvariant`.
    surrogate : TotalDegree, Tensor, Adaptive or bool, optional
        A Chebyshev surrogate proposes the draws, and the model decides (:class:`DelayedAcceptance`): for models that
        cost seconds. ``True`` for one of relative error 1e-4.
    start : Fit, mapping by name, or array of shape (parameters,), optional
        Where the posterior is large; identified by least squares if not given.
    chains, draws, warmup : int
        ``draws`` of each of ``chains`` are kept, after ``warmup`` that are not.
    seed : int
        All random numbers follow from it.
    blocks : int
        Blocks of neighbouring samples of each record, whose log densities after all other values are kept for
        :func:`compare_models`.
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.inverse.events`) as it happens.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, such as ``"tcp://10.0.0.1:8786"``, or a client of one, to which chains and batches
        go.

    Returns
    -------
    Posterior

    Raises
    ------
    DataError
        For data that do not fit the model.
    InputError
        For unknown names, a sampler whose package is not installed, priors that are not proper.
    SolveError
        If the start cannot be simulated, or a surrogate is too inaccurate.

    Notes
    -----
    Samplers move in coordinates without bounds, z = logit((p − lower)/(upper − lower)), of ln p for parameters whose
    logarithm is searched; the Jacobian of the map is part of the density. They are preconditioned by the Cholesky
    factor of JᵀΣ⁻¹J and the curvature of the priors at the mode, so that the posterior is nearly round.

    Further modes are searched from the ends of the fit's starts and from local maxima among points all over the
    prior. Each mode of at least 1 % of the probability has a chain, if there are enough chains. If no chain connects
    two modes, the finding ``separate-modes`` is an error.

    Source: A. Gelman and others, Bayesian Data Analysis, third edition, 2013, chapters 11 and 12.

    Examples
    --------
    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0.0, 1.0, 11)
    >>> line = PythonModel(lambda slope: slope * times, {"slope": (0.0, 4.0)}, ["x"], times)
    >>> data = Measurements.of(times, {"x": 2 * times}, deviations=0.1)
    >>> posterior = sample(line, data, chains=2, draws=200, warmup=100)
    >>> exact = 0.1 / np.sqrt(np.sum(times**2))
    >>> bool(abs(posterior.deviations[0] - exact) < 0.15 * exact)
    True
    """
    counts = {"chains": chains, "draws": draws, "warmup": warmup, "seed": seed, "blocks": blocks}
    for name, number in counts.items():
        check_whole("sample", name, number, {"seed": 0, "blocks": 2}.get(name, 1))
    chosen = _sampler(sampler, surrogate)
    if chosen is not None:
        chosen.check()
    whole, measured, known, _ = joined("sample", placed(model, executor), data, weights)
    journal = Journal(len(measured.coordinate.values), on_event)
    problem = pose(whole, measured, known, journal, noise_known=True)
    likely = likelihood_of(problem, noise, weighted=weights is not None)
    parameters = with_priors(likely, priors)
    vector, fit = _start(model, data, weights, likely, start, seed, on_event, executor)
    differentiable = has_jacobian(likely, vector)
    chosen = chosen or (NUTS() if differentiable else AffineInvariant())
    chosen.check()
    if chosen.gradients:
        check_derivatives(likely.problem.model, vector[: len(likely.problem.model.parameters)])
        if not differentiable:
            raise InputError(
                f"sample: the sampler {chosen.name!r} needs a jacobian, which the model does not return; use the "
                "sampler 'affine-invariant'"
            )
    around = centred(likely, parameters, vector, gradients=differentiable)
    length = Length(chains, draws, warmup, seed)
    ends = [] if fit is None else [start.end for start in fit.starts if np.isfinite(start.fitness)]
    known_noise = weights is not None or problem.data.deviations is not None
    found_modes = modes(around, ends, known_noise=known_noise, gradients=differentiable, draws=length.total, seed=seed)
    # A surrogate's draws are vectors that the model has simulated: what it is asked again costs nothing.
    remembered = Remembered(problem.model) if isinstance(chosen, DelayedAcceptance) else None
    own = problem if remembered is None else replace(problem, model=remembered, journal=Journal(problem.samples))
    found_modes = found_modes.of(own)
    found = chosen.sampled(found_modes, length, _announced(on_event))
    result = _result(found_modes, found, chosen, length, blocks)
    simulations = problem.journal.simulations + found.simulations
    simulations += 0 if remembered is None else remembered.simulations
    doubts = inherited(fit, likely, usual=noise is None)
    return replace(result, simulations=simulations, findings=(*result.findings, *doubts))


def _result(modes: Modes, found: Chains, sampler: Sampler, length: Length, blocks: int) -> Posterior:
    """The result of the draws, with what is computed at them."""
    around = modes.best
    target = around.target
    parameters, vectors = target.parameters, target.vectors(found.places)
    flat = vectors.reshape(-1, len(parameters))
    places = target.likelihood.places
    kept = _spaced(len(flat), int(MOST_VALUES // max(1, len(places.row))))
    replicated = _spaced(len(flat), REPLICAS)
    diagnostics = convergence(vectors)
    likely = target.likelihood
    block_of = _blocks(likely, blocks)
    experiment_of = np.unique(places.experiment, return_inverse=True)[1].ravel()
    groups = np.arange(len(places.row)), block_of, experiment_of
    single, of_blocks, of_experiments = _left_out(likely, flat[kept], groups)
    settings = {
        "chains": length.chains,
        "draws": length.draws,
        "warmup": length.warmup,
        "seed": length.seed,
        "data": target.problem.data.fingerprint,
        "units": dict(target.problem.data.source_units),
        "priors": {item.name: str(item.prior or item.distribution) for item in parameters},
    }
    return Posterior(
        parameters=parameters,
        draws=vectors,
        log_density=found.log_density,
        statistics=found.statistics,
        r_hat=diagnostics.r_hat,
        bulk=diagnostics.bulk,
        tail=diagnostics.tail,
        errors=diagnostics.error,
        mode=around.vector,
        linear_deviations=around.deviations,
        log_likelihood=single,
        kept=kept,
        experiments=tuple(map(str, places.experiment)),
        channels=tuple(map(str, places.channel)),
        rows=np.asarray(places.row),
        blocks=block_of,
        block_log_likelihood=of_blocks,
        experiment_log_likelihood=of_experiments,
        correlated=any(channel.whitening is not None for channel in likely.channels),
        replicas=likely.replicas(flat[replicated], length.seed),
        replicated=replicated,
        data=target.problem.data,
        parts=tuple(getattr(around.target.problem.model, "parts", ())),
        sampler=type(sampler).__name__,
        warmup=length.warmup,
        simulations=0,
        provenance=provenance(target.problem.model, sampler, **settings),
        findings=(
            *separate_modes(modes, found.places, sampler),
            *found.findings,
            *contradictions(around),
            *findings(parameters, flat),
        ),
    )


def _spaced(count: int, most: int) -> np.ndarray:
    """Numbers of at most some of a count of draws, evenly spaced."""
    return np.unique(np.linspace(0, count - 1, min(count, max(most, 1))).astype(int))


def _left_out(likely: Likelihood, vectors: np.ndarray, groups: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Log densities of groups of values after all others, (vectors, groups) each; equal vectors are simulated once."""
    distinct, back = np.unique(vectors, axis=0, return_inverse=True)
    parts = np.array_split(distinct, max(1, len(distinct) // TOGETHER))
    found = zip(*(likely.left_out(part, *groups) for part in parts), strict=True)
    return [np.concatenate(one)[back.ravel()] for one in found]


def _blocks(likely: Likelihood, blocks: int) -> np.ndarray:
    """Number of the block of each value, (values,): of at most some blocks of each record."""
    problem = likely.problem
    parts = getattr(problem.model, "parts", ())
    numbers = blocks_of_records(problem.weights > 0, parts, lambda samples: min(blocks, samples))
    return numbers.ravel()[np.concatenate([channel.series.rows for channel in likely.channels])]


def with_priors(likely: Likelihood, priors: Mapping[str, AnyPrior] | None) -> Parameters:
    """Parameters of a likelihood with the priors that they declare, or that are given in their place."""
    given = dict(priors or {})
    for name in given:
        likely.parameters.check_name(name, where="sample: priors")
    noise = set(likely.noise_parameters.names)

    def prior_of(item: Parameter) -> Parameter:
        if item.name in given:
            return replace(item, prior=given[item.name], deviation=None)
        if item.name in noise and item.prior is None and item.logarithmic:
            return replace(item, prior=LogUniform(item.lower, item.upper))
        return item

    return Parameters(tuple(map(prior_of, likely.parameters.items)), likely.parameters.fixed)


def _sampler(given: Sampler | str | None, surrogate: Scheme | bool | None) -> Sampler | None:
    """The sampler that is asked for; None where the model decides."""
    if isinstance(given, str):
        known = named(SAMPLERS, Sampler)
        require_known("sampler", given, known)
        given = known[given]()
    if given is not None and not isinstance(given, Sampler):
        raise InputError(f"sample: sampler is {shown(given)}; expected a sampler such as NUTS(), or its name")
    if surrogate is None or surrogate is False:
        return given
    if given is not None and not isinstance(given, DelayedAcceptance):
        raise InputError(
            f"sample: surrogate and the sampler {given.name!r} were given; a surrogate proposes draws of the sampler "
            "'delayed-acceptance'. Leave one of them out"
        )
    sampler = given or DelayedAcceptance()
    if surrogate is True:
        return sampler
    if not isinstance(surrogate, Scheme):
        raise InputError(f"sample: surrogate is {shown(surrogate)}; expected a scheme such as TotalDegree(4), or True")
    return replace(sampler, scheme=surrogate)


def _start(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None,
    weights: Any,
    likely: Likelihood,
    start: Fit | Mapping[str, float] | ArrayLike | None,
    seed: int,
    on_event: OnEvent | None,
    executor: Executor,
) -> tuple[np.ndarray, Fit | None]:
    """Where the posterior is searched, (parameters,), and the fit that it comes from."""
    own, noise = likely.problem.model.parameters, likely.noise_parameters
    estimated: Mapping[str, float] = {}
    fit = None
    if isinstance(start, Fit):
        fit, estimated = start, {} if start.noise is None else start.noise.estimates
        fit.needs_one_run("sample")
        vector = own.real_vector({name: fit.parameters.mapping(fit.values)[name] for name in own.names})
    elif start is None:
        known = weights is not None or likely.problem.data.deviations is not None
        posed = model if known else without_priors(model)
        fit = identify(posed, data, weights=weights, seed=seed, on_event=on_event, executor=executor)
        vector = fit.values
    else:
        vector = own.start_vector(start)
    vector = own.clip(vector)
    sizes = _guesses(likely, vector)
    sizes |= {name: value for name, value in estimated.items() if name in sizes}
    return np.concatenate([vector, noise.clip(noise.vector(sizes))]), fit


def _guesses(likely: Likelihood, vector: np.ndarray) -> dict[str, float]:
    """Noise parameters by the residuals at a vector of the model (parameters,); the usual ones if it fails there."""
    noise, response = likely.noise_parameters, likely.problem.responses(vector[None])[0]
    values = guessed(likely.channels, noise, likely.problem, response) if np.all(np.isfinite(response)) else noise.start
    return dict(zip(noise.names, values.tolist(), strict=True))


def _announced(on_event: OnEvent | None) -> OnDraws:
    """A function that announces each hundredth of the draws; threads may call it, and the events are the same."""
    lock, count = Lock(), 0

    def on_draws(draws: int, of: int) -> None:
        nonlocal count
        with lock:
            before, count = count, count + draws
            for part in range(1 + 100 * before // of, 1 + 100 * count // of):
                if on_event is not None:
                    on_event(Drawn(part * of // 100, of))

    return on_draws
