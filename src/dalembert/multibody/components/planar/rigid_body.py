"""The rigid body with named points."""

__all__ = ["RigidBody"]

from collections.abc import Mapping
from dataclasses import dataclass, field

from dalembert.errors import InputError, require_known
from dalembert.multibody.components.base_body import with_points
from dalembert.multibody.components.fields import Number, number, pair
from dalembert.multibody.components.planar.rigid import PlanarRigid
from dalembert.multibody.components.points import Place


@with_points("centre")
@dataclass(frozen=True)
class RigidBody(PlanarRigid):
    """A rigid body with named points.

    Parameters
    ----------
    name : str
    mass : float
        kg.
    inertia : float
        Moment of inertia about the centre of mass, kg m^2.
    position : (float, float) or Point
        Initial position of the anchor, m.
    angle : float
        Initial angle, rad.
    anchor : str
        The point that is placed: ``"centre"`` (of mass) or one of ``points``.
    points : mapping of str to (float, float)
        Points in the body's axes, from the centre of mass, m.
    velocity : (float, float), optional
        Initial velocity of the anchor, m/s. If not given, that of the point that the body is placed at, or zero; the
        joints may change it then.
    angular_velocity : float, optional
        Initial, rad/s. If not given, zero; the joints may change it then.

    Examples
    --------
    >>> plate = RigidBody("plate", mass=2.0, inertia=0.1, points={"corner": (0.1, 0.2)}, anchor="corner")
    >>> plate.point_names
    ('centre', 'corner')
    """

    mass: Number = number("kg", above=0)
    inertia: Number = number("kg*m**2", above=0)
    position: Place = pair("m")
    angle: Number = number("rad", 0.0)
    anchor: str = "centre"
    points: Mapping[str, tuple[Number, Number]] = field(default_factory=dict, metadata={"unit": "m"})
    velocity: tuple[Number, Number] | None = pair("m/s", None)
    angular_velocity: Number | None = number("rad/s", None)

    def __post_init__(self) -> None:
        if "centre" in self.points:
            raise InputError(f"rigid body {self.name!r}: the point name 'centre' is taken by the centre of mass")
        require_known("anchor", self.anchor, self.point_names, f"rigid body {self.name!r}")

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
