"""Bodies whose elements are in a row, between nodes that are points."""

from dalembert.errors import InputError
from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.points import Point

MOST_ELEMENTS = 100_000
"""A hundred times as many as the longest chain of the benchmarks."""


class NodeChain(BaseBody):
    """Points of a row of elements: ``start``, ``end``, and ``node0`` to the last node."""

    elements: int

    @property
    def last_node(self) -> int:
        """Number of the last node."""
        return self.elements

    @property
    def node_names(self) -> tuple[str, ...]:
        """Names of the nodes as points."""
        return ("start", "end", *(f"node{k}" for k in range(self.last_node + 1)))

    @property
    def point_names(self) -> tuple[str, ...]:
        return self.node_names

    def node(self, number: int) -> Point:
        """Node 0 (the start) to the last node (the end)."""
        return self.point(f"node{number}")

    def node_number(self, point: str) -> int:
        """Number of the node of a point, from 0 at the start."""
        ends = {"start": 0, "end": self.last_node}
        return ends[point] if point in ends else int(point.removeprefix("node"))

    def require_elements(self, owner: str) -> None:
        """Refuse a number of elements that does not exist."""
        if not (isinstance(self.elements, int) and 0 < self.elements <= MOST_ELEMENTS):
            raise InputError(
                f"{owner}: elements is {self.elements!r}; expected a whole number, from 1 to {MOST_ELEMENTS}"
            )
