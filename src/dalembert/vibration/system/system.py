"""A structure with forces, contacts and springs."""

from dataclasses import dataclass, field
from typing import TypeVar

from dalembert.arguments import Checked
from dalembert.errors import InputError, ModelError, shown
from dalembert.notebook_display import Displayed
from dalembert.structure import Structure
from dalembert.vibration.laws.contacts import FrictionContact, Number
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.user_element import UserElement


@dataclass(frozen=True)
class HarmonicForce(Checked):
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
        if self.harmonic < 1:
            raise InputError(
                f"force on {self.dof!r}: the harmonic is {self.harmonic}; expected 1 or more, and a StaticForce for a "
                "force that does not change"
            )


@dataclass(frozen=True)
class StaticForce(Checked):
    """A constant force on a degree of freedom.

    Parameters
    ----------
    dof : str
    value : float
        N.
    """

    dof: str
    value: Number = field(metadata={"unit": "N"})


Element = FrictionContact | LawElement | UserElement
Part = TypeVar("Part", bound=HarmonicForce | StaticForce | Element)


class VibrationSystem(Displayed):
    """A linear structure with forces on it and nonlinear elements in it.

    Parameters
    ----------
    structure : Structure

    Raises
    ------
    InputError
        For anything else than a structure.

    Examples
    --------
    >>> from dalembert.structure import lumped
    >>> system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    >>> force = system.add(HarmonicForce("m", 1.0))
    >>> damper = system.add(FrictionContact("damper", "m", friction=0.5, preload=2.0))
    >>> [element.name for element in system.elements]
    ['damper']
    """

    def __init__(self, structure: Structure) -> None:
        if not isinstance(structure, Structure):
            raise InputError(
                f"VibrationSystem: structure is {shown(structure)}; expected a Structure, such as lumped(...) or "
                "Structure(mass, stiffness, dofs)"
            )
        self.structure = structure
        self.forces: list[HarmonicForce | StaticForce] = []
        self.elements: list[Element] = []

    @property
    def highest_harmonic(self) -> int:
        """Highest harmonic in which a force acts; 1 without harmonic forces."""
        return max([1, *(force.harmonic for force in self.forces if isinstance(force, HarmonicForce))])

    def add(self, part: Part) -> Part:
        """Add a force, a contact or a spring, and hand it back."""
        if isinstance(part, HarmonicForce | StaticForce):
            self.forces.append(part)
        elif isinstance(part, Element):
            if part.name in (element.name for element in self.elements):
                raise ModelError(f"{type(part).__name__} {part.name!r}: the name is taken; give each element its own")
            self.elements.append(part)
        else:
            raise InputError(f"{shown(part)} was added to a vibrating system; expected a force, a contact or a spring")
        return part
