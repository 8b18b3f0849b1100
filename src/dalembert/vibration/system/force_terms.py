r"""Forces on a vibrating system, as sums of terms.

A term is a pattern over the degrees of freedom times a function of the excitation frequency,
:math:`f(t) = p(\omega)\,[a \cos h\omega t + b \sin h\omega t]`. A structure answers each pattern once, whatever the
frequency.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from dalembert.errors import InputError
from dalembert.structure import Structure
from dalembert.vibration.laws.contacts import Number

Factor = Callable[[float], tuple[float, float]]
"""A function of ω, and its derivative."""


class Term(NamedTuple):
    """A part of a force: degrees of freedom ``rows``, ``cosine`` a and ``sine`` b (rows,) in N, ``harmonic`` h, and
    ``factor``, p; None for 1.
    """

    rows: np.ndarray
    cosine: np.ndarray
    sine: np.ndarray
    harmonic: int
    factor: Factor | None = None


class AtDof:
    """A force on one degree of freedom."""

    dof: str

    @property
    def dofs(self) -> tuple[str, ...]:
        """Where it acts."""
        return (self.dof,)

    @property
    def where(self) -> str:
        """What it is, for messages."""
        return f"the force on {self.dof!r}"


def term_at(
    structure: Structure, dof: str, cosine: Number, sine: Number, harmonic: int, factor: Factor | None = None
) -> Term:
    """Return a term on one degree of freedom."""
    row = structure.dofs.index(dof, "a force")
    return Term(np.array([row]), np.array([cosine]), np.array([sine]), harmonic, factor)


def require_varying(where: str, harmonic: int) -> None:
    """Raise InputError for a harmonic that is the mean."""
    if harmonic < 1:
        raise InputError(
            f"{where}: the harmonic is {harmonic}; expected 1 or more, and a StaticForce for a force that does not "
            "change"
        )
