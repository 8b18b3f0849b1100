"""What a user does to runs: rename them, delete them and take that back, and continue them as new studies."""

import json
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

import tomlkit
from tomlkit import TOMLDocument

from dalembert.errors import InputError, unwritable
from dalembert.files import free_path, write_text
from dalembert.studio.workspace import Workspace, checked
from dalembert.study.run.folder import RUNNING, RunFolder

TRASH = ".trash"
"""Folder below that of the runs. Its name begins with a dot, so that no run can have it."""


@dataclass(frozen=True)
class Deleted:
    """A deleted run: its name, and the folder that it is in now."""

    name: str
    path: Path


def rename(workspace: Workspace, old: str, new: str) -> None:
    """Rename a run."""
    path, target = _idle(workspace, old).path, workspace.runs_folder / checked(new)
    if target.exists():
        raise InputError(f"there is a run {new!r} already; choose another name")
    _move(path, target)


def delete(workspace: Workspace, name: str) -> Deleted:
    """Move a run to the trash."""
    path, trash = _idle(workspace, name).path, workspace.runs_folder / TRASH
    try:
        trash.mkdir(exist_ok=True)
    except OSError as error:
        raise unwritable(trash, error.strerror) from None
    target = free_path(trash / name)
    _move(path, target)
    return Deleted(name, target)


def restore(workspace: Workspace, deleted: Deleted) -> str:
    """Move a run back from the trash; return its name, which is another one if its own is taken meanwhile."""
    if not deleted.path.is_dir():
        raise InputError(f"the run {deleted.name!r} is no longer in the trash; look for it in {deleted.path.parent}")
    target = free_path(workspace.runs_folder / deleted.name)
    _move(deleted.path, target)
    return target.name


def trashed(workspace: Workspace) -> list[Deleted]:
    """Return the deleted runs, by name."""
    trash = workspace.runs_folder / TRASH
    found = sorted(trash.iterdir()) if trash.is_dir() else []
    return [Deleted(path.name, path) for path in found if path.is_dir()]


def empty_trash(workspace: Workspace) -> int:
    """Remove all deleted runs for good; return their number."""
    found = trashed(workspace)
    for deleted in found:
        shutil.rmtree(deleted.path)
    return len(found)


def continued(workspace: Workspace, folder: RunFolder, name: str, text: str) -> str:
    """Make a new study with copies of the files that a run used; return ``"folder/file"``, as :meth:`Workspace.studies`
    lists it. ``text`` is that of the run, or a changed one.
    """
    kept = _kept(folder)
    places = {given: _beside(given) for given in kept["files"]}

    def copy_files(target: Path) -> None:
        for given, entry in kept["files"].items():
            _copy(folder.path / entry["copy"], target / places[given], places)
        if any(place.endswith(".py") for place in places.values()):
            for module in Path(kept["folder"]).glob("*.py"):  # functions may import them
                if not (target / module.name).exists():
                    shutil.copyfile(module, target / module.name)

    return workspace.create(name, renamed_files(text, places), copy_files)


def renamed_files(text: str, places: dict[str, str]) -> str:
    """Return a study's text with other names of files; comments and order stay."""
    if all(given == place for given, place in places.items()):
        return text
    document = tomlkit.parse(text)
    for table, key, value in list(_texts(document)):
        given, colon, function = value.partition(":")
        if value in places:
            table[key] = places[value]
        elif given in places:
            table[key] = places[given] + colon + function
    return tomlkit.dumps(document)


def study_text(folder: RunFolder) -> TOMLDocument:
    """Return the study of a run as a document that can be changed."""
    try:
        return tomlkit.parse(folder.study.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        raise folder.damaged(folder.study) from None


def _kept(folder: RunFolder) -> dict[str, Any]:
    try:
        kept = json.loads(folder.inputs.read_text(encoding="utf-8"))
        return {"folder": str(kept["folder"]), "files": dict(kept["files"])}
    except (OSError, ValueError, TypeError, KeyError):
        raise folder.damaged(folder.inputs) from None


def _beside(given: str) -> str:
    """Name of a file within the folder of a new study."""
    path = PurePosixPath(given)
    return path.name if path.is_absolute() or ".." in path.parts else given


def _copy(source: Path, target: Path, places: dict[str, str]) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    if target.suffix == ".toml":  # a model, which may name files too
        write_text(target, renamed_files(source.read_text(encoding="utf-8"), places))
    else:
        shutil.copyfile(source, target)


def _texts(table: Any) -> Iterator[tuple[Any, Any, str]]:
    """Texts in a document, each with the table or list and the key that hold it."""
    entries = table.items() if hasattr(table, "items") else enumerate(table)
    for key, value in entries:
        if isinstance(value, str):
            yield table, key, value
        elif isinstance(value, dict | list):
            yield from _texts(value)


def _idle(workspace: Workspace, name: str) -> RunFolder:
    """The run of a name, refused while it is running."""
    folder = workspace.run(name)
    if folder.state()["state"] == RUNNING:
        raise InputError(f"{name} is running; stop it first")
    return folder


def _move(path: Path, target: Path) -> None:
    try:
        path.rename(target)
    except OSError as error:
        raise unwritable(target, error.strerror) from None
