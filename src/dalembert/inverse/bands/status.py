"""How an identification from bands went, in full sentences with advice."""

import numpy as np
from scipy.special import ndtri

from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.check import scale
from dalembert.inverse.bands.found import Found
from dalembert.inverse.doubts import NO_BOX
from dalembert.inverse.matching import place
from dalembert.inverse.noise import quantum, random_residuals

SMALL = 1e-2
"""Misfit, as a part of the bands' mean width, from which bands are said to be explained badly."""

CHANCE = 1e-3
"""Probability with which normal noise would make some bound stand out."""

CORRELATED = 4.0
"""Autocorrelation of noise, in its deviations, beyond which the bands are inconsistent: noise has it once in 10,000."""


def status(problem: BandProblem, found: Found) -> str:
    """Whether it converged, how far given and reproduced bands lie apart, and what true runs say."""
    parts = ["Converged." if found.success else f"Not converged: {found.message}."]
    journal = problem.journal
    if journal.failures:
        parts.append(
            f"{len(journal.failures)} simulations failed and were passed over, the first: {journal.failures[0]}."
        )
    parts.append(_misfit(problem, found))
    if found.check is None:
        parts.append("No true run checks the bounds of the surrogate.")
    else:
        worst = np.max(found.check.error / scale(problem))
        parts.append(
            f"True runs at {len(found.check.points)} points where the surrogate takes its bounds differ from it by at "
            f"most {worst:.1g} of a channel's range."
        )
    return " ".join(parts)


def _misfit(problem: BandProblem, found: Found) -> str:
    """What the difference between reproduced and given bands says about the given ones."""
    bounds, given = found.candidate.bounds, problem.bands
    apart = np.stack([bounds.lower, bounds.upper]).reshape(2, *problem.shape) - np.stack([given.lower, given.upper])
    apart = np.where(problem.weights > 0, apart, 0.0)
    digits = [max(map(quantum, columns)) for columns in zip(given.lower.T, given.upper.T, strict=True)]
    if np.all(np.abs(apart) <= digits):
        return "The given bands are reproduced to the digits that they are rounded to."
    rms, width = np.sqrt(np.mean(apart**2, axis=(0, 1))), given.width.mean(axis=0)
    share = np.divide(rms, width, out=np.where(rms > 0, np.inf, 0.0), where=width > 0)
    worst = int(np.argmax(share))
    name = repr(given.channels[worst])
    by = f"{share[worst]:.2g} of their mean width at rms in {name}"
    if not width[worst] > 0:
        by = f"{rms[worst]:.2g} at rms in {name}, where the given bands have no width"
    parts = [f"The reproduced bands differ from the given ones by {by}; {_largest(problem, apart)}."]
    largest = np.max(np.abs(apart) / np.where(rms > 0, rms, 1.0))
    stands_out = largest > -ndtri(CHANCE / (2 * max(1, 2 * np.count_nonzero(problem.weights))))
    if stands_out:
        parts.append(f"One bound stands out, {largest:.2g} times the rms of its channel: look whether it is a slip.")
    if not stands_out and random_residuals(
        np.hstack(tuple(apart)), (problem.shape[0], 2 * problem.shape[1]), deviations=CORRELATED
    ):
        parts.append("What remains looks like noise.")
    elif share.max() > SMALL:
        parts.append(
            f"{NO_BOX}: look at the residuals, whether the model lacks something, or "
            "whether the bounds leave the true intervals out."
        )
    return " ".join(parts)


def _largest(problem: BandProblem, apart: np.ndarray) -> str:
    """Where the largest difference is, of differences (2, samples, channels) between bands."""
    flat = apart.reshape(2, -1)
    side, output = np.unravel_index(np.argmax(np.abs(flat) / scale(problem)), flat.shape)
    bound = ("lower", "upper")[side]
    return f"most in the {bound} bound of {place(problem.bands, int(output))}, by {abs(flat[side, output]):.2g}"
