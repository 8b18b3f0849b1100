"""The state of a joint in space that is stated: its angle or displacement, and the rate, as assembly needs them."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.signals import Signal
from dalembert.multibody.components.spatial.joint import ANGLE, Joint, joint_angle, joint_displacement
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.lowering import SpatialLowering
from dalembert.multibody.components.spatial.pairs import LENGTHS
from dalembert.multibody.kernels.elementary import wrapped
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.time_inputs import signal


@inlined
def _angle(x, p, m, inputs, g):
    g[0] = wrapped(joint_angle(x, p, m) - signal(inputs, m.course))


@inlined
def _displacement(x, p, m, inputs, g):
    g[0] = joint_displacement(x, p, m) - signal(inputs, m.course)


def _stated(name: str, constraint: Any) -> Kind:
    return pair_kind(name, __name__, integers=("course",), multipliers=1, constraint=constraint, lengths=LENGTHS)


STATED_ANGLE, STATED_DISPLACEMENT = _stated("stated_angle", _angle), _stated("stated_displacement", _displacement)


@dataclass(frozen=True)
class JointState(Joint):
    """A constraint on the coordinate of a joint, with the name of that coordinate.

    Parameters
    ----------
    name : str
    a, b : Point or ground
    axes : (array, array)
        Rotations (3, 3) from the axes of both markers to those of the joint.
    coordinate : {"angle", "displacement"}
    course : Signal
    """

    axes: tuple[np.ndarray, np.ndarray]
    coordinate: str
    course: Signal

    kind = STATED_ANGLE

    @property
    def turned(self) -> tuple[np.ndarray, np.ndarray]:
        return self.axes

    def lower(self, lowering: SpatialLowering) -> None:
        kind = STATED_ANGLE if self.coordinate == ANGLE[0][0] else STATED_DISPLACEMENT
        pair = lowering.pair(self.a, self.b, self.name, self.axes)
        index = pair.slots + lowering.multipliers(self.name, 1)
        lowering.add(kind, index, pair.data, [*pair.integers, lowering.signal(self.course)], self.name)
