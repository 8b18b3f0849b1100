"""Chebyshev surrogates of costly functions over a box, and bounds of a polynomial on a box. They know no models."""

from dalembert.surrogate.adaptive import Adaptive
from dalembert.surrogate.bounds import PolynomialBounds, bounds
from dalembert.surrogate.fit import fit
from dalembert.surrogate.polynomial import ChebyshevPolynomial
from dalembert.surrogate.sobol import Checks, SobolIndices, sobol_indices
from dalembert.surrogate.surrogate import Surrogate
from dalembert.surrogate.tensor import Tensor
from dalembert.surrogate.total_degree import TotalDegree

__all__ = [
    "Adaptive",
    "ChebyshevPolynomial",
    "Checks",
    "PolynomialBounds",
    "SobolIndices",
    "Surrogate",
    "Tensor",
    "TotalDegree",
    "bounds",
    "fit",
    "sobol_indices",
]
