"""Runs that cannot write: a disk that is full, a folder that is read-only. A sentence each, and what was kept is kept.

A limit on the size of files stands for a disk without room: the first file that outgrows it meets the error. The
rights to a folder bind root too, once it has given up the capability to pass over them.
"""

import ctypes
import os
import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from dalembert.study import RunFolder
from faults.kills import content, kinds
from faults.slow_runs import COMMAND

MODEL = """
import os
from pathlib import Path
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 1, 3)
asked = 0

def decay(parameters):
    return PythonModel(response, parameters, ["x"], times)

def response(rate):
    global asked
    asked += 1
    if asked == int(os.environ.get("CLOSED_AFTER", "0")):
        Path("run").chmod(0o555)
    return np.exp(-rate * times)
"""
STUDY = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
[model]
forward = "decay.py:decay"
[sweep]
at = 0.5
channels = ["x"]
over = { rate = { count = 400 } }
"""
TOLD = (
    " cannot be written: {reason}; what was written before is whole: see that the disk has room and that the folder "
    "may be written to, and continue the run by 'dalembert resume'"
)
NOT_BEGUN = (
    " cannot be written: {reason}; nothing has run yet: see that the disk has room and that the folder may be written "
    "to, and run the study again"
)
DROP, ANY_FILE = 24, 1
"""PR_CAPBSET_DROP and CAP_DAC_OVERRIDE of Linux."""


def command(folder: Path, *words: str, before: Callable[[], object] | None = None, **more: str) -> tuple[int, str]:
    """Exit code and last line of a command in a folder."""
    done = subprocess.run(
        [COMMAND, *words],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=before,
        env={**os.environ, **more},
    )
    assert "Traceback" not in done.stderr
    return done.returncode, (done.stderr.splitlines() or [""])[-1]


def written(folder: Path) -> Path:
    (folder / "decay.py").write_text(MODEL)
    (folder / "study.toml").write_text(STUDY)
    return folder


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    folder = written(tmp_path_factory.mktemp("undisturbed"))
    assert command(folder, "run", "study.toml", "--out", "run")[0] == 0
    return RunFolder(folder / "run")


def ends_as(folder: Path, undisturbed: RunFolder) -> None:
    """Go on with what is there, or begin where nothing was: the same bits, and no traces."""
    run = RunFolder(folder / "run")
    words = ("resume", "run") if run.is_run else ("run", "study.toml", "--out", "run")
    assert command(folder, *words)[0] == 0
    assert content(run.result) == content(undisturbed.result)
    assert kinds(run) == kinds(undisturbed)
    assert run.state()["state"] == "finished"
    assert not run.checkpoint.exists()
    assert not [path.name for path in run.path.iterdir() if path.name.startswith(".")]


ROOMS = {
    "for nothing": (20, "run/study.toml", "File too large"),
    "for what is given, not for the checkpoint": (3_000, "run/checkpoint", "disk I/O error"),
    "for a part of the checkpoint": (24_000, "run/checkpoint", "disk I/O error"),
    "for all but the report": (300_000, "run/report.html", "File too large"),
}


@pytest.mark.parametrize(
    "room",
    [room if room == "for a part of the checkpoint" else pytest.param(room, marks=pytest.mark.slow) for room in ROOMS],
)
def test_without_room_there_is_a_sentence_and_a_way_on(room, tmp_path, undisturbed):
    size, name, reason = ROOMS[room]
    written(tmp_path)
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))  # noqa: E731
    code, said = command(tmp_path, "run", "study.toml", "--out", "run", before=limit)
    told = NOT_BEGUN if room == "for nothing" else TOLD
    assert (code, said) == (1, name + told.format(reason=reason))
    ends_as(tmp_path, undisturbed)


def bound() -> None:
    """Bind this process to the rights of folders, though it be root's."""
    ctypes.CDLL(None).prctl(DROP, ANY_FILE, 0, 0, 0)


@pytest.fixture
def rights(tmp_path):
    """A folder in which rights count."""
    closed = tmp_path / "closed"
    closed.mkdir(mode=0o555)
    tried = [sys.executable, "-c", "open('a', 'w')"]
    if subprocess.run(tried, cwd=closed, preexec_fn=bound, capture_output=True, check=False).returncode == 0:
        pytest.skip("this system does not let go of root's right to write everywhere")
    return written(tmp_path)


def test_where_no_folder_may_be_made_there_is_a_sentence(rights):
    code, said = command(rights, "run", "study.toml", "--out", "closed/run", before=bound)
    told = "the run folder closed/run cannot be made: Permission denied; choose another with --out"
    assert (code, said) == (2, told)


def test_in_a_read_only_folder_there_is_a_sentence(rights):
    code, said = command(rights, "run", "study.toml", "--out", "closed", before=bound)
    assert (code, said) == (1, "closed/lock" + NOT_BEGUN.format(reason="Permission denied"))


@pytest.mark.slow
@pytest.mark.parametrize("evaluations", [1, 200, 400])
def test_a_folder_that_becomes_read_only_keeps_what_was_written(evaluations, rights, undisturbed):
    words = ("run", "study.toml", "--out", "run")
    code, said = command(rights, *words, before=bound, CLOSED_AFTER=str(evaluations))
    run = RunFolder(rights / "run")
    assert code == 1
    assert said.startswith("run/")
    assert said.partition("; ")[2] == TOLD.partition("; ")[2]
    assert run.state()["state"] == "killed"  # what it is that nobody could write
    code, said = command(rights, "resume", "run", before=bound)
    assert (code, said) == (1, "run/state.json" + TOLD.format(reason="Permission denied"))
    run.path.chmod(0o755)
    ends_as(rights, undisturbed)
