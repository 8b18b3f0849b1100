"""A base that moves."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError
from dalembert.structure import Structure
from dalembert.structure.structure import AXES
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.system.force_terms import Term, require_varying


@dataclass(frozen=True)
class BaseExcitation(Checked):
    r"""A base that moves along an axis, :math:`x_b = X \cos(h\omega t + \varphi)`, and carries a structure.

    The displacements of the structure are those relative to the base: it feels the force
    :math:`-M \iota\, \ddot x_b`, with :math:`\iota` = 1 for the degrees of freedom along the axis. Springs, dampers and
    contacts to the ground act between the structure and the base.

    Parameters
    ----------
    direction : {"x", "y", "z"}
    displacement : float
        X, m.
    acceleration : float
        Amplitude of the acceleration, m/s², in place of the displacement.
    phase : float
        rad, of the displacement or the acceleration that is stated.
    harmonic : int

    Raises
    ------
    InputError
        For both amplitudes, or none; and for a structure without mass along the axis.

    Examples
    --------
    >>> import numpy as np
    >>> import dalembert as da
    >>> system = da.VibrationSystem(da.lumped({"m": 2.0}, [("m", None, 2.0, 0.2)]))
    >>> base = system.add(BaseExcitation("x", displacement=0.01))
    >>> curve = da.frequency_response(system, np.array([1.0]) / (2 * np.pi))
    >>> float(curve.amplitude("m")[0].round(6))  # X/(2 D) with D = 0.05
    0.1
    """

    direction: str
    displacement: Number | None = field(default=None, metadata={"unit": "m"})
    acceleration: Number | None = field(default=None, metadata={"unit": "m/s^2"})
    phase: Number = field(default=0.0, metadata={"unit": "rad"})
    harmonic: int = 1

    def __post_init__(self) -> None:
        require_varying(self.where, self.harmonic)
        if self.direction not in AXES:
            raise InputError(f"BaseExcitation: direction is {self.direction!r}; expected one of {', '.join(AXES)}")
        if (self.displacement is None) == (self.acceleration is None):
            stated = "no displacement and no acceleration"
            if self.displacement is not None:
                stated = "both a displacement and an acceleration"
            raise InputError(f"{self.where} has {stated}; expected one of them")

    @property
    def dofs(self) -> tuple[str, ...]:
        """None of the structure: the force acts on all masses."""
        return ()

    @property
    def where(self) -> str:
        """What it is, for messages."""
        return f"the base excitation along {self.direction!r}"

    def terms(self, structure: Structure) -> list[Term]:
        """Return its parts on the degrees of freedom of a structure."""
        inertia = structure.inertia_of_base[:, AXES.index(self.direction)]
        if not np.any(inertia):
            raise InputError(f"{self.where}: no degree of freedom with a mass moves along this axis")
        # -M ι ẍ_b: + (hω)² X M ι cos(hτ + φ) of a displacement.
        h, moves = self.harmonic, self.acceleration is None
        size: Any = self.displacement if self.acceleration is None else -self.acceleration
        c, s = inertia * size * np.cos(self.phase), -inertia * size * np.sin(self.phase)
        rows = np.arange(structure.size)
        return [Term(rows, c, s, h, (lambda omega: ((h * omega) ** 2, 2 * h**2 * omega)) if moves else None)]
