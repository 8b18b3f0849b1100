"""Checks the text of a study in the study's process, which a user's function may hang or end."""

import asyncio
from collections.abc import Callable
from pathlib import Path

from nicegui import background_tasks, ui

from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.reading import Reading, mistake, reading
from dalembert.studio.editor.watched_files import stamps_of
from dalembert.studio.worker import Kept, Worker, WorkerError

AFTER = 0.4
"""Seconds after the last change of the text until it is checked."""
PATIENCE = 3.0
"""Seconds that a check waits for what was asked for an earlier text."""


class Checking:
    """Reads the text of a draft at first, and after changes of it or of a file that it names. ``function`` reads a
    text, as :func:`reading` does. ``path`` is that of the study, by default that of the draft.
    """

    def __init__(
        self,
        draft: Draft,
        worker: Worker,
        function: Callable[[Kept, Path, str], Reading] = reading,
        path: Path | None = None,
    ) -> None:
        self._draft, self._worker, self._function = draft, worker, function
        self._path = draft.path if path is None else path
        self._place = ui.context.slot
        self._waiting: ui.timer | None = None
        background_tasks.create(self.check())  # while the browser still loads the page
        draft.follow("text", self._later)
        draft.follow("files", self._later)

    async def check(self) -> None:
        """Read the text now."""
        request = asyncio.ensure_future(self._read(self._draft.text))
        await asyncio.wait([request], timeout=PATIENCE)
        if not request.done() and self._worker.holds_up("reading"):
            self._worker.interrupt()  # it computes for a text that is no longer there
        self._draft.take(await request or Reading(""))

    async def _read(self, text: str) -> Reading | None:
        try:
            return await self._worker.ask("reading", self._function, self._path, text)
        except WorkerError as error:
            files = stamps_of(self._draft.reading.files)  # the next change of one of them may correct it
            return Reading(text, mistakes=(mistake(text, (), str(error)),), files=files)

    def _later(self) -> None:
        if self._waiting is not None:
            self._waiting.cancel()
        with self._place:
            self._waiting = ui.timer(AFTER, self.check, once=True)
