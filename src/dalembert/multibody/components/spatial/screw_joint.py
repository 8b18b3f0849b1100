"""The screw joint: a sleeve that slides along its axis in proportion to its angle."""

__all__ = ["ScrewJoint"]

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from dalembert.errors import InputError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial import spatial_pairs as pairs
from dalembert.multibody.components.spatial.conditions import Condition, forces_of, level, perpendicular
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_joint import Joint, joint_displacement, joint_kind, observed
from dalembert.multibody.components.spatial.spatial_pairs import (
    e1,
    e2,
    e3,
    f1,
    push_a_axis,
    push_b_axis,
    push_pair,
    separation,
)
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import dot, minus, times
from dalembert.multibody.kernels.elementary import angle_of, reciprocal, sin_cos

_push_e1, _push_e2, _push_e3, _push_f1 = push_a_axis(1), push_a_axis(2), push_a_axis(3), push_b_axis(1)


@inlined
def _counted(x, p, m):
    """The angle that belongs to the displacement."""
    return 2.0 * pi * reciprocal(p.lead) * (joint_displacement(x, p, m) - p.offset)


@inlined
def _threaded(x, p, m, row, g):
    """Angle of the joint less the angle u = 2 pi (e3 . Delta - offset) / lead, within half a turn.

    The sine of it would hold half a turn off, too, and Newton's method would end at a thread far from the nearest one.
    """
    s, c = sin_cos(_counted(x, p, m))
    f = f1(x, p, m)
    along, across = dot(e1(x, p, m), f), dot(e2(x, p, m), f)
    g[row] = angle_of(c * along + s * across, c * across - s * along)


@inlined
def _threaded_forces(x, p, m, k, r):
    """The gradient of the angle, (along d(across) - across d(along)) / (along^2 + across^2), less that of u."""
    first, second, f, force = e1(x, p, m), e2(x, p, m), f1(x, p, m), x[k]
    along, across = dot(first, f), dot(second, f)
    share = force * reciprocal(along * along + across * across)
    _push_e2(p, m, times(share * along, f), r)
    _push_e1(p, m, times(-share * across, f), r)
    _push_f1(p, m, minus(times(share * along, second), times(share * across, first)), r)
    slide = -force * 2.0 * pi * reciprocal(p.lead)
    _push_e3(p, m, times(slide, separation(x, p, m)), r)
    push_pair(p, m, times(slide, e3(x, p, m)), r)


CONDITIONS = (
    level(1),
    level(2),
    perpendicular(1, 3),
    perpendicular(2, 3),
    Condition(1, _threaded, _threaded_forces),
)
_sleeve: Any = observed(forces_of(CONDITIONS, pairs.COORDINATES), pairs.COORDINATES + 5, angle=True, displacement=True)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    """The channels of a cylindrical joint, with the counted angle."""
    _sleeve(x, v, a, p, m, inputs, out)
    out[12] = _counted(x, p, m)


SCREW = joint_kind(
    "screw",
    __name__,
    *CONDITIONS,
    angle=True,
    displacement=True,
    numbers=("lead", "offset"),
    observe=_observe,
    angles=(),
)


@dataclass(frozen=True)
class ScrewJoint(Joint):
    """A screw: b turns about the axis and slides along it, displacement = lead angle / (2 pi) + offset.

    It is a complete joint with one degree of freedom, without friction.

    Parameters
    ----------
    name : str
    a, b : Point or ground
        Nut and screw, or screw and nut.
    lead : float
        m per turn; positive for a right-hand thread.
    offset : float, optional
        m; what it is at the start if not given.
    axis : (float, float, float)
        Direction of the axis, the same in the axes of both markers.

    Raises
    ------
    InputError
        For a lead of zero.

    Notes
    -----
    The channel ``angle`` is counted over all turns. ``force_3`` and ``torque_3`` are force and torque of the thread on
    b, with torque_3 = -force_3 lead / (2 pi).

    Examples
    --------
    A nut that falls along its screw turns: its acceleration is g/(1 + J (2 pi/lead)^2/m).

    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import Inertia, RigidBody, ScrewJoint, SpatialSystem
    >>> system = SpatialSystem()
    >>> nut = system.add(RigidBody("nut", Inertia(1.0, (1e-4, 1e-4, 1e-4))))
    >>> _ = system.add(ScrewJoint("thread", system.ground, nut.point("origin"), lead=0.05))
    >>> simulate(system, end=1.0, solver="auto").channels(["thread.displacement"])[-1].round(4)
    array([-1.9018])
    """

    lead: Number = number("m")
    offset: Number | None = number("m", None)
    axis: Vector = (0.0, 0.0, 1.0)

    kind = SCREW
    aligned = (3,)

    def __post_init__(self) -> None:
        if not (np.isfinite(np.real(self.lead)) and np.real(self.lead) != 0):
            raise InputError(f"screw joint {self.name!r}: lead is {self.lead}; expected a number other than zero")

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        """The displacement, which gives the angle with its turns."""
        return ("displacement",)

    def lower(self, lowering: SpatialRows) -> None:
        self._oriented()
        pair, offset = self.pair(lowering), self.offset
        if offset is None:
            offset = pair.displacement - self.lead * pair.angle / (2.0 * pi)
        self._add(lowering, pair, [self.lead, offset])
