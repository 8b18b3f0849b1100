"""How small a misfit can become: the noise that the data are known to have."""

from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri

from dalembert.inverse.problem.problem import MisfitProblem

SMALL = 1e-6
"""Noise below this fraction (0.1 % squared) of the signal's squares is small: a minimum that reaches it is the one."""


@dataclass(frozen=True)
class NoiseFloor:
    """Misfit that known noise alone explains."""

    misfit: float  # 99.9 % quantile of the misfit at the true parameters
    # source: {"given", "smoothed", "rounded", "arithmetic"}: where the noise is known from: given standard deviations,
    # local polynomials, rounding of the data, or rounding errors of the arithmetic
    source: str
    # conclusive: whether reaching the floor shows that no better minimum need be looked for: the noise is so small
    # against the signal that a false minimum would not get there
    conclusive: bool

    @property
    def known(self) -> bool:
        """Whether deviations of the data were given."""
        return self.source == "given"


def noise_floor(problem: MisfitProblem, smooth: np.ndarray | None = None) -> NoiseFloor:
    """Floor from given deviations, or the deviations ``smooth`` (channels,) that local polynomials estimated, from the
    digits that the data are rounded to, and from arithmetic. The variance of a value is the given one, plus q²/12 for
    data rounded to multiples of q, plus the square of a millionth of its channel's spread.
    """
    data, weights = problem.data, problem.weights
    deviations = np.zeros(len(data.channels)) if data.deviations is None else data.deviations
    deviations = deviations if smooth is None else smooth
    quanta = np.array([quantum(column[present]) for column, present in zip(data.values.T, data.present.T, strict=True)])
    spread = _filled(problem).std(axis=0)
    expected = float(np.sum(weights * (deviations**2 + quanta**2 / 12 + (1e-6 * spread) ** 2))) + problem.priors
    source = (
        "smoothed"
        if smooth is not None
        else "given"
        if deviations.any()
        else "rounded"
        if quanta.any()
        else "arithmetic"
    )
    return NoiseFloor(
        expected * float(chdtri(problem.compared, 0.001)) / problem.compared,
        source,
        expected < SMALL * signal(problem),
    )


def signal(problem: MisfitProblem) -> float:
    """Σ W (data − mean)²: what a response that explains nothing leaves."""
    values = _filled(problem)
    return float(np.sum(problem.weights * (values - values.mean(axis=0)) ** 2))


def _filled(problem: MisfitProblem) -> np.ndarray:
    """Data without jumps by whole turns, their gaps filled with the channel's mean."""
    data = problem.data
    values, present = data.continuous, data.present
    if np.all(present):
        return values
    mean = np.sum(np.where(present, values, 0.0), axis=0) / np.maximum(1, np.sum(present, axis=0))
    return np.where(present, values, mean)


def quantum(column: np.ndarray) -> float:
    """Unit of the last decimal that data (samples,) are rounded to; 0 where they are not, or span too few units."""
    for decimals in range(13):
        scaled = column * 10.0**decimals
        if np.all(np.abs(scaled - np.rint(scaled)) < 1e-6):
            return 10.0**-decimals if np.ptp(scaled) > 1000 else 0.0
    return 0.0
