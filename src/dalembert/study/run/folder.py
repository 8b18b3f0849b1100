"""The folder of a run: its study, events, results and state."""

import hashlib
import json
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dalembert.errors import InputError, unwritable
from dalembert.files import free_path, replacing, write_text
from dalembert.study.run.events import read_events

if TYPE_CHECKING:
    from dalembert.study.tables.study import Study

RUNNING = "running"
FINISHED = "finished"
FAILED = "failed"  # the solver could not
INPUT = "input"  # what was given cannot run
INTERRUPTED = "interrupted"  # stopped by the user
PAUSED = "paused"  # never written: stopped by the user, who said that the run will be resumed
KILLED = "killed"  # never written: the process of a running run is gone
DAMAGED = "damaged"  # never written: state.json holds no state
WRITTEN = (RUNNING, FINISHED, FAILED, INPUT, INTERRUPTED)
COMPUTED_WITH = "computed_with"
"""Key of ``settings.json``: versions and threads of linear algebra of the processes that computed a part of the run."""
RESUMABLE = (KILLED, INTERRUPTED, PAUSED, FAILED)


class _File:
    """The path of a file in a run's folder, as an attribute of the folder."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, folder: "RunFolder", owner: type) -> Path:
        return folder.path / self._name


@dataclass(frozen=True)
class RunFolder:
    """A run's folder and the files in it.

    ``study.toml`` is the study as run, byte for byte; ``inputs/`` holds the files that it names and ``inputs.json``
    which is which; ``settings.json`` the study as understood, in SI units, and what computed it; ``events.jsonl``,
    ``state.json``, ``result.nc`` and ``report.html`` say the rest.
    """

    path: Path

    study = _File("study.toml")
    settings = _File("settings.json")
    inputs = _File("inputs.json")
    events = _File("events.jsonl")
    result = _File("result.nc")
    report = _File("report.html")
    checkpoint = _File("checkpoint")
    """What the model has answered so far, while the run is not finished."""
    pause = _File("pause")
    """Mark of a run that was stopped to be resumed later."""
    _state = _File("state.json")
    _lock = _File("lock")

    @property
    def is_run(self) -> bool:
        """Whether this is a run's folder."""
        return self._state.is_file()

    @property
    def is_remnant(self) -> bool:
        """Whether a run was killed here before it began: it left nothing but copies of what was given."""
        copies = {"lock", "study.toml", "settings.json", "inputs", "inputs.json", "events.jsonl"}
        names = {entry.name for entry in self.path.iterdir() if not entry.name.startswith(".")}
        return "lock" in names <= copies

    @property
    def is_refused(self) -> bool:
        """Return True for a run with wrong input that computed nothing, so that it can be replaced without loss."""
        from dalembert.forward.checkpoint import holds_results

        return self.is_run and self.state()["state"] == INPUT and not holds_results(self.checkpoint)

    def state(self) -> dict[str, Any]:
        """State of the run: ``state``, ``since``, ``study``, ``task`` and more."""
        try:
            state = json.loads(self._state.read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise InputError(
                f"{self.path} is no run folder: it has no state.json; name a run that 'dalembert list' shows"
            ) from None
        except (ValueError, RecursionError):  # no JSON, or no text at all
            state = None
        if not isinstance(state, dict) or state.get("state") not in WRITTEN:
            state = self._logged_state()
        if state["state"] == RUNNING and not self._is_locked():
            state["state"] = KILLED
        if state["state"] == INTERRUPTED and self.pause.exists():
            state |= {"state": PAUSED, "message": "paused by the user; Resume continues it"}
        return state

    def _logged_state(self) -> dict[str, Any]:
        begun: dict[str, Any] = {}
        last: dict[str, Any] = {}
        for event in read_events(self.events):
            if event["event"] in ("run-started", "run-resumed"):
                begun, last = event, {**event, "state": RUNNING}
            elif event["event"] == "run-ended":
                last = event
        if last.get("state") not in WRITTEN:
            return {"state": DAMAGED}
        entries = {key: begun[key] for key in ("study", "title", "task", "version") if key in begun}
        entries |= {key: last[key] for key in ("state", "message", "digests") if key in last}
        return entries | {"since": str(last.get("at", ""))[:19]}

    def damaged(self, file: Path) -> InputError:
        """Error about a file of the run that is not there, or that was changed."""
        return InputError(
            f"{self.path}: the run is damaged: {file.name} is missing, or was changed; run its study again, in "
            "another folder"
        )

    def set_state(self, state: str, **details: Any) -> None:
        """Write the state, atomically."""
        now = datetime.now(UTC).isoformat(timespec="seconds")
        _write_json(self._state, {"state": state, "since": now, **details})

    def keep(self, study: "Study") -> None:
        """Keep what runs: the study's bytes, its settings, its seed, and copies of the files that it names."""
        with replacing(self.study) as temporary:
            temporary.write_bytes(study.content)
        _write_json(self.settings, study.settings | {COMPUTED_WITH: []})
        copies = {}
        for number, (name, path) in enumerate(study.files.items()):
            (self.path / "inputs").mkdir(exist_ok=True)
            copy = self.path / "inputs" / f"{number}-{path.name}"
            with replacing(copy) as temporary:
                shutil.copyfile(path, temporary)
            copies[name] = {"copy": copy.relative_to(self.path).as_posix(), "sha256": sha256(copy)}
        seed = getattr(study.table, "seed", None)
        about = {"name": study.name, "folder": _origin(study), "seed": seed, "sha256": sha256(self.study)}
        _write_json(self.inputs, {**about, "files": copies})

    def computed_with(self) -> list[dict[str, Any]]:
        """Versions and threads of linear algebra of all processes that computed a part of the run, as far as known.

        Raises
        ------
        InputError
            If the file of the settings is damaged.
        """
        try:
            return list(json.loads(self.settings.read_text(encoding="utf-8")).get(COMPUTED_WITH, []))
        except (FileNotFoundError, ValueError, TypeError, AttributeError):
            raise self.damaged(self.settings) from None

    def add_computed_with(self, process: Mapping[str, Any]) -> None:
        """Keep the versions and threads of linear algebra of a process that computes a part of the run."""
        known = self.computed_with()
        if process not in known:
            settings = json.loads(self.settings.read_text(encoding="utf-8"))
            _write_json(self.settings, settings | {COMPUTED_WITH: [*known, process]})

    def digests(self) -> dict[str, str]:
        """Hashes of the run's results, by the names of their files."""
        return {path.name: sha256(path) for path in sorted(self.path.glob("*.nc"))}

    def check(self, file: Path, digest: object) -> None:
        """Refuse a file of the run that is not as it was written.

        Raises
        ------
        InputError
        """
        if not file.is_file() or sha256(file) != digest:
            raise self.damaged(file)

    def kept(self) -> "Study":
        """The study as it ran, with the copies of its files.

        Raises
        ------
        InputError
            If the folder is no run's, or lacks what was kept.
        """
        self.state()
        try:
            kept = json.loads(self.inputs.read_text(encoding="utf-8"))
            files = {name: self.path / entry["copy"] for name, entry in kept["files"].items()}
            digests = {self.path / entry["copy"]: entry["sha256"] for entry in kept["files"].values()}
            digests[self.study] = kept["sha256"]
        except (FileNotFoundError, ValueError, TypeError, AttributeError, KeyError):
            raise self.damaged(self.inputs) from None
        for file, digest in digests.items():
            self.check(file, digest)
        from dalembert.study.loader import load

        study = load(self.study, name=kept["name"], folder=Path(kept["folder"]), files=files)
        return study if kept["seed"] is None else study.with_seed(kept["seed"])

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Hold the folder: no other process may run in it, and the lock ends with this one, however it dies."""
        from filelock import FileLock, Timeout

        lock = FileLock(self._lock, timeout=0)
        try:
            lock.acquire()
        except Timeout:
            raise InputError(
                f"a run is active in {self.path}; wait for it, stop it, or choose another folder with --out"
            ) from None
        except OSError as error:
            raise unwritable(self._lock, error.strerror) from None
        try:
            yield
        finally:
            lock.release()

    def clear(self) -> None:
        """Remove all that a run left."""
        with self.locked():
            for entry in self.path.iterdir():
                if entry.is_dir():
                    shutil.rmtree(entry)
                elif entry.name != "lock":
                    entry.unlink()

    def tidy(self) -> None:
        """Remove files that were being written when a process was killed."""
        for entry in self.path.glob(".*-*"):
            entry.unlink()

    def _is_locked(self) -> bool:
        from filelock import FileLock, Timeout

        if not self._lock.is_file():
            return False
        try:
            with FileLock(self._lock, timeout=0):
                return False
        except Timeout:
            return True
        except OSError:  # no run is going on where none may write
            return False


def _origin(study: "Study") -> str:
    """Folder of a study, from which its functions are imported; for the study of a run that of its first run."""
    folder = RunFolder(study.path.parent.resolve())
    if folder.is_run and study.path.resolve() == folder.study:
        return str(json.loads(folder.inputs.read_text(encoding="utf-8"))["folder"])
    return str(folder.path)


def sha256(path: Path) -> str:
    """Hash of a file's content."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def new_folder(name: str, out: Path | None = None, *, force: bool = False) -> RunFolder:
    """Return a folder for a new run, made empty. Without ``out`` it is ``runs/<name>``, or ``runs/<name>-2`` and so on
    while those are taken. With ``out`` or ``force`` it is the one named, and what a run left there is removed only if
    ``force`` says so. A run that was refused before it computed anything takes no folder.
    """
    path = out or Path("runs") / name
    if out is None and not force:
        path = free_path(path, lambda path: path.exists() and not RunFolder(path).is_refused)
    folder = RunFolder(path)
    if path.exists():
        _empty(folder, force)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"the run folder {path} cannot be made: {error.strerror}; choose another with --out") from None
    return folder


def _empty(folder: RunFolder, force: bool) -> None:
    if not folder.path.is_dir():
        raise InputError(f"{folder.path} is a file; expected a folder for the run")
    if not any(folder.path.iterdir()):
        return
    if folder.is_remnant or folder.is_refused:
        folder.clear()
        return
    if not folder.is_run:
        raise InputError(f"{folder.path} holds files that are no run's; choose an empty or new folder with --out")
    state = folder.state()["state"]
    if not force:
        resume = f"continue it by 'dalembert resume {folder.path}', " if state in RESUMABLE else ""
        raise InputError(
            f"{folder.path} holds a run ({state}); {resume}give --force to replace it, or choose another folder with "
            "--out"
        )
    folder.clear()


def _write_json(path: Path, content: Any) -> None:
    write_text(path, json.dumps(content, indent=1, ensure_ascii=False) + "\n")


def find_runs(root: Path) -> list[RunFolder]:
    """All runs in a folder, by name."""
    if not root.is_dir():
        return []
    runs = [RunFolder(path) for path in sorted(root.iterdir()) if path.is_dir()]
    return [run for run in runs if run.is_run]
