"""Sections of beams as a study file writes them: by their shape and material, or by constants."""

from dataclasses import dataclass
from typing import ClassVar

from dalembert.arguments import Checked
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial.section import Section
from dalembert.study.tables.dataclass_tables import Written

MATERIAL = ("youngs_modulus", "poisson_ratio", "density")


@dataclass(frozen=True, kw_only=True)
class Profile(Checked, Written):
    """A shape of a homogeneous material."""

    SHAPE: ClassVar[str]
    SIZES: ClassVar[tuple[str, ...]]

    youngs_modulus: Number = number("Pa", above=0)
    poisson_ratio: Number = number("", above=-1, below=0.5)
    density: Number = number("kg/m**3", above=0)

    @property
    def value(self) -> Section:
        sizes = [getattr(self, name) for name in self.SIZES]
        return getattr(Section, self.SHAPE)(*sizes, **{name: getattr(self, name) for name in MATERIAL})


@dataclass(frozen=True, kw_only=True)
class Rectangle(Profile):
    """A rectangle with sides along y and z."""

    SHAPE, SIZES = "rectangle", ("width", "height")
    width: Number = number("m", above=0)
    height: Number = number("m", above=0)


@dataclass(frozen=True, kw_only=True)
class Circle(Profile):
    """A solid circle."""

    SHAPE, SIZES = "circle", ("radius",)
    radius: Number = number("m", above=0)


@dataclass(frozen=True, kw_only=True)
class RoundTube(Profile):
    """A tube."""

    SHAPE, SIZES = "tube", ("radius", "inner")
    radius: Number = number("m", above=0)
    inner: Number = number("m", above=0)


@dataclass(frozen=True, kw_only=True)
class HollowBox(Profile):
    """A closed box with sides along y and z and a thin wall."""

    SHAPE, SIZES = "box", ("width", "height", "wall")
    width: Number = number("m", above=0)
    height: Number = number("m", above=0)
    wall: Number = number("m", above=0)


@dataclass(frozen=True, kw_only=True)
class IBeam(Profile):
    """An I with its web along z and flanges along y."""

    SHAPE, SIZES = "i_beam", ("width", "height", "web", "flange")
    width: Number = number("m", above=0)
    height: Number = number("m", above=0)
    web: Number = number("m", above=0)
    flange: Number = number("m", above=0)


PROFILES = (Rectangle, Circle, RoundTube, HollowBox, IBeam)
