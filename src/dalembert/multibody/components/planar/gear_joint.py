"""The gear joint: a fixed ratio between the angles of two bodies."""

__all__ = ["GearJoint"]

from dataclasses import dataclass

import numpy as np

from dalembert.errors import InputError, ModelError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.planar.joint import OUTPUTS, Joint, observe_joint
from dalembert.multibody.components.planar.markers import angle
from dalembert.multibody.components.planar.pairs import pair_kind
from dalembert.multibody.components.rows import Lowering


@inlined
def _constraint(x, p, m, inputs, g):
    """Angle of b less the ratio times the angle of a, less what it is at the start."""
    g[0] = angle(m.b_kind, 4, x, p.b_angle) - p.ratio * angle(m.a_kind, 0, x, p.a_angle) - p.offset


@inlined
def _observe(x, v, a, p, m, inputs, out):
    observe_joint(x, v, p, m, 0.0 * x[8], 0.0 * x[8], -x[8], out)


GEAR = pair_kind("gear", ("ratio", "offset"), multipliers=1, constraint=_constraint, outputs=OUTPUTS, observe=_observe)


@dataclass(frozen=True)
class GearJoint(Joint):
    """A gear pair: b turns ``ratio`` times as fast as a.

    The wheels need bearings, such as revolute joints to the ground. The joint compares absolute angles, so the bodies
    that carry the bearings must not turn. The channel ``<name>.torque`` is the torque on b; the torque on a is
    ``-ratio`` times as large.

    Parameters
    ----------
    name : str
    a, b : Point
        Of rigid bodies, whose angles count full turns.
    ratio : float
        Angular velocity of b per angular velocity of a: negative for an external gear pair (-teeth of a / teeth of b),
        positive for an internal one or a belt.

    Examples
    --------
    >>> from dalembert.multibody import RevoluteJoint, RigidBody, System, simulate
    >>> system = System(gravity=(0.0, 0.0))
    >>> pinion = system.add(RigidBody("pinion", mass=1.0, inertia=0.1, angular_velocity=3.0))
    >>> wheel = system.add(RigidBody("wheel", mass=4.0, inertia=0.9, position=(0.4, 0.0), angular_velocity=-1.0))
    >>> for body in (pinion, wheel):
    ...     _ = system.add(RevoluteJoint(f"bearing of {body.name}", system.ground, body.centre))
    >>> gear = system.add(GearJoint("gear", pinion.centre, wheel.centre, ratio=-1 / 3))
    >>> simulate(system, end=1.0).channels(["wheel.centre.angle"])[-1].round(6)
    array([-1.])
    """

    ratio: Number = number("")

    kind = GEAR

    def __post_init__(self) -> None:
        if not (np.isfinite(np.real(self.ratio)) and np.real(self.ratio) != 0):
            raise InputError(f"gear joint {self.name!r}: ratio is {self.ratio}; expected a number other than zero")

    def lower(self, lowering: Lowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        self._oriented("rigid bodies")
        if pair.integers[2]:
            raise ModelError(
                f"gear joint {self.name!r}: {self.a} or {self.b} is a node of a beam, whose turns are not counted; "
                "fix a rigid body to the node, and give the gear that body"
            )
        self._add(lowering, pair, [self.ratio, pair.angles[1] - self.ratio * pair.angles[0]])
