"""Where objects are kept, and that several processes may make them at once."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from dalembert.kernels import objects
from small_kernels import both, weighted

HERE = str(Path(__file__).parents[2])
CODE = (
    "import sys; sys.path.insert(0, sys.argv[1]); import numpy as np; from small_kernels import both, pair; "
    "print(both(pair(1.0, 2.0), np.zeros((2, 1)), np.zeros(1, np.int64)))"
)


FRAGMENTED = """
import mmap

pages = [mmap.mmap(-1, mmap.PAGESIZE) for _ in range(4000)]
large = mmap.mmap(-1, 6 << 30)
for page in pages[::2]:
    page.close()
import numpy as np, dalembert as da
system = da.System()
bar = system.add(da.RigidBar("bar", length=1.0, mass=1.0, angle=0.5))
system.add(da.RevoluteJoint("pin", system.ground, bar.start))
da.simulate(system, 0.1, da.GeneralizedAlpha(step=1e-2), np.linspace(0.0, 0.1, 3))
"""
"""Small sections fit into holes between pages, large ones only beyond 6 GB that are reserved, not used."""


def process(folder: Path) -> subprocess.Popen:
    environment = {**os.environ, objects.FOLDER: str(folder)}
    command = [sys.executable, "-c", CODE, HERE]
    return subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def finished(run: subprocess.Popen) -> None:
    output, errors = run.communicate(timeout=120)
    assert (run.returncode, output) == (0, "(1, 18.0)\n"), errors


def kept(folder: Path) -> set[str]:
    return {path.name for path in folder.glob("kernels/*/*")}


def test_objects_are_kept_and_used_again(tmp_path: Path) -> None:
    finished(process(tmp_path))
    names = kept(tmp_path)
    assert {name.partition("-")[0] for name in names} == {both.symbol, weighted.symbol}
    before = {path: path.stat().st_mtime_ns for path in tmp_path.glob("kernels/*/*")}
    finished(process(tmp_path))
    assert {path: path.stat().st_mtime_ns for path in tmp_path.glob("kernels/*/*")} == before


def test_processes_may_start_at_once(tmp_path: Path) -> None:
    runs = [process(tmp_path) for _ in range(3)]
    for run in runs:
        finished(run)
    assert len(kept(tmp_path)) == 2


def test_a_folder_that_cannot_be_written_is_no_error(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("no folder")
    finished(process(blocked))


def test_a_damaged_object_is_not_whole_by_accident(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*_: object) -> None:
        raise OSError("no space")

    monkeypatch.setattr(Path, "replace", stopped)
    with pytest.raises(OSError, match="no space"):
        objects.write_object(tmp_path / "folder" / "object.o", b"code")
    assert list((tmp_path / "folder").iterdir()) == []


@pytest.mark.skipif(sys.platform != "linux", reason="how memory is fragmented depends on the system")
def test_sections_may_be_far_apart() -> None:
    run = subprocess.run([sys.executable, "-c", FRAGMENTED], check=False, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr


def test_unused_objects_are_removed_after_thirty_days(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(objects.FOLDER, str(tmp_path))
    old, new = (tmp_path / "kernels" / folder / "object.o" for folder in ("old", "new"))
    for path in (old, new):
        path.parent.mkdir(parents=True)
        path.write_bytes(b"code")
    month = time.time() - 31 * 86400
    os.utime(old, (month, month))
    objects.remove_unused()
    assert not old.parent.exists()
    assert new.exists()


def test_an_object_in_use_is_marked_as_such(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(objects, "cache_folder", lambda: tmp_path)
    path = objects.cached_path(weighted)
    path.write_bytes(b"code")
    month = time.time() - 29 * 86400
    os.utime(path, (month, month))
    assert objects.read_cached(weighted) == b"code"
    assert time.time() - path.stat().st_mtime < 60
