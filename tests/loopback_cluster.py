"""A Dask cluster on the loopback: a real scheduler and real workers, processes of their own."""

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

DASK = Path(sys.executable).with_name("dask")
QUIET = dict(stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@dataclass
class Cluster:
    """A scheduler, its address, and the workers that were started."""

    address: str
    scheduler: subprocess.Popen
    workers: list[subprocess.Popen] = field(default_factory=list)

    def worker(self, sources: Path | None = None) -> subprocess.Popen:
        """Start one more worker, a process of one thread; ``sources`` replace those of this process."""
        limits = ["--nthreads", "1", "--memory-limit", "0", "--no-dashboard", "--no-nanny"]
        folders = [path for path in sys.path if path.endswith("src")] if sources is None else [str(sources)]
        here = {**os.environ, "PYTHONPATH": os.pathsep.join(folders)}
        self.workers.append(subprocess.Popen([DASK, "worker", self.address, *limits], env=here, **QUIET))
        return self.workers[-1]


@contextmanager
def cluster(workers: int) -> Iterator[Cluster]:
    """A cluster that ends with the context; its workers may need a moment yet."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [DASK, "scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard"]
    started = Cluster(f"tcp://127.0.0.1:{port}", subprocess.Popen(command, **QUIET))
    try:
        for _ in range(workers):
            started.worker()
        yield started
    finally:
        for process in (*started.workers, started.scheduler):
            process.kill()
            process.wait()
