"""Prior distributions: what is known of parameters before any data.

Every prior is proper. The bounds of its parameter truncate it.
"""

from dalembert.priors.correlated import CorrelatedNormal
from dalembert.priors.kinds import AnyPrior, prior_of
from dalembert.priors.normal import HalfNormal, LogNormal, Normal
from dalembert.priors.prior import Prior, SquarePrior
from dalembert.priors.uniform import LogUniform, Uniform

__all__ = [
    "AnyPrior",
    "CorrelatedNormal",
    "HalfNormal",
    "LogNormal",
    "LogUniform",
    "Normal",
    "Prior",
    "SquarePrior",
    "Uniform",
    "prior_of",
]
