"""How an identification from bands went, in full sentences with advice."""

import numpy as np
from scipy.special import ndtri

from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.check import scale
from dalembert.inverse.bands.found import Found
from dalembert.inverse.problem.matching import place
from dalembert.inverse.problem.noise import quantum, random_residuals

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
    given, apart = problem.bands, _apart(problem, found)
    if _rounded(problem, apart):
        return "The given bands are reproduced to the digits that they are rounded to."
    rms, width = np.sqrt(np.mean(apart**2, axis=(0, 1))), given.width.mean(axis=0)
    share = _shares(problem, apart)
    worst = int(np.argmax(share))
    name = repr(given.channels[worst])
    by = f"{share[worst]:.2g} of their mean width at rms in {name}"
    if not width[worst] > 0:
        by = f"{rms[worst]:.2g} at rms in {name}, where the given bands have no width"
    parts = [f"The reproduced bands differ from the given ones by {by}; {_largest(problem, apart)}."]
    largest = _standing_out(problem, apart)
    if largest:
        parts.append(f"One bound stands out, {largest:.2g} times the rms of its channel: look whether it is a slip.")
    if _random(problem, apart):
        parts.append("What remains looks like noise.")
    elif share.max() > SMALL:
        parts.append(
            "No box of these parameters has these bands: look at the residuals, whether the model lacks something, or "
            "whether the bounds leave the true intervals out."
        )
    return " ".join(parts)


def inconsistency(problem: BandProblem, found: Found) -> float:
    """Rms difference of reproduced and given bands, as part of their mean width, if it is not random; else 0."""
    apart = _apart(problem, found)
    share = float(_shares(problem, apart).max())
    return 0.0 if share <= SMALL or _rounded(problem, apart) or _random(problem, apart) else share


def _apart(problem: BandProblem, found: Found) -> np.ndarray:
    """Differences of reproduced and given bands, (2, samples, channels); 0 where none was given."""
    bounds, given = found.candidate.bounds, problem.bands
    apart = np.stack([bounds.lower, bounds.upper]).reshape(2, *problem.shape) - np.stack([given.lower, given.upper])
    return np.where(problem.weights > 0, apart, 0.0)


def _rounded(problem: BandProblem, apart: np.ndarray) -> bool:
    """Whether the differences are those of rounding."""
    given = problem.bands
    digits = [max(map(quantum, columns)) for columns in zip(given.lower.T, given.upper.T, strict=True)]
    return bool(np.all(np.abs(apart) <= digits))


def _shares(problem: BandProblem, apart: np.ndarray) -> np.ndarray:
    """Rms of the differences as part of the mean width of the bands, (channels,)."""
    rms, width = np.sqrt(np.mean(apart**2, axis=(0, 1))), problem.bands.width.mean(axis=0)
    return np.divide(rms, width, out=np.where(rms > 0, np.inf, 0.0), where=width > 0)


def _standing_out(problem: BandProblem, apart: np.ndarray) -> float:
    """Largest difference over the rms of its channel, if normal noise would not make it so large; else 0."""
    rms = np.sqrt(np.mean(apart**2, axis=(0, 1)))
    largest = float(np.max(np.abs(apart) / np.where(rms > 0, rms, 1.0)))
    return largest if largest > -ndtri(CHANCE / (2 * max(1, 2 * np.count_nonzero(problem.weights)))) else 0.0


def _random(problem: BandProblem, apart: np.ndarray) -> bool:
    """Whether the differences look like noise."""
    shape = problem.shape[0], 2 * problem.shape[1]
    return not _standing_out(problem, apart) and random_residuals(np.hstack(tuple(apart)), shape, deviations=CORRELATED)


def _largest(problem: BandProblem, apart: np.ndarray) -> str:
    """Where the largest difference is, of differences (2, samples, channels) between bands."""
    flat = apart.reshape(2, -1)
    side, output = np.unravel_index(np.argmax(np.abs(flat) / scale(problem)), flat.shape)
    bound = ("lower", "upper")[side]
    return f"most in the {bound} bound of {place(problem.bands, int(output))}, by {abs(flat[side, output]):.2g}"
