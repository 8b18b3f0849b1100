"""What components in space are made of, as a study file writes it: inertias, orientations, markers, friction, matrices.

The tables have the arguments of the classes and functions of :mod:`dalembert.multibody.spatial` as keys.
"""

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any

import numpy as np
from pydantic import Field, PlainValidator, ValidationInfo, WithJsonSchema

from dalembert.arguments import Checked
from dalembert.errors import InputError
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial.friction import ALONG, Friction
from dalembert.multibody.components.spatial.ground_points import GroundPoint
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.node_point import NodePoint
from dalembert.multibody.components.spatial.orientation import Orientation, Pose, Vector
from dalembert.multibody.components.spatial.section import Section
from dalembert.study.tables.data_table import DataFile
from dalembert.study.tables.dataclass_tables import KindTable, Written, any_of, table_of
from dalembert.study.tables.free_body_parts import FREE_BODIES
from dalembert.study.tables.section_parts import PROFILES
from dalembert.study.text.functions import FunctionName
from dalembert.study.text.numbers import number as number_key
from dalembert.study.text.numbers import read_number
from dalembert.study.text.places import place
from dalembert.study.text.table import Context, alternative, checked

_USUAL = "moments"  # the kind of an inertia where none is given
_CONSTANTS = "constants"  # the kind of a section where none is given
_BLOCKS = {
    "BushingStiffness": ("N/m", "N", "N*m/rad"),
    "BushingDamping": ("N*s/m", "N*s", "N*m*s/rad"),
    "SensorGain": ("",),
    "SectionStiffness": ("N", "N*m", "N*m**2"),
}
"""Units of matrices. Of bushings and sections: forces by displacements, the coupling, torques by rotations."""


@dataclass(frozen=True)
class Turned(Checked, Written):
    """An orientation: angles about axes, a quaternion, a rotation vector, or the directions of axes.

    Parameters
    ----------
    axes : str
        Of the angles: small letters turn with the rotations before, capital letters are fixed.
    angles : float or sequence of float
        rad.
    quaternion : (w, x, y, z)
    rotation_vector : (float, float, float)
        rad.
    z, x : (float, float, float)
        Directions of the third and the first axis.
    """

    axes: str | None = None
    angles: Number | Sequence[Number] | None = number("rad", None)
    quaternion: tuple[Number, Number, Number, Number] | None = number("", None)
    rotation_vector: Vector | None = number("rad", None)
    z: Vector | None = None
    x: Vector | None = None

    @property
    def value(self) -> Orientation:
        ways = ("angles", "quaternion", "rotation_vector", "z")
        stated = [way for way in ways if getattr(self, way) is not None]
        if (
            len(stated) != 1
            or (self.axes is None) == (stated == ["angles"])
            or (self.x is not None and stated != ["z"])
        ):
            keys = [name for name in ("axes", *ways, "x") if getattr(self, name) is not None]
            raise InputError(
                f"{' and '.join(keys) or 'nothing'} given; expected axes with angles, such as axes = 'zyx' and "
                "angles = ['10 deg', 0, 0], or quaternion, or rotation_vector, or z, which may have x beside it"
            )
        if self.angles is not None and self.axes is not None:
            return Orientation.by_angles(self.axes, self.angles if isinstance(self.angles, Sequence) else [self.angles])
        if self.quaternion is not None:
            return Orientation.by_quaternion(*self.quaternion)
        if self.rotation_vector is not None:
            return Orientation.by_rotation_vector(self.rotation_vector)
        assert self.z is not None  # checked above
        return Orientation.by_axes(self.z, self.x)


@dataclass(frozen=True, kw_only=True)
class Shape(Checked, Written):
    """A homogeneous solid of a mass or a density; its own axes stand in its centre, turned by an orientation."""

    mass: Number | None = number("kg", None, above=0)
    density: Number | None = number("kg/m**3", None, above=0)
    centre: Vector = number("m", (0.0, 0.0, 0.0))
    orientation: Orientation = Orientation()

    @property
    @abstractmethod
    def volume(self) -> Number:
        """m^3."""

    @abstractmethod
    def of(self, mass: Number) -> Inertia:
        """Inertia about its own axes."""

    @property
    def value(self) -> Inertia:
        if self.mass is not None and self.density is None:
            inertia = self.of(self.mass)
        elif self.mass is None and self.density is not None:
            inertia = self.of(self.density * self.volume)
        else:
            stated = "neither mass nor" if self.mass is None else "both mass and"
            raise InputError(f"{stated} density given; give either a mass or a density")
        turn = self.orientation.matrix
        return Inertia.of(inertia.mass, turn @ inertia.tensor @ turn.T, self.centre)


@dataclass(frozen=True, kw_only=True)
class Box(Shape):
    """A solid box with sides along the axes."""

    sides: Vector = number("m", above=0)

    @property
    def volume(self) -> Number:
        return self.sides[0] * self.sides[1] * self.sides[2]

    def of(self, mass: Number) -> Inertia:
        return Inertia.box(mass, self.sides)


@dataclass(frozen=True, kw_only=True)
class Cylinder(Shape):
    """A solid cylinder along its z axis."""

    radius: Number = number("m", above=0)
    length: Number = number("m", above=0)

    @property
    def volume(self) -> Number:
        return np.pi * self.radius**2 * self.length

    def of(self, mass: Number) -> Inertia:
        return Inertia.cylinder(mass, self.radius, self.length)


@dataclass(frozen=True, kw_only=True)
class Tube(Cylinder):
    """A tube along its z axis."""

    inner: Number = number("m", above=0)

    @property
    def volume(self) -> Number:
        if not np.real(self.inner) < np.real(self.radius):
            raise InputError(f"inner is {self.inner} m and radius {self.radius} m; expected a smaller inner radius")
        return np.pi * (self.radius**2 - self.inner**2) * self.length

    def of(self, mass: Number) -> Inertia:
        return Inertia.cylinder(mass, self.radius, self.length, self.inner)


@dataclass(frozen=True, kw_only=True)
class Sphere(Shape):
    """A solid sphere."""

    radius: Number = number("m", above=0)

    @property
    def volume(self) -> Number:
        return 4.0 / 3.0 * np.pi * self.radius**3

    def of(self, mass: Number) -> Inertia:
        return Inertia.sphere(mass, self.radius)


@cache
def spatial_part(name: str) -> Any:
    """Type of the key for what a component in space is made of, by the name of its type."""
    match name:
        case "Orientation":
            return table_of(Turned, name, default=True)
        case "Pose":
            return table_of(Pose, default=True, part=spatial_part)
        case "Friction":
            return table_of(Friction, default=True)
        case "FrictionAlong":
            return table_of(Friction, default=True, units=ALONG, prefix="Sliding")
        case "Inertia":
            shapes = [
                table_of(kind, kind.__name__.lower(), part=spatial_part) for kind in (Box, Cylinder, Tube, Sphere)
            ]
            return any_of([table_of(Inertia, _USUAL, default=True), *shapes], _USUAL)
        case "Section":
            profiles = [table_of(profile, profile.SHAPE, prefix="Section") for profile in PROFILES]
            constants = table_of(Section, _CONSTANTS, default=True, part=spatial_part, prefix="Section")
            return any_of([constants, *profiles], _CONSTANTS)
        case "FreeBodyModes":
            return any_of([table_of(kind, kind.KIND, part=spatial_part, prefix="FreeBody") for kind in FREE_BODIES])
        case "DataFile":
            return DataFile
        case "NodePoint":
            return table_of(NodePoint, default=True, part=spatial_part)
        case "Curvature":
            constant = Annotated[list[number_key("1/m")], Field(min_length=3, max_length=3)]
            return alternative(lambda value: isinstance(value, list), constant, FunctionName)
        case "BushingStiffness" | "BushingDamping" | "SensorGain" | "SectionStiffness":
            return _matrix(_BLOCKS[name])
    return None


@cache
def spatial_place(bare: bool) -> Any:
    """Type of a key that takes a point; ``bare`` allows ``"ground"`` without a position."""
    marker = table_of(GroundPoint, default=True, part=spatial_part)
    return alternative(lambda value: isinstance(value, dict | KindTable), marker, place(bare, space=True))


def _matrix(units: tuple[str, ...]) -> Any:
    """Type of a key that takes the diagonal of a matrix, or its rows: (6, 6) with units of blocks, or (3, 3)."""
    size, word = (6, "six") if len(units) == 3 else (3, "three")

    def read(value: Any, info: ValidationInfo) -> list:
        names = info.context.names if isinstance(info.context, Context) else None

        def entry(number: Any, i: int, j: int) -> Any:
            return read_number(number, units[(i > 2) + (j > 2)], names)

        def full() -> list:
            if not isinstance(value, list) or len(value) != size:
                raise InputError(f"{value!r} was given; expected {word} numbers, or {word} rows of {word} numbers")
            if not all(isinstance(row, list) for row in value):
                return [entry(number, i, i) for i, number in enumerate(value)]
            if any(len(row) != size for row in value):
                raise InputError(f"{value!r} was given; expected {word} numbers in each of the {word} rows")
            return [[entry(number, i, j) for j, number in enumerate(row)] for i, row in enumerate(value)]

        return checked(full)

    unit = f" in {units[0]} and {units[2]}, along and about x, y and z" if size == 6 else ""
    words = f"{word} numbers{unit}, or {word} rows of {word} numbers"
    schema = {"type": "array", "minItems": size, "maxItems": size, "description": words}
    return Annotated[Any, PlainValidator(read), WithJsonSchema(schema)]
