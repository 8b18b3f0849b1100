"""Springs with dampers in space: along the connection of two points, and about an axis."""

__all__ = ["Spring", "TorsionSpring"]

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.points import require_direction
from dalembert.multibody.components.spatial.joint import joint_angle, joint_rate, turned_to
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.load import Load
from dalembert.multibody.components.spatial.lowering import Pair, SpatialLowering
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.pairs import e3, push_pair, separation, separation_rate, twist_pair
from dalembert.multibody.components.spatial.points import Side
from dalembert.multibody.components.spatial.vectors import dot, times
from dalembert.multibody.components.spring_law import NUMBERS, law_functions, tension
from dalembert.multibody.kernels.elementary import reciprocal, root, wrapped
from dalembert.multibody.kernels.kind import Kind

_TINY = 1e-30  # keeps the direction of a spring of no length defined, m^2


@inlined
def _elongation(x, v, p, m):
    """Elongation and its rate."""
    delta = separation(x, p, m)
    length = root(dot(delta, delta) + _TINY)
    return length - p.rest, dot(delta, separation_rate(v, p, m)) * reciprocal(length)


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """Tension on both ends."""
    elongation, rate = _elongation(x, v, p, m)
    delta = separation(x, p, m)
    push_pair(p, m, times(tension(elongation, rate, p) * reciprocal(root(dot(delta, delta) + _TINY)), delta), r)


@inlined
def _twist(x, v, p, m):
    """Twist about the third axis, and its rate."""
    return wrapped(joint_angle(x, p, m) - p.rest), joint_rate(x, v, p, m)


@inlined
def _twist_residual(x, v, a, p, m, inputs, r):
    """Torque about the axis on both sides."""
    twisted, rate = _twist(x, v, p, m)
    twist_pair(x, m, times(tension(twisted, rate, p), e3(x, p, m)), r)


def _kind(name: str, stretch: Callable[..., Any], residual: Callable[..., Any], outputs: Any, frame: bool) -> Kind:
    energy, observe = law_functions(stretch)
    return pair_kind(
        name, __name__, NUMBERS, residual=residual, energy=energy, outputs=outputs, observe=observe,
        dissipates="damping", holds=True, holds_frame=frame,
    )  # fmt: skip


SPRING = _kind("spring_in_space", _elongation, _residual, (("elongation", "m"), ("force", "N")), False)
TORSION_SPRING = _kind("torsion_spring_in_space", _twist, _twist_residual, (("twist", "rad"), ("torque", "N*m")), True)


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
        m; the initial distance of the points if not given.
    cubic : float
        N/m^3.
    """

    a: Side
    b: Side
    stiffness: Number = number("N/m")
    damping: Number = number("N*s/m", 0.0)
    free_length: Number | None = number("m", None, least=0)
    cubic: Number = number("N/m**3", 0.0)

    kind = SPRING

    def lower(self, lowering: SpatialLowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        square = pair.separation @ pair.separation
        distance = np.sqrt(square) if np.real(square) > 0 else 0.0
        _add(self, lowering, SPRING, pair, distance if self.free_length is None else self.free_length)


@dataclass(frozen=True)
class TorsionSpring(Load):
    """A torsion spring with damper about the axis of a joint.

    Torque = stiffness x twist + cubic x twist^3 + damping x rate of twist. The twist lies within half a turn of the
    free angle.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    stiffness : float
        N m/rad.
    damping : float
        N m s/rad.
    free_angle : float, optional
        Angle of b relative to a without torque, rad; the initial one if not given.
    cubic : float
        N m/rad^3.
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.
    """

    a: Side
    b: Side
    stiffness: Number = number("N*m/rad")
    damping: Number = number("N*m*s/rad", 0.0)
    free_angle: Number | None = number("rad", None)
    cubic: Number = number("N*m/rad**3", 0.0)
    axis: Vector = (0.0, 0.0, 1.0)

    kind = TORSION_SPRING

    def lower(self, lowering: SpatialLowering) -> None:
        owner = f"torsion spring {self.name!r}"
        require_direction(owner, "a spring, or a rigid body", self.a, self.b)
        pair = lowering.pair(self.a, self.b, self.name, turned_to(self.axis, owner))
        free = pair.angle if self.free_angle is None else self.free_angle
        _add(self, lowering, TORSION_SPRING, pair, free)


def _add(load: Spring | TorsionSpring, lowering: SpatialLowering, kind: Kind, pair: Pair, rest: Any) -> None:
    numbers = [*pair.data, rest, load.stiffness, load.damping, load.cubic]
    lowering.add(kind, pair.slots, numbers, pair.integers, load.name)
