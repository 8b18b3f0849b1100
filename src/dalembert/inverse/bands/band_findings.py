"""How an identification from bands ended, as findings."""

from collections.abc import Iterator

import numpy as np
from scipy.special import ndtri

from dalembert.findings import Finding
from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.check import BandSolution, scale
from dalembert.inverse.noise.noise_floor import quantum
from dalembert.inverse.problem.matching import place
from dalembert.inverse.problem.random_residuals import random_residuals
from dalembert.inverse.problem.search_findings import converged, failed_simulations

SMALL = 1e-2  # misfit, as a part of the bands' mean width, from which bands are said to be explained badly
# Rms difference of reproduced and given bands, as part of their mean width, from which the box is not to be used.
CLEAR = 5e-2
CHANCE = 1e-3  # probability with which normal noise would make some bound stand out
# Autocorrelation of noise, in its deviations, beyond which the bands are inconsistent: noise has it once in 10,000.
CORRELATED = 4.0


def outcome(problem: BandProblem, solution: BandSolution) -> Iterator[Finding]:
    """Yield whether the search converged, the difference of given and reproduced bands, and the check by runs."""
    yield converged(solution.success, solution.message)
    yield from failed_simulations(problem.journal.failures)
    yield from _differences(problem, solution)
    if solution.check is None:
        yield Finding(
            "surrogate-unchecked", "note", {}, "The bounds of the surrogate are not checked by runs of the model."
        )
    else:
        worst, points = float(np.max(solution.check.error / scale(problem))), len(solution.check.points)
        message = (
            f"At the {points} parameter points where the surrogate has its minima and maxima, it differs from runs "
            f"of the model by at most {worst:.1g} of a channel's range."
        )
        yield Finding("surrogate-checked", "note", {"points": points, "difference": worst}, message)


def _differences(problem: BandProblem, solution: BandSolution) -> Iterator[Finding]:
    """Yield what the difference between reproduced and given bands shows."""
    bands, apart = problem.bands, _apart(problem, solution)
    if _rounded(problem, apart):
        message = "The given bands are reproduced to the digits that they are rounded to."
        yield Finding("bands-reproduced", "note", {}, message)
        return
    rms, width = np.sqrt(np.mean(apart**2, axis=(0, 1))), bands.width.mean(axis=0)
    share = _shares(problem, apart)
    worst = int(np.argmax(share))
    name = bands.channels[worst]
    size = f"{share[worst]:.2g} of their mean width"
    if not width[worst] > 0:
        size = f"{rms[worst]:.2g} (SI unit; the given bands have no width)"
    message = (
        f"The rms difference between the reproduced and the given bands of {name!r} is {size}; "
        f"{_largest(problem, apart)}."
    )
    yield Finding(
        "bands-differ", "note", {"channel": name, "share": float(share[worst]), "rms": float(rms[worst])}, message
    )
    largest = _standing_out(problem, apart)
    if largest:
        message = f"One bound is an outlier: it differs by {largest:.2g} times the rms of its channel."
        yield Finding("outlying-bound", "note", {"ratio": largest}, message, "Check it.")
    if _random(problem, apart):
        yield Finding("uncorrelated-residuals", "note", {}, "The remaining differences are not correlated.")


def conclusions(problem: BandProblem, solution: BandSolution) -> Iterator[Finding]:
    """Yield the findings: bands that no box has, and a best end that only one of the descents reached."""
    apart = _apart(problem, solution)
    share = float(_shares(problem, apart).max())
    if share > SMALL and not _rounded(problem, apart) and not _random(problem, apart):
        message = (
            "The bands are inconsistent: no box of the parameters gives them. The bands of the best box differ "
            f"by {100 * share:.2g} % of their mean width."
        )
        advice = "Check the bands, the model and the bounds of the parameters."
        yield Finding("inconsistent-bands", "error" if share > CLEAR else "warning", {"share": share}, message, advice)
    if solution.reached == 1:
        message = "Only one of the descents reached the smallest misfit: another minimum may be better."
        yield Finding("minimum-reached-once", "warning", {"reached": 1}, message, "Increase starts.")


def _apart(problem: BandProblem, solution: BandSolution) -> np.ndarray:
    """Differences of reproduced and given bands, (2, samples, channels); 0 where none was given."""
    bounds, bands = solution.candidate.bounds, problem.bands
    apart = np.stack([bounds.lower, bounds.upper]).reshape(2, *problem.shape) - np.stack([bands.lower, bands.upper])
    return np.where(problem.weights > 0, apart, 0.0)


def _rounded(problem: BandProblem, apart: np.ndarray) -> bool:
    """Whether the differences are those of rounding."""
    bands = problem.bands
    digits = [max(map(quantum, columns)) for columns in zip(bands.lower.T, bands.upper.T, strict=True)]
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
    at = f"in the {bound} bound of {place(problem.bands, int(output))}"
    return f"the largest difference relative to a channel's range is {abs(flat[side, output]):.2g} (SI unit), {at}"
