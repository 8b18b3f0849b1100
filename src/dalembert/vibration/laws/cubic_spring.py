"""Cubic springs."""

from dataclasses import dataclass, field

from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.law import law


@law
def cubic(u, v, z, numbers, force):
    """Force k u³."""
    force[0] = numbers[0] * u[0] * u[0] * u[0]


@dataclass(frozen=True)
class CubicSpring(LawElement):
    """Force k u³ between two degrees of freedom, or one and the ground.

    Parameters
    ----------
    name : str
    first : str
        Degree of freedom, such as ``"A.x"``.
    second : str, optional
        The ground if not given; u is the first displacement less the second.
    stiffness : float
        N/m³.
    """

    stiffness: Number = field(kw_only=True, metadata={"unit": "N/m^3"})

    law = cubic
