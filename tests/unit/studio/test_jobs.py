"""Runs that are stopped and paused, and processes that ended by themselves."""

import os
import signal
import subprocess

import pytest

from dalembert.errors import InputError
from dalembert.studio.jobs import Job, Jobs, _temporary, pause
from dalembert.study.run.folder import PAUSED, RESUMABLE, RunFolder
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
    assert folder.state()["message"] == "paused by the user; Resume continues it"
    assert PAUSED in RESUMABLE
    with pytest.raises(InputError, match=says(f"{tmp_path.name} is not running: it is paused")):
        pause(folder)


@pytest.fixture
def ended():
    """A function that makes the job of a folder, whose process does what a script says, and has ended."""
    files = []

    def ended(jobs, folder, script):
        files.extend(_temporary() for _ in range(2))
        process = subprocess.Popen(["sh", "-c", script], stderr=files[-2])
        process.wait()
        jobs._started[folder.path] = Job(process, *files[-2:])

    yield ended
    for file in files:
        file.close()


def test_a_process_that_was_killed_says_so(tmp_path, ended):
    jobs, folder = Jobs(), RunFolder(tmp_path)
    ended(jobs, folder, "kill -KILL $$")
    begins = "The process of this run ended by the signal SIGKILL. "
    assert jobs.complaint(folder.path) == begins + "Nothing was computed. Run it again."
    folder.set_state("running", process=1)
    assert jobs.complaint(folder.path) == begins + "What it computed is kept. Resume continues it."
    ended(jobs, folder, "echo no such spring >&2; exit 2")
    assert jobs.complaint(folder.path) == "no such spring"
    assert not jobs.is_started(folder.path)
