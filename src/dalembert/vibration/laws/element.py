"""Elements between degrees of freedom that follow a law, and blocks of them: all elements but friction contacts."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np

from dalembert.arguments import Checked
from dalembert.vibration.balance.fourier import Fourier
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.laws.law import Law
from dalembert.vibration.laws.law_sums import LawSums, Sums


class LawElement(Checked):
    """Base of elements that follow a law. A frozen dataclass that derives from it is a new kind of element.

    The dataclass has a ``name`` and the degrees of freedom ``first`` and ``second``, the ground if None. Its fields
    with a unit in their metadata are the numbers of the law, in their order.

    Attributes
    ----------
    law : Law
        A function under :func:`dalembert.vibration.law`.
    rated : bool
        Whether forces depend on velocities.
    switches : bool
        Whether the stiffness jumps between two values, as where a stop is touched.
    """

    name: str
    law: ClassVar[Law]
    rated: ClassVar[bool] = False
    switches: ClassVar[bool] = False

    @property
    def states(self) -> int:
        """Internal numbers of the law. They are 0 at rest."""
        return 0

    @property
    def ends(self) -> Sequence[tuple[str, str | None]]:
        """Degrees of freedom, first and second, of each column that the law sees."""
        own: Any = self
        return ((own.first, own.second),)

    @property
    def numbers(self) -> dict[str, Number]:
        """Numbers of the law by their names."""
        own: Any = self
        return {one.name: getattr(self, one.name) for one in fields(own) if "unit" in one.metadata}

    @classmethod
    def sums(cls, block: "LawBlock", series: Fourier, events: bool) -> Sums:
        """Fourier coefficients of the forces. A kind may have a faster way, or one that corrects events."""
        return LawSums(block.names[0], block.law, block.numbers, block.states, cls.rated, series)


@dataclass(frozen=True)
class LawBlock:
    """Elements of one kind and one law.

    Parameters
    ----------
    kind : type
    law : Law
    states : int
        Internal numbers of each.
    names : tuple of str
        Of the elements.
    given : tuple of str
        Names of the numbers.
    rows : array of int, shape (elements, columns)
        Among the rows of all elements.
    numbers : array, shape (elements, numbers)
    """

    kind: type[LawElement]
    law: Law
    states: int
    names: tuple[str, ...]
    given: tuple[str, ...]
    rows: np.ndarray
    numbers: np.ndarray

    @property
    def remembers(self) -> bool:
        """Whether forces depend on more than displacements, which Hill's method does not see."""
        return self.states > 0 or self.kind.rated

    def sums(self, series: Fourier, events: bool = True) -> Sums:
        """Fourier coefficients of the forces."""
        return self.kind.sums(self, series, events)
