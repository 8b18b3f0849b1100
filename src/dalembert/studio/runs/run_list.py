"""All runs as rows of a table, read quickly: a run is read again only if its files have changed."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from dalembert.findings import Severity
from dalembert.studio.runs.run_note import NOTE, read_note
from dalembert.studio.runs.run_units import run_units, values_text
from dalembert.study.run.events import last_progress
from dalembert.study.run.folder import RUNNING, RunFolder
from dalembert.study.run.listing import counted, doubts, since

Row = dict[str, Any]
Stamp = tuple[int, ...]
_WEIGHTS: Mapping[Severity, int] = {"error": 1_000_000, "warning": 1_000, "note": 1}
_WATCHED = ("state.json", NOTE)


@dataclass
class RunList:
    """The runs of a folder as rows. A row has ``id``, which stays when the run is renamed, ``run``, ``study``,
    ``title``, ``task``, ``state``, ``message``, ``findings`` (text), ``severity`` (to sort by), ``doubts`` (messages),
    ``values`` (text), ``misfit``, ``duration`` (s), ``date`` (UTC), ``tags`` and ``note``. Unknown numbers are None.
    """

    root: Path
    _known: dict[str, tuple[Stamp, Row]] = field(default_factory=dict, repr=False)

    def rows(self) -> list[Row]:
        """Return a row for each run, the newest first."""
        found: dict[str, tuple[Stamp, Row]] = {}
        for name, stamp in self._stamps():
            known = self._known.get(name)
            if known is None or known[0] != stamp or known[1]["state"] == RUNNING:
                known = stamp, {"id": str(stamp[0]), **row(RunFolder(self.root / name))}
            found[name] = known
        self._known = found
        return self.known

    @property
    def known(self) -> list[Row]:
        """The rows as they were read last, the newest first."""
        rows = (known_row for _, known_row in self._known.values())
        return sorted(rows, key=lambda known_row: (known_row["date"], known_row["run"]), reverse=True)

    def _stamps(self) -> list[tuple[str, Stamp]]:
        """Names of the runs with the numbers of their folders, and when their files were changed."""
        try:
            with os.scandir(self.root) as entries:
                names = [(entry.name, entry.inode()) for entry in entries if entry.is_dir()]
        except FileNotFoundError:
            return []
        watched = (
            (name, number, [_changed(f"{self.root}/{name}/{file}") for file in _WATCHED]) for name, number in names
        )
        return [(name, (number, *changed)) for name, number, changed in watched if changed[0]]


def row(folder: RunFolder) -> Row:
    """Return the row of a run; see :class:`RunList`, which adds its ``id``."""
    state = folder.state()
    best = state.get("best") or {}
    note = read_note(folder.path)
    notes = _numbers(state)["note"]
    parts = [counted(dict(state)), f"{notes} note{'s' * (notes > 1)}" if notes else ""]
    return {
        "run": folder.path.name,
        "study": study_name(folder, state),
        "title": str(state.get("title", "")),
        "task": str(state.get("task", "")),
        "state": str(state["state"]),
        "message": str(state.get("message", "")),
        "findings": ", ".join(filter(None, parts)),
        "severity": sum(_WEIGHTS[severity] * count for severity, count in _numbers(state).items()),
        "doubts": doubts(state),
        "values": values_text(best, run_units(folder, best.get("values") or {})),
        "misfit": _misfit(folder, best),
        "duration": _duration(state),
        "date": since(state),
        "tags": ", ".join(note.tags),
        "note": note.text,
    }


def study_name(folder: RunFolder, state: Mapping[str, Any]) -> str:
    """Return the name of a run's study: that of its folder if the file is ``study.toml``, as all new ones are."""
    name = str(state.get("study", ""))
    if name != "study":
        return name
    try:
        return Path(json.loads(folder.inputs.read_text(encoding="utf-8"))["folder"]).name or name
    except (OSError, ValueError, TypeError, KeyError):
        return name


def _changed(path: str) -> int:
    try:
        return os.stat(path).st_mtime_ns  # noqa: PTH116  Path objects would double the time
    except OSError:
        return 0


def _numbers(state: Mapping[str, Any]) -> dict[Severity, int]:
    given = [finding.get("severity") for finding in state.get("findings") or []]
    return {severity: given.count(severity) for severity in _WEIGHTS}


def _misfit(folder: RunFolder, best: Mapping[str, Any]) -> float | None:
    """Misfit of the result, or the best so far."""
    if best.get("misfit") is not None:
        return float(best["misfit"])
    event = None if best else last_progress(folder.events)
    return None if event is None else float(event["best"])


def _duration(state: Mapping[str, Any]) -> float | None:
    """Seconds of computation, also of an unfinished run; None for a damaged state."""
    if "seconds" not in state:
        return None
    seconds = float(state["seconds"])
    if state["state"] == RUNNING:
        seconds += (datetime.now(UTC) - datetime.fromisoformat(state["since"])).total_seconds()
    return round(seconds, 3)
