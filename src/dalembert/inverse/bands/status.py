"""How an identification from bands went, in full sentences with advice."""

import numpy as np

from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.check import scale
from dalembert.inverse.bands.found import Found
from dalembert.inverse.noise import quantum

SMALL = 1e-2
"""Misfit, as a part of the bands' mean width, from which bands are said to be explained badly."""


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
    """What the residual says about the given bands."""
    bounds, given = found.candidate.bounds, problem.bands
    apart = np.stack([bounds.lower, bounds.upper]).reshape(2, *problem.shape) - np.stack([given.lower, given.upper])
    counted = np.broadcast_to(problem.weights > 0, apart.shape)
    apart = np.where(counted, apart, 0.0)
    rms = np.sqrt(np.sum(apart**2, axis=(0, 1)) / np.maximum(counted.sum(axis=(0, 1)), 1))
    width = given.width.mean(axis=0)
    share = np.divide(rms, width, out=np.where(rms > 0, np.inf, 0.0), where=width > 0)
    channel = int(np.argmax(share))
    side, sample, column = np.unravel_index(
        np.argmax(np.abs(apart) / scale(problem).reshape(problem.shape)), apart.shape
    )
    along = given.coordinate
    where = (
        f"most in the {('lower', 'upper')[side]} bound of {given.channels[column]!r} at {along.name} "
        f"{along.values[sample]:.6g} {along.unit}".rstrip()
        + f", by {abs(apart[side, sample, column]):.2g}"
    )
    digits = np.array([max(map(quantum, columns)) for columns in zip(given.lower.T, given.upper.T, strict=True)])
    if np.all(rms <= digits):
        return "The given bands are reproduced to the digits that they are rounded to."
    sentence = (
        f"The reproduced bands differ from the given ones by {share[channel]:.2g} of their mean width at rms in "
        f"{given.channels[channel]!r}; {where}."
    )
    if share[channel] > SMALL:
        sentence += (
            " No box of these parameters gives these bands: look at the residuals whether some values stand out, "
            "whether the model lacks something, or whether the bounds leave the true intervals out."
        )
    return sentence
