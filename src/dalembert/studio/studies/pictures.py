"""Pictures of studies, drawn in a process of their own and kept until a file of the study changes."""

import asyncio
import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from importlib.resources import as_file
from pathlib import Path

from dalembert.report.pictures import message_picture
from dalembert.study.picture import picture_or_message
from dalembert.study.template import TEMPLATES

PATIENCE = 60.0
"""Seconds that one picture may take; a mesh may have to be made first."""
Stamp = tuple[tuple[str, int, int], ...]


@dataclass
class Pictures:
    """Draws one picture after another. A study that hangs or crashes ends its process only."""

    patience: float = PATIENCE
    _known: dict[Path, tuple[Stamp, str]] = field(default_factory=dict)
    _pool: ProcessPoolExecutor | None = None
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
        found = [folder for folder in TEMPLATES.iterdir() if folder.name.partition("-")[2] == name]
        if not found:
            return message_picture("No such template")
        with as_file(found[0]) as folder:
            return await self.of(folder / "study.toml")

    def close(self) -> None:
        """End the process."""
        if self._pool is not None:
            processes = list((self._pool._processes or {}).values())
            self._pool.shutdown(wait=False, cancel_futures=True)
            for process in processes:
                process.kill()
            self._pool = None

    async def _drawn(self, path: Path) -> str:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn"))
        try:
            drawing = asyncio.wrap_future(self._pool.submit(picture_or_message, path))
            return await asyncio.wait_for(drawing, self.patience)
        except TimeoutError:
            self.close()
            return message_picture(f"No drawing: it takes over {self.patience:g} s")
        except BrokenProcessPool:
            self.close()
            return message_picture("No drawing: the model ended its process")


def _stamp(folder: Path) -> Stamp:
    """Names, times and sizes of the files that a picture may depend on."""
    found = []
    for entry in sorted(folder.iterdir()) if folder.is_dir() else ():
        about = entry.stat()
        found.append((entry.name, about.st_mtime_ns, about.st_size))
    return tuple(found)
