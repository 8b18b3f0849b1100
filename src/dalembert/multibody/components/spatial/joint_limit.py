"""Limits of joints in space: stops at both ends of the range of an angle or a displacement.

The law of Hunt and Crossley (Coefficient of restitution interpreted as damping in vibroimpact, Journal of Applied
Mechanics 42, 1975, 440-445) with Hertz's exponent: beyond a limit by d, the stop pushes back by
stiffness d^(3/2) (1 + damping d'). The force has a continuous derivative at the limit, and a stop never pulls back a
coordinate that bounces off it: there d' > -1/damping.
"""

__all__ = ["AngleLimit", "DisplacementLimit"]

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.errors import InputError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_body import ANGLE, DISPLACEMENT
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial.joint_coordinate import CHANNELS, JointCoordinate, chosen_coordinate
from dalembert.multibody.components.spatial.spatial_joint import Joint
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.kernels.elementary import real, root, where
from dalembert.multibody.kernels.kind import Kind


@inlined
def _beyond(x, v, p, m):
    """How far the coordinate is beyond a limit, its rate there, and the direction, 1, -1 or 0 between the limits."""
    depth, rate, side = 0.0 * x[0], 0.0 * v[0], 0.0 * real(x[0])
    if m.has_lower == 1:
        is_below = real(x[0]) < real(p.lower)
        depth, rate, side = (
            where(is_below, p.lower - x[0], depth),
            where(is_below, -v[0], rate),
            where(is_below, -1.0, side),
        )
    if m.has_upper == 1:
        is_above = real(x[0]) > real(p.upper)
        depth, rate, side = (
            where(is_above, x[0] - p.upper, depth),
            where(is_above, v[0], rate),
            where(is_above, 1.0, side),
        )
    return depth, rate, side


@inlined
def _force(depth, side, p):
    """Elastic force of a stop. The root has no derivative at zero: between the limits it is that of 1."""
    return p.stiffness * depth * root(where(side == 0.0, 1.0, depth))


@inlined
def _pushed(x, v, p, m):
    """What pushes the coordinate back, against its direction."""
    depth, rate, side = _beyond(x, v, p, m)
    return side * _force(depth, side, p) * (1.0 + p.damping * rate)


@inlined
def _residual(x, v, a, p, m, inputs, r):
    r[0] += _pushed(x, v, p, m)


@inlined
def _energy(x, v, p, m, inputs):
    """No kinetic energy; stiffness d^(5/2) / (5/2); power of the damping."""
    depth, rate, side = _beyond(x, v, p, m)
    force = _force(depth, side, p)
    return 0.0 * force, 0.4 * force * depth, -force * p.damping * rate * rate


@inlined
def _observe(x, v, a, p, m, inputs, out):
    out[0], out[1], out[2] = x[0], v[0], -_pushed(x, v, p, m)


def _limit(coordinate: str) -> Kind:
    return Kind(
        f"{coordinate}_limit",
        coordinates=1,
        numbers=("lower", "upper", "stiffness", "damping"),
        integers=("has_lower", "has_upper"),
        residual=_residual,
        energy=_energy,
        outputs=CHANNELS[coordinate],
        observe=_observe,
        dissipates="damping",
    )


ANGLE_LIMIT, DISPLACEMENT_LIMIT = _limit(ANGLE), _limit(DISPLACEMENT)


@dataclass(frozen=True)
class Limit(Load):
    """Base of limits."""

    joint: Joint
    stiffness: Number
    lower_limit: Any
    upper_limit: Any
    damping: Number

    COORDINATE: ClassVar[str] = ANGLE

    def __post_init__(self) -> None:
        owner = f"{type(self).__name__} {self.name!r}"
        chosen_coordinate(owner, self.joint, self.COORDINATE)
        ends = [np.real(end) for end in (self.lower_limit, self.upper_limit) if end is not None]
        if not ends:
            raise InputError(f"{owner}: neither lower_limit nor upper_limit was given; give one of them, or both")
        if len(ends) == 2 and not ends[0] < ends[1]:
            raise InputError(
                f"{owner}: lower_limit is {ends[0]:g} and upper_limit {ends[1]:g}; expected a lower limit below the "
                "upper one"
            )

    @property
    def coordinates(self) -> tuple[JointCoordinate]:
        return (JointCoordinate(f"{self.name}.joint", self.joint, self.COORDINATE, self._within),)

    @property
    def _within(self) -> tuple[float, float]:
        """Where the angle is counted from at the start."""
        near = getattr(self, "near", None)
        if near is not None or self.lower_limit is None or self.upper_limit is None:
            middle = near or 0.0
            return middle - np.pi, middle + np.pi
        return float(np.real(self.lower_limit)), float(np.real(self.upper_limit))

    def lower(self, lowering: SpatialRows) -> None:
        index, _ = lowering.coordinate(self.coordinates[0])
        ends = self.lower_limit, self.upper_limit
        numbers = [0.0 if end is None else end for end in ends]
        integers = [int(end is not None) for end in ends]
        lowering.add(self.kind, [index], [*numbers, self.stiffness, self.damping], integers, self.name)


@dataclass(frozen=True)
class AngleLimit(Limit):
    """Stops at the ends of the range of a joint's angle, which is counted over whole turns.

    Beyond a limit by d rad, a torque stiffness d^(3/2) (1 + damping d') pushes back (Hunt and Crossley 1975).

    Parameters
    ----------
    name : str
    joint : Joint
        With an angle: revolute, cylindrical and others.
    stiffness : float
        N m/rad^(3/2).
    lower_limit, upper_limit : float, optional
        rad; at least one of them.
    damping : float
        s/rad. The rate after a slow impact is about 1 - 2/3 damping rate of the rate before.
    near : float, optional
        The angle at the start is the one nearest to this, rad. If not given, it is the one between both limits, where
        there is one, or within half a turn of zero.

    Raises
    ------
    InputError
        Without a limit, with a lower one that is not below the upper one, and for what is no joint with an angle.

    Notes
    -----
    Channels: ``angle`` and ``rate`` of the joint, and the ``torque`` of the stop on side b.

    Examples
    --------
    A pendulum that falls on a stop and comes to rest there, where stiffness d^(3/2) is the torque of its weight:

    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import AngleLimit, Inertia, RevoluteJoint, RigidBody, SpatialSystem
    >>> system = SpatialSystem()
    >>> rod = system.add(RigidBody("rod", Inertia(1.0, (0.02, 0.02, 0.02), centre=(0.5, 0.0, 0.0))))
    >>> pin = system.add(RevoluteJoint("pin", system.ground, rod.point("origin"), axis=(0.0, 1.0, 0.0)))
    >>> stop = system.add(AngleLimit("stop", pin, upper_limit=0.5, stiffness=1e3, damping=2.0))
    >>> angle, torque = simulate(system, end=6.0).channels(["stop.angle", "stop.torque"])[-1].round(3)
    >>> float(angle), float(torque)
    (0.526, -4.241)
    """

    stiffness: Number = number("N*m/rad**1.5", least=0)
    lower_limit: Number | None = number("rad", None)
    upper_limit: Number | None = number("rad", None)
    damping: Number = number("s/rad", 0.0, least=0)
    near: float | None = number("rad", None)

    kind = ANGLE_LIMIT


@dataclass(frozen=True)
class DisplacementLimit(Limit):
    """Stops at the ends of the range of a joint's displacement along its axis.

    Beyond a limit by d, a force stiffness d^(3/2) (1 + damping d') pushes back (Hunt and Crossley 1975).

    Parameters
    ----------
    name : str
    joint : Joint
        With a displacement: prismatic, cylindrical and others.
    stiffness : float
        N/m^(3/2).
    lower_limit, upper_limit : float, optional
        m; at least one of them.
    damping : float
        s/m. The speed after a slow impact is about 1 - 2/3 damping speed of the speed before.

    Raises
    ------
    InputError
        Without a limit, with a lower one that is not below the upper one, and for what is no joint with a displacement.

    Notes
    -----
    Channels: ``displacement`` and ``speed`` of the joint, and the ``force`` of the stop on side b.
    """

    stiffness: Number = number("N/m**1.5", least=0)
    lower_limit: Number | None = number("m", None)
    upper_limit: Number | None = number("m", None)
    damping: Number = number("s/m", 0.0, least=0)

    COORDINATE = DISPLACEMENT
    kind = DISPLACEMENT_LIMIT
