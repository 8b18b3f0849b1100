"""Least squares over all terms of a total degree, from a part of a root grid."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lstsq, qr

from dalembert.arguments import Checked, limited
from dalembert.errors import SolveError
from dalembert.surrogate.basis import chebyshev, products, roots, terms_of, total_degree
from dalembert.surrogate.decay import by_direction, by_total_degree, slow_tails, tail
from dalembert.surrogate.held_out import HeldOut
from dalembert.surrogate.runs import Runs, failed
from dalembert.surrogate.scheme import Fitted

# Points of the root grid among which those of the runs are chosen, a run: of a larger grid, a random part.
MOST_CANDIDATES = 20


@dataclass(frozen=True)
class TotalDegree(Checked):
    """All terms of total degree at most ``order``, by least squares from ``oversampling`` runs a term.

    Parameters
    ----------
    order : int
        Total degree p; the polynomial in d directions has P = (p + d)!/(p! d!) terms.
    oversampling : float
        Runs a term, M = oversampling · P rounded up; at least 1.

    Raises
    ------
    InputError
        For an order below 1 or an oversampling below 1.

    Notes
    -----
    As published (Guo & Jin 2025, equations (5) to (13), after Wu et al. 2013): M = 2P runs on the smallest grid of
    Chebyshev roots that has M points, and p + 1 at least in each direction. The paper does not say which ones: we take
    a well-conditioned part by QR decompositions with pivoting, each of which chooses P points. A failed run is left
    out, as long as there remain as many as terms.

    Examples
    --------
    >>> TotalDegree(order=2).runs(2)
    12
    """

    order: int = limited(2, least=1)
    oversampling: float = limited(2.0, least=1)

    def runs(self, directions: int) -> int:
        """Number M of runs that it takes."""
        return int(np.ceil(self.oversampling * terms_of(directions, self.order)))

    def fitted(self, runs: Runs, seed: int, held_out: HeldOut, scale: Callable[[], np.ndarray]) -> Fitted:
        exponents = total_degree(runs.directions, self.order)
        eta = self.points(runs.directions, seed)
        values = runs(eta)
        kept = ~failed(values)
        if kept.sum() < len(exponents):
            raise SolveError(
                f"{(~kept).sum()} of the {len(eta)} runs of a surrogate failed; its {len(exponents)} terms need as "
                "many runs; raise TotalDegree(oversampling=...), or keep the box away from where the model fails"
            )
        matrix = _matrix(eta[kept], exponents)
        # Least squares as published; the rank shows whether the runs that are left determine all terms.
        coefficients, _, rank, _ = lstsq(matrix, values[kept])  # pyright: ignore[reportGeneralTypeIssues]
        if rank < len(exponents):
            raise SolveError(
                f"{(~kept).sum()} of the {len(eta)} runs of a surrogate failed; those that are left do not "
                f"determine its {len(exponents)} terms; raise TotalDegree(oversampling=...)"
            )
        left_out = tail(self.shells(exponents, coefficients)[0])
        return Fitted(exponents, coefficients, np.maximum(left_out, slow_tails(by_direction(exponents, coefficients))))

    def points(self, directions: int, seed: int = 0) -> np.ndarray:
        """Coordinates η of the runs, shape (M, d); ``seed`` counts only where the grid is too large to search whole."""
        number = self.runs(directions)
        # The smallest full grid with as many points; p + 1 in each direction determine the degree p.
        sides = max(self.order + 1, int(np.ceil(number ** (1 / max(directions, 1)) - 1e-9)))
        # Points of the root grid, all of them or ``most`` of them drawn at random, shape (points, directions).
        most = MOST_CANDIDATES * number
        line = roots(sides)
        if sides**directions <= most:
            places = np.indices((sides,) * directions).reshape(directions, -1).T
        else:
            drawn = np.random.default_rng((seed, 2)).integers(sides, size=(most, directions))
            places = np.unique(drawn, axis=0)
        grid = line[places]
        exponents = total_degree(directions, self.order)
        matrix = _matrix(grid, exponents)
        chosen: list[int] = []
        left = np.arange(len(grid))
        while len(chosen) < number and len(left):
            # Pivoting takes the row that is farthest from the span of the chosen ones: P points that determine P terms
            # well.
            _, _, order = qr(matrix[left].T, mode="economic", pivoting=True)  # pyright: ignore
            first = order[: min(len(exponents), number - len(chosen))]
            chosen += left[first].tolist()
            left = np.delete(left, first)
        return grid[np.sort(chosen)]

    def shells(self, exponents: np.ndarray, coefficients: np.ndarray) -> list[np.ndarray]:
        return by_total_degree(exponents, coefficients)

    def more(self, order: int) -> str:
        return f"take TotalDegree(order={order})"


def _matrix(eta: np.ndarray, exponents: np.ndarray) -> np.ndarray:
    return products(chebyshev(eta, exponents.max(axis=0, initial=0)), exponents)
