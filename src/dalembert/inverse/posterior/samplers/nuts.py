"""The No-U-Turn sampler, by nutpie."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from threading import Event
from typing import Any, ClassVar, cast

import numpy as np

from dalembert.arguments import limited
from dalembert.findings import Finding
from dalembert.forward import ensemble
from dalembert.forward.prefetch import on_several_machines
from dalembert.inverse.posterior.modes import PosteriorModes
from dalembert.inverse.posterior.packages import package
from dalembert.inverse.posterior.posed import Length
from dalembert.inverse.posterior.samplers.sampler import Chains, OnDraws, Sampler, moved
from dalembert.inverse.posterior.target import Target
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem

# What is kept of nutpie's statistics.
STATISTICS = {
    "diverging": bool,
    "maxdepth_reached": bool,
    "depth": int,
    "n_steps": int,
    "energy": float,
    "energy_error": float,
    "mean_tree_accept": float,
    "step_size": float,
}


@dataclass(frozen=True)
class NUTS(Sampler):
    """No-U-Turn sampler, a Hamiltonian Monte Carlo method that needs gradients (nutpie).

    Parameters
    ----------
    target_accept : float
        Mean acceptance probability that the step size is adapted to. Larger values give smaller steps and fewer
        divergences.
    max_depth : int
        A draw takes at most 2^max_depth steps.

    Notes
    -----
    Source: M. D. Hoffman and A. Gelman, The No-U-Turn sampler, Journal of Machine Learning Research 15 (2014).
    """

    name: ClassVar[str] = "nuts"
    gradients: ClassVar[bool] = True

    target_accept: float = limited(0.8, above=0, below=1)
    max_depth: int = limited(10, least=1)

    def check(self) -> None:
        package("nutpie", "the sampler NUTS")

    def sampled(self, modes: PosteriorModes, length: Length, on_draws: OnDraws) -> Chains:
        """Sample the chains, several at a time in threads, or on the workers of a cluster.

        Each chain moves in the coordinates of the mode in which it starts.

        Raises
        ------
        SolveError
            If no start of a chain can be simulated.
        """
        stop, several = Event(), range(length.chains)
        best = modes.best.target
        targets = [modes.targets[k] for k in modes.of_chains(length.chains)]
        chain_of = partial(_chain, self, length, on_draws, stop)
        if on_several_machines(best.problem.model):
            problem = replace(best.problem, model=cast(Any, None), journal=Journal(best.problem.samples))
            alone = [target.of(problem) for target in targets]
            ahead = best.problem.prefetched(partial(_on_worker, alone, self, length), several)
            chains = [chain_of(targets[chain], chain) for chain in ahead]
        else:
            chains = list(ensemble(partial(_apart, targets, chain_of), several, on_stop=stop.set))
        placed = zip(chains, targets, strict=True)
        chains = [replace(chain, places=moved(chain.places, target, best)) for chain, target in placed]
        statistics = {name: np.concatenate([part.statistics[name] for part in chains]) for name in STATISTICS}
        return Chains(
            np.concatenate([part.places for part in chains]),
            np.concatenate([part.log_density for part in chains]),
            statistics,
            sum(part.simulations for part in chains),
            tuple(_findings(statistics, self.max_depth)),
        )


def _silent(draws: int, of: int) -> None:
    """Take the number of draws and do nothing."""


def _apart(targets: Sequence[Target], chain_of: Callable[[Target, int], Chains], chain: int) -> Chains:
    """A chain with a separate journal, since several threads count."""
    target = targets[chain]
    problem = replace(target.problem, journal=Journal(target.problem.samples))
    result = chain_of(target.of(problem), chain)
    return replace(result, simulations=problem.journal.simulations)


def _on_worker(targets: Sequence[Target], sampler: NUTS, length: Length, problem: MisfitProblem, chain: int) -> None:
    _chain(sampler, length, _silent, Event(), targets[chain].of(problem), chain)


def _chain(sampler: NUTS, length: Length, on_draws: OnDraws, stop: Event, target: Target, chain: int) -> Chains:
    """Sample one chain. nutpie calls Python from a separate thread and ends the process where a function raises. So
    the first error is kept, further calls return at once, and the error is raised at the end.
    """
    nutpie, count = package("nutpie", "the sampler NUTS"), len(target.centre)
    # A density of −∞ ends a trajectory as divergent, so nutpie comes back soon after an error.
    errors: list[BaseException] = []

    def density(place: np.ndarray) -> tuple[float, np.ndarray]:
        if errors or stop.is_set():
            return -np.inf, np.zeros(count)
        try:
            return target.linearise(place)
        except BaseException as error:
            errors.append(error)
            return -np.inf, np.zeros(count)

    def expanded(place: np.ndarray) -> dict[str, np.ndarray]:
        try:
            if not errors:
                on_draws(1, length.total)
        except BaseException as error:
            errors.append(error)
        return {"place": np.array(place)}

    def start(seed: int) -> np.ndarray:
        return np.random.default_rng(seed).standard_normal(count)

    compiled = nutpie.compiled_pyfunc.from_pyfunc(
        count,
        lambda: density,
        lambda *seeds: expanded,
        [np.dtype(float)],
        [(count,)],
        ["place"],
        make_initial_point_fn=start,
    )
    trace = _trace(nutpie, compiled, sampler, length, chain, errors)
    if errors:
        raise errors[0]
    sample_statistics = trace.sample_stats
    if trace.posterior["place"].shape[1] < length.draws:  # nutpie returns what it has when it is interrupted
        raise KeyboardInterrupt
    statistics = {name: sample_statistics[name].values.astype(kind) for name, kind in STATISTICS.items()}
    return Chains(trace.posterior["place"].values, sample_statistics["logp"].values, statistics)


def _trace(nutpie: Any, compiled: Any, sampler: NUTS, length: Length, chain: int, errors: list[BaseException]) -> Any:
    """Result of nutpie; raises the error of the density if that ended it."""
    try:
        return nutpie.sample(
            compiled,
            draws=length.draws,
            tune=length.warmup,
            chains=1,
            cores=1,
            seed=length.chain_seed(chain),
            progress_bar=False,
            save_warmup=False,
            target_accept=sampler.target_accept,
            maxdepth=sampler.max_depth,
        )
    except BaseException:
        if errors:
            raise errors[0] from None
        raise


def _findings(statistics: dict[str, np.ndarray], max_depth: int) -> list[Finding]:
    findings, draws = [], statistics["diverging"].size
    diverging, deep = (int(np.sum(statistics[name])) for name in ("diverging", "maxdepth_reached"))
    if diverging:
        message = f"{diverging} of {draws} draws diverge: the sampler misses parts of the posterior near them."
        advice = (
            "Increase target_accept, for example to 0.95. If draws still diverge, narrow the bounds, or give priors to "
            "parameters that the data do not determine."
        )
        values = {"divergences": diverging, "draws": draws}
        findings.append(Finding("divergent-draws", "warning", values, message, advice))
    if deep > 0.01 * draws:
        message = f"{deep} of {draws} draws end at the largest trajectory of 2^{max_depth} steps."
        advice = "Increase warmup, or max_depth."
        findings.append(Finding("long-trajectories", "warning", {"draws": deep, "depth": max_depth}, message, advice))
    return findings
