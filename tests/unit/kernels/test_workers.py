"""Processes that compile kernels for another."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from dalembert.kernels import workers
from dalembert.multibody.components.planar.point_mass import POINT_MASS

_COMPILE = """
import os, sys
from pathlib import Path
from dalembert.kernels import workers
from dalembert.multibody.components.planar.point_mass import POINT_MASS

assert workers.can_fork()
worker = workers.Worker()
{before}
answers = [worker.compile(kernel, Path(sys.argv[1]) / f"{{kernel.symbol}}.o") for kernel in POINT_MASS.all_kernels()]
worker.close()
print(answers)
"""

_OPEN = """
worker.close()
file = open(Path(sys.argv[1]) / "lock", "w")
worker = workers.Worker()
assert worker.compile(POINT_MASS.all_kernels()[0], Path(sys.argv[1]) / "first.o")
opened = [os.readlink(path) for path in Path(f"/proc/{worker.process}/fd").iterdir()]
assert not [name for name in opened if name.endswith("lock")]
"""


def compiled(folder: Path, before: str = "") -> str:
    """What a process prints that has no other threads."""
    command = [sys.executable, "-W", "error", "-c", _COMPILE.format(before=before), str(folder)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def test_a_copy_of_the_process_compiles_the_same_objects(tmp_path: Path) -> None:
    kernels = POINT_MASS.all_kernels()
    assert compiled(tmp_path) == str([True] * len(kernels))
    for kernel in kernels:
        assert (tmp_path / f"{kernel.symbol}.o").read_bytes() == kernel.object_code()


def test_a_worker_that_was_killed_says_no(tmp_path: Path) -> None:
    killed = "import signal; os.kill(worker.process, signal.SIGKILL)"
    assert compiled(tmp_path, killed) == str([False] * len(POINT_MASS.all_kernels()))


def test_a_worker_keeps_no_file_of_the_process_open(tmp_path: Path) -> None:
    assert compiled(tmp_path, _OPEN) == str([True] * len(POINT_MASS.all_kernels()))


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere every worker is a new process")
def test_a_process_with_threads_is_not_copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers.threading, "active_count", lambda: 2)
    monkeypatch.setattr(os, "fork", lambda: pytest.fail("a copy has none of the other threads"))
    worker, kernel = workers.Worker(), POINT_MASS.all_kernels()[0]
    assert worker.compile(kernel, tmp_path / "object.o")
    worker.close()
    assert (tmp_path / "object.o").read_bytes() == kernel.object_code()
