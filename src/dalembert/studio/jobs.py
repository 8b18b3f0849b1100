"""Runs as separate processes, which continue if the studio or the browser ends."""

import os
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from dalembert.errors import InputError
from dalembert.study.run.folder import RUNNING, RunFolder


@dataclass
class Jobs:
    """Processes that this studio started, by the folder of their run."""

    _started: dict[Path, "Job"] = field(default_factory=dict)

    def start(self, study: Path, folder: Path) -> None:
        """Run a study in a new folder."""
        self._begin(folder, ["run", str(study), "--out", str(folder)])

    def rerun(self, old: Path, folder: Path) -> None:
        """Run the study of a run again, with the same files, in a new folder."""
        self._begin(folder, ["run", str(old), "--out", str(folder)])

    def resume(self, folder: Path) -> None:
        """Resume a run."""
        self._begin(folder, ["resume", str(folder)])

    def complaint(self, folder: Path) -> str:
        """What a process said that ended with an error, or by which signal it ended; empty if there is nothing."""
        job = self._started.get(folder)
        code = None if job is None else job.process.poll()
        if job is None or code in (None, 0):
            return ""
        if code > 0:
            return job.said().strip()
        begun = RunFolder(folder).is_run
        then = "What it computed is kept. Resume continues it." if begun else "Nothing was computed. Run it again."
        return f"The process of this run ended {ending(code)}. {then}"

    def is_started(self, folder: Path) -> bool:
        """Whether a process that this studio started is at work in a folder."""
        job = self._started.get(folder)
        return job is not None and job.process.poll() is None

    def said(self, folder: Path) -> str:
        """What a process has said so far, such as that it compiles; empty if there is nothing."""
        job = self._started.get(folder)
        return "" if job is None else job.said().strip() or job.progress()

    def tidy(self) -> None:
        """Forget processes that have ended without an error."""
        ended = [folder for folder, job in self._started.items() if job.process.poll() == 0]
        for folder in ended:
            del self._started[folder]

    def _begin(self, folder: Path, arguments: list[str]) -> None:
        self.tidy()
        log, output = (_temporary() for _ in range(2))
        command = [sys.executable, "-m", "dalembert.cli", *arguments]
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output, stderr=log, start_new_session=True)
        self._started[folder] = Job(process, log, output)


def _temporary() -> IO[str]:
    return tempfile.TemporaryFile("w+", encoding="utf-8")  # it is the process's, and goes with it


@dataclass
class Job:
    """A process and what it says."""

    process: subprocess.Popen
    log: IO[str]
    output: IO[str]

    def said(self) -> str:
        """What it wrote as errors and warnings."""
        self.log.seek(0)
        return self.log.read()[-4000:]

    def progress(self) -> str:
        """The last line of its output."""
        self.output.seek(0)
        return "".join(self.output.read().strip().splitlines()[-1:])


def ending(code: int) -> str:
    """Return how a process ended, from its exit code.
    >>> ending(-9), ending(3)
    ('by the signal SIGKILL', 'with code 3')
    """
    return f"by the signal {signal.Signals(-code).name}" if code < 0 else f"with code {code}"


def pause(folder: RunFolder) -> None:
    """Stop a run to resume it later; its state says so.

    The process ends: a paused run takes no memory, holds no lock that others wait for, and survives a restart.
    """
    _require_running(folder)
    folder.pause.touch()
    stop(folder)


def stop(folder: RunFolder) -> None:
    """Ask a run to end, as Ctrl-C does; whoever started it."""
    os.kill(int(_require_running(folder)["process"]), signal.SIGTERM)


def _require_running(folder: RunFolder) -> dict[str, Any]:
    """State of a run, refused unless it is running."""
    state = folder.state()
    if state["state"] != RUNNING:
        raise InputError(f"{folder.path.name} is not running: it is {state['state']}")
    return state
