"""Forces, torques, springs with dampers, and forces that a function of the user's gives."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from dalembert.multibody.fields import Number, number, require_not_negative
from dalembert.multibody.kernels import load, spring
from dalembert.multibody.points import Side, require_direction
from dalembert.multibody.signals import Course

if TYPE_CHECKING:
    from dalembert.multibody.lowering import Lowering


@dataclass(frozen=True)
class Load:
    """Base of all that acts without a constraint."""

    name: str

    @abstractmethod
    def lower(self, lowering: "Lowering") -> None:
        """Write the rows of the kernels."""


@dataclass(frozen=True)
class Force(Load):
    """A force at a point.

    Parameters
    ----------
    name : str
    at : Point
    x, y : float or Signal
        Components along the fixed axes, or along those of the point for a follower force, N.
    follower : bool
        Whether the force turns with the point.
    """

    at: Side
    x: Course = number("N", 0.0)
    y: Course = number("N", 0.0)
    follower: bool = False

    def lower(self, lowering: "Lowering") -> None:
        if self.follower:
            require_direction(f"follower force {self.name!r}", "a force that does not follow, or a rigid body", self.at)
        pair = lowering.pair(self.at, None, self.name)
        kind = load.FOLLOWER if self.follower else load.FORCE
        meta = [kind, *pair.kinds, lowering.signal(self.x), lowering.signal(self.y)]
        lowering.add("loads", pair.slots, meta, pair.data)


@dataclass(frozen=True)
class Torque(Load):
    """A torque on a point's body, and its opposite on that of ``against``, where one is given.

    Parameters
    ----------
    name : str
    at : Point
    torque : float or Signal
        N m, positive counter-clockwise.
    against : Point, optional
    """

    at: Side
    torque: Course = number("N*m")
    against: Side | None = None

    def lower(self, lowering: "Lowering") -> None:
        require_direction(f"torque {self.name!r}", "a force, or a rigid body", self.at, self.against)
        pair = lowering.pair(self.at, self.against, self.name)
        meta = [load.TORQUE, *pair.kinds, lowering.signal(self.torque), 0]
        lowering.add("loads", pair.slots, meta, pair.data)


@dataclass(frozen=True)
class Spring(Load):
    """A spring with damper along the connection of two points.

    Tension = stiffness x elongation + cubic x elongation^3 + damping x rate of elongation.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    stiffness : float
        N/m.
    damping : float
        N s/m.
    free_length : float, optional
        m; the first distance of the points if not given.
    cubic : float
        N/m^3.
    """

    a: Side
    b: Side
    stiffness: Number = number("N/m")
    damping: Number = number("N*s/m", 0.0)
    free_length: Number | None = number("m", None)
    cubic: Number = number("N/m**3", 0.0)

    def __post_init__(self) -> None:
        if self.free_length is not None:
            require_not_negative(f"spring {self.name!r}", free_length=self.free_length)

    def lower(self, lowering: "Lowering") -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        free = pair.distance if self.free_length is None else self.free_length
        meta = [spring.TRANSLATION, *pair.kinds, 0, pair.wraps]
        lowering.add(
            "springs", pair.slots, meta, [*pair.data, free, 0.0, self.stiffness, self.damping, self.cubic], self.name
        )


@dataclass(frozen=True)
class TorsionSpring(Load):
    """A torsional spring with damper between the directions of two points.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    stiffness : float
        N m/rad.
    damping : float
        N m s/rad.
    free_angle : float, optional
        Of b against a, rad; the first one if not given.
    cubic : float
        N m/rad^3.
    """

    a: Side
    b: Side
    stiffness: Number = number("N*m/rad")
    damping: Number = number("N*m*s/rad", 0.0)
    free_angle: Number | None = number("rad", None)
    cubic: Number = number("N*m/rad**3", 0.0)

    def lower(self, lowering: "Lowering") -> None:
        require_direction(f"torsion spring {self.name!r}", "a spring, or a rigid body", self.a, self.b)
        pair = lowering.pair(self.a, self.b, self.name)
        free = pair.rest_angle if self.free_angle is None else self.free_angle
        meta = [spring.TORSION, *pair.kinds, 0, pair.wraps]
        lowering.add(
            "springs", pair.slots, meta, [*pair.data, free, 0.0, self.stiffness, self.damping, self.cubic], self.name
        )


@dataclass(frozen=True)
class UserForce(Load):
    """A force and torque at a point, from a function of the user's, and their opposites on ``against``.

    Parameters
    ----------
    name : str
    at : Point
    function : callable
        ``function(t, at, against) -> (fx, fy, torque)`` in N and N m; ``at`` and ``against`` are arrays
        (x, y, vx, vy, angle, angular velocity), in the fixed axes. Under ``numba.njit`` it runs compiled; a plain
        Python function is called at every iteration, which is some hundred times slower.
    against : Point, optional
    """

    at: Side
    function: Callable[..., Any] = field()
    against: Side | None = None

    def lower(self, lowering: "Lowering") -> None:
        pair = lowering.pair(self.at, self.against, self.name)
        lowering.add("users", pair.slots, [0, *pair.kinds, lowering.callback(self.function, self.name)], pair.data)
