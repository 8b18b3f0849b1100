"""Forces that a function of the user's returns from the time and the state of one or two markers."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar

from dalembert.multibody.components.base_load import BaseLoad
from dalembert.multibody.kernels.callbacks import Sizes

TIME = 0
"""Signal that holds the time."""


@dataclass(frozen=True)
class CalledForce(BaseLoad):
    """Fields and row of a user's force; ``SIZES``: how many numbers its function gets and returns."""

    at: Any
    function: Callable[..., Any] = field()
    against: Any = None

    SIZES: ClassVar[Sizes]

    def lower(self, lowering: Any) -> None:
        pair = lowering.pair(self.at, self.against, self.name)
        integers = [*pair.integers, lowering.callback(self.function, self.name, self.SIZES)]
        lowering.add(self.kind, pair.slots, pair.data, integers)
