"""A polynomial in place of a costly function, with the runs that it comes from and an estimate of its error."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import SolveError
from dalembert.surrogate.decay import by_direction, needed_order, slow_tail
from dalembert.surrogate.held_out import SHARE
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
    tested : int
        Number of held-out runs that succeeded.
    ended : str
        Which limit ended the growth and how to raise it; empty if none did.
    """

    polynomial: ChebyshevPolynomial
    scheme: Scheme
    tail: np.ndarray
    held_out: np.ndarray
    points: np.ndarray
    values: np.ndarray
    scale: np.ndarray
    failures: int = 0
    tested: int = 0
    ended: str = ""

    def __call__(self, points: ArrayLike) -> np.ndarray:
        """Values of the polynomial at points (n, d), shape (n, outputs)."""
        return self.polynomial(points)

    @property
    def runs(self) -> int:
        """Number of true runs made: the held-out and the failed ones count."""
        return len(self.points) + self.failures

    @property
    def error(self) -> np.ndarray:
        """Estimate of the largest error over the box, shape (outputs,): the larger of ``tail`` and ``held_out``/0.2.

        The held-out runs are few and do not lie where the error is largest.
        """
        return np.maximum(self.tail, self.held_out / SHARE)

    @cached_property
    def order(self) -> int:
        """The order p: total degree or highest degree of a direction, as its scheme counts."""
        return max((len(shells) - 1 for shells in self._shells), default=0)

    @property
    def improvement(self) -> str:
        """Which setting gives a surrogate with less error: the limit that ended it, or that of its scheme."""
        return self.ended or self.scheme.more(2 * self.order)

    @cached_property
    def _shells(self) -> list[np.ndarray]:
        return self.scheme.shells(self.polynomial.exponents, self.polynomial.coefficients)

    def needed_order(self, tolerance: ArrayLike) -> int:
        """Return the order that suffices for a tolerance, a number or (outputs,), if the decay continues.

        Where the coefficients do not decay yet, it is twice the order: the next one to try. Where the held-out runs
        show a larger error than the coefficients, the tolerance is reduced by the ratio of the two.
        """
        return self._needed(np.broadcast_to(np.asarray(tolerance, dtype=float), self.tail.shape))[0]

    def _needed(self, wanted: np.ndarray) -> tuple[int, bool]:
        """The order that would do, and whether it is more than the next one to try."""
        if np.all(self.error <= wanted):
            return self.order, True
        seen = np.maximum(self.tail, self.held_out)
        trust = np.divide(self.tail, seen, out=np.ones_like(self.tail), where=seen > 0)
        share = wanted * np.maximum(trust, 1e-3) / max(len(self._shells), 1)
        orders, seen = zip(*(needed_order(shells, share) for shells in self._shells), strict=True)
        return max(self.order + 1, *orders), all(seen)

    def slow_directions(self, tolerance: np.ndarray) -> list[int]:
        """Return the directions in which the coefficients decay as slowly as those of a kink or a step.

        Parameters
        ----------
        tolerance : array, shape (outputs,)
            A direction counts if, for at least one output, the terms left out along it add more than this.

        Returns
        -------
        list of int
            Numbers of the directions, that is of the columns of the points, from 0.
        """
        shells = by_direction(self.polynomial.exponents, self.polynomial.coefficients)
        return [k for k, shell in enumerate(shells) if np.any(slow_tail(shell) > tolerance)]

    def demand(
        self,
        tolerance: ArrayLike,
        name: Callable[[int], str] = "output {}".format,
        parameters: Sequence[str] = (),
        instead: str = "",
    ) -> None:
        """Refuse a surrogate whose error is above the tolerance, a number or (outputs,).

        Parameters
        ----------
        tolerance : float or array, shape (outputs,)
        name : callable
            How the error calls an output, from its number.
        parameters : sequence of str, of length d
            Names of the directions; their numbers if not given.
        instead : str
            Name of a method for functions that are not smooth.

        Raises
        ------
        SolveError
            With the error, the order, the runs, the directions in which the coefficients do not decay, and the order
            that would do.
        """
        wanted = np.broadcast_to(np.asarray(tolerance, dtype=float), self.error.shape)
        if np.all(self.error <= wanted):
            return
        worst = int(np.argmax(self.error / np.maximum(wanted, np.finfo(float).tiny)))
        start = (
            f"the surrogate of order {self.order} is wrong by about {self.error[worst]:.2g} at {name(worst)}, "
            f"more than the tolerance of {wanted[worst]:.2g}"
        )
        slow = self.slow_directions(wanted)
        if slow:
            where = ", ".join(repr(parameters[k]) if len(parameters) else f"direction {k}" for k in slow)
            advice = [f"use method {instead!r}"] * bool(instead) + [self.improvement]
            raise SolveError(
                f"{start}, after {self.runs} runs; the coefficients do not decay along {where}, as at a kink, a step "
                f"or a fast oscillation: {', '.join(advice)}, raise the tolerance, or make the box smaller"
            )
        order, seen = self._needed(wanted)
        advice = f"about order {order} " + ("would do" if seen else "is to be tried next, as no decay shows yet")
        raise SolveError(
            f"{start}; {advice}: {self.ended or self.scheme.more(order)}, raise the tolerance, or make the box smaller"
        )
