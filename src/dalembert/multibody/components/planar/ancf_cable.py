"""The gradient-deficient ANCF cable."""

__all__ = ["AncfCable"]

from dataclasses import InitVar, dataclass, field

import numpy as np

from dalembert.findings import Finding
from dalembert.multibody.components.base_body import with_points
from dalembert.multibody.components.fields import Number, number, pair
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.ancf import Ancf
from dalembert.multibody.components.planar.body import Marker
from dalembert.multibody.components.planar.cable_element import CABLE
from dalembert.multibody.components.planar.slenderness import cable_findings
from dalembert.multibody.components.points import Place
from dalembert.multibody.components.rows import Lowering


@with_points("start", "end")
@dataclass(frozen=True)
class AncfCable(Ancf):
    """A bar of gradient-deficient planar ANCF elements (Gerstmayr and Shabana 2006): stretch and bending.

    Parameters
    ----------
    name : str
    length : float
        m.
    elements : int
    youngs_modulus : float
        Pa.
    density : float
        kg/m^3.
    height, width : float
        Of the section, in the plane of motion and across it, m.
    angle, start, velocity, angular_velocity, damping
        As those of :class:`AncfBeam`.

    Examples
    --------
    >>> AncfCable("rope", length=1.0, elements=4, youngs_modulus=1e7, density=1000.0, height=0.01, width=0.01).size
    20
    """

    vectors = 2
    density: Number = number("kg/m**3", above=0)
    height: Number = number("m", above=0)
    width: Number = number("m", above=0)
    angle: Number = number("rad", 0.0)
    start: InitVar[Place] = pair("m")
    velocity: tuple[Number, Number] | None = pair("m/s", None)
    angular_velocity: Number | None = number("rad/s", None)
    damping: Number = number("s", 0.0, least=0)
    origin: Place = field(init=False)

    def __post_init__(self, start: Place) -> None:
        object.__setattr__(self, "origin", start)
        self.require_elements(f"beam {self.name!r}")

    @property
    def findings(self) -> tuple[Finding, ...]:
        return cable_findings(self.name, float(np.real(self.length)), float(np.real(self.height)))

    def marker(self, point: str) -> Marker:
        k = 4 * self.node_number(point)
        return Marker(markers.NODE, (k, k + 1, k + 2, k + 3), (0.0, 0.0, 0.0))

    def lower(self, lowering: Lowering, first: int) -> None:
        h = self.length / self.elements
        area = self.height * self.width
        data = [
            h, self.youngs_modulus * area, self.youngs_modulus * area * self.height**2 / 12, self.density * area * h,
            self.damping, *lowering.gravity,
        ]  # fmt: skip
        lowering.add_many(CABLE, self.element_index(first), data)
