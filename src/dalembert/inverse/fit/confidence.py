"""From standard deviations to intervals: the noise of a fit, and the quantile that belongs to it."""

import numpy as np
from scipy.special import ndtri, stdtrit  # quantiles; scipy.stats takes long to load

from dalembert.arguments import is_number
from dalembert.errors import InputError, shown
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.problem.prior import priors


def check_level(level: float, where: str) -> None:
    """Refuse a level that is no probability.

    Raises
    ------
    InputError
    """
    if not is_number(level) or np.iscomplexobj(level) or not 0 < level < 1:
        raise InputError(f"{where}: level is {shown(level)}; expected a number between 0 and 1, such as 0.95")


def noise_is_known(fit: Fit) -> bool:
    """Whether the deviations of a fit come from given deviations of the data, not from its residuals."""
    given = fit.data.deviations is not None and fit.provenance.get("weights") == "data"
    return given or len(priors(fit.parameters)) > 0


def freedom(fit: Fit) -> int:
    """Values that count, less parameters."""
    return int(np.count_nonzero(fit.weights)) + len(priors(fit.parameters)) - len(fit.parameters)


def quantile(fit: Fit, level: float) -> float:
    """Deviations on either side of a value that hold it with probability ``level``: normal, or Student's t."""
    if noise_is_known(fit):
        return float(ndtri((1 + level) / 2))
    return float(stdtrit(freedom(fit), (1 + level) / 2)) if freedom(fit) > 0 else np.nan


def variance(fit: Fit) -> float:
    """Variance of a weighted residual: 1 where the noise is known, else from the residuals."""
    if noise_is_known(fit):
        return 1.0
    return fit.fitness / freedom(fit) if freedom(fit) > 0 else np.nan


def intervals(fit: Fit, level: float) -> dict[str, tuple[float, float]]:
    """Value ∓ quantile × deviation of each parameter, by name."""
    check_level(level, "intervals")
    radius = quantile(fit, level) * fit.deviations
    ends = zip(fit.parameters.names, (fit.values - radius).tolist(), (fit.values + radius).tolist(), strict=True)
    return {name: (lower, upper) for name, lower, upper in ends}
