"""Noise of a channel from neighbouring samples alone."""

import numpy as np


def local_deviation(along: np.ndarray, values: np.ndarray) -> float:
    """Return the standard deviation of the noise of values (values,) along a coordinate, which need not be even. Each
    value is compared with the straight line between its neighbours, in units of that difference's own deviation. What
    varies smoothly does not count. Correlated noise counts less than it is. Source: T. Gasser, L. Sroka,
    C. Jennen-Steinmetz, Residual variance and residual pattern in nonlinear regression, Biometrika 73 (1986).
    """
    after = (along[1:-1] - along[:-2]) / (along[2:] - along[:-2])
    before = 1 - after
    apart = before * values[:-2] + after * values[2:] - values[1:-1]
    return float(np.sqrt(np.mean(apart**2 / (before**2 + after**2 + 1))))
