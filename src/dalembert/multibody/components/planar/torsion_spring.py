"""Torsional springs with dampers."""

__all__ = ["TorsionSpring"]

from dataclasses import dataclass

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number, parameters_of
from dalembert.multibody.components.laws.spring_law import TwistSpring, counted_spring, tension
from dalembert.multibody.components.planar.angle_coordinate import AngleCoordinate, counted_angle
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.pairs import relative_angle, relative_spin, twist_pair
from dalembert.multibody.components.planar.spring import spring_kind
from dalembert.multibody.components.points import Side, require_direction
from dalembert.multibody.components.rows import Lowering

_OUTPUTS = (("elongation", "rad"), ("force", "N*m"))


@inlined
def _stretch(x, v, p, m):
    """Twist and its rate."""
    return relative_angle(x, p, m) - p.rest, relative_spin(x, v, m)


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """Torque on both sides."""
    twisted, rate = _stretch(x, v, p, m)
    twist_pair(x, m, tension(twisted, rate, p), r)


TORSION_SPRING = spring_kind("torsion_spring", _stretch, _residual, outputs=_OUTPUTS)

COUNTED_TORSION_SPRING = counted_spring("counted_torsion_spring", __name__, _OUTPUTS)


@parameters_of(TwistSpring)
@dataclass(frozen=True)
class TorsionSpring(TwistSpring, Load):
    """A torsional spring with damper between the directions of two points.

    Torque = stiffness x twist + cubic x twist^3 + damping x rate of twist. The twist, the channel ``elongation``, is
    the angle of b relative to a less the free angle. It counts whole turns, also of nodes of beams.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    {law}
    near : float, optional
        The angle at the start is the one nearest to this, rad; so a spring can start with whole turns. If not given,
        the angle of rigid bodies is the one that they state, and the twist of nodes of beams starts within half a turn.
    """

    a: Side
    b: Side
    near: float | None = number("rad", None)

    kind = TORSION_SPRING

    @property
    def coordinates(self) -> tuple[AngleCoordinate, ...]:
        return counted_angle(self.name, self.a, self.b)

    def lower(self, lowering: Lowering) -> None:
        require_direction(f"torsion spring {self.name!r}", "a spring, or a rigid body", self.a, self.b)
        pair, law = lowering.pair(self.a, self.b, self.name), [self.stiffness, self.damping, self.cubic]
        counted = self.coordinates
        rest = self._rest(pair.rest_angle, within=bool(counted))
        if counted:
            index, _ = lowering.coordinate(counted[0])
            lowering.add(COUNTED_TORSION_SPRING, [index], [rest, *law], name=self.name)
        else:
            lowering.add(TORSION_SPRING, pair.slots, [*pair.data, rest, *law], pair.integers, self.name)

    def _rest(self, angle: Number, *, within: bool) -> Number:
        """Angle without torque, moved by the whole turns between the angle that bodies state and the one that is meant.

        ``within``: the twist starts within half a turn.
        """
        if self.free_angle is None:
            return angle
        near = self.near if self.near is not None else float(np.real(self.free_angle)) if within else None
        if near is None:
            return self.free_angle
        return self.free_angle - 2.0 * np.pi * np.round((near - np.real(angle)) / (2.0 * np.pi))
