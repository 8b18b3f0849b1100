"""Runs that a polynomial is tested by and not made from."""

from dataclasses import dataclass, field

import numpy as np

from dalembert.errors import InputError
from dalembert.latin_hypercube import latin_hypercube
from dalembert.surrogate.basis import chebyshev, products
from dalembert.surrogate.growth import Growth
from dalembert.surrogate.leja import hierarchical_at
from dalembert.surrogate.runs import Runs, failed

SHARE = 0.2  # part of the largest error that held-out runs show: they are few, and do not lie where it is
FEWEST, EACH = 10, 2  # held-out runs in all and for each direction, the larger number counts, where none is given


@dataclass(eq=False)
class HeldOut:
    """Held-out runs that succeeded."""

    eta: np.ndarray  # (runs, f)
    values: np.ndarray  # (runs, outputs)
    _table: list[np.ndarray] = field(default_factory=list, init=False)
    _seen: int = field(default=0, init=False)
    _predicted: np.ndarray | float = field(default=0.0, init=False)

    def difference(self, exponents: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
        """Return the largest difference (outputs,) to a polynomial; zero without runs."""
        if not len(self.eta):
            return np.zeros(coefficients.shape[1])
        basis = products(chebyshev(self.eta, exponents.max(axis=0, initial=0)), exponents)
        return np.max(np.abs(basis @ coefficients - self.values), axis=0)

    def difference_of(self, growth: Growth) -> np.ndarray:
        """Return the same for a growing polynomial, of which only the terms since the last call are evaluated."""
        exponents, surpluses = growth.since(self._seen)
        if not len(self.eta):
            return np.zeros(surpluses.shape[1])
        highest = int(exponents.max(initial=0))
        if not self._table or highest >= self._table[0].shape[1]:
            self._table = [hierarchical_at(column, 2 * highest + 16) for column in self.eta.T]
        self._predicted = self._predicted + products(self._table, exponents) @ surpluses
        self._seen = len(growth.terms)
        return np.max(np.abs(self._predicted - self.values), axis=0)


def held_out_runs(runs: Runs, number: int | None, seed: int) -> HeldOut:
    """Make the held-out runs: ``number`` of them, or by the directions if it is None.

    They form a Latin hypercube in arccos η, so that they are denser near the sides, where surrogates are worst.
    """
    if number is None:
        number = max(FEWEST, EACH * runs.directions)
    if number < 0:
        raise InputError(f"held_out is {number}; expected zero or more runs")
    if not (number and runs.directions):
        return HeldOut(np.empty((0, runs.directions)), np.empty((0, 0)))
    eta = -np.cos(np.pi * latin_hypercube(runs.directions, number, np.random.default_rng((seed, 3))))
    values = runs(eta)
    kept = ~failed(values)
    return HeldOut(eta[kept], values[kept])
