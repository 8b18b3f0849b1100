"""The stream of events of a run: one JSON line each, the same for progress bar, list, resume and studio."""

import json
import math
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Self

import numpy as np

from dalembert.errors import unwritable
from dalembert.files import set_aside

Event = dict[str, Any]
Emit = Callable[..., None]

LOST = "run-damaged"
"""Kind of the event that says which file of the run is damaged, and what was lost."""

STORAGE = "run-storage"
"""Kind of the event that says how much the run will write to the disk until it ends, before its first simulation."""

OF_THE_RUN = "run-"
"""Prefixes of the kinds of events that concern the run itself; others concern its computation."""


@dataclass
class EventLog:
    """Events of a run, appended to a file and handed to listeners as they come. ``path``: ``events.jsonl``; a last line
    that a kill cut short is removed when the log is opened again. A run that is resumed does again what it did, in the
    same order: as many events as the log has of what a run does are handed to ``listeners``, and not written again.
    """

    path: Path
    listeners: tuple[Callable[[Event], None], ...] = ()
    number: int = field(default=0, init=False)
    known: int = field(default=0, init=False)

    def __enter__(self) -> Self:
        try:
            aside = _repair(self.path)
            self._file = os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
        except OSError as error:
            raise unwritable(self.path, error.strerror) from None
        events = list(read_events(self.path))
        self.number = len(events)
        self.known = sum(not event["event"].startswith(OF_THE_RUN) for event in events)
        if aside is not None:
            self.emit(
                LOST,
                message=f"{self.path} is damaged and was kept as {aside.name}. Its first {self.number} events could be "
                "read; the others are written again.",
            )
        return self

    def __exit__(self, *error: object) -> None:
        os.close(self._file)

    def emit(self, kind: str, **details: Any) -> None:
        """Write one event; it is in the file when this returns."""
        event = {"n": self.number, "at": datetime.now(UTC).isoformat(timespec="milliseconds"), "event": kind}
        event |= {key: plain(value) for key, value in details.items()}
        if self.known and not kind.startswith(OF_THE_RUN):
            self.known -= 1
        else:
            self._write(event)
        for listener in self.listeners:
            listener(event)

    def _write(self, event: Event) -> None:
        self.number += 1
        line = (json.dumps(event, ensure_ascii=False, allow_nan=False) + "\n").encode()
        try:
            written = os.write(self._file, line)
        except OSError as error:
            raise unwritable(self.path, error.strerror) from None
        if written < len(line):
            raise unwritable(self.path, "no room for a whole line")


def teller(emit: Emit, as_record: Callable[[Any], dict[str, Any]]) -> Callable[[Any], None]:
    """Listener that writes the events of a method; ``as_record`` makes mappings of them, their kind by ``"event"``."""

    def tell(event: Any) -> None:
        record = as_record(event)
        emit(record.pop("event"), **record)

    return tell


def read_events(path: Path) -> Iterator[Event]:
    """Events of a run, also of an unfinished one, without incomplete or damaged lines."""
    if not path.exists():
        return
    with path.open("rb") as file:
        for line in file:
            event = event_of(line)
            if event is not None:
                yield event


def event_of(line: bytes) -> Event | None:
    """Return the event of a line; None for a line that is not whole, or damaged."""
    try:
        event = json.loads(line) if line.endswith(b"\n") else None
    except (ValueError, RecursionError):
        return None
    return event if isinstance(event, dict) and isinstance(event.get("event"), str) else None


def last_progress(path: Path, tail: int = 65536) -> Event | None:
    """Last event of a run with a best value, from the end of its file."""
    if not path.exists():
        return None
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - tail))
        lines = file.read().splitlines(keepends=True)
    events = (event_of(line) for line in reversed(lines) if b'"best"' in line)
    return next((event for event in events if event is not None and event.get("best") is not None), None)


def _repair(path: Path) -> Path | None:
    """Cut off a last line that is not whole; keep a damaged file aside, and its events before the damage.

    Returns the file that was kept, None if there was no damage.
    """
    if not path.exists():
        return None
    content, intact = path.read_bytes(), 0
    for line in content.split(b"\n"):
        if event_of(line + b"\n") is None:
            break
        intact += len(line) + 1
    if b"\n" not in content[intact:]:
        if intact < len(content):
            os.truncate(path, intact)
        return None
    aside = set_aside(path)
    path.write_bytes(content[:intact])
    return aside


def plain(value: Any) -> Any:
    """Return a value as JSON can hold it; what is not finite becomes null."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    return value if isinstance(value, (int, str, bool)) or value is None else str(value)
