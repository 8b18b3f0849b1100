"""The files beside a study that it depends on, and whether one of them has changed."""

from collections.abc import Iterable, Mapping
from pathlib import Path

Stamp = tuple[int, int] | None
"""Time of the last change and size of a file; None if it is not there."""


def stamps_of(paths: Iterable[Path]) -> dict[Path, Stamp]:
    """Return the stamps of files."""
    return {path: _stamp(path) for path in paths}


class WatchedFiles:
    """Files with their stamps when they were last read."""

    def __init__(self) -> None:
        self._stamps: dict[Path, Stamp] = {}
        self._shown: dict[Path, Stamp] = {}

    def take(self, stamps: Mapping[Path, Stamp]) -> None:
        """Watch the files of a study that was read, and no longer those of an earlier one."""
        self._stamps = dict(stamps)

    def show(self, path: Path) -> None:
        """Watch also a file that a panel shows, and no longer an earlier one."""
        if path not in self._shown:
            self._shown = stamps_of([path])

    def have_changed(self) -> bool:
        """Return True if a file has changed, appeared or vanished since this was last asked."""
        before = self._stamps, self._shown
        self._stamps, self._shown = stamps_of(self._stamps), stamps_of(self._shown)
        return before != (self._stamps, self._shown)


def _stamp(path: Path) -> Stamp:
    try:
        status = path.stat()
    except (OSError, ValueError):  # a name that no file can have
        return None
    return status.st_mtime_ns, status.st_size
