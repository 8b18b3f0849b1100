"""Harmonic and static forces on a degree of freedom."""

from dataclasses import dataclass, field

import numpy as np

from dalembert.arguments import Checked
from dalembert.structure import Structure
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.system.force_terms import AtDof, Term, require_varying, term_at


@dataclass(frozen=True)
class HarmonicForce(AtDof, Checked):
    """Force amplitude · cos(harmonic · ω t + phase) on a degree of freedom.

    Parameters
    ----------
    dof : str
        Such as ``"A.x"``.
    amplitude : float
        N.
    phase : float
        rad.
    harmonic : int
    """

    dof: str
    amplitude: Number = field(metadata={"unit": "N"})
    phase: Number = field(default=0.0, metadata={"unit": "rad"})
    harmonic: int = 1

    def __post_init__(self) -> None:
        require_varying(self.where, self.harmonic)

    def terms(self, structure: Structure) -> list[Term]:
        """Return its parts on the degrees of freedom of a structure."""
        # a cos(hτ + φ) = a cos φ cos hτ - a sin φ sin hτ
        turned = self.amplitude * np.cos(self.phase), -self.amplitude * np.sin(self.phase)
        return [term_at(structure, self.dof, *turned, self.harmonic)]


@dataclass(frozen=True)
class StaticForce(AtDof, Checked):
    """A constant force on a degree of freedom.

    Parameters
    ----------
    dof : str
    value : float
        N.
    """

    dof: str
    value: Number = field(metadata={"unit": "N"})

    @property
    def harmonic(self) -> int:
        """The mean."""
        return 0

    def terms(self, structure: Structure) -> list[Term]:
        """Return its only part."""
        return [term_at(structure, self.dof, self.value, 0.0, 0)]
