"""What planar joints share: the base class, and the outputs of a joint."""

__all__ = ["Joint"]

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.pairs import INTEGERS, pair_kind, relative_angle, relative_spin
from dalembert.multibody.components.points import Side, require_direction
from dalembert.multibody.components.rows import Lowering, Pair
from dalembert.multibody.kernels.kind import Kind

OUTPUTS = (("angle", "rad"), ("rate", "rad/s"), ("force_x", "N"), ("force_y", "N"), ("torque", "N*m"))


def joint_kind(
    name: str, multipliers: int, numbers: tuple[str, ...] = (), integers: tuple[str, ...] = (), **declared: Any
) -> Kind:
    """Kind of a joint that holds points, with the outputs of all joints if it declares no others."""
    common = {"outputs": OUTPUTS, "lengths": ("a_x", "a_y", "b_x", "b_y"), "holds": True}
    return pair_kind(name, numbers, integers, multipliers=multipliers, **common | declared)


@dataclass(frozen=True)
class Joint(BaseJoint):
    """Base of all planar joints: a name and two sides."""

    a: Side
    b: Side

    @abstractmethod
    def lower(self, lowering: Lowering) -> None:
        """Write the rows of the kernels."""

    def stating(self, coordinate: str, course: Any) -> "Joint":
        from dalembert.multibody.components.planar.joint_state import stated

        return stated(self, coordinate, course)

    def position(self, kind: Kind, numbers: np.ndarray, integers: np.ndarray, x: np.ndarray) -> np.ndarray | None:
        """Position of the second side, or of the first one if the second is the ground, (frames, 2)."""
        if kind.integers[:2] != INTEGERS[:2]:  # a joint of another form has no position to draw
            return None
        side = 0 if integers[1] == markers.GROUND else 1
        (sx, sy), own = numbers[3 * side : 3 * side + 2], x[:, 4 * side : 4 * side + 4]
        if integers[side] == markers.GROUND:
            return np.tile([sx, sy], (len(x), 1))
        if integers[side] == markers.RIGID:
            c, s = np.cos(own[:, 2]), np.sin(own[:, 2])
            return own[:, :2] + np.column_stack([c * sx - s * sy, s * sx + c * sy])
        return own[:, :2]

    def _add(
        self, lowering: Lowering, pair: Pair, numbers: Sequence[Number] = (), integers: Sequence[int] = ()
    ) -> list[int | None]:
        """Add the joint with the numbers and integers that follow those of its markers; its unknowns."""
        index = pair.slots + lowering.multipliers(self.name, self.kind.multipliers)
        lowering.add(self.kind, index, [*pair.data, *numbers], [*pair.integers, *integers], self.name)
        return index

    def _oriented(self, advice: str = "a revolute or distance joint, or a rigid body") -> None:
        """Refuse sides that have no direction."""
        require_direction(f"{type(self).__name__} {self.name!r}", advice, self.a, self.b)


@inlined
def observe_joint(x, v, p, m, fx, fy, torque, out):
    """Fill the outputs: relative angle and its rate, and the force and torque that the joint exerts on b."""
    out[0], out[1] = relative_angle(x, p, m), relative_spin(x, v, m)
    out[2], out[3], out[4] = fx, fy, torque
