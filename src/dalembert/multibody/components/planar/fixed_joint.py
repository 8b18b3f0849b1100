"""The fixed joint."""

__all__ = ["FixedJoint"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.planar.joint import Joint, joint_kind, observe_joint
from dalembert.multibody.components.planar.pairs import push_pair, relative_angle, separation, twist_pair
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.elementary import sin_cos


@inlined
def _turned(x, p, m):
    """Sine and cosine of the angle by which b has turned against a."""
    return sin_cos(relative_angle(x, p, m) - p.rest_angle)


@inlined
def _constraint(x, p, m, inputs, g):
    g[0], g[1] = separation(x, p, m)
    g[2], _ = _turned(x, p, m)


@inlined
def _forces(x, p, m, r):
    push_pair(x, p, m, x[8], x[9], r)
    twist_pair(x, m, _turned(x, p, m)[1] * x[10], r)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    observe_joint(x, v, p, m, -x[8], -x[9], -x[10], out)


FIXED = joint_kind("fixed", 3, ("rest_angle",), constraint=_constraint, forces=_forces, observe=_observe)


@dataclass(frozen=True)
class FixedJoint(Joint):
    """A weld: both points coincide and keep their relative angle. A beam's end offers its section's direction."""

    kind = FIXED

    def lower(self, lowering: Lowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        self._oriented()
        self._add(lowering, pair, [pair.rest_angle])
