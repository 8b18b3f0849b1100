"""The distance joint."""

__all__ = ["DistanceJoint"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import parameters_of
from dalembert.multibody.components.laws.distance_law import Rod, distance_gap
from dalembert.multibody.components.planar.joint import Joint, joint_kind, observe_joint
from dalembert.multibody.components.planar.pairs import push_pair, separation
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.elementary import root


@inlined
def _constraint(x, p, m, inputs, g):
    dx, dy = separation(x, p, m)
    g[0] = distance_gap(dx * dx + dy * dy, p.length)


@inlined
def _forces(x, p, m, r):
    dx, dy = separation(x, p, m)
    push_pair(x, p, m, x[8] * dx / p.length, x[8] * dy / p.length, r)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    dx, dy = separation(x, p, m)
    length = root(dx * dx + dy * dy)
    observe_joint(x, v, p, m, -x[8] * dx / length, -x[8] * dy / length, 0.0 * x[8], out)


DISTANCE = joint_kind(
    "distance", 1, ("length",), constraint=_constraint, forces=_forces, observe=_observe, holds_frame=False
)


@parameters_of(Rod)
@dataclass(frozen=True)
class DistanceJoint(Joint, Rod):
    """A massless rod between two points.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    {law}

    An initial state may state ``direction``, the angle of the line from a to b in the axes of a, and ``angle``, that of
    b against a.
    """

    kind = DISTANCE

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        return ("direction", "angle")

    def lower(self, lowering: Lowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        self._add(lowering, pair, [self._length(pair, "revolute")])
