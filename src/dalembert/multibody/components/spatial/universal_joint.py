"""The universal joint and the joint of constant velocity."""

__all__ = ["ConstantVelocityJoint", "UniversalJoint"]

from dataclasses import dataclass

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.conditions import MEETS, Condition, forces_of, perpendicular
from dalembert.multibody.components.spatial.orientation import Orientation, Vector
from dalembert.multibody.components.spatial.spatial_joint import REACTIONS, Joint, joint_kind, observed
from dalembert.multibody.components.spatial.spatial_pairs import (
    COORDINATES,
    e1,
    e2,
    e3,
    f1,
    f2,
    f3,
    push_a_axis,
    push_b_axis,
    relative_spin,
)
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import dot, times
from dalembert.multibody.kernels.elementary import angle_of

_CROSS = (MEETS, perpendicular(1, 2))
ANGLES = (("angle_a", "rad"), ("rate_a", "rad/s"), ("angle_b", "rad"), ("rate_b", "rad/s"))
_reactions = observed(forces_of(_CROSS, COORDINATES), COORDINATES + 4, angle=False, displacement=False)


@inlined
def _observe_turns(x, v, p, m, out):
    """Angles and rates of both pins."""
    first, other, spin = e1(x, p, m), f2(x, p, m), relative_spin(x, v, m)
    out[0], out[1] = angle_of(dot(e2(x, p, m), other), dot(e3(x, p, m), other)), dot(spin, first)
    out[2], out[3] = angle_of(dot(first, f1(x, p, m)), dot(first, f3(x, p, m))), dot(spin, other)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    """Reactions, the turns about both pins, b = R(e1, angle_a) R(f2, angle_b) a, and rates spin . e1 and spin . f2."""
    _reactions(x, v, a, p, m, inputs, out)
    _observe_turns(x, v, p, m, out[12:])


UNIVERSAL = joint_kind(
    "universal",
    __name__,
    *_CROSS,
    outputs=(*REACTIONS, *ANGLES),
    angles=("angle_a", "angle_b"),
    turn=_observe_turns,
    observe=_observe,
)

_push_e1, _push_e2, _push_f1, _push_f2 = push_a_axis(1), push_a_axis(2), push_b_axis(1), push_b_axis(2)


@inlined
def _residual(x, p, m, row, g):
    """e1 . f2 - e2 . f1: b is turned relative to a about an axis in the plane of e1 and e2."""
    g[row] = dot(e1(x, p, m), f2(x, p, m)) - dot(e2(x, p, m), f1(x, p, m))


@inlined
def _forces(x, p, m, k, r):
    _push_e1(p, m, times(x[k], f2(x, p, m)), r)
    _push_f2(p, m, times(x[k], e1(x, p, m)), r)
    _push_e2(p, m, times(-x[k], f1(x, p, m)), r)
    _push_f1(p, m, times(-x[k], e2(x, p, m)), r)


CONSTANT_VELOCITY = joint_kind("constant_velocity", __name__, MEETS, Condition(1, _residual, _forces))


@dataclass(frozen=True)
class UniversalJoint(Joint):
    """A cross of two perpendicular pins: both points coincide, and the pins stay perpendicular.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axis_a : (float, float, float)
        Direction of the pin in a, in the axes of a.
    axis_b : (float, float, float)
        Direction of the pin in b, in the axes of b.

    Notes
    -----
    ``angle_a`` and ``angle_b`` are the turns about the pins: b is turned about ``axis_b``, then with the cross about
    ``axis_a``. They are zero where both markers have the same orientation, if the pins are then perpendicular.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import Inertia, Orientation, RigidBody, SpatialSystem
    >>> system, rod = SpatialSystem(), Inertia.cylinder(mass=1.0, radius=0.01, length=0.5)
    >>> body = system.add(RigidBody("rod", rod, orientation=Orientation.by_angles("xy", [0.3, -0.2])))
    >>> _ = system.add(UniversalJoint("cross", system.ground, body.point("origin")))
    >>> simulate(system, end=0.01).channels(["cross.angle_a", "cross.angle_b"])[0].round(12)
    array([ 0.3, -0.2])
    """

    axis_a: Vector = (1.0, 0.0, 0.0)
    axis_b: Vector = (0.0, 1.0, 0.0)

    kind = UNIVERSAL

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        return ("angle_a", "angle_b")

    @property
    def turned(self) -> tuple[np.ndarray, np.ndarray]:
        across = np.cross(self.axis_a, self.axis_b)
        parallel = np.real(across @ across) < 1e-12  # of pins that are given in markers that are turned
        first = Orientation.by_axes(self.axis_a, None if parallel else self.axis_b).matrix
        second = Orientation.by_axes(self.axis_b, None if parallel else tuple(across)).matrix
        return first[:, [2, 0, 1]], second[:, [1, 2, 0]]  # the pin as the first axis of a, the second of b

    def lower(self, lowering: SpatialRows) -> None:
        self._oriented()
        super().lower(lowering)


@dataclass(frozen=True)
class ConstantVelocityJoint(Joint):
    """A coupling of shafts, such as a Rzeppa joint: both points coincide, and both shafts turn at the same rate.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axis : (float, float, float)
        Direction of the shafts, the same in the axes of both markers.

    Notes
    -----
    The rotation vector of b relative to a is perpendicular to the axis. An initial state may state its components
    ``rotation_1`` and ``rotation_2`` along the joint's first two axes. Their rates are the components of the relative
    angular velocity along these axes.
    """

    axis: Vector = (0.0, 0.0, 1.0)

    kind = CONSTANT_VELOCITY

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        return ("rotation_1", "rotation_2")

    def lower(self, lowering: SpatialRows) -> None:
        self._oriented()
        super().lower(lowering)
