"""Distance joints: two points at a constant distance L, (Delta . Delta / L - L) / 2 = 0."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.errors import ModelError
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.components.fields import Number, number


@inlined
def distance_gap(square, length):
    """Constraint in m, of degree two in the coordinates; ``square`` is Delta . Delta. The multiplier is a force."""
    return 0.5 * (square / length - length)


@dataclass(frozen=True)
class Rod(BaseJoint):
    """Length of a distance joint.

    Parameters
    ----------
    length : float, optional
        m; the initial distance of the points if not given.
    """

    length: Number | None = number("m", None, above=0)

    def _length(self, pair: Any, alternative: str) -> Number:
        """Length, or the distance of the markers; ``alternative``: joint for points that coincide."""
        length = pair.distance if self.length is None else self.length
        if not np.real(length) > 0:
            raise ModelError(
                f"distance joint {self.name!r}: its points {self.a} and {self.b} coincide and no length is given; "
                f"give a length, or use a {alternative} joint"
            )
        return length
