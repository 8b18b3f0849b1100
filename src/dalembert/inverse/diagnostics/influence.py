"""How much single values determine a fit."""

from dataclasses import dataclass

import numpy as np

from dalembert.inverse.least_squares.estimate import UNSEEN

ALONE = 1e-9
"""1 − leverage below which a value alone determines a combination of parameters, and has no residual."""


@dataclass(frozen=True, eq=False)
class Influence:
    """Influence of each value on a fit.

    Parameters
    ----------
    leverage : array, shape (values,)
        Derivative of the computed value by the measured one.
    distance : array, shape (values,)
        Cook's distance: how far the parameters move without the value, in the metric of their covariance, divided by
        their number.
    changes : array, shape (values, parameters)
        DFBETAS: identified value less that without the value, in standard deviations; 0 for a parameter on a bound,
        NaN where the other values have no residual.
    """

    leverage: np.ndarray
    distance: np.ndarray
    changes: np.ndarray


def influence(
    slopes: np.ndarray, residual: np.ndarray, free: np.ndarray, variance: float, freedom: float | None
) -> Influence:
    """Return the influence of each value, to first order in the parameters; exact for a linear model.

    ``slopes`` (values + priors, parameters): W^½ ∂R/∂p, then one row a prior. ``residual`` (values,): W^½ (R − data).
    ``free`` (parameters,): parameters that are on no bound. ``variance``: of a weighted residual. ``freedom``: degrees
    of freedom that the variance was estimated with; None where it is known.

    With the hat matrix H = S (SᵀS)⁻¹ Sᵀ, leverage h and weighted residual e = data − R: D = e² h / (m s² (1 − h)²) for
    m parameters. Without the value, the parameters change by −(SᵀS)⁻¹ x e/(1 − h), where x is its row of S. Source:
    R. D. Cook, Detection of influential observation in linear regression, Technometrics 19 (1977); D. A. Belsley,
    E. Kuh, R. E. Welsch, Regression Diagnostics (1980), section 2.1.
    """
    left, singular, directions = np.linalg.svd(slopes[:, free], full_matrices=False)
    seen = singular > UNSEEN * (singular[0] if len(singular) else 1.0)
    left, spread = left[: len(residual), seen], directions[seen].T / singular[seen]
    variance = variance if variance > 0 else np.nan  # no residuals: nothing moves anything
    leverage = np.clip(np.sum(left**2, axis=1), 0.0, 1.0)
    remaining = np.where(1 - leverage > ALONE, 1 - leverage, np.nan)
    distance = residual**2 * leverage / (remaining**2 * variance * max(1, np.count_nonzero(seen)))
    without = np.full(len(residual), variance)
    if freedom is not None:
        left_over = variance * freedom - residual**2 / remaining
        exact = left_over <= ALONE * variance * freedom  # the other values have no residual
        without = np.where(exact, np.nan, left_over) / (freedom - 1) if freedom > 1 else np.full(len(residual), np.nan)
    changes = np.zeros((len(residual), len(free)))
    size = np.linalg.norm(spread, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        step = -(left @ spread.T) * (residual / remaining / np.sqrt(without))[:, None]
        changes[:, free] = np.where(size > 0, step / size, 0.0)
    return Influence(leverage, distance, changes)
