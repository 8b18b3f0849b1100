"""The list of runs, with their states and best values."""

from pathlib import Path
from typing import TYPE_CHECKING

from dalembert.study.run.events import last_progress
from dalembert.study.run.folder import RunFolder, find_runs

if TYPE_CHECKING:
    from rich.table import Table

COLUMNS = ("run", "task", "state", "since", "best", "findings")
_STYLES = {"finished": "green", "running": "cyan", "failed": "red", "input": "red", "killed": "red", "damaged": "red"}


def rows(root: Path) -> list[dict[str, str]]:
    """One row a run, by name."""
    return [_row(folder) for folder in find_runs(root)]


def table(rows: list[dict[str, str]]) -> "Table":
    """The rows as a table."""
    from rich.table import Table
    from rich.text import Text

    shown = Table(box=None, pad_edge=False)
    for heading in COLUMNS:
        shown.add_column(heading, overflow="fold")
    for row in rows:
        shown.add_row(*(Text(row[key], _STYLES.get(row[key], "") if key == "state" else "") for key in COLUMNS))
    return shown


def _row(folder: RunFolder) -> dict[str, str]:
    state = folder.state()
    return {
        "run": folder.path.name,
        "task": str(state.get("task", "")),
        "state": str(state["state"]),
        "since": since(state),
        "best": best(folder, state),
        "findings": counted(state),
        "messages": "\n".join(doubts(state)),
    }


def counted(state: dict) -> str:
    """Return the numbers of errors and warnings about a result in words; empty if there are none.
    >>> found = ["warning", "error", "warning"], ["warning", "note"], ["note"]
    >>> [counted({"findings": [{"severity": kind} for kind in kinds]}) for kinds in found]
    ['1 error, 2 warnings', '1 warning', '']
    """
    severities = [finding.get("severity") for finding in state.get("findings") or []]
    counts = {severity: severities.count(severity) for severity in ("error", "warning")}
    return ", ".join(f"{count} {name}{'s' * (count > 1)}" for name, count in counts.items() if count)


def doubts(state: dict) -> list[str]:
    """Messages of the warnings and errors about a result."""
    return [
        str(finding.get("message", ""))
        for finding in state.get("findings") or []
        if finding.get("severity") in ("warning", "error")
    ]


def since(state: dict) -> str:
    """When a run came into its state, in universal time."""
    return str(state.get("since", "")).replace("T", " ").removesuffix("+00:00")


def best(folder: RunFolder, state: dict) -> str:
    """Smallest misfit and values: of the result, or of the events while there is none."""
    numbers = state.get("best") or {}
    misfit = numbers.get("misfit")
    if misfit is None:
        event = last_progress(folder.events)
        misfit = event["best"] if event else None
    values = ", ".join(f"{name} = {value:.6g}" for name, value in (numbers.get("values") or {}).items())
    return ", ".join(part for part in ("" if misfit is None else f"misfit {misfit:.4g}", values) if part)
