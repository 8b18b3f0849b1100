"""A polynomial in place of a costly function, with the runs that it comes from and an estimate of its error."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import SolveError
from dalembert.surrogate.decay import needed_order
from dalembert.surrogate.polynomial import ChebyshevPolynomial
from dalembert.surrogate.scheme import Scheme


@dataclass(frozen=True, eq=False)
class Surrogate:
    """What :func:`fit` returns.

    Parameters
    ----------
    polynomial : ChebyshevPolynomial
    scheme : TotalDegree, Tensor or Adaptive
    tail : array, shape (outputs,)
        Estimate of what the terms left out would add, from the decay of the coefficients.
    held_out : array, shape (outputs,)
        Largest difference to the runs that the polynomial was not made from; zero if there are none.
    points : array, shape (runs that succeeded, d)
        Of all true runs, the held-out ones first.
    values : array, shape (runs that succeeded, outputs)
    scale : array, shape (outputs,)
        Variation to which a relative tolerance refers; see :func:`fit`.
    failures : int
        Number of runs that failed.
    """

    polynomial: ChebyshevPolynomial
    scheme: Scheme
    tail: np.ndarray
    held_out: np.ndarray
    points: np.ndarray
    values: np.ndarray
    scale: np.ndarray
    failures: int = 0

    def __call__(self, points: ArrayLike) -> np.ndarray:
        """Values of the polynomial at points (n, d), shape (n, outputs)."""
        return self.polynomial(points)

    @property
    def runs(self) -> int:
        """Number of true runs made: the held-out and the failed ones count."""
        return len(self.points) + self.failures

    @property
    def error(self) -> np.ndarray:
        """Estimate of the largest error over the box, shape (outputs,): the larger one of ``tail`` and ``held_out``."""
        return np.maximum(self.tail, self.held_out)

    @cached_property
    def order(self) -> int:
        """The order p: total degree or highest degree of a direction, as its scheme counts."""
        return max((len(shells) - 1 for shells in self._shells), default=0)

    @cached_property
    def _shells(self) -> list[np.ndarray]:
        return self.scheme.shells(self.polynomial.exponents, self.polynomial.coefficients)

    def needed_order(self, tolerance: ArrayLike) -> int:
        """Order that would do for this tolerance, a number or (outputs,), if the coefficients go on as they decay.

        Where they do not decay yet, twice the order: the next one to try. Where the held-out runs show a larger error
        than the coefficients do, the tolerance is taken as much smaller.
        """
        return self._needed(np.broadcast_to(np.asarray(tolerance, dtype=float), self.tail.shape))[0]

    def _needed(self, wanted: np.ndarray) -> tuple[int, bool]:
        """The order that would do, and whether it is more than the next one to try."""
        if np.all(self.error <= wanted):
            return self.order, True
        trust = np.divide(self.tail, self.error, out=np.ones_like(self.tail), where=self.error > 0)
        share = wanted * np.maximum(trust, 1e-3) / max(len(self._shells), 1)
        orders, seen = zip(*(needed_order(shells, share) for shells in self._shells), strict=True)
        return max(self.order + 1, *orders), all(seen)

    def demand(self, tolerance: ArrayLike, name: Callable[[int], str] = "output {}".format) -> None:
        """Refuses a surrogate whose error is above the tolerance, a number or (outputs,).

        ``name`` is how the error calls an output, given its number.

        Raises
        ------
        SolveError
            With the error, the order, and the order that would do.
        """
        wanted = np.broadcast_to(np.asarray(tolerance, dtype=float), self.error.shape)
        if np.all(self.error <= wanted):
            return
        worst = int(np.argmax(self.error / np.maximum(wanted, np.finfo(float).tiny)))
        order, seen = self._needed(wanted)
        advice = f"about order {order} " + ("would do" if seen else "is to be tried next, as no decay shows yet")
        raise SolveError(
            f"the surrogate of order {self.order} is wrong by about {self.error[worst]:.2g} at {name(worst)}, "
            f"more than the tolerance of {wanted[worst]:.2g}; {advice}: "
            f"{self.scheme.more(order)}, raise the tolerance, or make the box smaller"
        )
