"""The fully parametrised ANCF beam."""

__all__ = ["AncfBeam"]

from dataclasses import InitVar, dataclass, field

import numpy as np

from dalembert.errors import require_known
from dalembert.findings import Finding
from dalembert.multibody.components.base_body import with_points
from dalembert.multibody.components.fields import Number, number, pair
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.ancf import Ancf
from dalembert.multibody.components.planar.beam_strains import strain_findings
from dalembert.multibody.components.planar.body import Marker
from dalembert.multibody.components.planar.continuum_beam import CONTINUUM
from dalembert.multibody.components.planar.slenderness import continuum_findings
from dalembert.multibody.components.planar.structural_beam import STRUCTURAL
from dalembert.multibody.components.points import Place
from dalembert.multibody.components.rows import Lowering

LAWS = ("plane-stress", "plane-strain", "uncoupled")
FORMULATIONS = ("structural", "continuum")


@with_points("start", "end")
@dataclass(frozen=True)
class AncfBeam(Ancf):
    """A bar of fully parametrised planar ANCF elements: stretch, bending, shear and thickness.

    A node has a position r, the slope r_x of the line and the section vector r_y.

    Parameters
    ----------
    name : str
    length : float
        m.
    elements : int
    youngs_modulus : float
        Pa.
    poisson_ratio : float
    density : float
        kg/m^3.
    height, width : float
        Of the section, in the plane of motion and across it, m.
    angle : float
        Initial angle from the x axis, rad.
    start : (float, float) or Point
        Initial position of the start, m. The attributes ``start`` and ``end`` are the bar's points.
    velocity : (float, float), optional
        Initial velocity of the start, m/s. If not given, that of the point that the body is placed at, or zero; the
        joints may change it then.
    angular_velocity : float, optional
        Initial, rad/s. If not given, zero; the joints may change it then.
    damping : float
        Retardation time of the Kelvin-Voigt material, s: stress = D (strain + damping x strain rate).
    law : {"plane-stress", "plane-strain", "uncoupled"}
        Saint-Venant-Kirchhoff material; ``"uncoupled"`` leaves the Poisson coupling out of the normal stresses.
    formulation : {"structural", "continuum"}
        ``"structural"`` has the strains of a beam: stretch, bending, shear with the shear factor
        10 (1 + nu) / (12 + 11 nu) of a rectangle (Cowper 1966), thickness. It does not lock: one or two elements are
        enough for thin and for thick beams. ``"continuum"`` is the published element (Omar and Shabana 2001), with
        Green-Lagrange strains over the whole section. It locks in bending where its elements are thin, and its bending
        stiffness is E I / (1 - nu^2); use it to repeat published results.

    Examples
    --------
    >>> bar = AncfBeam("bar", length=1.0, elements=2, youngs_modulus=2e8, poisson_ratio=0.3, density=5540.0,
    ...                height=0.4, width=0.2)
    >>> bar.size, str(bar.end)
    (18, 'bar.end')
    """

    vectors, has_motion_findings = 3, True
    poisson_ratio: Number = number("", above=-1, below=0.5)
    density: Number = number("kg/m**3", above=0)
    height: Number = number("m", above=0)
    width: Number = number("m", above=0)
    angle: Number = number("rad", 0.0)
    start: InitVar[Place] = pair("m")
    velocity: tuple[Number, Number] | None = pair("m/s", None)
    angular_velocity: Number | None = number("rad/s", None)
    damping: Number = number("s", 0.0, least=0)
    law: str = "plane-stress"
    formulation: str = "structural"
    origin: Place = field(init=False)

    def __post_init__(self, start: Place) -> None:
        object.__setattr__(self, "origin", start)
        self.require_elements(f"beam {self.name!r}")
        owner = f"beam {self.name!r}"
        require_known("law", self.law, LAWS, owner)
        require_known("formulation", self.formulation, FORMULATIONS, owner)

    @property
    def stiffnesses(self) -> tuple[Number, Number, Number]:
        """C11, C12 and the shear modulus G of the law, Pa."""
        e, nu = self.youngs_modulus, self.poisson_ratio
        shear = e / (2 * (1 + nu))
        if self.law == "plane-stress":
            return e / (1 - nu**2), nu * e / (1 - nu**2), shear
        if self.law == "plane-strain":
            lame = e / ((1 + nu) * (1 - 2 * nu))
            return (1 - nu) * lame, nu * lame, shear
        return e, 0.0, shear

    def marker(self, point: str) -> Marker:
        k = 6 * self.node_number(point)
        # The direction of a section is that of r_y, a quarter turn ahead of the axis.
        return Marker(markers.NODE, (k, k + 1, k + 4, k + 5), (0.0, 0.0, -np.pi / 2))

    def motion_findings(self, times: np.ndarray, states: np.ndarray, rates: np.ndarray) -> tuple[Finding, ...]:
        return strain_findings(self, times, states)

    @property
    def findings(self) -> tuple[Finding, ...]:
        if self.formulation != "continuum":
            return ()
        length, height, c11, c12, shear = (float(np.real(n)) for n in (self.length, self.height, *self.stiffnesses))
        return continuum_findings(self.name, length, height, self.elements, (c11, c12, shear))

    @property
    def shear_factor(self) -> Number:
        """Shear factor of a rectangle (Cowper 1966), for plane strain with the Poisson's ratio nu / (1 - nu)."""
        nu = self.poisson_ratio
        if self.law == "plane-strain":
            nu = nu / (1 - nu)
        return 10 * (1 + nu) / (12 + 11 * nu)

    def lower(self, lowering: Lowering, first: int) -> None:
        h, area = self.length / self.elements, self.height * self.width
        mass, square = self.density * area * h, self.height**2 / 12
        c11, c12, shear = self.stiffnesses
        index = self.element_index(first)
        if self.formulation == "continuum":
            data = [h, self.height, self.width, mass, mass * square, c11, c12, shear]
            lowering.add_many(CONTINUUM, index, [*data, self.damping, *lowering.gravity])
            return
        # without stress across the axis
        modulus = c11 - c12**2 / c11
        data = [h, mass, mass * square, c11 * area, c12 * area, self.shear_factor * shear * area]
        lowering.add_many(STRUCTURAL, index, [*data, modulus * area * square, self.damping, *lowering.gravity])
