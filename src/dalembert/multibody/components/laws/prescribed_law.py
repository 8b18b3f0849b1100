"""Prescribed motions: a coordinate that follows a function u of time, g = coordinate - u = 0."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

from dalembert.errors import require_known
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.components.rows import Rows
from dalembert.multibody.components.signals import Course, as_signal, refuse_jumps


def power_of_motion(multiplier: int) -> Callable[..., Any]:
    """Energies of a prescribed motion: none, and the power lambda dg/dt at a fixed position, which it feeds in."""

    @inlined
    def energy(x, v, p, m, inputs):
        nothing = 0.0 * x[multiplier]
        return nothing, nothing, -x[multiplier] * inputs.signals[m.motion, 1]

    return energy


@dataclass(frozen=True)
class DrivenCoordinate(BaseJoint):
    """Fields and checks of a prescribed motion; ``NUMBERS``: number of each coordinate in kernels."""

    coordinate: str = "angle"
    motion: Course = 0.0

    NUMBERS: ClassVar[dict[str, int]]

    def __post_init__(self) -> None:
        owner = f"prescribed motion {self.name!r}"
        require_known("coordinate", self.coordinate, self.NUMBERS, owner)
        refuse_jumps(owner, self.motion)

    def _driven(self, lowering: Rows) -> list[int]:
        """Integers of the coordinate and the signal; the kinks of the signal go to the system."""
        lowering.kinks += [(time, self.name) for time in as_signal(self.motion).kinks]
        return [self.NUMBERS[self.coordinate], lowering.signal(self.motion)]
