"""Pictures of studies, drawn in a separate process and kept until a file of the study changes."""

import asyncio
from dataclasses import dataclass, field
from importlib.resources import as_file
from pathlib import Path

from dalembert.report.pictures.canvas import message_picture
from dalembert.studio.worker import Cause, Kept, Limits, Worker, WorkerError
from dalembert.study.template import TEMPLATES

PATIENCE = 60.0
"""Seconds that one picture may take; a mesh may have to be made first."""
BECAUSE: dict[Cause, str] = {
    "failed": "the model cannot be drawn",
    "ended": "the model ended its process",
    "time": "it takes too long",
    "memory": "it needs too much memory",
}
"""Why there is no picture, in few words."""
Stamp = tuple[tuple[str, int, int], ...]


@dataclass
class Pictures:
    """Draws one picture after another. A study that hangs, crashes or fills the memory ends its process only."""

    worker: Worker = field(default_factory=lambda: Worker(Limits(seconds=PATIENCE)))
    _known: dict[Path, tuple[Stamp, str]] = field(default_factory=dict)
    _turn: asyncio.Lock = field(default_factory=asyncio.Lock)

    async def of(self, path: Path) -> str:
        """Return the picture of a study file as SVG, or one with a message where there is none."""
        stamp = _stamp(path.parent)
        known = self._known.get(path)
        if known is None or known[0] != stamp:
            async with self._turn:
                known = self._known[path] = stamp, await self._drawn(path)
        return known[1]

    async def of_template(self, name: str) -> str:
        """Return the picture of a template, an unknown one included."""
        folders = [folder for folder in TEMPLATES.iterdir() if folder.name.partition("-")[2] == name]
        if not folders:
            return message_picture("No such template")
        with as_file(folders[0]) as folder:
            return await self.of(folder / "study.toml")

    def close(self) -> None:
        """End the process."""
        self.worker.stop()

    async def _drawn(self, path: Path) -> str:
        try:
            drawn = await self.worker.ask(str(path), _draw, path)
        except WorkerError as error:
            return message_picture(f"No drawing: {BECAUSE[error.cause]}")
        return drawn or message_picture("No drawing")


def _draw(kept: Kept, path: Path) -> str:
    from dalembert.study.picture import picture_or_message

    return picture_or_message(path)


def _stamp(folder: Path) -> Stamp:
    """Names, times and sizes of the files that a picture may depend on."""
    stamps = []
    for entry in sorted(folder.iterdir()) if folder.is_dir() else ():
        about = entry.stat()
        stamps.append((entry.name, about.st_mtime_ns, about.st_size))
    return tuple(stamps)
