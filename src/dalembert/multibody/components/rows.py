"""What components call while a system is lowered: the rows that they write for the kernels."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np

from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.points import Side
from dalembert.multibody.components.signals import Course
from dalembert.multibody.kernels.callbacks import Sizes
from dalembert.multibody.kernels.kind import Kind


class Pair(NamedTuple):
    """Two markers as kernels see them, and how they are placed at the start.

    ``angles`` of both; ``relative``: position of b against a, in the axes of a.
    """

    slots: list[int | None]
    data: list[Number]
    integers: list[int]
    distance: Number
    rest_angle: Number
    angles: tuple[Number, Number]
    relative: tuple[Number, Number]

    @property
    def unwrapped(self) -> list[int]:
        """The integers of a component whose angle counts turns by itself."""
        return [*self.integers[:2], 0]


class Rows(Protocol):
    """Collects the rows of the kernels."""

    kinks: list[tuple[float, str]]

    def add(
        self,
        kind: Kind,
        index: Sequence[int | None],
        numbers: Sequence[Number],
        integers: Sequence[int] = (),
        name: str = "",
    ) -> None:
        """One component of a kind; a ``name`` gives it channels."""

    def add_many(self, kind: Kind, index: np.ndarray, numbers: Sequence[Number]) -> None:
        """Components of a kind, index (count, width), that share their numbers."""

    def multipliers(self, owner: str, count: int) -> list[int | None]:
        """Unknowns of ``count`` constraints of a joint."""
        ...

    def signal(self, course: Course) -> int:
        """Number of a function of time."""
        ...

    def callback(self, function: Callable[..., Any], owner: str, sizes: Sizes) -> int:
        """Number of a force function of the user's."""
        ...

    def coordinate(self, body: Any) -> tuple[int, Number]:
        """Number of the coordinate that a component needs, and its value as the bodies are placed."""
        ...


class Lowering(Rows, Protocol):
    """Collects the rows of the kernels of a planar mechanism."""

    gravity: tuple[Number, Number]

    def pair(self, a: Side, b: Side | None, owner: str) -> Pair:
        """The markers of two sides; a bare ground stands where the other side is."""
        ...
