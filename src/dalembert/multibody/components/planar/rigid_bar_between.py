"""The rigid bar between two places."""

__all__ = ["RigidBarBetween"]

from dataclasses import MISSING, InitVar, dataclass, field

import numpy as np

from dalembert.elementary import atan2, hypot
from dalembert.errors import InputError
from dalembert.multibody.components.base_body import with_points
from dalembert.multibody.components.fields import Number, number, pair
from dalembert.multibody.components.planar.rigid_bar import Bar


@with_points("start", "end", "centre")
@dataclass(frozen=True)
class RigidBarBetween(Bar):
    """A rigid bar between two places, whose length and angle follow from their coordinates.

    The coordinates may depend on parameters: derivatives are exact.

    Parameters
    ----------
    name : str
    start, end : (float, float)
        Initial positions of both ends, m. The attributes of these names, and ``centre``, are the bar's points.
    mass, line_density : float
        The mass of the bar is ``mass + line_density * length``; kg and kg/m, not negative, and not both 0.
    inertia : float, optional
        About the centre of mass, kg m^2; that of a uniform rod of that mass, mass x length^2 / 12, if not given.
    centre : float
        Place of the centre of mass, as a fraction of the length from the start.
    velocity : (float, float)
        Initial velocity of the start, m/s.
    angular_velocity : float
        Initial, rad/s.

    Raises
    ------
    InputError
        For two equal places, and for a bar without mass.

    Examples
    --------
    >>> bar = RigidBarBetween("bar", start=(1.0, 0.0), end=(4.0, 4.0), line_density=0.6)
    >>> bar.length, round(bar.angle, 6), bar.inertias
    (5.0, 0.927295, (3.0, 6.25))
    """

    start: InitVar[tuple[Number, Number]] = pair("m", MISSING)
    end: InitVar[tuple[Number, Number]] = pair("m", MISSING)
    mass: Number = number("kg", 0.0, least=0)
    line_density: Number = number("kg/m", 0.0, least=0)
    inertia: Number | None = number("kg*m**2", None)
    centre: InitVar[Number] = number("", 0.5)
    velocity: tuple[Number, Number] = pair("m/s")
    angular_velocity: Number = number("rad/s", 0.0)
    balance: Number = field(init=False)
    origin: tuple[Number, Number] = field(init=False)
    target: tuple[Number, Number] = field(init=False)

    def __post_init__(self, start: tuple[Number, Number], end: tuple[Number, Number], centre: Number) -> None:
        for name, value in (("balance", centre), ("origin", tuple(start)), ("target", tuple(end))):
            object.__setattr__(self, name, value)
        owner = f"rigid bar {self.name!r}"
        if not np.real(self.length) > 0:
            place = tuple(float(np.real(coordinate)) for coordinate in start)
            raise InputError(f"{owner}: start and end are both at {place}; give two different positions")
        total, inertia = self.inertias
        if not np.real(total) > 0:
            raise InputError(f"{owner}: mass and line_density are both 0; expected a positive one")
        if not np.real(inertia) > 0:
            raise InputError(f"{owner}: inertia is {np.real(inertia):g} kg*m**2; expected a positive number")

    @property
    def length(self) -> Number:
        """Distance of the places, m."""
        return hypot(*self._along)

    @property
    def angle(self) -> Number:
        """Initial angle from the x axis, rad."""
        across, up = self._along
        return atan2(up, across)

    @property
    def inertias(self) -> tuple[Number, Number]:
        mass = self.mass + self.line_density * self.length
        return mass, mass * self.length**2 / 12 if self.inertia is None else self.inertia

    @property
    def _along(self) -> tuple[Number, Number]:
        return self.target[0] - self.origin[0], self.target[1] - self.origin[1]
