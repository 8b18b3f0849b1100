"""The structure of a model: which unknowns each component couples, in the full system and in the reduced one."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.kernels.kernel import Compiled
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.nodes import CHANGE, RESTORE, SPREAD
from dalembert.multibody.kernels.reduction import Reduction, reduction
from dalembert.multibody.model.couplings import Couplings


@dataclass(frozen=True, eq=False)
class Structure:
    """What samples of an ensemble share.

    ``n``, ``size``: coordinates; coordinates and multipliers; ``owners``: component of each unknown; ``kinds``: kind of
    each coordinate; ``index``, ``meta`` (count, -); ``signals`` (signals, 4).
    """

    n: int
    size: int
    owners: tuple[str, ...]
    first: dict[str, int]
    kinds: tuple[str, ...]
    index: dict[Kind, np.ndarray]
    meta: dict[Kind, np.ndarray]
    rows: dict[str, tuple[Kind, int]]
    signals: np.ndarray

    def same(self, other: "Structure") -> bool:
        """Whether the other structure fits the same compiled arrays."""
        return self is other or (
            (self.n, self.size, self.owners) == (other.n, other.size, other.owners)
            and np.array_equal(self.signals, other.signals)
            and list(self.index) == list(other.index)
            and all(
                np.array_equal(self.index[kind], other.index[kind])
                and np.array_equal(self.meta[kind], other.meta[kind])
                for kind in self.index
            )
        )

    @cached_property
    def full(self) -> Couplings:
        """The system in coordinates and multipliers."""
        return Couplings(self.index, self.size)

    @cached_property
    def reduction(self) -> Reduction:
        """Rows of the reduced system."""
        return reduction(self.index, self.n, self.size)

    @cached_property
    def takes_means(self) -> bool:
        """Whether a step that keeps the energy takes mean forces, and constraint forces of its middle.

        So it does with components that have mean forces: beams and cables in space. Constraints are quadratic in the
        coordinates there, but for angles of rotors.
        """
        return any(kind.has("mean") for kind in self.index) and "rotor" not in self.kinds

    @cached_property
    def reduced(self) -> Couplings:
        """The system in increments, without internal constraints; the full one of a model that has none."""
        return Couplings(self.reduction.index, self.reduction.size) if self.reduction.nodes else self.full

    def reduced_kernels(self, derivatives: bool) -> list[Compiled]:
        """Kernels of the reduced system that the full one does not have."""
        if not self.reduction.nodes:
            return []
        linear = [kernel for kernel in self.reduced.linear_kernels if kernel not in self.full.linear_kernels]
        roles = [("change", float), ("restore", float), *[("spread", float), ("restore", complex)] * derivatives]
        nodes = [kind.kernel(*role) for role in roles for kind in self.reduction.nodes]
        return [*linear, *nodes, CHANGE[float], RESTORE[float], *[SPREAD, RESTORE[complex]] * derivatives]
