"""Runs that are stopped and paused."""

import os
import signal

import pytest

from dalembert.errors import InputError
from dalembert.studio.jobs import pause
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
