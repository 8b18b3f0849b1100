"""Runs of studies: the last run of each, the study of a run, and its repetition."""

import json
from dataclasses import dataclass
from pathlib import Path

from dalembert.studio.jobs import Jobs
from dalembert.studio.runs.run_list import study_name
from dalembert.studio.studies.documents import name_in
from dalembert.studio.workspace import Workspace
from dalembert.study.run.folder import RunFolder
from dalembert.study.run.listing import since


@dataclass(frozen=True)
class LastRun:
    """A run, its state, and since when it is in it (UTC)."""

    name: str
    state: str
    since: str


def last_runs(root: Path) -> dict[tuple[Path, str], LastRun]:
    """Return the newest run of each study in the folder of runs, by the folder and the name of the study."""
    newest: dict[tuple[Path, str], tuple[int, Path]] = {}
    for path in root.glob("*/state.json"):
        try:
            kept = json.loads((path.parent / "inputs.json").read_text(encoding="utf-8"))
            key, changed = (Path(kept["folder"]), str(kept["name"])), path.stat().st_mtime_ns
        except (OSError, ValueError, TypeError, KeyError):
            continue  # refused before it began, or damaged
        if key not in newest or newest[key][0] < changed:
            newest[key] = changed, path.parent
    return {key: _last(RunFolder(path)) for key, (_, path) in newest.items()}


def study_of(workspace: Workspace, folder: RunFolder) -> str | None:
    """Return the study of a run, as :meth:`Workspace.studies` lists it; None if it is not there any more."""
    try:
        kept = json.loads(folder.inputs.read_text(encoding="utf-8"))
        place, name = Path(kept["folder"]), str(kept["name"])
    except (OSError, ValueError, TypeError, KeyError):
        return None
    if place.parent != workspace.root / "studies":
        return None
    found = sorted(path for path in place.glob("*.toml") if name_in(path) == name)
    return f"{place.name}/{found[0].stem}" if found else None


def _last(folder: RunFolder) -> LastRun:
    state = folder.state()
    return LastRun(folder.path.name, str(state["state"]), since(state))


def run_again(workspace: Workspace, jobs: Jobs, name: str) -> str:
    """Start the study of a run again; return the name of the new run."""
    old = workspace.run(name)
    folder = workspace.new_run(study_name(old, old.state()) or name)
    jobs.rerun(old.path, folder)
    return folder.name
