"""What flexible bars of planar ANCF elements share: straight and undeformed at first."""

from dataclasses import dataclass, field
from typing import Any, ClassVar, cast

import numpy as np

from dalembert.multibody.components.base_body import POSITION
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.hermite import line
from dalembert.multibody.components.node_chain import NodeChain
from dalembert.multibody.components.planar.body import GRADIENT, Body, turned
from dalembert.multibody.components.points import Place


@dataclass(frozen=True)
class Ancf(NodeChain, Body):
    """What both beams share: a chain of equal elements between equal nodes, cubic along the axis.

    Its first vectors a node are the position and the gradient along the axis.
    """

    length: Number = number("m", above=0)
    elements: int = cast(Any, field())  # as a field of ours is to a type checker: any
    youngs_modulus: Number = number("Pa", above=0)

    vectors: ClassVar[int]
    """Vectors of two components a node."""

    @property
    def place(self) -> Place:
        return self.origin  # type: ignore[attr-defined] - every concrete beam has it

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        node = (POSITION, POSITION) + (GRADIENT, GRADIENT) * (self.vectors - 1)
        return node * (self.elements + 1)

    def coordinates(self, x: Number, y: Number, angle: Number) -> np.ndarray:
        c, s = turned(1.0, 0.0, angle)
        along = np.linspace(0.0, 1.0, self.elements + 1) * self.length
        frame = [c, s, -s, c][: 2 * (self.vectors - 1)]
        nodes = np.empty((self.elements + 1, 2 * self.vectors), dtype=np.result_type(x, y, angle, along))
        nodes[:, 0], nodes[:, 1], nodes[:, 2:] = x + along * c, y + along * s, frame
        return nodes.ravel()

    def element_index(self, first: int) -> np.ndarray:
        """Coordinates of each element, (elements, 4 vectors)."""
        return first + np.arange(4 * self.vectors) + 2 * self.vectors * np.arange(self.elements)[:, None]

    def outline(self, coordinates: np.ndarray, points: int) -> np.ndarray:
        nodes = coordinates.reshape(len(coordinates), self.elements + 1, self.vectors, 2)
        return line(nodes, float(np.real(self.length)) / self.elements, points)
