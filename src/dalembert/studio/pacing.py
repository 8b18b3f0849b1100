"""Work that is repeated: for the newest state alone, or in a part of the time."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from nicegui import background_tasks


class Latest:
    """Does one thing at a time; requests that come meanwhile become one more turn after it. ``work`` reads the newest
    state when it begins; it begins after ``pause`` seconds without a request. ``draft.follow("study", Latest(redraw))``
    redraws after changes, and skips those that came too fast.
    """

    def __init__(self, work: Callable[[], Awaitable[object]], pause: float = 0.0) -> None:
        self._work, self._pause, self._pending, self._busy = work, pause, False, False

    def __call__(self) -> None:
        """Ask for a turn."""
        self._pending = True
        if not self._busy:
            self._busy = True
            background_tasks.create(self._turns())

    async def _turns(self) -> None:
        try:
            while self._pending:
                self._pending = False
                if self._pause > 0:
                    await asyncio.sleep(self._pause)
                if not self._pending:
                    await self._work()
        finally:
            self._busy = False


@dataclass
class Throttle:
    """Repeated work that takes at most ``part`` of the time by ``clock`` (s)."""

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
