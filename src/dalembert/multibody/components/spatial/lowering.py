"""What spatial components call while a system is lowered."""

from typing import NamedTuple, Protocol

import numpy as np

from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.lowering import Rows
from dalembert.multibody.components.spatial.points import Side


class Pair(NamedTuple):
    """Two markers as kernels see them, and how they are placed at the start.

    Parameters
    ----------
    slots : list of int or None
        Coordinates of a and of b, 24; None on the side of the ground.
    data : list of numbers
    integers : list of int
    separation : array (3,)
        Position of b relative to a, in the fixed axes.
    axes : (array, array), each (3, 3)
        Axes of both markers, as columns, in the fixed axes.
    """

    slots: list[int | None]
    data: list[Number]
    integers: list[int]
    separation: np.ndarray
    axes: tuple[np.ndarray, np.ndarray]


class SpatialLowering(Rows, Protocol):
    """Collects the rows of the kernels of a mechanism in space."""

    gravity: tuple[Number, Number, Number]

    def pair(self, a: Side, b: Side | None, owner: str, turned: tuple[np.ndarray, np.ndarray] | None = None) -> Pair:
        """The markers of two sides; a bare ground stands where the other side is.

        ``turned``: rotation matrices that turn the axes of both markers into those of the joint.
        """
        ...
