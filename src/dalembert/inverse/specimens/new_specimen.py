"""What a parameter may be in a new specimen, with the uncertainty of the spread.

With the restricted likelihood L(σ) of a spread σ and a uniform prior of σ, the value in a new specimen has the density

    p(θ) = ∫ L(σ) N(θ; μ̂(σ), σ² + var μ̂(σ)) dσ / ∫ L(σ) dσ.

The spread of the largest likelihood alone gives intervals that are too narrow for few specimens. Source: Gelman, Prior
distributions for variance parameters in hierarchical models (2006); Partlett and Riley, Random effects meta-analysis:
coverage performance of 95 % confidence and prediction intervals (2017).
"""

import numpy as np
from scipy.optimize import root_scalar
from scipy.special import ndtr

from dalembert.inverse.specimens.restricted_likelihood import Likelihood

# Spreads of the quadrature, 0 to 100, over the deviation of the specimens' values.
SPREADS = np.sinh(np.linspace(0.0, 5.3, 241))
FARTHEST = 1e4  # end of the search for a quantile, over the same


def new_specimen(values: np.ndarray, variances: np.ndarray, level: float) -> tuple[float, float]:
    """Return the interval that contains the value of a parameter in a new specimen.

    ``values``, ``variances`` (specimens,): identified values and the squares of their standard deviations.
    """
    centre, scale = values.mean(), np.sqrt(values.var(ddof=1) + variances.mean())
    likelihood = Likelihood((values[:, None] - centre) / scale, np.diag(variances) / scale**2)
    likelihoods = [
        (likelihood.value_and_slope(variance)[0], *likelihood.mean(variance))
        for variance in SPREADS[:, None, None] ** 2
    ]
    heights = np.array([height for height, _, _ in likelihoods])
    means = np.array([mean[0] for _, mean, _ in likelihoods])
    deviations = np.sqrt(SPREADS**2 + np.array([known[0, 0] for _, _, known in likelihoods]))
    weights = np.exp(heights - heights.max()) * np.gradient(SPREADS)
    weights /= weights.sum()

    def quantile(part: float) -> float:
        def more(at: float) -> float:
            return float(weights @ ndtr((at - means) / deviations)) - part

        return centre + scale * float(root_scalar(more, bracket=(-FARTHEST, FARTHEST), method="brentq").root)

    return quantile((1 - level) / 2), quantile((1 + level) / 2)
