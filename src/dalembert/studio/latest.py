"""Work that is only worth doing for the newest state."""

import asyncio
from collections.abc import Awaitable, Callable

from nicegui import background_tasks


class Latest:
    """Does one thing at a time; requests that come meanwhile become one more turn after it.

    Parameters
    ----------
    work : coroutine function
        Reads the newest state when it begins.
    pause : float
        Seconds without a request after which it begins.

    Examples
    --------
    ``draft.follow("study", Latest(redraw))`` redraws after changes, and skips those that came too fast.
    """

    def __init__(self, work: Callable[[], Awaitable[object]], pause: float = 0.0) -> None:
        self._work, self._pause, self._asked, self._busy = work, pause, False, False

    def __call__(self) -> None:
        """Ask for a turn."""
        self._asked = True
        if not self._busy:
            self._busy = True
            background_tasks.create(self._turns())

    async def _turns(self) -> None:
        try:
            while self._asked:
                self._asked = False
                if self._pause > 0:
                    await asyncio.sleep(self._pause)
                if not self._asked:
                    await self._work()
        finally:
            self._busy = False
