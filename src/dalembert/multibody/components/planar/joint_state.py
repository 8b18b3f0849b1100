"""The state of a joint that is stated: one of its coordinates, and the rate, as assembly needs them."""

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.planar.joint import Joint
from dalembert.multibody.components.planar.markers import angle, direction
from dalembert.multibody.components.planar.pairs import pair_kind, relative_angle, separation
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.components.signals import Signal
from dalembert.multibody.kernels.elementary import angle_of, wrapped
from dalembert.multibody.kernels.time_inputs import signal

_ANGLE, _DISPLACEMENT, _DIRECTION = range(3)
_COORDINATES = {"angle": _ANGLE, "displacement": _DISPLACEMENT, "direction": _DIRECTION}


@inlined
def _constraint(x, p, m, inputs, g):
    """Angle of b against a; position of b along a line that turns with a; angle of the line from a to b against a."""
    target = signal(inputs, m.course)
    dx, dy = separation(x, p, m)
    if m.coordinate == _ANGLE:
        gap = relative_angle(x, p, m) - target
        g[0] = wrapped(gap) if m.wraps == 1 else gap
    elif m.coordinate == _DISPLACEMENT:
        c, s = direction(m.a_kind, 0, x, p.a_angle + p.line)
        g[0] = c * dx + s * dy - target
    else:
        g[0] = wrapped(angle_of(dx, dy) - angle(m.a_kind, 0, x, p.a_angle) - target)


STATED = pair_kind(
    "stated", ("line",), ("coordinate", "course"),
    multipliers=1, constraint=_constraint, lengths=("a_x", "a_y", "b_x", "b_y"),
)  # fmt: skip


@dataclass(frozen=True)
class JointState(Joint):
    """A constraint on the coordinate of a joint, with the name of that coordinate.

    ``line``: angle of the line of a displacement against the axes of a, rad.
    """

    coordinate: str
    course: Signal
    line: float

    kind = STATED

    def lower(self, lowering: Lowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        self._add(lowering, pair, [self.line], [_COORDINATES[self.coordinate], lowering.signal(self.course)])


def stated(joint: Joint, coordinate: str, course: Signal) -> JointState:
    """Return the constraint that makes a coordinate of a joint follow a signal."""
    a, b = joint.a, joint.b
    masses = [isinstance(side, Point) and not side.body.has_axes for side in (a, b)]
    if coordinate == "direction" and masses[0] and not masses[1]:  # the rod turns with the side that has axes
        a, b = b, a
    return JointState(f"{joint.name}.{coordinate}", a, b, coordinate, course, getattr(joint, "angle", 0.0))
