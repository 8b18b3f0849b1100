"""Delayed acceptance: a surrogate proposes, the model decides."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from scipy.special import erfc

from dalembert.arguments import limited
from dalembert.errors import SolveError
from dalembert.findings import Finding
from dalembert.inverse.posterior.modes import PosteriorModes
from dalembert.inverse.posterior.posed import Length
from dalembert.inverse.posterior.samplers.sampler import Chains, OnDraws, Sampler, moved
from dalembert.inverse.posterior.surrogate_model import SurrogateModel, with_surrogate
from dalembert.inverse.posterior.target import Target
from dalembert.surrogate import Adaptive
from dalembert.surrogate.scheme import Scheme

PILOT = 32  # draws of the surrogate's posterior that test it
# Largest standard deviation of the surrogate's error in the log density; half of the proposals are then accepted.
LIMIT = 1.0
BURN = 20  # decisions of the model in each chain before the first draw that is kept
WANTED = 0.3  # acceptance of the random walk on the surrogate to which its step is adapted
EDGE = 0.02  # distance to a side of the surrogate's box, relative to its width, within which the box cuts the posterior


@dataclass(frozen=True)
class DelayedAcceptance(Sampler):
    """Metropolis sampler whose proposals come from a surrogate's posterior, and whose acceptance is the model's.

    A short random walk on the surrogate makes each proposal y of x. It is accepted with the probability
    min(1, π(y) π*(x)/(π(x) π*(y))), with the posterior π of the model and π* of the surrogate. So the draws are those
    of the model's posterior, however inexact the surrogate is: its error only lowers the acceptance. A draw costs at
    most one simulation.

    Parameters
    ----------
    scheme : TotalDegree, Tensor or Adaptive
        Of the Chebyshev surrogate, see :func:`dalembert.surrogate.fit`.
    walk : int, optional
        Steps of the random walk for a proposal; 5 for each parameter if not given.

    Notes
    -----
    Source: J. A. Christen and C. Fox, Markov chain Monte Carlo using an approximation, Journal of Computational and
    Graphical Statistics 14 (2005).
    """

    name: ClassVar[str] = "delayed-acceptance"
    gradients: ClassVar[bool] = False

    scheme: Scheme = field(default_factory=lambda: Adaptive(tolerance=1e-4))
    walk: int | None = limited(None, least=1)

    def sampled(self, modes: PosteriorModes, length: Length, on_draws: OnDraws) -> Chains:
        """Sample the chains of each mode together: their simulations are batches, and each mode has its surrogate.

        Raises
        ------
        SolveError
            If a surrogate is too inaccurate, or its runs fail.
        """
        counts = np.bincount(modes.of_chains(length.chains), minlength=len(modes.targets))
        parts: list[tuple[Chains, Target]] = []
        for number, (target, count) in enumerate(zip(modes.targets, counts, strict=True)):
            if count:
                part, cheap = self._of_mode(target, replace(length, chains=int(count)), number, length.chains, on_draws)
                parts.append((replace(part, places=moved(part.places, target, modes.best.target)), cheap))
        if len(parts) == 1:
            places, density, accepted = parts[0][0].places, parts[0][0].log_density, parts[0][0].statistics["accepted"]
        else:
            places = np.concatenate([part.places for part, _ in parts])
            density = np.concatenate([part.log_density for part, _ in parts])
            accepted = np.concatenate([part.statistics["accepted"] for part, _ in parts])
        cut = [finding for part, _ in parts for finding in part.findings]
        return Chains(
            places,
            density,
            {"accepted": accepted},
            findings=(_effort([surrogate_target for _, surrogate_target in parts], accepted), *cut),
        )

    def _of_mode(
        self, target: Target, length: Length, number: int, chains: int, on_draws: OnDraws
    ) -> tuple[Chains, Target]:
        """Chains that start in one mode, and the target with the surrogate around it; of ``chains`` in all."""
        random = np.random.default_rng(length.chain_seed(number))
        rows = target.coordinates.slope(target.centre)[:, None] * target.factor
        vector = target.coordinates.vectors(target.centre)
        # The box of the surrogate follows from the linear deviations of the parameters at the mode.
        cheap = with_surrogate(target, vector, np.sqrt(np.sum(rows**2, axis=1)), self.scheme, length.seed)
        walk = _Walk(cheap, self.walk or 5 * len(target.centre), random)
        states = walk.started(length.chains, length.warmup)
        error, acceptance = _error(target, cheap, walk, states)
        if not error <= LIMIT:
            raise SolveError(_too_inaccurate(error, acceptance, cheap))
        exact = target.evaluate(states.places)
        keep: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
        for _ in range(BURN + length.draws):
            proposed = walk.walked(states)
            proposed_exact = target.evaluate(proposed.places)
            with np.errstate(invalid="ignore"):
                # ln of π(y) π*(x)/(π(x) π*(y)). The walk leaves π* invariant, so π* takes the place of the proposal
                # density.
                ratio = (proposed_exact - exact) - (proposed.density - states.density)
            taken = np.log(random.random(length.chains)) < np.nan_to_num(ratio, nan=-np.inf, posinf=np.inf)
            states, exact = states.where(taken, proposed), np.where(taken, proposed_exact, exact)
            keep.append((states.places, exact, taken))
            on_draws(length.chains, chains * (BURN + length.draws))
        places, density, accepted = (np.stack(part, axis=1)[:, BURN:] for part in zip(*keep, strict=True))
        return Chains(places, density, {"accepted": accepted}, findings=tuple(_cuts(cheap, places))), cheap


@dataclass(frozen=True, eq=False)
class _States:
    """Places (chains, parameters) of chains, and the log density (chains,) of the surrogate there."""

    places: np.ndarray
    density: np.ndarray

    def where(self, mask: np.ndarray, other: "_States") -> "_States":
        """Others where a mask (chains,) is true."""
        places = np.where(mask[:, None], other.places, self.places)
        return _States(places, np.where(mask, other.density, self.density))


@dataclass
class _Walk:
    """Random-walk Metropolis on a surrogate; its step is adapted in the warm-up alone."""

    target: Target
    steps: int
    random: np.random.Generator
    scale: float = field(init=False)

    def __post_init__(self) -> None:
        # 2.4/√d suits a random walk on a normal density (Gelman, Roberts & Gilks 1996).
        self.scale = 2.4 / np.sqrt(len(self.target.centre))

    def started(self, chains: int, warmup: int) -> _States:
        """States after a warm-up, which begins near the mode."""
        places = 0.5 * self.random.standard_normal((chains, len(self.target.centre)))
        states = _States(places, self.target.evaluate(places))
        origin = np.zeros_like(places)
        states = states.where(~np.isfinite(states.density), _States(origin, self.target.evaluate(origin)))
        for number in range(max(warmup, 100)):
            states, accepted = self._step(states)
            # Robbins & Monro: steps ∝ 1/√n. Adaptation ends with the warm-up, else π* would not stay invariant.
            self.scale *= float(np.exp((accepted - WANTED) / np.sqrt(1 + number)))
        return states

    def walked(self, states: _States) -> _States:
        """States some steps later."""
        for _ in range(self.steps):
            states, _ = self._step(states)
        return states

    def _step(self, states: _States) -> tuple[_States, float]:
        places = states.places + self.scale * self.random.standard_normal(states.places.shape)
        proposed = _States(places, self.target.evaluate(places))
        with np.errstate(invalid="ignore"):
            ratio = proposed.density - states.density
        taken = np.log(self.random.random(len(places))) < np.nan_to_num(ratio, nan=-np.inf, posinf=np.inf)
        return states.where(taken, proposed), float(np.mean(taken))


def _error(target: Target, cheap: Target, walk: _Walk, states: _States) -> tuple[float, float]:
    """Standard deviation of the surrogate's error in the log density over its posterior, and the expected acceptance.

    For normal errors of the deviation s the acceptance is erfc(s/2).
    """
    pilot = []
    while len(pilot) * len(states.places) < PILOT:
        states = walk.walked(states)
        pilot.append(states)
    places, density = (
        np.concatenate([state.places for state in pilot]),
        np.concatenate([state.density for state in pilot]),
    )
    error = target.evaluate(places) - density
    if not np.all(np.isfinite(error)):
        return np.inf, 0.0
    spread = float(np.std(error))
    # For e ~ N(0, s²) at both ends, E min(1, e^Δ) with Δ ~ N(−s², 2 s²) is erfc(s/2).
    return spread, float(erfc(spread / 2))


def _too_inaccurate(error: float, acceptance: float, cheap: Target) -> str:
    model = cheap.problem.model
    assert isinstance(model, SurrogateModel)
    surrogate = model.surrogate
    size = f"by ±{error:.2g}" if np.isfinite(error) else "without limit"
    return (
        f"the surrogate of {surrogate.runs} runs is too inaccurate: over {PILOT} draws of its posterior, its log "
        f"density is wrong {size}, more than {LIMIT:g}, and about {100 * acceptance:.0f} % of the proposals would be "
        f"accepted. Improve it ({surrogate.improvement}), narrow the bounds, or sample without a surrogate"
    )


def _effort(surrogates: Sequence[Target], accepted: np.ndarray) -> Finding:
    """Return the note on the simulations of the surrogates, and on the proposals that the model accepted."""
    part = float(np.mean(accepted))
    runs = 0
    for cheap in surrogates:
        assert isinstance(cheap.problem.model, SurrogateModel)
        runs += cheap.problem.model.surrogate.runs
    what = "A surrogate" if len(surrogates) == 1 else f"{len(surrogates)} surrogates"
    message = (
        f"{what} of {runs} simulations proposed the draws; the model accepted {100 * part:.0f} % of the proposals."
    )
    return Finding("delayed-acceptance", "note", {"acceptance": part, "runs": runs}, message)


def _cuts(cheap: Target, places: np.ndarray) -> Iterator[Finding]:
    """Yield findings on sides of the surrogate's box that cut the posterior."""
    model = cheap.problem.model
    assert isinstance(model, SurrogateModel)
    polynomial, problem = model.surrogate.polynomial, model.problem
    vectors = cheap.vectors(places)[..., : len(problem.model.parameters)]
    inside = (problem.search.points(vectors) - polynomial.lower) / (polynomial.upper - polynomial.lower)
    for k, name in enumerate(problem.model.parameters.names):
        cut = (polynomial.lower[k] > problem.search.lower[k], polynomial.upper[k] < problem.search.upper[k])
        near = (inside[..., k] < EDGE, inside[..., k] > 1 - EDGE)
        share = max(
            (float(np.mean(inside_edge)) for inside_edge, is_cut in zip(near, cut, strict=True) if is_cut), default=0.0
        )
        if share > 0.001:
            yield Finding(
                "surrogate-box",
                "warning",
                {"parameter": name, "share": share},
                f"The box of the surrogate cuts the posterior of {name!r}.",
                "Sample without a surrogate, or narrow the bounds to where the posterior is.",
            )
