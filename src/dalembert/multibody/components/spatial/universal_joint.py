"""The universal joint and the joint of constant velocity."""

__all__ = ["ConstantVelocityJoint", "UniversalJoint"]

from dataclasses import dataclass

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.conditions import MEETS, Condition, perpendicular
from dalembert.multibody.components.spatial.joint import Joint, joint_kind
from dalembert.multibody.components.spatial.lowering import SpatialLowering
from dalembert.multibody.components.spatial.orientation import Orientation, Vector
from dalembert.multibody.components.spatial.pairs import e1, e2, f1, f2, push_a_axis, push_b_axis
from dalembert.multibody.components.spatial.vectors import dot, times

UNIVERSAL = joint_kind("universal", __name__, MEETS, perpendicular(1, 2))

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


CONSTANT_VELOCITY = joint_kind("constant_velocity", __name__, MEETS, Condition(1, _residual, _forces, quadratic=True))


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
    """

    axis_a: Vector = (1.0, 0.0, 0.0)
    axis_b: Vector = (0.0, 1.0, 0.0)

    kind = UNIVERSAL

    @property
    def turned(self) -> tuple[np.ndarray, np.ndarray]:
        first, second = Orientation.by_axes(self.axis_a).matrix, Orientation.by_axes(self.axis_b).matrix
        return first[:, [2, 0, 1]], second[:, [1, 2, 0]]  # the pin as the first axis of a, the second of b

    def lower(self, lowering: SpatialLowering) -> None:
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
    """

    axis: Vector = (0.0, 0.0, 1.0)

    kind = CONSTANT_VELOCITY

    def lower(self, lowering: SpatialLowering) -> None:
        self._oriented()
        super().lower(lowering)
