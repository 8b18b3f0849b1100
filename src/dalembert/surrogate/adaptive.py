"""A surrogate that chooses its own terms, on nested points, until its error is small enough."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from dalembert.errors import InputError, unknown
from dalembert.settings import expect_at_least, expect_positive
from dalembert.surrogate.decay import by_direction, by_total_degree
from dalembert.surrogate.growth import Growth
from dalembert.surrogate.runs import Runs
from dalembert.surrogate.scheme import Doubt, Fitted

SHARE = 0.3
"""Part of the tolerance that the held-out runs may use up: they are few, and do not lie where the error is largest."""
UNSEEN = 0.1
"""Where less than this part of the error of the held-out runs is expected, its terms are looked for elsewhere."""
BASES = ("sparse", "total-degree", "tensor")


@dataclass(frozen=True)
class Adaptive:
    """Terms added where they are expected to matter most, until the error is below a tolerance.

    Parameters
    ----------
    tolerance : float
        Largest error of an output over the box, as a part of its scale: the largest variation over the box of an
        output of its group; see :func:`dalembert.surrogate.fit`.
    most_runs : int
        Where it ends at the latest, held-out runs included; what it then has is returned with its error.
    basis : str
        Which terms there may be. "sparse": any, each judged by itself, so that parameters which matter little or do
        not act together cost few runs. "total-degree": degree after degree. "tensor": all up to an order in each
        direction, raised in the direction where it is expected to matter most.

    Raises
    ------
    InputError
        For a tolerance that is not positive, no runs, or an unknown basis.

    Notes
    -----
    Terms e and points (ζ_{e_1}, …, ζ_{e_d}) of Leja's sequence ζ belong together: one run more, one term more, and all
    runs are used. What a run adds to the polynomial (its surplus) is its distance to the value foretold, and no term is
    larger in the box than its surplus. A term is expected to be as large as the geometric mean of the surpluses one
    degree below it. When all that is expected is below the tolerance and the held-out runs are not met, it goes on.
    Source of the idea: Gerstner & Griebel, Dimension-adaptive tensor-product quadrature (2003); Chkifa, Cohen &
    Schwab, High-dimensional adaptive sparse polynomial interpolation (2014).

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.surrogate import fit
    >>> found = fit(lambda x: np.exp(x[:, :1]) * (1 + x[:, 1:]), [-1, -1], [1, 1], Adaptive(1e-8), held_out=4)
    >>> found.runs, found.polynomial.degrees.tolist(), bool(found.error[0] < 1e-8 * found.scale[0])
    (27, [10, 3], True)
    """

    tolerance: float = 1e-6
    most_runs: int = 2000
    basis: Literal["sparse", "total-degree", "tensor"] = "sparse"

    def __post_init__(self) -> None:
        expect_positive(self, "tolerance")
        expect_at_least(self, 1, "most_runs")
        if self.basis not in BASES:
            raise InputError(unknown("basis", self.basis, BASES, "Adaptive"))

    def fitted(self, runs: Runs, seed: int, held_out: Doubt, scale: Callable[[], np.ndarray]) -> Fitted:
        growth = Growth(runs.directions, self.basis)
        stalled = False
        while True:
            batch = growth.batch(scale() if growth.terms else None, max(1, self.most_runs - runs.count), stalled)
            growth.add(batch, runs(growth.points(batch)), runs)
            tail, wanted = growth.tail(), self.tolerance * scale()
            stalled = False
            if np.all(tail <= wanted) or runs.count >= self.most_runs:
                exponents, coefficients = growth.polynomial()
                excess = held_out(exponents, coefficients) - SHARE * wanted
                if np.all(excess <= 0) or runs.count >= self.most_runs:
                    return Fitted(exponents, coefficients, tail)
                worst = int(np.argmax(excess / wanted))
                stalled = bool(tail[worst] < UNSEEN * excess[worst])

    def shells(self, exponents: np.ndarray, coefficients: np.ndarray) -> list[np.ndarray]:
        by_degree = by_total_degree if self.basis == "total-degree" else by_direction
        return by_degree(exponents, coefficients)

    def more(self, order: int) -> str:
        return f"allow more runs by Adaptive(most_runs=...), now {self.most_runs}"
