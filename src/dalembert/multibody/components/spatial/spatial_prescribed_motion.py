"""Prescribed motions in space: an angle about an axis, or a displacement along it, that follows a function of time."""

__all__ = ["PrescribedMotion"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import stack
from dalembert.multibody.components.laws.prescribed_law import DrivenCoordinate, power_of_motion
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_joint import (
    ANGLE,
    DISPLACEMENT,
    REACTIONS,
    Joint,
    joint_angle,
    joint_displacement,
    joint_rate,
    joint_speed,
    observe_reactions,
    observe_turn,
)  # fmt: skip
from dalembert.multibody.components.spatial.spatial_pairs import COORDINATES, LENGTHS, e1, e2, f1
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import dot
from dalembert.multibody.kernels.constraints import forces_of
from dalembert.multibody.kernels.elementary import angle_of, sin_cos
from dalembert.multibody.kernels.time_inputs import signal

_ANGLE, _DISPLACEMENT = range(2)


@inlined
def _constraint(x, p, m, inputs, g):
    """Angle of the joint less an angle u, within half a turn, or e3 . Delta - u for a displacement."""
    target = signal(inputs, m.motion)
    if m.coordinate == _ANGLE:
        s, c = sin_cos(target)
        f = f1(x, p, m)
        along, across = dot(e1(x, p, m), f), dot(e2(x, p, m), f)
        g[0] = angle_of(c * along + s * across, c * across - s * along)
    else:
        g[0] = joint_displacement(x, p, m) - target


_WIDTH = COORDINATES + 1
_forces = forces_of(_constraint, COORDINATES, 1)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    r = stack(x, _WIDTH)
    for i in range(_WIDTH):
        r[i] = 0.0
    _forces(x, p, m, inputs, r)
    observe_reactions(x, p, m, r, out)
    out[12], out[13] = joint_angle(x, p, m), joint_rate(x, v, p, m)
    out[14], out[15] = joint_displacement(x, p, m), joint_speed(x, v, p, m)


MOTION = pair_kind(
    "prescribed_motion_in_space",
    __name__,
    integers=("coordinate", "motion"),
    multipliers=1,
    constraint=_constraint,
    energy=power_of_motion(COORDINATES),
    outputs=(*REACTIONS, *ANGLE, *DISPLACEMENT),
    angles=("angle",),
    turn=observe_turn,
    observe=_observe,
    observes_inputs=True,
    lengths=LENGTHS,
    driven=True,
    holds=True,
)


@dataclass(frozen=True)
class PrescribedMotion(Joint, DrivenCoordinate):
    """The angle of b relative to a about an axis, or its displacement along it, that follows a function of time.

    It acts beside the joint that guides the motion, such as a revolute or a prismatic joint with the same axis.

    Parameters
    ----------
    name : str
    a, b : Point or ground
        b may be a point without axes, as of a cable, where the coordinate is a displacement.
    coordinate : {"angle", "displacement"}
        The angle in rad, the displacement in m.
    motion : float or Signal
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.
    """

    axis: Vector = (0.0, 0.0, 1.0)

    NUMBERS = {"angle": _ANGLE, "displacement": _DISPLACEMENT}
    kind = MOTION

    def lower(self, lowering: SpatialRows) -> None:
        if self.coordinate == "displacement":
            self._oriented(self.a)
        else:
            self._oriented()
        integers = self._driven(lowering)
        self._add(lowering, self.pair(lowering), integers=integers)
