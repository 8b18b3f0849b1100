"""A surrogate that chooses its own terms, on nested points, until its error is small enough."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from dalembert.arguments import Checked, limited
from dalembert.errors import require_known
from dalembert.surrogate.decay import by_direction, by_total_degree, slow_tails
from dalembert.surrogate.growth import Growth
from dalembert.surrogate.held_out import SHARE, HeldOut
from dalembert.surrogate.runs import Runs
from dalembert.surrogate.scheme import Fitted

# Where less than this part of the error of the held-out runs is expected, its terms are looked for elsewhere.
UNSEEN = 0.1
RECHECK = 1.05  # growth of the number of terms after which the decay of the coefficients is looked at again
AGREED = 3  # times that the decay must agree once it did not: by chance the last terms of a kink are small now and then
KEPT = 6  # arrays of a number for each run and output that are kept: runs, surpluses, candidates and their copies
BASES = ("sparse", "total-degree", "tensor")


@dataclass(frozen=True)
class Adaptive(Checked):
    """Terms added where they are expected to matter most, until the error is below a tolerance.

    Parameters
    ----------
    tolerance : float
        Largest error of an output over the box, as a part of its scale: the largest variation over the box of an
        output of its group; see :func:`dalembert.surrogate.fit`.
    most_runs : int
        Where it ends at the latest, held-out runs included; what it then has is returned with its error.
    most_order : int
        Degree in one direction at which it ends. Functions with a kink or a step need thousands.
    memory : float
        Bytes for runs and terms; a run takes 8 bytes an output, six times.
    cautious : bool
        Whether the decay of the coefficients by degree must agree before it stops. Not needed where true runs check
        the answer.
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
    degree below it. When all that is expected is below the tolerance and the held-out runs are not met, it continues.
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

    tolerance: float = limited(1e-6, above=0)
    most_runs: int = limited(2000, least=1)
    most_order: int = limited(256, least=1)
    memory: float = limited(1e9, above=0)
    cautious: bool = True
    basis: Literal["sparse", "total-degree", "tensor"] = "sparse"

    def __post_init__(self) -> None:
        require_known("basis", self.basis, BASES, "Adaptive")

    def fitted(self, runs: Runs, seed: int, held_out: HeldOut, scale: Callable[[], np.ndarray]) -> Fitted:
        growth = Growth(runs.directions, self.basis)
        stalled, next_check, doubted = 0, 0, []
        while True:
            # Terms in batches of one expected size: a batch is one call of the model, a term at a time would be serial.
            most, limit = self._most(runs)
            batch = growth.batch(scale() if growth.terms else None, max(1, most - runs.count), stalled)
            highest = max(map(max, batch))
            if highest > self.most_order:
                return self._fitted(growth, f"raise Adaptive(most_order=...), now {self.most_order}")
            growth.add(batch, runs.complete(growth.points(batch), "an adaptive"))
            full = runs.count >= most
            tail, wanted = growth.tail(), self.tolerance * scale()
            excess = held_out.difference_of(growth) - SHARE * wanted
            if full:
                return self._fitted(growth, limit)
            # 1. Terms that are expected to matter are added. 2. Where none is, but held-out runs disagree, terms
            # elsewhere. 3. Then the decay of the coefficients has to agree.
            if np.any(tail > wanted):
                stalled = 0
            elif np.any(excess > 0):
                worst = int(np.argmax(excess / wanted))
                stalled = stalled + 1 if tail[worst] < UNSEEN * excess[worst] else 0
            elif len(growth.terms) >= next_check:
                fitted = self._fitted(growth, "")
                if not self.cautious:
                    return fitted
                doubted.append(fitted.tail)
                # The largest of the last three: the order may fall between two waves of the coefficients of a kink.
                latest = np.max(doubted[-AGREED:], axis=0)
                if np.all(latest <= wanted):
                    return replace(fitted, tail=latest)
                stalled, next_check = 0, len(growth.terms) * RECHECK

    def _most(self, runs: Runs) -> tuple[int, str]:
        """Return the number of runs that the limits allow, and how to raise the one that counts."""
        outputs = 1 if runs.range is None else runs.range.shape[1]
        affordable = int(self.memory / (KEPT * 8 * outputs))
        if affordable < self.most_runs:
            return affordable, f"raise Adaptive(memory=...), now {self.memory:.3g} bytes"
        return self.most_runs, f"allow more runs by Adaptive(most_runs=...), now {self.most_runs}"

    def _fitted(self, growth: Growth, ended: str) -> Fitted:
        (exponents, coefficients), tail = growth.polynomial(), growth.tail()
        if self.cautious:
            tail = np.maximum(tail, slow_tails(by_direction(exponents, coefficients)))
        return Fitted(exponents, coefficients, tail, ended)

    def shells(self, exponents: np.ndarray, coefficients: np.ndarray) -> list[np.ndarray]:
        by_degree = by_total_degree if self.basis == "total-degree" else by_direction
        return by_degree(exponents, coefficients)

    def more(self, order: int) -> str:
        """Advice where no limit ended it: it has reached its tolerance."""
        return f"allow less error by Adaptive(tolerance=...), now {self.tolerance:g}"
