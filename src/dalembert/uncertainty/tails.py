"""What the tails of a distribution hold of its variance."""

import numpy as np
from numpy.polynomial.legendre import leggauss

from dalembert.priors import Prior

# Nodes in each part of an integral, and parts between the median and an end, each twice as wide as the one before.
NODES, HALVINGS = 16, 60


def lost_variance(prior: Prior, inner: tuple[float, float], outer: tuple[float, float]) -> float:
    """Return the part of the variance of a distribution in the interval ``outer`` that is left out in ``inner``.
    >>> from dalembert.priors import Normal
    >>> round(lost_variance(Normal(0.0, 1.0), (-2.0, 2.0), (-9.0, 9.0)), 4)  # 2 φ(2) · 2 / (Φ(2) − Φ(−2))
    0.2263
    """
    if inner == outer:
        return 0.0
    return max(1.0 - _variance(prior, *inner) / _variance(prior, *outer), 0.0)


def _variance(prior: Prior, lower: float, upper: float) -> float:
    """Variance within an interval, by Gauss and Legendre's rule in parts that grow from the median."""
    median = float(np.clip(prior.quantile(0.5), lower, upper))
    # Parts double from the median outwards, so that they resolve the middle of any distribution in a wide interval.
    knots = np.concatenate([[0.0], 2.0 ** np.arange(-HALVINGS, 1)])
    nodes, weights = leggauss(NODES)
    half, middle = np.diff(knots)[:, None] / 2, (knots[1:] + knots[:-1])[:, None] / 2
    away = np.concatenate([(end - median) * (middle + half * nodes).ravel() for end in (lower, upper)])
    density = np.exp(prior.log_density(median + away))
    density *= np.concatenate([abs(end - median) * (half * weights).ravel() for end in (lower, upper)])
    # The norm of the truncated density, by the same nodes.
    density /= density.sum()
    # Measured from the median, and about the mean: the difference of two large squares would lose digits.
    mean = away @ density
    return float((away - mean) ** 2 @ density)
