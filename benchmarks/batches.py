"""A batch over the cores of one process, beside two independent processes that share the same samples.

Two cores of one machine share caches and clock, so a batch cannot be judged against half the time of one core; it is
judged against what two processes reach together, measured in turn in the same run.
"""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from os import environ

import numpy as np

import dalembert as da
from benchmarks import ours, timing
from benchmarks.cases import PENDULUM

SAMPLES = 64


def model() -> da.TimeResponse:
    return da.TimeResponse(
        ours.beam_pendulum,
        parameters={"theta1": (0.6, 1.0), "theta2": (0.4, 0.65)},
        channels=ours.JOINT_AND_TIP,
        times=PENDULUM.integration.times,
        solver=ours.solver(PENDULUM.integration),
    )


def samples(count: int) -> np.ndarray:
    """Samples of the angles, shape (count, 2)."""
    box = model().parameters
    return box.lower + np.random.default_rng(0).random((count, 2)) * (box.upper - box.lower)


def main() -> list[dict[str, object]]:
    batch, whole = model(), samples(SAMPLES)
    with _worker() as first, _worker() as second:
        times = timing.interleaved(
            {
                "batch": lambda: batch.evaluate(whole).only(),
                "two": lambda: _together(first, second),
                "one": lambda: _together(first),
            },
            repeats=5,
        )
    rates = {"batch": SAMPLES / times["batch"], "two": SAMPLES / times["two"], "one": SAMPLES / 2 / times["one"]}
    rows = [
        {"what": "one process, one core", "samples a second": rates["one"], "against two processes": ""},
        {"what": "two processes, one core each", "samples a second": rates["two"], "against two processes": 1.0},
        {
            "what": "batch in one process",
            "samples a second": rates["batch"],
            "against two processes": rates["batch"] / rates["two"],
        },
    ]
    timing.report("batches", f"Batch of {SAMPLES} pendulums of fully parametrised beams", rows)
    return rows


def work() -> None:
    """A worker: its half of the samples each time a line comes in."""
    batch, half = model(), samples(SAMPLES)[: SAMPLES // 2]
    batch.evaluate(half)
    print("ready", flush=True)
    for _ in sys.stdin:
        batch.evaluate(half)
        print("done", flush=True)


@contextmanager
def _worker() -> Iterator[subprocess.Popen]:
    command = [sys.executable, "-c", "from benchmarks.batches import work; work()"]
    one_core = {**environ, "NUMBA_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=one_core) as process:
        _answer(process)
        yield process
        process.stdin.close()


def _together(*workers: subprocess.Popen) -> None:
    for worker in workers:
        worker.stdin.write("go\n")
        worker.stdin.flush()
    for worker in workers:
        _answer(worker)


def _answer(worker: subprocess.Popen) -> None:
    if not worker.stdout.readline():
        raise RuntimeError("a worker process of the batch benchmark ended before it answered")


if __name__ == "__main__":
    main()
