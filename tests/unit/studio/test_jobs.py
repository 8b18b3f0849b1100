"""Runs that are stopped and paused, and processes that ended by themselves."""

import os
import signal
import subprocess
import tempfile

import pytest

from dalembert.errors import InputError
from dalembert.studio.jobs import Job, Jobs, pause
from dalembert.study.folder import PAUSED, RESUMABLE, RunFolder
from support import says


def test_a_paused_run_says_so(tmp_path, monkeypatch):
    sent = []
    monkeypatch.setattr(os, "kill", lambda process, which: sent.append((process, which)))
    folder = RunFolder(tmp_path)
    with folder.locked():
        folder.set_state("running", process=123)
        pause(folder)
        assert sent == [(123, signal.SIGTERM)]
        folder.set_state("interrupted")
    assert folder.state()["state"] == PAUSED
    assert PAUSED in RESUMABLE
    with pytest.raises(InputError, match=says(f"{tmp_path.name} is not running: it is paused")):
        pause(folder)


def test_a_process_that_was_killed_says_so(tmp_path, monkeypatch):
    jobs, folder = Jobs(), RunFolder(tmp_path / "run")
    monkeypatch.setattr(Jobs, "_begin", begin_with("kill -KILL $$"))
    jobs.start(tmp_path / "study.toml", folder.path)
    ended = "The process of this run ended by the signal SIGKILL. "
    assert jobs.complaint(folder.path) == ended + "Nothing was computed. Run it again."
    folder.path.mkdir()
    folder.set_state("running", process=1)
    assert jobs.complaint(folder.path) == ended + "What it computed is kept. Resume continues it."
    monkeypatch.setattr(Jobs, "_begin", begin_with("echo no such spring >&2; exit 2"))
    jobs.resume(folder.path)
    assert jobs.complaint(folder.path) == "no such spring"
    assert not jobs.is_started(folder.path)


def begin_with(script):
    """A start of a process that does what a script says, and has ended."""

    def begin(jobs, folder, arguments):
        log, output = tempfile.TemporaryFile("w+"), tempfile.TemporaryFile("w+")
        process = subprocess.Popen(["sh", "-c", script], stderr=log, stdout=output)
        process.wait()
        jobs._started[folder] = Job(process, log, output)

    return begin
