"""The affine-invariant ensemble sampler, by emcee."""

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from dalembert.arguments import limited
from dalembert.errors import SolveError
from dalembert.inverse.posterior.modes import PosteriorModes
from dalembert.inverse.posterior.packages import package
from dalembert.inverse.posterior.posed import Length
from dalembert.inverse.posterior.samplers.sampler import Chains, OnDraws, Sampler, moved

TRIES = 20  # times that walkers whose start cannot be simulated get another one


@dataclass(frozen=True)
class AffineInvariant(Sampler):
    """Ensemble of walkers that move along their differences: needs no gradients (emcee).

    Each walker is a chain of the result, so there are at least four times as many chains as parameters.

    Parameters
    ----------
    walkers : int, optional
        The larger of ``chains`` and 4 walkers for each parameter and mode if not given.
    thin : int
        Steps of the ensemble for each draw.

    Notes
    -----
    Moves by differential evolution and its snooker variant, 4 to 1. All walkers of a half-step are one batch. Where the
    posterior has several modes, walkers start in each of them, and every fifth move is from one mode to another.

    Sources: D. Foreman-Mackey and others, emcee: the MCMC hammer, Publications of the Astronomical Society of the
    Pacific 125 (2013). H. Tjelmeland and B. K. Hegstad, Mode jumping proposals in MCMC, Scandinavian Journal of
    Statistics 28 (2001).
    """

    name: ClassVar[str] = "affine-invariant"
    gradients: ClassVar[bool] = False
    jumps: ClassVar[bool] = True

    walkers: int | None = limited(None, least=4)
    thin: int = limited(5, least=1)

    def check(self) -> None:
        package("emcee", "the sampler AffineInvariant")

    def sampled(self, modes: PosteriorModes, length: Length, on_draws: OnDraws) -> Chains:
        """Sample one ensemble.

        Raises
        ------
        SolveError
            If too few starts can be simulated.
        """
        target = modes.best.target
        emcee, size = package("emcee", "the sampler AffineInvariant"), len(target.centre)
        # A move along differences needs at least twice as many walkers as parameters, an even number for two halves.
        walkers = self.walkers or max(length.chains, 4 * size * len(modes.targets))
        walkers = max(walkers + walkers % 2, 2 * size + 2)
        # Differential evolution and its snooker variant, as ter Braak & Vrugt (2008) combine them.
        moves = [(emcee.moves.DEMove(), 0.8), (emcee.moves.DESnookerMove(), 0.2)]
        # Differences of walkers in two modes hardly ever lead from one to the other: a map between them does.
        if len(modes.targets) > 1:
            moves = [(emcee.moves.DEMove(), 0.6), *moves[1:], (emcee.moves.MHMove(partial(_jumped, modes)), 0.2)]
        sampler = emcee.EnsembleSampler(walkers, size, target.evaluate, vectorize=True, moves=moves)
        sampler.log_prob_fn = target.evaluate  # without emcee's wrapper, which prints a traceback of each interrupt
        random = np.random.RandomState(length.chain_seed(0))  # emcee takes the state of this one
        starts = _starts(modes, walkers, random)
        state = emcee.State(starts, random_state=random.get_state())
        total = length.warmup + length.draws
        for _ in sampler.sample(state, iterations=total, thin_by=self.thin):
            on_draws(walkers, walkers * total)
        places, density = sampler.get_chain(discard=length.warmup), sampler.get_log_prob(discard=length.warmup)
        accepted = np.broadcast_to((sampler.acceptance_fraction)[:, None], density.T.shape).copy()
        return Chains(np.moveaxis(places, 0, 1), density.T, {"acceptance_rate": accepted})


def _starts(modes: PosteriorModes, walkers: int, random: np.random.RandomState) -> np.ndarray:
    """Starts (walkers, parameters) that can be simulated, around the modes."""
    target, mode = modes.best.target, modes.of_chains(walkers)
    starts = _around(modes, mode, random.standard_normal((walkers, len(target.centre))))
    for _ in range(TRIES):
        failed = ~np.isfinite(target.evaluate(starts))
        if not np.any(failed):
            return starts
        # Half as far away: the model fails far from the mode rather than near it.
        closer = 0.5 * random.standard_normal((int(np.sum(failed)), len(target.centre)))
        starts[failed] = _around(modes, mode[failed], closer)
    raise SolveError(
        f"the sampler AffineInvariant found no {walkers} starts that can be simulated. Narrow the bounds to where the "
        "model can be run"
    )


def _around(modes: PosteriorModes, mode: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Places (walkers, parameters) around the mode (walkers,) of each, in the coordinates of the best one."""
    result = places.copy()
    for k, target in enumerate(modes.targets):
        result[mode == k] = moved(places[mode == k], target, modes.best.target)
    return result


def _jumped(modes: PosteriorModes, places: np.ndarray, random: np.random.RandomState) -> tuple[np.ndarray, np.ndarray]:
    """Places (walkers, parameters) from one mode to another, and the logarithm of the ratio of volumes (walkers,). The
    map y_j = y_i, with y_i the coordinates in which mode i is round, is affine, and its inverse is proposed as often.
    So the ratio of densities times the determinant of the map decides.
    """
    best, targets, count = modes.best.target, modes.targets, len(modes.targets)
    # ln det of the map from mode i to mode j is ln det factor_j − ln det factor_i.
    sizes = np.array([np.linalg.slogdet(target.factor)[1] for target in targets])
    before = random.randint(count, size=len(places))
    # Uniform among the other modes, so that the way back is proposed with the same probability.
    after = (before + 1 + random.randint(count - 1, size=len(places))) % count
    result = np.empty_like(places)
    for i, j in {*zip(before.tolist(), after.tolist(), strict=True)}:
        walkers = (before == i) & (after == j)
        result[walkers] = moved(moved(places[walkers], best, targets[i]), targets[j], best)
    return result, sizes[after] - sizes[before]
