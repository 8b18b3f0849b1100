"""What modules may ask for: a cluster on the loopback, and a process that has no compiled kernels."""

from pathlib import Path

import pytest

from dalembert.kernels import objects, preparation
from loopback_cluster import cluster


@pytest.fixture(scope="module")
def started():
    with cluster(workers=2) as started:
        yield started


@pytest.fixture(scope="module")
def client(started):
    from distributed import Client

    with Client(started.address, timeout=60, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=60)
        yield client
    assert all(worker.poll() is None for worker in started.workers[:2])


@pytest.fixture
def nothing_compiled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A process that has loaded nothing, and an empty folder."""
    monkeypatch.setattr(objects, "cache_folder", lambda: tmp_path)
    own = objects.Objects()
    own._packaged = True
    monkeypatch.setattr(preparation, "OBJECTS", own)
    return tmp_path
