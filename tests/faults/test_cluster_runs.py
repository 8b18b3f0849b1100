"""Runs on a cluster that are stopped, or whose cluster is lost, in the middle of a batch."""

import signal
import subprocess
import time

import pytest

from dalembert.study import RunFolder, load, run_study
from dalembert.study.run.events import read_events
from faults.kills import content, kinds
from faults.slow_runs import begun, wait_for, written
from loopback_cluster import cluster

STUDY = """
[propagate]
method = { kind = "monte-carlo", runs = 400 }
"""


@pytest.fixture
def started():
    with cluster(workers=2) as started:
        yield started


@pytest.fixture
def study(tmp_path):
    return written(tmp_path, STUDY)


@pytest.fixture
def folder(tmp_path):
    return RunFolder(tmp_path / "run")


def runs(folder: RunFolder) -> int:
    """Simulations that the events of a run tell."""
    return max((event.get("runs", 0) for event in read_events(folder.events)), default=0)


def stopped(folder: RunFolder, process: subprocess.Popen[str], beyond: int) -> None:
    """Interrupt a run that has told of more simulations; it says how to go on, and nothing of how it ended."""
    wait_for(lambda: runs(folder) > beyond)
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=300)
    *told, last = errors.splitlines()
    assert process.returncode == 130, errors
    assert last == "stopped; continue by: dalembert resume run"
    assert told
    assert all(line.startswith("monte-carlo") for line in told), errors
    assert folder.state()["state"] == "interrupted"


@pytest.mark.slow
def test_a_run_that_is_stopped_leaves_the_cluster_and_ends_with_the_same_bits(started, study, folder):
    from distributed import Client

    address = started.address
    reference, _ = run_study(load(study), folder.path.with_name("undisturbed"))
    stopped(folder, begun(folder.path.parent, "run", "slow.toml", "--out", "run", "--cluster", address), 0)
    with Client(address, timeout=60, set_as_default=False) as client:
        wait_for(lambda: not any(client.processing().values()))
        wait_for(lambda: not client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)))
    stopped(folder, begun(folder.path.parent, "resume", "run", "--cluster", address), runs(folder))
    process = begun(folder.path.parent, "resume", "run")
    said, errors = process.communicate(timeout=300)
    assert process.returncode == 0, errors
    assert "report: run/report.html" in said
    assert content(folder.result) == content(reference.result)
    assert kinds(folder) == kinds(reference)


@pytest.mark.slow
def test_a_cluster_that_is_lost_ends_the_run_with_a_sentence(study, folder):
    with cluster(workers=1) as lost:
        process = begun(folder.path.parent, "run", "slow.toml", "--out", "run", "--cluster", lost.address)
        wait_for(lambda: runs(folder) > 0)
        lost.scheduler.kill()
        _, errors = process.communicate(timeout=300)
    assert process.returncode == 1, errors
    assert "Traceback" not in errors
    assert "the cluster lost a part of a batch of 64" in errors
    assert errors.endswith("; see its workers' logs, and resume the run\n")
    assert folder.state()["state"] == "failed"
    resumed = begun(folder.path.parent, "resume", "run")
    _, errors = resumed.communicate(timeout=300)
    assert resumed.returncode == 0, errors
