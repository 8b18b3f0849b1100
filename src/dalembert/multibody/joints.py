"""Joints between two points, or between a point and the ground."""

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from dalembert.errors import InputError, ModelError, unknown
from dalembert.multibody.fields import Number, number, require, require_not_negative
from dalembert.multibody.kernels import joints as kernel
from dalembert.multibody.points import Side, require_direction
from dalembert.multibody.signals import Course, Step, Table, as_signal

if TYPE_CHECKING:
    from dalembert.multibody.lowering import Lowering


@dataclass(frozen=True)
class Joint:
    """Base of all joints: a name and two sides."""

    name: str
    a: Side
    b: Side

    @abstractmethod
    def lower(self, lowering: "Lowering") -> None:
        """Write the rows of the kernels."""

    def _oriented(self, advice: str = "a revolute or distance joint, or a rigid body") -> None:
        """Refuse sides that have no direction."""
        require_direction(f"{type(self).__name__} {self.name!r}", advice, self.a, self.b)


def _given(joint: "RevoluteJoint | PrismaticJoint") -> dict[str, Number]:
    """Friction coefficients that are given; one that is zero stays in the model: it may be a parameter's bound."""
    values = {name: getattr(joint, name) for name in ("viscous", "coulomb", "friction_coefficient")}
    return {name: value for name, value in values.items() if value is not None}


@dataclass(frozen=True)
class RevoluteJoint(Joint):
    """A pin: both points coincide.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    viscous : float
        Friction torque per relative angular velocity, N m s.
    coulomb : float
        Constant friction torque, N m.
    friction_coefficient : float
        With ``pin_radius`` (m): friction torque friction_coefficient x pin_radius x reaction force.
    slip_rate : float
        Relative angular velocity, rad/s, over which the Coulomb torque turns its sign, as tanh(rate / slip_rate).

    Without any of the first three there is no friction; one that is zero may be a parameter's value.
    """

    viscous: Number | None = number("N*m*s", None)
    coulomb: Number | None = number("N*m", None)
    friction_coefficient: Number | None = number("", None)
    pin_radius: Number | None = number("m", None)
    slip_rate: Number = number("rad/s", 1e-3)

    def __post_init__(self) -> None:
        owner = f"revolute joint {self.name!r}"
        require_not_negative(owner, pin_radius=self.pin_radius or 0.0, **_given(self))
        require(owner, slip_rate=self.slip_rate)
        if self.friction_coefficient is not None and self.pin_radius is None:
            raise InputError(
                f"{owner}: a friction_coefficient was given without a pin_radius, so it would have no lever; "
                "give the pin's radius in m"
            )

    def lower(self, lowering: "Lowering") -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        index = pair.slots + lowering.multipliers(self.name, 2)
        lowering.add("joints", index, [kernel.REVOLUTE, *pair.kinds, 0, pair.wraps], [*pair.data, 0.0, 0.0])
        if _given(self):
            self._oriented("a rigid body where a joint has friction")
            lever = (self.friction_coefficient or 0.0) * (self.pin_radius or 0.0)
            meta = [kernel.REVOLUTE, *pair.kinds, 0, pair.wraps]
            lowering.add(
                "frictions",
                index,
                meta,
                [*pair.data, 0.0, 0.0, self.viscous or 0.0, self.coulomb or 0.0, lever, self.slip_rate],
            )


@dataclass(frozen=True)
class FixedJoint(Joint):
    """A weld: both points coincide and keep their relative angle. A beam's end offers its section's direction."""

    def lower(self, lowering: "Lowering") -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        self._oriented()
        index = pair.slots + lowering.multipliers(self.name, 3)
        lowering.add("joints", index, [kernel.FIXED, *pair.kinds, 0, pair.wraps], [*pair.data, pair.rest_angle, 0.0])


@dataclass(frozen=True)
class PrismaticJoint(Joint):
    """A slide: point b stays on a line through point a that turns with a, and keeps its relative angle.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    angle : float
        Of the line against the axes of a, rad.
    viscous : float
        Friction force per sliding velocity, N s/m.
    coulomb : float
        Constant friction force, N.
    friction_coefficient : float
        Friction force per normal force.
    slip_velocity : float
        Sliding velocity, m/s, over which the Coulomb force turns its sign.
    """

    angle: Number = number("rad", 0.0)
    viscous: Number | None = number("N*s/m", None)
    coulomb: Number | None = number("N", None)
    friction_coefficient: Number | None = number("", None)
    slip_velocity: Number = number("m/s", 1e-3)

    def __post_init__(self) -> None:
        owner = f"prismatic joint {self.name!r}"
        require_not_negative(owner, **_given(self))
        require(owner, slip_velocity=self.slip_velocity)

    def lower(self, lowering: "Lowering") -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        self._oriented()
        index = pair.slots + lowering.multipliers(self.name, 2)
        rest = [pair.rest_angle, self.angle]
        meta = [kernel.PRISMATIC, *pair.kinds, 0, pair.wraps]
        lowering.add("joints", [*index, None], meta, [*pair.data, *rest])
        if _given(self):
            law = self.viscous or 0.0, self.coulomb or 0.0, self.friction_coefficient or 0.0
            lowering.add("frictions", [*index, None], meta, [*pair.data, *rest, *law, self.slip_velocity])


@dataclass(frozen=True)
class DistanceJoint(Joint):
    """A massless rod between two points.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    length : float, optional
        m; the first distance of the points if not given.
    """

    length: Number | None = number("m", None)

    def __post_init__(self) -> None:
        if self.length is not None:
            require(f"distance joint {self.name!r}", length=self.length)

    def lower(self, lowering: "Lowering") -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        length = pair.distance if self.length is None else self.length
        if not np.real(length) > 0:
            raise ModelError(
                f"distance joint {self.name!r}: its points {self.a} and {self.b} coincide and no length is given; "
                "give a length, or use a revolute joint"
            )
        index = pair.slots + lowering.multipliers(self.name, 1)
        lowering.add("joints", index, [kernel.DISTANCE, *pair.kinds, 0, pair.wraps], [*pair.data, length, 0.0])


@dataclass(frozen=True)
class PrescribedMotion(Joint):
    """A coordinate of point b against point a that follows a function of time.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    coordinate : {"x", "y", "angle"}
        x and y along the fixed axes, in m; the angle in rad.
    motion : float or Signal
    """

    coordinate: str = "angle"
    motion: Course = 0.0

    _KINDS = {"x": kernel.MOTION_X, "y": kernel.MOTION_Y, "angle": kernel.MOTION_ANGLE}

    def __post_init__(self) -> None:
        if self.coordinate not in self._KINDS:
            raise InputError(unknown("coordinate", self.coordinate, self._KINDS, f"prescribed motion {self.name!r}"))
        if isinstance(self.motion, Step) or (isinstance(self.motion, Table) and self.motion.kind == "linear"):
            raise InputError(
                f"prescribed motion {self.name!r}: the velocity of its {type(self.motion).__name__} jumps, which no "
                "mechanism can follow; expected a smooth function of time, such as a cubic Table or a Polynomial"
            )

    def lower(self, lowering: "Lowering") -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        if self.coordinate == "angle":
            self._oriented()
        index = pair.slots + lowering.multipliers(self.name, 1)
        lowering.kinks += [(time, self.name) for time in as_signal(self.motion).kinks]
        meta = [self._KINDS[self.coordinate], *pair.kinds, lowering.signal(self.motion), pair.wraps]
        lowering.add("joints", index, meta, [*pair.data, 0.0, 0.0])
