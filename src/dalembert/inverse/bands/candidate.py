"""Bands of a candidate box on a surrogate, and how they change with it."""

from dataclasses import dataclass

import numpy as np

from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.surrogate import ChebyshevPolynomial, PolynomialBounds, bounds


@dataclass(frozen=True, eq=False)
class Candidate:
    """A box, by its unknowns x (d + k,), with the bounds of a surrogate on it."""

    x: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    bounds: PolynomialBounds


def candidate(problem: BandProblem, polynomial: ChebyshevPolynomial, x: np.ndarray) -> Candidate:
    """The candidate with unknowns x, bounded."""
    lower, upper = problem.unknowns.ends(x)
    return Candidate(x, lower, upper, bounds(polynomial, lower, upper))


def slopes(problem: BandProblem, polynomial: ChebyshevPolynomial, at: Candidate) -> np.ndarray:
    """Jacobian of :meth:`BandProblem.residual` by the two ends of the box, shape (2, 2 × outputs, d). By the envelope
    theorem a bound changes as the polynomial at the point where it is taken, x* = a + (1 + η)/2 (b − a) in each
    direction: ∂f/∂x (1 − η)/2 with the lower end a, ∂f/∂x (1 + η)/2 with the upper end b. On a side without width the
    bound leaves to where the polynomial falls or rises, η = ∓ sign ∂f/∂x.
    """
    width = at.upper - at.lower
    root = np.sqrt(problem.weights.ravel())
    rows = []
    for place, sign in ((at.bounds.at_lower, -1.0), (at.bounds.at_upper, 1.0)):
        assert place is not None  # the bounds are optimised, not enclosed
        gradient = root[:, None] * gradients(polynomial, place)
        eta = np.divide(2 * place - at.lower - at.upper, width, out=sign * np.sign(gradient), where=width > 0)
        rows.append(np.stack([gradient * (1 - eta) / 2, gradient * (1 + eta) / 2]))
    return np.concatenate(rows, axis=1)


def gradients(polynomial: ChebyshevPolynomial, points: np.ndarray) -> np.ndarray:
    """Gradient (outputs, d) of each output at a separate point, points of shape (outputs, d)."""
    distinct, row = np.unique(points, axis=0, return_inverse=True)
    return polynomial.gradient(distinct)[row.ravel(), np.arange(len(points))]
