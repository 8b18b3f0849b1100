"""A batch on a cluster of two workers on this machine, beside the same batch over this machine's cores.

What the cluster costs is sending, scheduling and receiving; the simulations are the same.
"""

import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from distributed import Client

import dalembert as da
from benchmarks import timing
from benchmarks.batches import model, samples

SAMPLES = 256
WORKERS = 2


def main() -> list[dict[str, object]]:
    batch, whole = model(), samples(SAMPLES)
    with _cluster() as client:
        there = da.on_cluster(batch, client)
        if there.evaluate(whole).values.tobytes() != batch.evaluate(whole).values.tobytes():
            raise RuntimeError("the cluster computed other bits than this process")
        runs = {"cores": lambda: batch.evaluate(whole).only(), "cluster": lambda: there.evaluate(whole).only()}
        times = timing.interleaved(runs, repeats=5)
    rates = {name: SAMPLES / seconds for name, seconds in times.items()}
    rows = [
        {"what": label, "samples a second": rates[name], "against the cores": rates[name] / rates["cores"]}
        for name, label in (("cores", "this process, all cores"), ("cluster", f"{WORKERS} workers of one thread"))
    ]
    timing.report("cluster", f"Batch of {SAMPLES} pendulums on a cluster on this machine", rows)
    return rows


@contextmanager
def _cluster() -> Iterator[Client]:
    """A scheduler and its workers, as processes."""
    dask = Path(sys.executable).with_name("dask")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    host, port = address.split(":")
    worker = ["worker", address, "--nthreads", "1", "--memory-limit", "0", "--no-dashboard", "--no-nanny"]
    commands = [["scheduler", "--host", host, "--port", port, "--no-dashboard"], *[worker] * WORKERS]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    processes = [subprocess.Popen([dask, *command], **quiet) for command in commands]
    try:
        with Client(f"tcp://{address}", timeout=60, set_as_default=False) as client:
            client.wait_for_workers(WORKERS, timeout=60)
            yield client
    finally:
        for process in processes:
            process.kill()


if __name__ == "__main__":
    main()
