"""A structure with forces, contacts and springs."""

from typing import TypeVar

import numpy as np

from dalembert.arguments import is_number
from dalembert.errors import InputError, ModelError, shown
from dalembert.notebook_display import Displayed
from dalembert.structure import Structure
from dalembert.vibration.laws.contacts import FrictionContact, Number
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.user_element import UserElement
from dalembert.vibration.system.forces import Force
from dalembert.vibration.system.unbalance import Unbalance

Element = FrictionContact | LawElement | UserElement
Part = TypeVar("Part", bound=Force | Element)
SYNCHRONOUS = "synchronous"
"""Speed of a rotor that turns once in a period of the excitation."""


class VibrationSystem(Displayed):
    """A linear structure with forces on it and nonlinear elements in it.

    Parameters
    ----------
    structure : Structure
    speed : float or "synchronous", optional
        Of the rotor parts of the structure, rad/s: a constant one, or that of the excitation, Ω = ω. A structure with
        such parts needs it.

    Raises
    ------
    InputError
        If the structure is not a Structure, the speed is not a number, or a rotor has no speed.

    Examples
    --------
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import HarmonicForce
    >>> system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    >>> force = system.add(HarmonicForce("m", 1.0))
    >>> damper = system.add(FrictionContact("damper", "m", friction=0.5, preload=2.0))
    >>> [element.name for element in system.elements]
    ['damper']
    """

    def __init__(self, structure: Structure, speed: Number | str | None = None) -> None:
        if not isinstance(structure, Structure):
            raise InputError(
                f"VibrationSystem: structure is {shown(structure)}; expected a Structure, such as lumped(...) or "
                "Structure(mass, stiffness, dofs)"
            )
        if speed is None and structure.rotates:
            raise InputError(
                f"VibrationSystem: the structure has a rotor. Give its speed in rad/s, or speed={SYNCHRONOUS!r} for "
                "that of the excitation"
            )
        speed = 0.0 if speed is None else speed
        if speed != SYNCHRONOUS and not is_number(speed):
            raise InputError(
                f"VibrationSystem: speed is {shown(speed)}; expected a number in rad/s, or {SYNCHRONOUS!r} for the "
                "frequency of the excitation"
            )
        self.structure = structure
        self.speed = speed
        self.forces: list[Force] = []
        self.elements: list[Element] = []

    @property
    def highest_harmonic(self) -> int:
        """Highest harmonic in which a force acts; 1 without harmonic forces."""
        return max([1, *(force.harmonic for force in self.forces)])

    def add(self, part: Part) -> Part:
        """Add a force, a contact or a spring, and hand it back."""
        if isinstance(part, Force):
            constant = self.speed != SYNCHRONOUS and (np.real(self.speed) or self.structure.rotates)
            if isinstance(part, Unbalance) and constant:
                raise InputError(
                    f"{part.where} turns with the rotor, and the speed of the system is {self.speed:g} rad/s. Use "
                    f"speed={SYNCHRONOUS!r}"
                )
            self.forces.append(part)
        elif isinstance(part, Element):
            if part.name in (element.name for element in self.elements):
                raise ModelError(f"{type(part).__name__} {part.name!r}: the name is taken; give each element its own")
            self.elements.append(part)
        else:
            raise InputError(f"{shown(part)} was added to a vibrating system; expected a force, a contact or a spring")
        return part
