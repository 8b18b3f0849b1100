"""Forces and torques in space."""

__all__ = ["Force", "Torque"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import number
from dalembert.multibody.components.points import require_direction
from dalembert.multibody.components.signals import Course
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_pairs import (
    e1,
    e2,
    e3,
    push_pair,
    relative_spin,
    separation_rate,
    twist_pair,
)
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import combined, dot


@inlined
def _vector(x, p, m, inputs):
    """Force or torque in the fixed axes."""
    c = (inputs.signals[m.along_x, 0], inputs.signals[m.along_y, 0], inputs.signals[m.along_z, 0])
    if m.follower == 1:
        return combined(c, e1(x, p, m), e2(x, p, m), e3(x, p, m))
    return combined(c, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@inlined
def _force_residual(x, v, a, p, m, inputs, r):
    """Add the force on a and its opposite on b to the left side, with the sign turned."""
    push_pair(p, m, _vector(x, p, m, inputs), r)


@inlined
def _force_energy(x, v, p, m, inputs):
    force = _vector(x, p, m, inputs)
    return 0.0 * force[0], 0.0 * force[0], -dot(force, separation_rate(v, p, m))


@inlined
def _torque_residual(x, v, a, p, m, inputs, r):
    twist_pair(x, m, _vector(x, p, m, inputs), r)


@inlined
def _torque_energy(x, v, p, m, inputs):
    torque = _vector(x, p, m, inputs)
    return 0.0 * torque[0], 0.0 * torque[0], -dot(torque, relative_spin(x, v, m))


_INTEGERS = ("follower", "along_x", "along_y", "along_z")
FORCE = pair_kind(
    "force_in_space", __name__, integers=_INTEGERS, residual=_force_residual, energy=_force_energy, loads=True
)
TORQUE = pair_kind(
    "torque_in_space", __name__, integers=_INTEGERS, residual=_torque_residual, energy=_torque_energy, loads=True
)


@dataclass(frozen=True)
class _Vector(Load):
    """Row of a force or a torque."""

    at: Side
    x: Course = 0.0
    y: Course = 0.0
    z: Course = 0.0
    follower: bool = False
    against: Side | None = None

    def lower(self, lowering: SpatialRows) -> None:
        pair = lowering.pair(self.at, self.against, self.name)
        signals = [lowering.signal(course) for course in (self.x, self.y, self.z)]
        lowering.add(self.kind, pair.slots, pair.data, [*pair.integers, int(self.follower), *signals])


@dataclass(frozen=True)
class Force(_Vector):
    """A force at a point, and its opposite at the point ``against``, if there is one.

    Parameters
    ----------
    name : str
    at : Point
    x, y, z : float or Signal
        Components along the fixed axes, or along those of the marker for a follower force, N.
    follower : bool
        Whether the force turns with the marker.
    against : Point, optional
    """

    x: Course = number("N", 0.0)
    y: Course = number("N", 0.0)
    z: Course = number("N", 0.0)

    kind = FORCE

    def lower(self, lowering: SpatialRows) -> None:
        if self.follower:
            require_direction(f"follower force {self.name!r}", "a force that does not follow, or a rigid body", self.at)
        super().lower(lowering)


@dataclass(frozen=True)
class Torque(_Vector):
    """A torque on the body of a marker, and its opposite on that of ``against``, if there is one.

    Parameters
    ----------
    name : str
    at : Point
    x, y, z : float or Signal
        Components along the fixed axes, or along those of the marker for a follower torque, N m.
    follower : bool
        Whether the torque turns with the marker.
    against : Point, optional
    """

    x: Course = number("N*m", 0.0)
    y: Course = number("N*m", 0.0)
    z: Course = number("N*m", 0.0)

    kind = TORQUE

    def lower(self, lowering: SpatialRows) -> None:
        require_direction(f"torque {self.name!r}", "a force, or a rigid body", self.at, self.against)
        super().lower(lowering)
