"""Couplings of joints in space: a coordinate of one joint that follows that of another one in a fixed ratio."""

__all__ = ["CouplingJoint", "GearJoint", "RackJoint"]

from dataclasses import dataclass
from itertools import product
from typing import ClassVar

import numpy as np

from dalembert.errors import InputError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_body import ANGLE, DISPLACEMENT
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial.joint_coordinate import CHANNELS, JointCoordinate, chosen_coordinate
from dalembert.multibody.components.spatial.spatial_joint import Joint
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.kernels.kind import Kind


@inlined
def _constraint(x, p, m, inputs, g):
    """Coordinate of b less ratio times that of a, less the offset."""
    g[0] = x[1] - p.ratio * x[0] - p.offset


@inlined
def _forces(x, p, m, r):
    r[0] -= p.ratio * x[2]
    r[1] += x[2]


@inlined
def _observe(x, v, a, p, m, inputs, out):
    """Both coordinates with their rates, and what the coupling exerts on them, -J^T lambda."""
    out[0], out[1], out[2] = x[0], v[0], p.ratio * x[2]
    out[3], out[4], out[5] = x[1], v[1], -x[2]


def _coupling(of_a: str, of_b: str) -> Kind:
    sides = (("a", of_a), ("b", of_b))
    return Kind(
        f"coupling_{of_a}_{of_b}",
        coordinates=2,
        multipliers=1,
        numbers=("ratio", "offset"),
        constraint=_constraint,
        forces=_forces,
        outputs=tuple((f"{name}_{side}", unit) for side, of in sides for name, unit in CHANNELS[of]),
        observe=_observe,
    )


COUPLINGS: dict[tuple[str, ...], Kind] = {ends: _coupling(*ends) for ends in product((ANGLE, DISPLACEMENT), repeat=2)}


@dataclass(frozen=True)
class Coupling(Joint):
    """Base of couplings.

    ``a``, ``b``: joints with an axis.
    """

    a: Joint
    b: Joint

    ends: ClassVar[tuple[str | None, str | None]] = (None, None)
    """Coordinates of a and b; None: the angle if the joint has one, or else the displacement."""

    def __post_init__(self) -> None:
        of_a, of_b = self.coordinates
        if self.a.name == self.b.name and of_a.coordinate == of_b.coordinate:
            raise InputError(
                f"{type(self).__name__} {self.name!r}: a and b are the {of_a.coordinate} of the same joint "
                f"{self.a.name!r}; expected two joints, or two coordinates of one"
            )

    @property
    def coordinates(self) -> tuple[JointCoordinate, JointCoordinate]:
        """Those of a and b."""
        own = []
        for side, joint, end, near in zip("ab", (self.a, self.b), self.ends, self.near, strict=True):
            end = chosen_coordinate(f"{type(self).__name__} {self.name!r}, {side}", joint, end)
            own.append(JointCoordinate(f"{self.name}.{side}", joint, end, (near - np.pi, near + np.pi)))
        return own[0], own[1]

    @property
    def near(self) -> tuple[float, float]:
        """The angles at the start are the ones nearest to these, rad."""
        return 0.0, 0.0

    @property
    def kind(self) -> Kind:
        of_a, of_b = self.coordinates
        return COUPLINGS[of_a.coordinate, of_b.coordinate]

    @property
    def coupled(self) -> tuple[Joint, str]:
        return self.b, f"{CHANNELS[self.coordinates[1].coordinate][2][0]}_b"

    def _couple(self, lowering: SpatialRows, ratio: Number, offset: Number | None) -> None:
        (i, at_a), (j, at_b) = map(lowering.coordinate, self.coordinates)
        if offset is None:
            offset = at_b - ratio * at_a
        index = [i, j, *lowering.multipliers(self.name, 1)]
        lowering.add(self.kind, index, [ratio, offset], name=self.name)


def _require_ratio(owner: str, name: str, value: Number) -> None:
    if not (np.isfinite(np.real(value)) and np.real(value) != 0):
        raise InputError(f"{owner}: {name} is {value}; expected a number other than zero")


@dataclass(frozen=True)
class CouplingJoint(Coupling):
    """A coordinate of joint b that follows one of joint a: u_b = ratio u_a + offset.

    A coordinate is the angle of a joint, counted over whole turns, or its displacement. Both are those of the channels
    of the joints: an angle begins within half a turn.

    Parameters
    ----------
    name : str
    a, b : Joint
        With an axis, such as revolute, cylindrical and prismatic joints.
    ratio : float
        In rad and m.
    offset : float, optional
        rad or m; what it is at the start if not given.
    of_a, of_b : {"angle", "displacement"}, optional
        Which coordinate; the angle if the joint has one, or else the displacement.
    near_a, near_b : float
        The angles at the start are the ones nearest to these, rad. They differ by whole turns.
    """

    ratio: Number = number("")
    offset: Number | None = number("", None)
    of_a: str | None = None
    of_b: str | None = None
    near_a: float = number("rad", 0.0)
    near_b: float = number("rad", 0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        _require_ratio(f"coupling joint {self.name!r}", "ratio", self.ratio)

    @property
    def ends(self) -> tuple[str | None, str | None]:
        return self.of_a, self.of_b

    @property
    def near(self) -> tuple[float, float]:
        return self.near_a, self.near_b

    def lower(self, lowering: SpatialRows) -> None:
        self._couple(lowering, self.ratio, self.offset)


@dataclass(frozen=True)
class GearJoint(Coupling):
    """A gear pair: joint b turns ``ratio`` times as far as joint a, angle_b = ratio angle_a + offset.

    The angles are those of the joints, counted over whole turns, so the bodies that carry the joints may move: in a
    planetary gear, the carrier is side a of the joints of the planets.

    Parameters
    ----------
    name : str
    a, b : Joint
        Revolute or cylindrical joints, or others with an angle about an axis.
    ratio : float
        Rate of b per rate of a: negative for an external gear pair with parallel axes (-teeth of a / teeth of b),
        positive for an internal one or a belt. It changes its sign with the direction of an axis.
    offset : float, optional
        rad; what it is at the start if not given.

    Raises
    ------
    InputError
        For a ratio of zero, and for what is no joint with an angle.

    Notes
    -----
    Channels: ``angle_a``, ``rate_a`` and ``angle_b``, ``rate_b``; ``torque_a`` and ``torque_b`` are the torques that
    the gear exerts about the axes on the sides b of both joints, and their opposites on the sides a.

    Examples
    --------
    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import GearJoint, Inertia, RevoluteJoint, RigidBody, SpatialSystem
    >>> system, joints = SpatialSystem(), []
    >>> for name, x, radius, spin in (("pinion", 0.0, 0.1, (0.0, 0.0, 3.0)), ("wheel", 0.4, 0.3, None)):
    ...     disc = Inertia.cylinder(mass=1.0, radius=radius, length=0.02)
    ...     body = system.add(RigidBody(name, disc, (x, 0.0, 0.0), angular_velocity=spin))
    ...     joints.append(system.add(RevoluteJoint(f"{name} bearing", system.ground, body.point("origin"))))
    >>> gear = system.add(GearJoint("gear", *joints, ratio=-1 / 3))
    >>> simulate(system, end=6.0, solver="auto").channels(["gear.angle_a", "gear.angle_b"])[-1].round(6)
    array([18., -6.])
    """

    ratio: Number = number("")
    offset: Number | None = number("rad", None)

    ends = (ANGLE, ANGLE)

    def __post_init__(self) -> None:
        super().__post_init__()
        _require_ratio(f"gear joint {self.name!r}", "ratio", self.ratio)

    def lower(self, lowering: SpatialRows) -> None:
        self._couple(lowering, self.ratio, self.offset)


@dataclass(frozen=True)
class RackJoint(Coupling):
    """A rack and its pinion: joint b slides with the angle of joint a, displacement_b = radius angle_a + offset.

    Parameters
    ----------
    name : str
    a : Joint
        Of the pinion: a revolute joint, or another one with an angle about an axis.
    b : Joint
        Of the rack: a prismatic or cylindrical joint.
    radius : float
        Pitch radius of the pinion, m; negative if the rack moves against its axis where the pinion turns about its own.
    offset : float, optional
        m; what it is at the start if not given.

    Raises
    ------
    InputError
        For a radius of zero, and for joints without an angle or a displacement.

    Notes
    -----
    Channels: ``angle_a``, ``rate_a``, ``torque_a`` on the pinion; ``displacement_b``, ``speed_b``, ``force_b`` on the
    rack.

    Examples
    --------
    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import Inertia, PrismaticJoint, RackJoint, RevoluteJoint, RigidBody
    >>> from dalembert.multibody.spatial import SpatialSystem
    >>> system = SpatialSystem()
    >>> disc = Inertia.cylinder(mass=1.0, radius=0.1, length=0.02)
    >>> pinion = system.add(RigidBody("pinion", disc, angular_velocity=(0.0, 0.0, 20.0)))
    >>> rack = system.add(RigidBody("rack", Inertia.box(mass=2.0, sides=(1.0, 0.1, 0.1)), (0.0, -0.1, 0.0)))
    >>> bearing = system.add(RevoluteJoint("bearing", system.ground, pinion.point("origin")))
    >>> slide = system.add(PrismaticJoint("slide", system.ground, rack.point("origin"), axis=(1.0, 0.0, 0.0)))
    >>> _ = system.add(RackJoint("teeth", bearing, slide, radius=0.1))
    >>> simulate(system, end=1.0, solver="auto").channels(["slide.displacement"])[-1].round(6)
    array([2.])
    """

    radius: Number = number("m")
    offset: Number | None = number("m", None)

    ends = (ANGLE, DISPLACEMENT)

    def __post_init__(self) -> None:
        super().__post_init__()
        _require_ratio(f"rack joint {self.name!r}", "radius", self.radius)

    def lower(self, lowering: SpatialRows) -> None:
        self._couple(lowering, self.radius, self.offset)
