"""Draws of the chains, and the posterior with all that is computed at them."""

from dataclasses import dataclass, replace

import numpy as np

from dalembert.forward.provenance import provenance
from dalembert.inverse.experiments.blocks import blocks_of_records
from dalembert.inverse.posterior.convergence import convergence
from dalembert.inverse.posterior.model_variants import Remembered
from dalembert.inverse.posterior.modes import PosteriorModes
from dalembert.inverse.posterior.posed import Length
from dalembert.inverse.posterior.posterior import Posterior
from dalembert.inverse.posterior.posterior_findings import contradictions, draw_findings, separate_modes
from dalembert.inverse.posterior.samplers.delayed_acceptance import DelayedAcceptance
from dalembert.inverse.posterior.samplers.sampler import Chains, OnDraws, Sampler
from dalembert.inverse.problem.journal import Journal

MOST_VALUES = 2e7  # log-likelihoods of single values that are kept: 160 MB
REPLICAS = 400  # draws whose responses with simulated noise are kept
TOGETHER = 256  # draws of which log-likelihoods are computed at once


@dataclass(frozen=True, eq=False)
class DrawnChains:
    """Chains, and what they were drawn with; ``journal`` counts the simulations of all steps before the draws."""

    modes: PosteriorModes
    chains: Chains
    sampler: Sampler
    length: Length
    journal: Journal


def draw(modes: PosteriorModes, sampler: Sampler, length: Length, on_draws: OnDraws) -> DrawnChains:
    """Draw the chains from starts in all modes."""
    problem = modes.best.target.problem
    if isinstance(sampler, DelayedAcceptance):
        # Its draws are vectors that the model has simulated: remembered, they cost nothing in what follows.
        modes = modes.of(replace(problem, model=Remembered(problem.model), journal=Journal(problem.samples)))
    return DrawnChains(modes, sampler.sampled(modes, length, on_draws), sampler, length, problem.journal)


def posterior_of(drawn: DrawnChains, blocks: int) -> Posterior:
    """Return the posterior with densities, replicas and findings at the draws."""
    best, chains, length = drawn.modes.best, drawn.chains, drawn.length
    target = best.target
    likelihood, problem, parameters = target.likelihood, target.problem, target.parameters
    vectors, places = target.vectors(chains.places), likelihood.places
    flat = vectors.reshape(-1, len(parameters))
    kept = _spaced(len(flat), int(MOST_VALUES // max(1, len(places.row))))
    replicated = _spaced(len(flat), REPLICAS)
    diagnostics = convergence(vectors)
    of_records = blocks_of_records(
        likelihood.problem.weights > 0,
        getattr(likelihood.problem.model, "parts", ()),
        lambda samples: min(blocks, samples),
    )
    block_of = of_records.ravel()[np.concatenate([channel.series.rows for channel in likelihood.channels])]
    experiment_of = np.unique(places.experiment, return_inverse=True)[1].ravel()
    groups = np.arange(len(places.row)), block_of, experiment_of
    # A Metropolis chain repeats a vector where it rejects: each distinct one is simulated once.
    distinct, back = np.unique(flat[kept], axis=0, return_inverse=True)
    parts = np.array_split(distinct, max(1, len(distinct) // TOGETHER))
    densities = zip(*(likelihood.left_out(part, *groups) for part in parts), strict=True)
    of_values, of_blocks, of_experiments = [np.concatenate(of_parts)[back.ravel()] for of_parts in densities]
    replicas = likelihood.replicas(flat[replicated], length.seed)
    findings = (
        *separate_modes(drawn.modes, chains.places, drawn.sampler),
        *chains.findings,
        *contradictions(best),
        *draw_findings(parameters, flat),
    )
    remembered = problem.model.simulations if isinstance(problem.model, Remembered) else 0
    settings = {
        "chains": length.chains,
        "draws": length.draws,
        "warmup": length.warmup,
        "seed": length.seed,
        "data": problem.data.fingerprint,
        "units": dict(problem.data.source_units),
        "priors": {item.name: str(item.prior or item.distribution) for item in parameters},
    }
    return Posterior(
        parameters=parameters,
        draws=vectors,
        log_density=chains.log_density,
        statistics=chains.statistics,
        r_hat=diagnostics.r_hat,
        bulk=diagnostics.bulk,
        tail=diagnostics.tail,
        errors=diagnostics.error,
        mode=best.vector,
        linear_deviations=best.deviations,
        log_likelihood=of_values,
        kept=kept,
        experiments=tuple(map(str, places.experiment)),
        channels=tuple(map(str, places.channel)),
        rows=np.asarray(places.row),
        blocks=block_of,
        block_log_likelihood=of_blocks,
        experiment_log_likelihood=of_experiments,
        correlated=any(channel.whitening is not None for channel in likelihood.channels),
        replicas=replicas,
        replicated=replicated,
        data=problem.data,
        parts=tuple(getattr(problem.model, "parts", ())),
        sampler=type(drawn.sampler).__name__,
        warmup=length.warmup,
        simulations=drawn.journal.simulations + chains.simulations + remembered,
        provenance=provenance(problem.model, drawn.sampler, **settings),
        findings=findings,
    )


def _spaced(count: int, most: int) -> np.ndarray:
    """Numbers of at most ``most`` of ``count`` draws, evenly spaced."""
    return np.unique(np.linspace(0, count - 1, min(count, max(most, 1))).astype(int))
