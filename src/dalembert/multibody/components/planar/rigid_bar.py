"""The rigid bar."""

__all__ = ["RigidBar"]

from dataclasses import InitVar, dataclass, field
from typing import Any

from dalembert.multibody.components.base_body import with_points
from dalembert.multibody.components.fields import Number, number, pair
from dalembert.multibody.components.planar.rigid import PlanarRigid
from dalembert.multibody.components.points import Place


class Bar(PlanarRigid):
    """What bars have in common. The centre of mass lies at the fraction ``balance`` of the length."""

    origin: Place
    length: Any
    balance: Number

    @property
    def place(self) -> Place:
        return self.origin

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("start", "end", "centre")

    @property
    def offset(self) -> tuple[Number, Number]:
        return self.local("start")

    def local(self, point: str) -> tuple[Number, Number]:
        along = {"start": -self.balance, "centre": 0.0, "end": 1.0 - self.balance}[point]
        return along * self.length, 0.0


@with_points("start", "end", "centre")
@dataclass(frozen=True)
class RigidBar(Bar):
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
        Initial angle from the x axis, rad.
    start : (float, float) or Point
        Initial position of the start, m. The attributes ``start``, ``end`` and ``centre`` are the bar's points.
    velocity : (float, float), optional
        Initial velocity of the start, m/s. If not given, that of the point that the body is placed at, or zero; the
        joints may change it then.
    angular_velocity : float, optional
        Initial, rad/s. If not given, zero; the joints may change it then.

    Examples
    --------
    >>> rod = RigidBar("rod", length=2.0, mass=3.0)
    >>> rod.inertias, str(rod.end)
    ((3.0, 1.0), 'rod.end')
    """

    length: Number = number("m", above=0)
    mass: Number = number("kg", above=0)
    inertia: Number | None = number("kg*m**2", None, above=0)
    centre: InitVar[Number] = number("", 0.5)
    angle: Number = number("rad", 0.0)
    start: InitVar[Place] = pair("m")
    velocity: tuple[Number, Number] | None = pair("m/s", None)
    angular_velocity: Number | None = number("rad/s", None)
    balance: Number = field(init=False)
    origin: Place = field(init=False)

    def __post_init__(self, centre: Number, start: Place) -> None:
        object.__setattr__(self, "balance", centre)
        object.__setattr__(self, "origin", start)

    @property
    def inertias(self) -> tuple[Number, Number]:
        return self.mass, self.mass * self.length**2 / 12 if self.inertia is None else self.inertia
