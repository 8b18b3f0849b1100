"""The full tensor of Chebyshev polynomials, from runs at all points of a root grid."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError, SolveError
from dalembert.surrogate.basis import chebyshev, full_tensor, roots
from dalembert.surrogate.decay import by_direction, slow_tails, tail
from dalembert.surrogate.held_out import HeldOut
from dalembert.surrogate.runs import Runs
from dalembert.surrogate.scheme import Fitted

MOST_RUNS = 1_000_000  # largest number of runs that a tensor is made from


@dataclass(frozen=True)
class Tensor(Checked):
    """All products of Chebyshev polynomials up to an order in each direction, through all points of the root grid.

    Parameters
    ----------
    order : int or tuple of int
        Highest degree, one for all directions or one for each; it takes Π (order_k + 1) runs.

    Raises
    ------
    InputError
        For an order below 1, or if the number of orders is not that of directions.
    SolveError
        From a fit that would take more than a million runs.

    Notes
    -----
    The coefficients follow without solving anything, since Chebyshev polynomials are orthogonal on their roots:
    c_e = Π_k (2 − δ_{0 e_k})/(order_k + 1) Σ_points f Π_k T_{e_k}. The interpolation is within a factor of about
    (2/π ln(order + 1) + 1)^d of the best polynomial of its order (Trefethen, Approximation Theory, chapter 15).

    Examples
    --------
    >>> Tensor((8, 6)).runs(2)
    63
    """

    order: int | tuple[int, ...] = 8

    def __post_init__(self) -> None:
        if min(np.atleast_1d(self.order), default=0) < 1:
            raise InputError(f"Tensor: order is {self.order}; expected at least 1 in each direction")

    def orders(self, directions: int) -> tuple[int, ...]:
        """The order of each direction."""
        orders = (self.order,) * directions if isinstance(self.order, int) else tuple(self.order)
        if len(orders) != directions:
            raise InputError(
                f"Tensor: {len(orders)} orders {orders} were given for {directions} directions with a width; "
                "expected one for each, or one number for all"
            )
        return orders

    def runs(self, directions: int) -> int:
        """Number of runs that it takes."""
        return int(np.prod([order + 1 for order in self.orders(directions)]))

    def fitted(self, runs: Runs, seed: int, held_out: HeldOut, scale: Callable[[], np.ndarray]) -> Fitted:
        orders = self.orders(runs.directions)
        number = self.runs(runs.directions)
        if number > MOST_RUNS:
            raise SolveError(
                f"a tensor surrogate of orders {list(orders)} takes {number} runs, more than {MOST_RUNS}; lower the "
                "order, or use Adaptive"
            )
        exponents = full_tensor(orders)
        eta = np.array([roots(order + 1)[exponents[:, k]] for k, order in enumerate(orders)]).T.reshape(exponents.shape)
        coefficients = _transformed(runs.complete(eta, "a tensor"), orders)
        directions = self.shells(exponents, coefficients)
        left_out = np.sum([tail(shells) for shells in directions], axis=0)
        return Fitted(exponents, coefficients, np.maximum(left_out, slow_tails(directions)))

    def shells(self, exponents: np.ndarray, coefficients: np.ndarray) -> list[np.ndarray]:
        return by_direction(exponents, coefficients)

    def more(self, order: int) -> str:
        return f"take Tensor({order})"


def _transformed(values: np.ndarray, orders: tuple[int, ...]) -> np.ndarray:
    """Return the coefficients (terms, outputs) of values (points, outputs) on the root grid, direction by direction."""
    grid = values.reshape(*(order + 1 for order in orders), values.shape[1])
    for k, order in enumerate(orders):
        basis = chebyshev(roots(order + 1)[:, None], np.array([order]))[0]
        # c = (2 − δ)/(n + 1) Σ f T: the discrete cosine transform as a small matrix, one direction at a time.
        weights = (2.0 - (np.arange(order + 1) == 0)) / (order + 1)
        grid = np.moveaxis(np.tensordot(weights[:, None] * basis.T, grid, axes=(1, k)), 0, k)
    return grid.reshape(values.shape)
