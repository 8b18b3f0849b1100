"""The distance joint in space."""

__all__ = ["DistanceJoint"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import parameters_of
from dalembert.multibody.components.laws.distance_law import Rod, distance_gap
from dalembert.multibody.components.spatial.conditions import Condition
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_kind
from dalembert.multibody.components.spatial.spatial_pairs import push_pair, separation
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import dot, times


@inlined
def _residual(x, p, m, row, g):
    delta = separation(x, p, m)
    g[row] = distance_gap(dot(delta, delta), p.length)


@inlined
def _forces(x, p, m, k, r):
    push_pair(p, m, times(x[k] / p.length, separation(x, p, m)), r)


KIND = joint_kind(
    "distance_in_space",
    __name__,
    Condition(1, _residual, _forces),
    numbers=("length",),
    holds_frame=False,
)


@parameters_of(Rod)
@dataclass(frozen=True)
class DistanceJoint(Joint, Rod):
    """A massless rod with ball joints at both ends: the points keep their distance.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    {law}

    Notes
    -----
    An initial state may state the direction of the line from a to b in the axes of a: ``azimuth``, the angle about the
    third axis from the first one, and ``elevation``, the angle above the plane of these two axes; and
    ``rotation_x``, ``rotation_y`` and ``rotation_z`` as those of a spherical joint.
    """

    kind = KIND

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        return ("azimuth", "elevation", *self._rotations)

    def lower(self, lowering: SpatialRows) -> None:
        pair = self.pair(lowering)
        self._add(lowering, pair, [self._length(pair, "spherical")])
