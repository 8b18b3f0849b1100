"""Torques on bodies."""

__all__ = ["Torque"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import number
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.pairs import pair_kind, relative_spin, twist_pair
from dalembert.multibody.components.points import Side, require_direction
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.components.signals import Course


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """The torque acts on a, its opposite on b; on the left side of the equations with its sign turned."""
    twist_pair(x, m, inputs.signals[m.torque, 0], r)


@inlined
def _energy(x, v, p, m, inputs):
    torque = inputs.signals[m.torque, 0]
    return 0.0 * torque, 0.0 * torque, -torque * relative_spin(x, v, m)


TORQUE = pair_kind("torque", integers=("torque",), residual=_residual, energy=_energy, loads=True)


@dataclass(frozen=True)
class Torque(Load):
    """A torque on a point's body, and its opposite on that of ``against``, where one is given.

    Parameters
    ----------
    name : str
    at : Point
    torque : float or Signal
        N m, positive counter-clockwise.
    against : Point, optional
    """

    at: Side
    torque: Course = number("N*m")
    against: Side | None = None

    kind = TORQUE

    def lower(self, lowering: Lowering) -> None:
        require_direction(f"torque {self.name!r}", "a force, or a rigid body", self.at, self.against)
        pair = lowering.pair(self.at, self.against, self.name)
        lowering.add(TORQUE, pair.slots, pair.data, [*pair.integers, lowering.signal(self.torque)])
