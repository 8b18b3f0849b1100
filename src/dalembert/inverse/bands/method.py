"""What a method of identifying bands hands back, and what it must offer."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.candidate import Candidate
from dalembert.inverse.bands.check import Check
from dalembert.surrogate import ChebyshevPolynomial


@dataclass(frozen=True, eq=False)
class BandSolution:
    """The best candidate, on the surrogate that bounds it.

    Parameters
    ----------
    polynomial : ChebyshevPolynomial
    candidate : Candidate
    error : array, shape (outputs,)
        Estimate of the surrogate's largest error on the candidate's box.
    check : Check or None
    success : bool
    message : str
    reached : int or None
        Number of descents that ended there; None for a method without descents.
    """

    polynomial: ChebyshevPolynomial
    candidate: Candidate
    error: np.ndarray
    check: Check | None
    success: bool
    message: str
    reached: int | None = None


class Method(Protocol):
    """A way to identify bands, made of settings."""

    @property
    def name(self) -> str: ...

    def search(self, problem: BandProblem, seed: int) -> BandSolution: ...
