"""The revolute joint, and its friction."""

__all__ = ["RevoluteJoint"]

from dataclasses import dataclass

from dalembert.errors import InputError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_joint import Smoothing
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.laws import friction_law as friction
from dalembert.multibody.components.planar.joint import Joint, joint_kind, observe_joint
from dalembert.multibody.components.planar.pairs import pair_kind, push_pair, relative_spin, separation, twist_pair
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.elementary import root
from dalembert.multibody.kernels.kind import Kind


@inlined
def _constraint(x, p, m, inputs, g):
    g[0], g[1] = separation(x, p, m)


@inlined
def _forces(x, p, m, r):
    push_pair(x, p, m, x[8], x[9], r)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    observe_joint(x, v, p, m, -x[8], -x[9], 0.0 * x[8], out)


REVOLUTE = joint_kind(
    "revolute", 2,
    constraint=_constraint, forces=_forces, observe=_observe, holds_frame=False,
)  # fmt: skip


@inlined
def _resistance(x, rate, p):
    """Friction torque against the rate; it grows with the reaction."""
    return friction.resistance(root(x[8] * x[8] + x[9] * x[9] + friction.TINY), rate, p)


@inlined
def _friction_residual(x, v, a, p, m, inputs, r):
    twist_pair(x, m, _resistance(x, relative_spin(x, v, m), p), r)


@inlined
def _friction_energy(x, v, p, m, inputs):
    rate = relative_spin(x, v, m)
    return 0.0 * rate, 0.0 * rate, -rate * _resistance(x, rate, p)


@inlined
def _observe_friction(x, v, a, p, m, inputs, out):
    out[0] = -_resistance(x, relative_spin(x, v, m), p)


REVOLUTE_FRICTION = pair_kind(
    "revolute_friction", friction.NUMBERS,
    reactions=2, residual=_friction_residual, energy=_friction_energy, outputs=friction.TORQUE,
    observe=_observe_friction, dissipates=True,
)  # fmt: skip


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
        Relative angular velocity, rad/s, over which dry friction turns its sign, as tanh(rate / slip_rate).
        The finding ``slip-rate`` of a trajectory says whether it suits the motion: where it is large, the joint creeps
        although friction should hold it; where it is small, steps jump over the change of sign.
    stribeck : float
        Friction torque at low rates beyond that of Coulomb, N m. It decreases with the rate as
        stribeck x exp(-\\|rate / stribeck_rate\\|^stribeck_exponent).
    stribeck_rate : float
        rad/s. The largest torque is nearly the sum of all three only if ``slip_rate`` is several times smaller.
    stribeck_exponent : float
        2 (the default) for a Gaussian decrease, 1 for an exponential one.

    Without ``viscous``, ``coulomb``, ``friction_coefficient`` and ``stribeck`` there is no friction. A coefficient of
    zero stays in the model: it may be the value of a parameter.

    Examples
    --------
    >>> from dalembert.multibody import RigidBody, System, simulate
    >>> system = System(gravity=(0.0, 0.0))
    >>> wheel = system.add(RigidBody("wheel", mass=1.0, inertia=0.1, angular_velocity=1.0))
    >>> dry = {"coulomb": 0.02, "stribeck": 0.01, "stribeck_rate": 0.5}
    >>> _ = system.add(RevoluteJoint("pin", system.ground, wheel.centre, **dry))
    >>> simulate(system, end=1.0).channels(["wheel.centre.rate"])[-1].round(3)
    array([0.796])
    """

    viscous: Number | None = number("N*m*s", None, least=0)
    coulomb: Number | None = number("N*m", None, least=0)
    friction_coefficient: Number | None = number("", None, least=0)
    pin_radius: Number | None = number("m", None, least=0)
    slip_rate: Number = number("rad/s", 1e-3, above=0)
    stribeck: Number | None = number("N*m", None, least=0)
    stribeck_rate: Number | None = number("rad/s", None, above=0)
    stribeck_exponent: Number = number("", 2.0, above=0)

    kind = REVOLUTE

    def __post_init__(self) -> None:
        friction.check(f"revolute joint {self.name!r}", self, "stribeck_rate")
        if self.friction_coefficient is not None and self.pin_radius is None:
            raise InputError(
                f"revolute joint {self.name!r}: a friction_coefficient was given without a pin_radius, so it would "
                "have no lever; give the pin's radius in m"
            )

    @property
    def smoothing(self) -> Smoothing | None:
        return Smoothing("rate", "slip_rate", self.slip_rate, "rad/s") if friction.rubs(self) else None

    @property
    def parts(self) -> dict[str, Kind]:
        return {"friction": REVOLUTE_FRICTION} if friction.coefficients(self) else {}

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        return ("angle",)

    def lower(self, lowering: Lowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        index = self._add(lowering, pair)
        if friction.coefficients(self):
            self._oriented("a rigid body where a joint has friction")
            lever = (self.friction_coefficient or 0.0) * (self.pin_radius or 0.0)
            law = friction.law(self, lever, self.slip_rate, self.stribeck_rate)
            lowering.add(REVOLUTE_FRICTION, index, [*pair.data, *law], pair.integers, f"{self.name}.friction")
