"""What a posterior shows of data and priors."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from dalembert.findings import Finding
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.posterior.modes import PosteriorModes
from dalembert.inverse.posterior.posed import PosedPosterior
from dalembert.inverse.posterior.preconditioning import Centred
from dalembert.inverse.posterior.samplers.sampler import Sampler
from dalembert.inverse.posterior.unbounded import UnboundedCoordinates
from dalembert.inverse.problem.prior import ALONE
from dalembert.inverse.problem.prior_conflicts import prior_conflicts
from dalembert.inverse.problem.simulated import named
from dalembert.parameters import Parameters

CLOSE = 0.02  # distance to a bound, relative to that of the bounds, that counts as at the bound
PILED = 0.1  # part of the draws at a bound from which the bound decides; for a flat posterior it is 0.02
# What to do about findings of a fit that concern the draws, where it differs from that of the fit.
ADVICE = {
    "correlated-residuals": "The draws take the noise for independent, so that their intervals are too narrow. Give "
    "noise='autoregressive', or correct the model.",
}
# Findings that correlated noise may explain.
OF_INDEPENDENT_NOISE = {"correlated-residuals", "systematic-residuals", "model-misfit"}


def inherited(fit: Fit | None, posed: PosedPosterior) -> Iterator[Finding]:
    """Yield the doubts of the fit at which the chains start that concern the draws, too."""
    codes = {"correlated-channels"} | ({"misfit-above-noise"} if posed.usual_noise else set())
    if all(channel.whitening is None for channel in posed.likelihood.channels):
        codes |= OF_INDEPENDENT_NOISE
    for finding in fit.doubts if fit is not None else ():
        if finding.code in codes:
            known = replace(finding, advice=ADVICE.get(finding.code, finding.advice))
            yield replace(known, message=_correlated(finding)) if finding.code == "correlated-residuals" else known


def _correlated(finding: Finding) -> str:
    values = finding.values
    message = (
        f"The residuals of {values['channel']!r} are correlated (lag-1 autocorrelation "
        f"{values['autocorrelation']:.2f})."
    )
    if "largest_factor" in values:
        message += f" With correlated noise, deviations are up to {values['largest_factor']:.2g} times as large."
    return message


def contradictions(centred: Centred) -> Iterator[Finding]:
    """Yield findings on priors that contradict the data, by the linearised likelihood at the mode."""
    if centred.data_information is None:
        return
    target = centred.target
    slope = target.coordinates.slope(target.centre)
    _, gradient = target.likelihood.linearise(centred.vector)
    yield from prior_conflicts(target.parameters, centred.vector, slope, centred.data_information, slope * gradient)


def draw_findings(parameters: Parameters, draws: np.ndarray) -> Iterator[Finding]:
    """Yield findings on the posterior from draws (draws, parameters)."""
    # Where draws lie between the bounds, from 0 to 1, in the coordinates of the search.
    logs = UnboundedCoordinates(parameters).logarithmic
    lower, upper, values = (
        np.where(logs, np.log(np.where(logs, column, 1.0)), column)
        for column in (parameters.lower, parameters.upper, draws)
    )
    inside = (values - lower) / (upper - lower)
    for k, item in enumerate(parameters):
        prior = item.distribution
        # The deviation of the prior within the bounds, from quantiles of equal probability.
        quantiles = prior.within(np.linspace(0.005, 0.995, 100), item.lower, item.upper)
        before, after = float(np.std(quantiles)), float(np.std(draws[:, k]))
        if after**2 > ALONE * before**2:
            yield Finding(
                "prior-dominates",
                "warning",
                {"parameters": item.name, "prior": before, "deviation": after},
                f"The data add nothing to the prior of {item.name!r}: its standard deviation is {before:.3g} in the "
                f"prior and {after:.3g} in the posterior.",
                "Check that the prior and the bounds are not too narrow, or measure a quantity that depends on "
                f"{item.name!r}.",
            )
            continue
        for side, near in (("lower", inside[:, k] < CLOSE), ("upper", inside[:, k] > 1 - CLOSE)):
            share, bound = float(np.mean(near)), float(getattr(item, side))
            if share > PILED:
                yield Finding(
                    "posterior-at-bound",
                    "warning",
                    {"parameter": item.name, "side": side, "bound": bound, "share": share},
                    f"{100 * share:.0f} % of the draws of {item.name!r} are at its {side} bound {bound:.6g}.",
                    "Widen the bound if the true value may lie beyond it.",
                )


def separate_modes(modes: PosteriorModes, places: np.ndarray, sampler: Sampler) -> Iterator[Finding]:
    """Yield the finding on modes between which no chain moves. A chain visits a mode where one of its draws, ``places``
    (chains, draws, parameters) in the coordinates of the best mode, is within the distance √(number of parameters) of
    it, in standard deviations: about half of the draws of a normal mode are. Modes that one chain visits are connected.
    """
    if len(modes.targets) < 2:
        return
    points = modes.best.target.points(places)
    distances = np.stack([np.linalg.norm(target.places(points), axis=-1) for target in modes.targets])
    nearest = np.argmin(distances, axis=0)
    inside = distances <= np.sqrt(places.shape[-1])
    visits = np.any(inside, axis=2)  # modes, chains
    mode, chain = np.nonzero(visits)
    count, chains = visits.shape
    # A bipartite graph: modes and chains are nodes, visits are edges. Modes are joined where a path of chains connects
    # them.
    joined = coo_array((np.ones(len(mode)), (mode, count + chain)), shape=(count + chains, count + chains))
    _, group = connected_components(joined, directed=False)
    if len(set(group[:count])) == 1:
        return
    model = modes.best.target.problem.model
    vectors = [centred.vector[: len(model.parameters)] for centred in modes.centred]
    values: dict[str, float] = {"modes": count}
    for number, (vector, share) in enumerate(zip(vectors, modes.shares, strict=True), 1):
        values |= {f"mode_{number}.{name}": float(value) for name, value in model.parameters.mapping(vector).items()}
        values[f"mode_{number}.share"] = float(share)
        values[f"mode_{number}.draws"] = float(np.mean(nearest == number - 1))
    texts = [
        f"{named(model, vector)} (about {100 * share:.0f} % of the probability, "
        f"{100 * values[f'mode_{number}.draws']:.0f} % of the draws)"
        for number, (vector, share) in enumerate(zip(vectors, modes.shares, strict=True), 1)
    ]
    message = f"The posterior has {count} modes that no chain connects: {'; '.join(texts)}."
    jumps = "Increase draws" if sampler.jumps else "Use the sampler 'affine-invariant', which jumps between modes"
    yield Finding(
        "separate-modes",
        "error",
        values,
        message,
        f"{jumps}, measure another channel, or narrow the bounds to one mode.",
    )
