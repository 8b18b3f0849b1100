"""Work beside a run, which must leave the machine to the run."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass


@dataclass
class Sparing:
    """Repeated work that takes at most a part of the time.

    Parameters
    ----------
    part : float
        Of the time.
    clock : function
        Time in seconds.
    """

    part: float = 0.05
    clock: Callable[[], float] = time.monotonic
    _next: float = 0.0

    @property
    def is_due(self) -> bool:
        """Whether the work may be done again."""
        return self.clock() >= self._next

    @contextmanager
    def work(self) -> Iterator[None]:
        """A block that does the work."""
        began = self.clock()
        try:
            yield
        finally:
            ended = self.clock()
            self._next = ended + (ended - began) * (1 / self.part - 1)
