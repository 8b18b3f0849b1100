"""Flexible bars of ANCF elements, straight and undeformed at first."""

from abc import abstractmethod
from dataclasses import InitVar, dataclass, field
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from dalembert.errors import InputError, unknown
from dalembert.multibody.bodies import GRADIENT, POSITION, Body, Marker, turned, with_points
from dalembert.multibody.fields import Number, number, pair, require, require_not_negative
from dalembert.multibody.kernels import markers
from dalembert.multibody.points import Place, Point

if TYPE_CHECKING:
    from dalembert.multibody.lowering import Lowering

MOST_ELEMENTS = 100_000
"""Of a beam: a hundred times as many as the longest chain of the benchmarks."""
LAWS = ("plane-stress", "plane-strain", "uncoupled")


@dataclass(frozen=True)
class _Ancf(Body):
    """What both beams share: a chain of equal elements between equal nodes, cubic along the axis.

    Its first vectors a node are the position and the gradient along the axis.
    """

    length: Number = number("m")
    elements: int = cast(Any, field())  # as a field of ours is to a type checker: any
    youngs_modulus: Number = number("Pa")

    @property
    @abstractmethod
    def vectors(self) -> int:
        """Vectors of two components a node."""

    @property
    def place(self) -> Place:
        return self.origin  # type: ignore[attr-defined] - every concrete beam has it

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        node = (POSITION, POSITION) + (GRADIENT, GRADIENT) * (self.vectors - 1)
        return node * (self.elements + 1)

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("start", "end", *(f"node{k}" for k in range(self.elements + 1)))

    def node(self, number: int) -> Point:
        """Node 0 (the start) to node ``elements`` (the end)."""
        return self.point(f"node{number}")

    def _node(self, point: str) -> int:
        ends = {"start": 0, "end": self.elements}
        return ends[point] if point in ends else int(point.removeprefix("node"))

    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        c, s = turned(1.0, 0.0, angle)
        along = np.linspace(0.0, 1.0, self.elements + 1) * self.length
        frame = [c, s, -s, c][: 2 * (self.vectors - 1)]
        nodes = np.empty((self.elements + 1, 2 * self.vectors), dtype=np.result_type(x, y, angle, along))
        nodes[:, 0], nodes[:, 1], nodes[:, 2:] = x + along * c, y + along * s, frame
        return nodes.ravel()

    def element_index(self, first: int) -> np.ndarray:
        """Coordinates of each element, (elements, 4 vectors)."""
        return first + np.arange(4 * self.vectors) + 2 * self.vectors * np.arange(self.elements)[:, None]

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        nodes = coordinates.reshape(len(coordinates), self.elements + 1, self.vectors, 2)
        h = np.real(self.length) / self.elements
        xi = np.linspace(0.0, 1.0, points + 1)[:, None]
        shape = [1 - 3 * xi**2 + 2 * xi**3, h * (xi - 2 * xi**2 + xi**3), 3 * xi**2 - 2 * xi**3, h * (xi**3 - xi**2)]
        r, t = nodes[:, :, None, 0], nodes[:, :, None, 1]
        line = shape[0] * r[:, :-1] + shape[1] * t[:, :-1] + shape[2] * r[:, 1:] + shape[3] * t[:, 1:]
        inner = line[:, :, :-1].reshape(len(coordinates), -1, 2)
        return np.concatenate([inner, line[:, -1, -1:]], axis=1)

    def _check(self) -> None:
        owner = f"beam {self.name!r}"
        require(owner, length=self.length, youngs_modulus=self.youngs_modulus)
        if not (isinstance(self.elements, int) and 0 < self.elements <= MOST_ELEMENTS):
            raise InputError(
                f"{owner}: elements is {self.elements!r}; expected a whole number, from 1 to {MOST_ELEMENTS}"
            )


@with_points("start", "end")
@dataclass(frozen=True)
class AncfBeam(_Ancf):
    """A bar of fully parametrised planar ANCF elements (Omar and Shabana 2001): stretch, bending, shear, thickness.

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
        At first, rad, from the x axis.
    start : (float, float) or Point
        Where the bar starts at first, m. The attributes ``start`` and ``end`` are the bar's points.
    velocity : (float, float)
        Of the start at first, m/s.
    angular_velocity : float
        At first, rad/s.
    damping : float
        Retardation time of the Kelvin-Voigt material, s: stress = D (strain + damping x strain rate).
    law : {"plane-stress", "plane-strain", "uncoupled"}
        Saint-Venant-Kirchhoff material; ``"uncoupled"`` leaves the Poisson coupling out of the normal stresses.

    Examples
    --------
    >>> bar = AncfBeam("bar", length=1.0, elements=2, youngs_modulus=2e8, poisson_ratio=0.3, density=5540.0,
    ...                height=0.4, width=0.2)
    >>> bar.size, str(bar.end)
    (18, 'bar.end')
    """

    poisson_ratio: Number = number("")
    density: Number = number("kg/m**3")
    height: Number = number("m")
    width: Number = number("m")
    angle: Number = number("rad", 0.0)
    start: InitVar[Place] = pair("m")
    velocity: tuple[Number, Number] = pair("m/s")
    angular_velocity: Number = number("rad/s", 0.0)
    damping: Number = number("s", 0.0)
    law: str = "plane-stress"
    origin: Place = field(init=False)

    def __post_init__(self, start: Place) -> None:
        object.__setattr__(self, "origin", start)
        self._check()
        owner = f"beam {self.name!r}"
        require(owner, density=self.density, height=self.height, width=self.width)
        require_not_negative(owner, damping=self.damping)
        if self.law not in LAWS:
            raise InputError(unknown("law", self.law, LAWS, owner))
        if not -1 < np.real(self.poisson_ratio) < 0.5:
            raise InputError(
                f"{owner}: poisson_ratio is {np.real(self.poisson_ratio):g}; expected a number in (-1, 0.5)"
            )

    @property
    def vectors(self) -> int:
        return 3

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
        k = 6 * self._node(point)
        # The direction of a section is that of r_y, a quarter turn ahead of the axis.
        return Marker(markers.NODE, (k, k + 1, k + 4, k + 5), (0.0, 0.0, -np.pi / 2))

    def lower(self, lowering: "Lowering", first: int) -> None:
        h = self.length / self.elements
        line = self.density * self.height * self.width
        data = [
            h, self.height, self.width, line * h, line * h * self.height**2 / 12, *self.stiffnesses, self.damping,
            *lowering.gravity,
        ]  # fmt: skip
        lowering.add_many("beams", self.element_index(first), data)


@with_points("start", "end")
@dataclass(frozen=True)
class AncfCable(_Ancf):
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

    density: Number = number("kg/m**3")
    height: Number = number("m")
    width: Number = number("m")
    angle: Number = number("rad", 0.0)
    start: InitVar[Place] = pair("m")
    velocity: tuple[Number, Number] = pair("m/s")
    angular_velocity: Number = number("rad/s", 0.0)
    damping: Number = number("s", 0.0)
    origin: Place = field(init=False)

    def __post_init__(self, start: Place) -> None:
        object.__setattr__(self, "origin", start)
        self._check()
        require(f"beam {self.name!r}", density=self.density, height=self.height, width=self.width)
        require_not_negative(f"beam {self.name!r}", damping=self.damping)

    @property
    def vectors(self) -> int:
        return 2

    def marker(self, point: str) -> Marker:
        k = 4 * self._node(point)
        return Marker(markers.NODE, (k, k + 1, k + 2, k + 3), (0.0, 0.0, 0.0))

    def lower(self, lowering: "Lowering", first: int) -> None:
        h = self.length / self.elements
        area = self.height * self.width
        data = [
            h, self.youngs_modulus * area, self.youngs_modulus * area * self.height**2 / 12, self.density * area * h,
            self.damping, *lowering.gravity,
        ]  # fmt: skip
        lowering.add_many("cables", self.element_index(first), data)
