"""Friction in the joints of mechanisms in space."""

__all__ = ["Friction"]

from dataclasses import dataclass
from typing import Any, ClassVar

from dalembert.arguments import Checked
from dalembert.errors import InputError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_joint import Smoothing
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.laws import friction_law as friction
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_rate, joint_speed
from dalembert.multibody.components.spatial.spatial_pairs import COORDINATES, e3, push_pair, twist_pair
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import times
from dalembert.multibody.kernels.elementary import root
from dalembert.multibody.kernels.kind import Kind

ALONG = {"N*m*s": "N*s/m", "N*m": "N", "rad/s": "m/s"}
"""Units of friction along an axis, by those about it."""


@dataclass(frozen=True)
class Friction(Checked):
    """Friction about the axis of a revolute joint (torques, rad/s), or along that of a prismatic one (forces, m/s).

    Torque = viscous x rate + (coulomb + coefficient x radius x reaction force + stribeck x exp(-\\|rate /
    stribeck_rate\\|^stribeck_exponent)) x tanh(rate / slip). In prismatic joints there is no radius: the force grows by
    the coefficient times the reaction force across the axis.

    Parameters
    ----------
    viscous : float
        N m s, or N s/m.
    coulomb : float
        N m, or N.
    coefficient : float
        Friction coefficient.
    radius : float
        Of the pin, m; needed with a coefficient in revolute joints.
    slip : float
        Rate over which the Coulomb friction turns its sign, rad/s or m/s.
    stribeck : float
        Friction at low rates beyond that of Coulomb, N m or N.
    stribeck_rate : float
        Rate at which it has decreased to 1/e, rad/s or m/s; needed with ``stribeck``.
    stribeck_exponent : float
        2 for a Gaussian decrease, 1 for an exponential one.
    """

    viscous: Number | None = number("N*m*s", None, least=0)
    coulomb: Number | None = number("N*m", None, least=0)
    coefficient: Number | None = number("", None, least=0)
    radius: Number | None = number("m", None, least=0)
    slip: Number = number("rad/s", 1e-3, above=0)
    stribeck: Number | None = number("N*m", None, least=0)
    stribeck_rate: Number | None = number("rad/s", None, above=0)
    stribeck_exponent: Number = number("", 2.0, above=0)

    IN_WORDS = "a Friction such as Friction(viscous=0.1, coulomb=0.2)"

    def __post_init__(self) -> None:
        friction.check("friction", self, "stribeck_rate")

    @property
    def friction_coefficient(self) -> Number | None:
        """The coefficient, by the name that planar joints use."""
        return self.coefficient

    def law(self, owner: str, turns: bool) -> list[Number]:
        """Numbers of the law.

        Raises
        ------
        InputError
            For a coefficient without the radius of a pin.
        """
        if turns and self.coefficient is not None and self.radius is None:
            raise InputError(
                f"{owner}: its friction has a coefficient without a radius, so it would have no lever; give the pin's "
                "radius in m"
            )
        lever = (self.coefficient or 0.0) * ((self.radius or 0.0) if turns else 1.0)
        return friction.law(self, lever, self.slip, self.stribeck_rate)

    def smoothing(self, channel: str, unit: str) -> Smoothing | None:
        """How it smooths its Coulomb friction."""
        return Smoothing(channel, "slip", self.slip, unit) if friction.rubs(self) else None


@dataclass(frozen=True)
class RubbingJoint(Joint):
    """Base of joints with friction about their axis or along it; ``rate`` names the output of the rate."""

    axis: Vector = (0.0, 0.0, 1.0)
    friction: Friction | None = None

    friction_kind: ClassVar[Kind]
    rate: ClassVar[str] = "rate"

    @property
    def smoothing(self) -> Smoothing | None:
        return self.friction.smoothing(self.rate, dict(self.kind.outputs)[self.rate]) if self.friction else None

    @property
    def parts(self) -> dict[str, Kind]:
        return {"friction": self.friction_kind} if self.friction else {}

    def lower(self, lowering: SpatialRows) -> None:
        self._oriented()
        pair = self.pair(lowering)
        index = self._add(lowering, pair)
        if self.friction:
            turns = self.rate == "rate"
            law = self.friction.law(f"{'revolute' if turns else 'prismatic'} joint {self.name!r}", turns)
            lowering.add(self.friction_kind, index, [*pair.data, *law], pair.integers, f"{self.name}.friction")


def friction_kind(name: str, home: str, multipliers: int, load: tuple[int, ...], turns: bool) -> Kind:
    """The kind of the friction of a joint, whose multipliers ``load`` are those of its reaction force."""
    first, second, third = (COORDINATES + (*load, *load)[k] for k in range(3))
    weight = 1.0 if len(load) == 3 else 0.0
    rate: Any = joint_rate if turns else joint_speed

    @inlined
    def resistance(x, v, p, m):
        """Friction against the rate; it grows with the reaction."""
        square = x[first] * x[first] + x[second] * x[second] + weight * x[third] * x[third]
        return friction.resistance(root(square + friction.TINY), rate(x, v, p, m), p)

    @inlined
    def residual(x, v, a, p, m, inputs, r):
        along = times(resistance(x, v, p, m), e3(x, p, m))
        if turns:
            twist_pair(x, m, along, r)
        else:
            push_pair(p, m, along, r)

    @inlined
    def energy(x, v, p, m, inputs):
        power = -rate(x, v, p, m) * resistance(x, v, p, m)
        return 0.0 * power, 0.0 * power, power

    @inlined
    def observe(x, v, a, p, m, inputs, out):
        """What friction exerts on b, about the axis or along it."""
        out[0] = -resistance(x, v, p, m)

    return pair_kind(
        name, home, friction.NUMBERS, reactions=multipliers, residual=residual, energy=energy,
        outputs=friction.TORQUE if turns else friction.FORCE, observe=observe, dissipates=True,
    )  # fmt: skip
