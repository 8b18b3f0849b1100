"""Elements between degrees of freedom that follow a law: all elements but friction contacts."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import ClassVar

import numpy as np

from dalembert.arguments import Checked
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.laws.law import Law
from dalembert.vibration.laws.law_block import LawBlock, LawSums
from dalembert.vibration.laws.marched_sums import MarchedSums
from dalembert.vibration.laws.sampled_sums import SampledSums


@dataclass(frozen=True)
class LawElement(Checked):
    """Base of elements that follow a law. A frozen dataclass that derives from it is a new kind of element.

    Its fields with a unit in their metadata (``""`` for a number without dimension) are the numbers of the law, in
    their order.

    Parameters
    ----------
    name : str
    first : str
        Degree of freedom, such as ``"A.x"``.
    second : str, optional
        The ground if not given; u is the first displacement less the second.

    Attributes
    ----------
    law : Law
        A function under :func:`dalembert.vibration.law`.
    rated : bool
        Whether the force depends on ``v``. If this is False although it does, harmonic balance computes a wrong force
        or a wrong Jacobian.
    switches : bool
        Whether the stiffness jumps between two values, as where a stop is touched.
    events : Law, optional
        ``events(u, v, z, numbers, crossings)`` writes functions whose zeros divide the motion into smooth parts, such
        as ``v[0]`` where a law changes with the direction of motion. ``z`` is the state that the law wrote at the
        point before, a sample or a zero, and is not changed. Harmonic balance finds the zeros between samples.
    event_count : int
        Number of these functions.
    """

    name: str
    first: str
    second: str | None = None

    law: ClassVar[Law]
    rated: ClassVar[bool] = False
    switches: ClassVar[bool] = False
    events: ClassVar[Law | None] = None
    event_count: ClassVar[int] = 0

    @property
    def states(self) -> int:
        """Number of internal states of the law, which are 0 at rest. A law with states overrides this property."""
        return 0

    @property
    def ends(self) -> Sequence[tuple[str, str | None]]:
        """Degrees of freedom, first and second, of each column that the law sees."""
        return ((self.first, self.second),)

    @property
    def numbers(self) -> dict[str, Number]:
        """Numbers of the law by their names."""
        return {part.name: getattr(self, part.name) for part in fields(self) if "unit" in part.metadata}

    def closed_stiffness(self, block: LawBlock) -> np.ndarray:
        """Stiffness of each column where the law is closed, N/m, (elements, columns); NaN if it has none."""
        return np.full(block.rows.shape, np.nan)

    def sums(self, block: LawBlock, series: Fourier, events: bool) -> LawSums:
        """Fourier coefficients of the forces. A kind may have a faster way, or one that corrects events."""
        if block.states or (events and self.events is not None):
            return MarchedSums(block, series, events and self.events is not None)
        return SampledSums(block, series)
