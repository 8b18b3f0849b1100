"""Friction in joints: viscous, smoothed Coulomb friction that may grow with the reaction, and Stribeck's."""

from typing import Any

from dalembert.errors import InputError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number
from dalembert.multibody.kernels.elementary import exponential, is_zero, logarithm, tanh

#: Viscous coefficient, constant Coulomb force or torque, what it grows by with the reaction (friction coefficient
#: times pin radius, or friction coefficient), the rate at which tanh(rate / slip) turns its sign, and how much larger
#: the force is at low rates, with the rate and the exponent of its decrease.
NUMBERS = ("viscous", "coulomb", "per_reaction", "slip", "stribeck", "stribeck_rate", "stribeck_exponent")
TORQUE, FORCE = (("torque", "N*m"),), (("force", "N"),)
"""Outputs of friction: what it exerts on b."""
TINY = 1e-18  # keeps |reaction| differentiable where the reaction vanishes, N^2, and the power of a rate of zero


@inlined
def resistance(reaction, rate, p):
    """Friction against a rate."""
    dry = p.coulomb + p.per_reaction * reaction
    if not is_zero(p.stribeck):
        ratio = rate / p.stribeck_rate
        power = exponential(0.5 * p.stribeck_exponent * logarithm(ratio * ratio + TINY))
        dry += p.stribeck * exponential(-power)
    return p.viscous * rate + dry * tanh(rate / p.slip)


def coefficients(joint: Any) -> dict[str, Number]:
    """Friction coefficients of a joint. A zero one stays in the model: it may be the bound of a parameter."""
    values = {name: getattr(joint, name) for name in ("viscous", "coulomb", "friction_coefficient", "stribeck")}
    return {name: value for name, value in values.items() if value is not None}


def rubs(joint: Any) -> bool:
    """Return whether a joint has dry friction."""
    return bool(joint.coulomb or joint.friction_coefficient or joint.stribeck)


def check(owner: str, joint: Any, stribeck: str) -> None:
    """Refuse Stribeck's friction without its rate, the field ``stribeck``."""
    if joint.stribeck is not None and getattr(joint, stribeck) is None:
        raise InputError(
            f"{owner}: stribeck was given without a {stribeck}. Give the rate at which Stribeck's friction has "
            "decreased to 1/e"
        )


def law(joint: Any, per_reaction: Number, slip: Number, stribeck_rate: Number | None) -> list[Number]:
    """Return the numbers of a joint's friction, in the order of `NUMBERS`."""
    decrease = joint.stribeck or 0.0, stribeck_rate or 1.0, joint.stribeck_exponent
    return [joint.viscous or 0.0, joint.coulomb or 0.0, per_reaction, slip, *decrease]
