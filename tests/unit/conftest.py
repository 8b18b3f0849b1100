"""A cluster on the loopback, for the modules that ask for one."""

import pytest

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
