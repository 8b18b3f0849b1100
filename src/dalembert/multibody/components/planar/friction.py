"""Friction in joints: viscous, and smoothed Coulomb friction that may grow with the reaction."""

from typing import Any, NamedTuple

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number
from dalembert.multibody.kernels.dual import tanh

#: Viscous coefficient, constant Coulomb force or torque, what it grows by with the reaction (friction coefficient
#: times pin radius, or friction coefficient), and the rate at which tanh(rate / slip) turns its sign.
NUMBERS = ("viscous", "coulomb", "per_reaction", "slip")
TINY = 1e-18  # keeps |reaction| differentiable where the reaction vanishes, N^2


class Smoothing(NamedTuple):
    """How a joint smooths its Coulomb friction, as tanh(rate / slip).

    Parameters
    ----------
    channel : str
        Output of the joint that has the rate.
    setting : str
        Name of the field that has the slip.
    slip : float
        In the unit.
    unit : str
        Of the rate.
    """

    channel: str
    setting: str
    slip: Number
    unit: str


@inlined
def resistance(reaction, rate, p):
    """Friction against a rate."""
    return p.viscous * rate + (p.coulomb + p.per_reaction * reaction) * tanh(rate / p.slip)


def coefficients(joint: Any) -> dict[str, Number]:
    """Friction coefficients of a joint. A zero one stays in the model: it may be the bound of a parameter."""
    values = {name: getattr(joint, name) for name in ("viscous", "coulomb", "friction_coefficient")}
    return {name: value for name, value in values.items() if value is not None}
