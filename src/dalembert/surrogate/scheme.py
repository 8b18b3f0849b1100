"""Result of every scheme: a polynomial on the reference box, and its estimated decay."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from dalembert.surrogate.held_out import HeldOut
from dalembert.surrogate.runs import Runs


@dataclass(frozen=True)
class Fitted:
    """A polynomial in η in [−1, 1]^f."""

    exponents: np.ndarray  # (terms, f)
    coefficients: np.ndarray  # (terms, outputs)
    tail: np.ndarray  # (outputs,): estimate of what the terms left out would add
    ended: str = ""  # which limit ended the growth and how to raise it; empty if none did


@runtime_checkable
class Scheme(Protocol):
    """Settings of a way to choose terms and runs."""

    def fitted(self, runs: Runs, seed: int, held_out: HeldOut, scale: Callable[[], np.ndarray]) -> Fitted:
        """Return the polynomial, from runs that it asks for. ``held_out``: runs that the polynomial is not fitted to.
        An adaptive scheme adds terms until the polynomial agrees with them. ``scale`` returns the sizes (outputs,) to
        which a tolerance is relative, from all runs so far.
        """
        ...

    def shells(self, exponents: np.ndarray, coefficients: np.ndarray) -> list[np.ndarray]:
        """Sums of |coefficients| by degree, from which the decay is read; see :mod:`dalembert.surrogate.decay`."""
        ...

    def more(self, order: int) -> str:
        """Which settings would make the error smaller, given the order that would do."""
        ...
