"""The normal prior of several parameters together."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from dalembert.errors import InputError, shown
from dalembert.priors.normal import Normal


@dataclass(frozen=True)
class CorrelatedNormal:
    """Normal distribution of several parameters together.

    Each of the parameters has this object as its prior.

    Parameters
    ----------
    names : tuple of str
        Of the parameters, in the order of ``mean`` and ``covariance``.
    mean : tuple of float
        In SI units.
    covariance : tuple of tuple of float
        Symmetric and positive definite.

    Examples
    --------
    >>> both = CorrelatedNormal(("mass", "stiffness"), (1.0, 100.0), ((0.01, 0.5), (0.5, 100.0)))
    >>> both.marginal("stiffness").deviation
    10.0
    """

    names: tuple[str, ...]
    mean: tuple[float, ...]
    covariance: tuple[tuple[float, ...], ...]
    kind: str = field(default="correlated-normal", init=False, repr=False)

    def __post_init__(self) -> None:
        for mistake in self._mistakes():
            raise InputError(f"CorrelatedNormal: {mistake}")
        object.__setattr__(self, "names", tuple(self.names))
        object.__setattr__(self, "mean", tuple(float(value) for value in self.mean))
        rows = tuple(tuple(float(value) for value in row) for row in self.covariance)
        object.__setattr__(self, "covariance", rows)

    def _mistakes(self) -> Iterator[str]:
        if isinstance(self.names, str) or len(self.names) < 2 or len(set(self.names)) < len(self.names):
            yield f"names are {shown(self.names)}; expected two or more different names"
            return
        count = len(self.names)
        try:
            mean, covariance = np.asarray(self.mean, dtype=float), np.asarray(self.covariance, dtype=float)
        except (TypeError, ValueError):
            yield f"mean or covariance are no numbers; expected {count} means and {count} rows of {count} covariances"
            return
        if mean.shape != (count,) or covariance.shape != (count, count):
            yield (
                f"mean has the shape {mean.shape} and covariance {covariance.shape}; expected ({count},) and "
                f"({count}, {count}) for {', '.join(self.names)}"
            )
        elif not (np.all(np.isfinite(mean)) and np.all(np.isfinite(covariance))):
            yield "mean or covariance is not finite, which makes the prior improper; expected finite numbers"
        elif not np.allclose(covariance, covariance.T, rtol=1e-9, atol=0):
            yield "covariance is not symmetric; expected equal entries on both sides of its diagonal"
        elif not _positive_definite(covariance):
            yield (
                "covariance is not positive definite, which makes the prior improper; expected positive variances, "
                "and correlations between −1 and 1 that are possible together"
            )

    def marginal(self, name: str) -> Normal:
        """The distribution of one of the parameters alone."""
        k = self.names.index(name)
        return Normal(self.mean[k], float(np.sqrt(self.covariance[k][k])))

    def whitening(self) -> np.ndarray:
        """Inverse of the Cholesky factor of the covariance: of p − mean it gives independent standard residuals."""
        return np.linalg.inv(np.linalg.cholesky(np.array(self.covariance)))


def _positive_definite(matrix: np.ndarray) -> bool:
    try:
        np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        return False
    return True
