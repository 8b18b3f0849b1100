"""Runs that end in the middle: killed, stopped, without room on the disk. What they leave can be read."""

import json
import resource
import signal
import subprocess
import time

import pytest

from dalembert.study import RunFolder
from dalembert.study.run.events import read_events
from faults.slow_runs import COMMAND, begun, wait_for, written

SWEEP = """
[sweep]
at = 0.5
channels = ["x"]
over = { rate = { count = COUNT } }
"""


@pytest.fixture
def start(tmp_path):
    """Start a run of so many points; it is stopped at the end of the test at the latest."""
    started = []

    def start(points: int, **options: object) -> subprocess.Popen[str]:
        written(tmp_path, SWEEP.replace("COUNT", str(points)))
        process = begun(tmp_path, "run", "slow.toml", "--out", "run", **options)
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
        process.communicate()


@pytest.fixture
def folder(tmp_path):
    return RunFolder(tmp_path / "run")


def is_running(folder: RunFolder) -> bool:
    return sum(1 for _ in read_events(folder.events)) > 5


def test_a_killed_run_says_so(start, folder):
    process = start(2000)
    wait_for(lambda: is_running(folder))
    assert folder.state()["state"] == "running"
    process.kill()
    process.wait()
    assert folder.state()["state"] == "killed"
    events = list(read_events(folder.events))
    assert [event["n"] for event in events] == list(range(len(events)))
    assert events[0]["event"] == "run-started"
    assert not folder.result.exists()
    listed = subprocess.run(
        [COMMAND, "list", "--runs", folder.path.parent], capture_output=True, text=True, check=True
    )  # fmt: skip
    assert "killed" in listed.stdout


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stopped_run_says_so(start, folder, number):
    process = start(2000)
    wait_for(lambda: is_running(folder))
    process.send_signal(number)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 130
    assert errors.splitlines()[-1] == "stopped; continue by: dalembert resume run"
    assert "Traceback" not in errors
    assert folder.state()["state"] == "interrupted"
    assert list(read_events(folder.events))[-1]["state"] == "interrupted"


def test_a_second_run_in_the_same_folder_is_refused(start, folder, tmp_path):
    start(2000)
    wait_for(lambda: is_running(folder))
    command = [COMMAND, "run", "slow.toml", "--out", "run", "--force"]
    second = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert second.returncode == 2
    assert second.stderr == ("a run is active in run; wait for it, stop it, or choose another folder with --out\n")
    assert folder.state()["state"] == "running"


def test_a_full_disk_gives_a_sentence(start, folder):
    """A limit on the size of files stands for a disk without room: the report does not fit."""
    scratch = 300_000
    process = start(5, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (scratch, scratch)))
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 1
    assert "Traceback" not in errors
    assert errors.splitlines()[-1] == (
        "run/report.html cannot be written: File too large; what was written before is whole: see that the disk has "
        "room and that the folder may be written to, and continue the run by 'dalembert resume'"
    )
    assert folder.state()["state"] == "failed"
    assert folder.result.stat().st_size > 0
    assert not folder.report.exists()
    assert not [path.name for path in folder.path.iterdir() if path.name.startswith(".")]
    command = [COMMAND, "resume", "run"]
    resumed = subprocess.run(command, cwd=folder.path.parent, capture_output=True, text=True, check=True)
    assert "report: run/report.html" in resumed.stdout
    assert folder.state()["state"] == "finished"
    assert not folder.checkpoint.exists()


def test_killed_at_any_moment_the_state_is_whole(start, folder):
    """Kills spread over the whole short run: state and events are readable at each."""
    for delay in (0.6, 0.8, 0.9, 1.0, 1.1, 1.2, 1.4):
        process = start(12)
        time.sleep(delay)
        process.kill()
        process.communicate()
        if folder.is_run:
            assert folder.state()["state"] in ("killed", "finished")
            json.loads((folder.path / "state.json").read_text())
        for event in read_events(folder.events):
            assert "event" in event
        for path in sorted(folder.path.rglob("*"), reverse=True) if folder.path.exists() else ():
            path.rmdir() if path.is_dir() else path.unlink()
