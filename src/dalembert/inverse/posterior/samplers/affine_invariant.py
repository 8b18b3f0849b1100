"""The affine-invariant ensemble sampler, by emcee."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.arguments import limited
from dalembert.errors import SolveError
from dalembert.inverse.posterior.packages import package
from dalembert.inverse.posterior.samplers.sampler import Chains, Length, OnDraws, Sampler
from dalembert.inverse.posterior.target import Target

TRIES = 20
"""Times that walkers whose start cannot be simulated get another one."""


@dataclass(frozen=True)
class AffineInvariant(Sampler):
    """Ensemble of walkers that move along their differences: needs no gradients (emcee).

    Each walker is a chain of the result, so there are at least four times as many chains as parameters.

    Parameters
    ----------
    walkers : int, optional
        The larger of ``chains`` and 4 walkers for each parameter if not given.
    thin : int
        Steps of the ensemble for each draw.

    Notes
    -----
    Moves by differential evolution and its snooker variant, 4 to 1. All walkers of a half-step are one batch.

    Source: D. Foreman-Mackey and others, emcee: the MCMC hammer, Publications of the Astronomical Society of the
    Pacific 125 (2013).
    """

    name: ClassVar[str] = "affine-invariant"
    gradients: ClassVar[bool] = False

    walkers: int | None = limited(None, least=4)
    thin: int = limited(5, least=1)

    def check(self) -> None:
        package("emcee", "the sampler AffineInvariant")

    def sampled(self, target: Target, length: Length, on_draws: OnDraws) -> Chains:
        """Sample one ensemble.

        Raises
        ------
        SolveError
            If too few starts can be simulated.
        """
        emcee, size = package("emcee", "the sampler AffineInvariant"), len(target.centre)
        walkers = self.walkers or max(length.chains, 4 * size)
        walkers = max(walkers + walkers % 2, 2 * size + 2)
        moves = [(emcee.moves.DEMove(), 0.8), (emcee.moves.DESnookerMove(), 0.2)]
        sampler = emcee.EnsembleSampler(walkers, size, target.evaluate, vectorize=True, moves=moves)
        random = np.random.RandomState(length.chain_seed(0))  # emcee takes the state of this one
        starts = _starts(target, walkers, random)
        state = emcee.State(starts, random_state=random.get_state())
        total = length.warmup + length.draws
        for _ in sampler.sample(state, iterations=total, thin_by=self.thin):
            on_draws(walkers, walkers * total)
        places, density = sampler.get_chain(discard=length.warmup), sampler.get_log_prob(discard=length.warmup)
        accepted = np.broadcast_to((sampler.acceptance_fraction)[:, None], density.T.shape).copy()
        return Chains(np.moveaxis(places, 0, 1), density.T, {"acceptance_rate": accepted})


def _starts(target: Target, walkers: int, random: np.random.RandomState) -> np.ndarray:
    """Starts (walkers, parameters) that can be simulated.

    Raises
    ------
    SolveError
    """
    found = random.standard_normal((walkers, len(target.centre)))
    for _ in range(TRIES):
        failed = ~np.isfinite(target.evaluate(found))
        if not np.any(failed):
            return found
        found[failed] = 0.5 * random.standard_normal((int(np.sum(failed)), len(target.centre)))
    raise SolveError(
        f"the sampler AffineInvariant found no {walkers} starts that can be simulated. Narrow the bounds to where the "
        "model can be run"
    )
