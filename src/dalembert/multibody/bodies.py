"""Rigid bodies and point masses, and what every body offers."""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import InitVar, dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dalembert.errors import InputError, unknown
from dalembert.multibody.fields import Number, number, pair, require
from dalembert.multibody.kernels import markers
from dalembert.multibody.points import Place, Point

if TYPE_CHECKING:
    from dalembert.multibody.lowering import Lowering

POSITION, GRADIENT, ANGLE = "position", "gradient", "angle"


class Marker(NamedTuple):
    """A point as kernels see it: kind, own coordinates (None: absent), and (sx, sy, phi)."""

    kind: int
    slots: tuple[int | None, ...]
    data: tuple[Number, Number, Number]


@dataclass(frozen=True)
class Body:
    """Base of all bodies: a name, a first placement and a first rigid motion."""

    name: str

    # The placed point is the start of beams and bars, the anchor of rigid bodies, the place of point masses.
    @property
    @abstractmethod
    def place(self) -> Place:
        """Where the placed point stands at first."""

    @property
    def turn(self) -> Number:
        """Angle at first, rad."""
        return getattr(self, "angle", 0.0)

    @property
    def motion(self) -> tuple[Number, Number, Number]:
        """Velocity of the placed point and angular velocity at first."""
        along, across = getattr(self, "velocity", (0.0, 0.0))
        return along, across, getattr(self, "angular_velocity", 0.0)

    @property
    @abstractmethod
    def coordinate_kinds(self) -> tuple[str, ...]:
        """Kind of each coordinate; positions and gradients come in pairs (x, y)."""

    @abstractmethod
    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        """Coordinates of the undeformed body with the placed point at (x, y), turned by ``angle``."""

    @abstractmethod
    def marker(self, point: str) -> Marker:
        """The marker of a point."""

    @property
    @abstractmethod
    def point_names(self) -> tuple[str, ...]:
        """Names of the points."""

    @abstractmethod
    def lower(self, lowering: "Lowering", first: int) -> None:
        """Write the rows of the kernels; ``first`` is the body's first coordinate."""

    @abstractmethod
    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        """Line to draw, shape (frames, -, 2), from coordinates (frames, size)."""

    @property
    def turns(self) -> bool:
        """Whether the body has a direction."""
        return True

    @property
    def rigid(self) -> bool:
        """Whether the distances of its points never change."""
        return self.size <= 3

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.coordinate_kinds)

    def point(self, name: str) -> Point:
        """The point of this name."""
        if name not in self.point_names:
            raise InputError(unknown("point", name, self.point_names, f"body {self.name!r}"))
        return Point(self, name)

    def rigid_modes(self, coordinates: np.ndarray, frame: np.ndarray) -> np.ndarray:
        """Derivatives of the coordinates by the frame: place (x, y) and angle about that place, (size, 3)."""
        modes = np.zeros((self.size, 3), dtype=np.result_type(coordinates, frame))
        i = 0
        while i < self.size:
            if self.coordinate_kinds[i] == ANGLE:
                modes[i, 2] = 1.0
                i += 1
                continue
            x, y = coordinates[i], coordinates[i + 1]
            if self.coordinate_kinds[i] == POSITION:
                modes[i, 0] = modes[i + 1, 1] = 1.0
                x, y = x - frame[0], y - frame[1]
            modes[i, 2], modes[i + 1, 2] = -y, x
            i += 2
        return modes


def with_points(*names: str) -> Callable[[type], type]:
    """Give a class its named points as attributes, also where the constructor has an argument of that name."""

    def give(component: type) -> type:
        for name in names:
            setattr(component, name, property(lambda body, name=name: Point(body, name), doc=f"The point {name!r}."))
        return component

    return give


def turned(x: Number, y: Number, angle: Number) -> tuple[Number, Number]:
    """The vector (x, y) turned by ``angle``; complex-safe."""
    c, s = np.cos(angle), np.sin(angle)
    return c * x - s * y, s * x + c * y


@dataclass(frozen=True)
class _Rigid(Body):
    """What rigid bodies share: three coordinates (x, y, theta) of the centre of mass."""

    @property
    @abstractmethod
    def offset(self) -> tuple[Number, Number]:
        """The placed point against the centre of mass, in the body's axes."""

    @abstractmethod
    def local(self, point: str) -> tuple[Number, Number]:
        """Position of a point against the centre of mass, in the body's axes."""

    @property
    @abstractmethod
    def inertias(self) -> tuple[Number, Number]:
        """Mass and moment of inertia about the centre of mass."""

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return (POSITION, POSITION, ANGLE)

    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        ox, oy = turned(*self.offset, angle)
        return np.array([x - ox, y - oy, angle])

    def marker(self, point: str) -> Marker:
        return Marker(markers.RIGID, (0, 1, 2, None), (*self.local(point), 0.0))

    def lower(self, lowering: "Lowering", first: int) -> None:
        lowering.add("bodies", [first, first + 1, first + 2], [], [*self.inertias, *lowering.gravity])

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        local = np.array([self.local(point) for point in self.point_names if point != "centre"] or [(0.0, 0.0)])
        if len(local) > 2:
            local = np.vstack([local, local[:1]])
        c, s = np.cos(coordinates[:, 2:]), np.sin(coordinates[:, 2:])
        x = coordinates[:, :1] + c * local[:, 0] - s * local[:, 1]
        y = coordinates[:, 1:2] + s * local[:, 0] + c * local[:, 1]
        return np.stack([x, y], axis=2)


@with_points("centre")
@dataclass(frozen=True)
class RigidBody(_Rigid):
    """A rigid body with named points.

    Parameters
    ----------
    name : str
    mass : float
        kg.
    inertia : float
        Moment of inertia about the centre of mass, kg m^2.
    position : (float, float) or Point
        Where the anchor stands at first, m.
    angle : float
        At first, rad.
    anchor : str
        The point that is placed: ``"centre"`` (of mass) or one of ``points``.
    points : mapping of str to (float, float)
        Points in the body's axes, from the centre of mass, m.
    velocity : (float, float)
        Of the anchor at first, m/s.
    angular_velocity : float
        At first, rad/s.

    Examples
    --------
    >>> plate = RigidBody("plate", mass=2.0, inertia=0.1, points={"corner": (0.1, 0.2)}, anchor="corner")
    >>> plate.point_names
    ('centre', 'corner')
    """

    mass: Number = number("kg")
    inertia: Number = number("kg*m**2")
    position: Place = pair("m")
    angle: Number = number("rad", 0.0)
    anchor: str = "centre"
    points: Mapping[str, tuple[Number, Number]] = field(default_factory=dict, metadata={"unit": "m"})
    velocity: tuple[Number, Number] = pair("m/s")
    angular_velocity: Number = number("rad/s", 0.0)

    def __post_init__(self) -> None:
        require(f"rigid body {self.name!r}", mass=self.mass, inertia=self.inertia)
        if "centre" in self.points:
            raise InputError(f"rigid body {self.name!r}: the point name 'centre' is taken by the centre of mass")
        if self.anchor not in self.point_names:
            raise InputError(unknown("anchor", self.anchor, self.point_names, f"rigid body {self.name!r}"))

    @property
    def place(self) -> Place:
        return self.position

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("centre", *self.points)

    @property
    def offset(self) -> tuple[Number, Number]:
        return self.local(self.anchor)

    @property
    def inertias(self) -> tuple[Number, Number]:
        return self.mass, self.inertia

    def local(self, point: str) -> tuple[Number, Number]:
        return (0.0, 0.0) if point == "centre" else self.points[point]


@with_points("start", "end", "centre")
@dataclass(frozen=True)
class RigidBar(_Rigid):
    """A rigid bar from its start to its end.

    Parameters
    ----------
    name : str
    length : float
        m.
    mass : float
        kg.
    inertia : float, optional
        About the centre of mass, kg m^2; that of a uniform rod, mass x length^2 / 12, if not given.
    centre : float
        Place of the centre of mass, as a fraction of the length from the start.
    angle : float
        At first, rad, from the x axis.
    start : (float, float) or Point
        Where the bar starts at first, m. The attributes ``start``, ``end`` and ``centre`` are the bar's points.
    velocity : (float, float)
        Of the start at first, m/s.
    angular_velocity : float
        At first, rad/s.

    Examples
    --------
    >>> rod = RigidBar("rod", length=2.0, mass=3.0)
    >>> rod.inertias, str(rod.end)
    ((3.0, 1.0), 'rod.end')
    """

    length: Number = number("m")
    mass: Number = number("kg")
    inertia: Number | None = number("kg*m**2", None)
    centre: InitVar[Number] = number("", 0.5)
    angle: Number = number("rad", 0.0)
    start: InitVar[Place] = pair("m")
    velocity: tuple[Number, Number] = pair("m/s")
    angular_velocity: Number = number("rad/s", 0.0)
    balance: Number = field(init=False)
    origin: Place = field(init=False)

    def __post_init__(self, centre: Number, start: Place) -> None:
        require(f"rigid bar {self.name!r}", length=self.length, mass=self.mass)
        if self.inertia is not None:
            require(f"rigid bar {self.name!r}", inertia=self.inertia)
        object.__setattr__(self, "balance", centre)
        object.__setattr__(self, "origin", start)

    @property
    def place(self) -> Place:
        return self.origin

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("start", "end", "centre")

    @property
    def offset(self) -> tuple[Number, Number]:
        return self.local("start")

    @property
    def inertias(self) -> tuple[Number, Number]:
        return self.mass, self.mass * self.length**2 / 12 if self.inertia is None else self.inertia

    def local(self, point: str) -> tuple[Number, Number]:
        along = {"start": -self.balance, "centre": 0.0, "end": 1.0 - self.balance}[point]
        return along * self.length, 0.0


@with_points("centre")
@dataclass(frozen=True)
class PointMass(Body):
    """A point with a mass; joints may hold its place, not a direction.

    Parameters
    ----------
    name : str
    mass : float
        kg.
    position : (float, float) or Point
        At first, m.
    velocity : (float, float)
        At first, m/s.
    """

    mass: Number = number("kg")
    position: Place = pair("m")
    velocity: tuple[Number, Number] = pair("m/s")

    def __post_init__(self) -> None:
        require(f"point mass {self.name!r}", mass=self.mass)

    @property
    def place(self) -> Place:
        return self.position

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        return (POSITION, POSITION)

    @property
    def turns(self) -> bool:
        return False

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("centre",)

    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        return np.array([x, y])

    def marker(self, point: str) -> Marker:
        return Marker(markers.MASS, (0, 1, None, None), (0.0, 0.0, 0.0))

    def lower(self, lowering: "Lowering", first: int) -> None:
        lowering.add("bodies", [first, first + 1, None], [], [self.mass, 0.0, *lowering.gravity])

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        return coordinates[:, None, :]
