"""Prescribed motions: a coordinate of a point that follows a function of time."""

__all__ = ["PrescribedMotion"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.laws.prescribed_law import DrivenCoordinate, power_of_motion
from dalembert.multibody.components.planar.joint import Joint, joint_kind, observe_joint
from dalembert.multibody.components.planar.pairs import push_pair, relative_angle, separation, twist_pair
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.kernels.elementary import wrapped
from dalembert.multibody.kernels.time_inputs import signal

_X, _Y, _ANGLE = range(3)


@inlined
def _constraint(x, p, m, inputs, g):
    target = signal(inputs, m.motion)
    if m.coordinate == _ANGLE:
        gap = relative_angle(x, p, m) - target
        g[0] = wrapped(gap) if m.wraps == 1 else gap
    else:
        dx, dy = separation(x, p, m)
        g[0] = (dx if m.coordinate == _X else dy) - target


@inlined
def _forces(x, p, m, r):
    nothing = 0.0 * x[8]
    if m.coordinate == _ANGLE:
        twist_pair(x, m, x[8], r)
    elif m.coordinate == _X:
        push_pair(x, p, m, x[8], nothing, r)
    else:
        push_pair(x, p, m, nothing, x[8], r)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    nothing = 0.0 * x[8]
    fx = -x[8] if m.coordinate == _X else nothing
    fy = -x[8] if m.coordinate == _Y else nothing
    observe_joint(x, v, p, m, fx, fy, -x[8] if m.coordinate == _ANGLE else nothing, out)


MOTION = joint_kind(
    "prescribed_motion", 1, (), ("coordinate", "motion"),
    constraint=_constraint, forces=_forces, energy=power_of_motion(8), observe=_observe, driven=True,
)  # fmt: skip


@dataclass(frozen=True)
class PrescribedMotion(Joint, DrivenCoordinate):
    """A coordinate of point b against point a that follows a function of time.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    coordinate : {"x", "y", "angle"}
        x and y along the fixed axes, in m; the angle in rad.
    motion : float or Signal
    """

    NUMBERS = {"x": _X, "y": _Y, "angle": _ANGLE}
    kind = MOTION

    def lower(self, lowering: Lowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        if self.coordinate == "angle":
            self._oriented()
        self._add(lowering, pair, integers=self._driven(lowering))
