"""The fixed joint in space."""

__all__ = ["FixedJoint"]

from dataclasses import dataclass

import numpy as np

from dalembert.errors import ModelError
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.spatial.cable import Cable
from dalembert.multibody.components.spatial.cable_clamp import CLAMP, SLOPE
from dalembert.multibody.components.spatial.conditions import MEETS, perpendicular
from dalembert.multibody.components.spatial.spatial_cable_element import NODE
from dalembert.multibody.components.spatial.spatial_joint import Joint, axis_in_space, joint_kind
from dalembert.multibody.components.spatial.spatial_markers import SLOTS
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.kernels.kind import Kind

KIND = joint_kind("fixed_in_space", __name__, MEETS, perpendicular(1, 2), perpendicular(2, 3), perpendicular(3, 1))


@dataclass(frozen=True)
class FixedJoint(Joint):
    """A weld: points and axes of both markers coincide.

    A cable has no axes: it is clamped. Its line runs along the x axis of the other marker, and may spin about it.

    Parameters
    ----------
    name : str
    a, b : Point or ground

    As a force sensor: the channels ``force_1`` to ``torque_3`` are force and torque on b along the axes of a, or of b
    where a is a point of a cable.
    """

    @property
    def kind(self) -> Kind:  # type: ignore[override]
        """A clamp where a side is a point of a cable."""
        return CLAMP if any(map(_is_line, (self.a, self.b))) else KIND

    @property
    def aligned(self) -> tuple[int, ...]:  # type: ignore[override]
        """All axes, where both sides have them."""
        return (1, 2, 3) if self.kind is KIND else ()

    def lower(self, lowering: SpatialRows) -> None:
        if self.kind is KIND:
            self._oriented()
            super().lower(lowering)
            return
        swapped = _is_line(self.a)
        marker, line = (self.b, self.a) if swapped else (self.a, self.b)
        if _is_line(marker):
            raise ModelError(
                f"FixedJoint {self.name!r}: both sides are points of cables. Put a rigid body between them"
            )
        self._oriented(marker)
        pair = lowering.pair(marker, line, self.name)
        first = pair.slots[SLOTS]
        assert first is not None
        index = [*pair.slots[:SLOTS], *range(first, first + NODE), *lowering.multipliers(self.name, CLAMP.multipliers)]
        lowering.add(CLAMP, index, pair.data, [*pair.integers, int(swapped)], self.name)

    def misaligned(
        self, kind: Kind, numbers: np.ndarray, integers: np.ndarray, placed: np.ndarray, closed: np.ndarray
    ) -> str:
        if kind is CLAMP and axis_in_space(0, 1, numbers, integers, closed) @ closed[SLOPE : SLOPE + 3] < 0.0:
            return "the line of the cable runs against the x axis of the other side, and has to run along it"
        return super().misaligned(kind, numbers, integers, placed, closed)


def _is_line(side: object) -> bool:
    return isinstance(side, Point) and isinstance(side.body, Cable)
