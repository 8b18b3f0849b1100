"""The stream of events of a run: one JSON line each, the same for progress bar, list and resume."""

import json
import math
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

Event = dict[str, Any]
Emit = Callable[..., None]


@dataclass
class EventLog:
    """Events of a run, appended to a file and handed to listeners as they come.

    Parameters
    ----------
    path : Path
        ``events.jsonl``; a last line that a kill cut short is removed when the log is opened again.
    listeners : tuple of callables
        Each is called with every event.
    """

    path: Path
    listeners: tuple[Callable[[Event], None], ...] = ()
    number: int = field(default=0, init=False)

    def __enter__(self) -> Self:
        self.number = _repair(self.path)
        self._file = self.path.open("a", encoding="utf-8", newline="\n")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def emit(self, kind: str, **details: Any) -> None:
        """Write one event; it is in the file when this returns."""
        event = {"n": self.number, "at": datetime.now(UTC).isoformat(timespec="milliseconds"), "event": kind}
        event |= {key: _plain(value) for key, value in details.items()}
        self.number += 1
        self._file.write(json.dumps(event, ensure_ascii=False, allow_nan=False) + "\n")
        self._file.flush()
        for listener in self.listeners:
            listener(event)


def teller(emit: Emit, as_record: Callable[[Any], dict[str, Any]]) -> Callable[[Any], None]:
    """Listener that writes the events of a method; ``as_record`` makes mappings of them, their kind by ``"event"``."""

    def tell(event: Any) -> None:
        record = as_record(event)
        emit(record.pop("event"), **record)

    return tell


def read_events(path: Path) -> Iterator[Event]:
    """Events of a run, one that may still be going on included: a last line that is not whole is left out."""
    if not path.exists():
        return
    with path.open(encoding="utf-8") as file:
        for line in file:
            if not line.endswith("\n"):
                return
            yield json.loads(line)


def last_progress(path: Path, tail: int = 65536) -> Event | None:
    """Last event of a run that tells a best value, from the end of its file."""
    if not path.exists():
        return None
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - tail))
        lines = file.read().decode("utf-8", errors="replace").splitlines(keepends=True)
    for line in reversed(lines):
        if line.endswith("\n") and '"best"' in line:
            try:
                return json.loads(line)
            except json.JSONDecodeError:
                continue  # the tail began within this line
    return None


def _repair(path: Path) -> int:
    """Number of whole lines of a file, after a last one that is not whole was cut off."""
    if not path.exists():
        return 0
    content = path.read_bytes()
    whole = content.rfind(b"\n") + 1
    if whole < len(content):
        os.truncate(path, whole)
    return content.count(b"\n")


def _plain(value: Any) -> Any:
    """Value as JSON can hold it; what is not finite becomes null."""
    if isinstance(value, np.ndarray):
        return [_plain(entry) for entry in value.tolist()]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return value if isinstance(value, (int, str, bool)) or value is None else str(value)
