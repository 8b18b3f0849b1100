"""The force of a rotating unbalance."""

from dataclasses import dataclass, field

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError
from dalembert.structure import Structure
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.system.force_terms import Term, term_at


@dataclass(frozen=True)
class Unbalance(Checked):
    r"""The force of a rotating unbalance, :math:`m e\,\omega^2 (\cos(\omega t + \varphi), \sin(\omega t + \varphi))`.

    Parameters
    ----------
    first, second : str
        Degrees of freedom across the axis, such as ``"disk.x"`` and ``"disk.y"``. The rotor turns from the first to the
        second.
    moment : float
        Mass times eccentricity, kg m.
    phase : float
        rad.

    Examples
    --------
    >>> import numpy as np
    >>> import dalembert as da
    >>> rotor = da.lumped({"disk.x": 1.0, "disk.y": 1.0}, [("disk.x", None, 1.0, 0.1), ("disk.y", None, 1.0, 0.1)])
    >>> system = da.VibrationSystem(rotor, speed="synchronous")
    >>> unbalance = system.add(Unbalance("disk.x", "disk.y", moment=0.01))
    >>> curve = da.frequency_response(system, np.array([1.0]) / (2 * np.pi))
    >>> float(curve.amplitude("disk.x")[0].round(6))  # at the resonance: m e/(2 D) with D = 0.05
    0.1
    """

    first: str
    second: str
    moment: Number = field(metadata={"unit": "kg*m"})
    phase: Number = field(default=0.0, metadata={"unit": "rad"})

    def __post_init__(self) -> None:
        if self.first == self.second:
            raise InputError(f"{self.where}: both directions are equal; expected two across the axis")

    @property
    def dofs(self) -> tuple[str, ...]:
        """Where it acts."""
        return self.first, self.second

    @property
    def where(self) -> str:
        """What it is, for messages."""
        return f"the unbalance at {self.first!r}"

    @property
    def harmonic(self) -> int:
        """Once in a turn."""
        return 1

    def terms(self, structure: Structure) -> list[Term]:
        """Return its parts on the degrees of freedom of a structure."""
        # sin(τ + φ) = sin φ cos τ + cos φ sin τ
        c, s = self.moment * np.cos(self.phase), self.moment * np.sin(self.phase)
        ends = (self.first, c, -s), (self.second, s, c)
        return [
            term_at(structure, dof, cosine, sine, 1, lambda omega: (omega**2, 2 * omega)) for dof, cosine, sine in ends
        ]
