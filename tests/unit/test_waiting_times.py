"""What a user waits for before anything is computed."""

import subprocess
import sys
import time

import pytest

QUIET = 0.12  # s that the loop takes on a quiet machine


def loop() -> float:
    """Processor time of a loop in plain Python."""
    began, total = time.process_time(), 0
    for i in range(2_000_000):
        total += i * i & 7
    return time.process_time() - began


def waiting_time(*command: str) -> float:
    """Processor time of a process, as on a quiet machine."""
    resource = pytest.importorskip("resource")

    def used() -> float:
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return children.ru_utime + children.ru_stime

    slowness, before = loop(), used()
    subprocess.run(command, capture_output=True, check=True)
    spent = used() - before
    return spent * QUIET / min(slowness, loop())


def test_the_help_text_comes_within_half_a_second() -> None:
    command = (sys.executable, "-m", "dalembert.cli", "--help")
    assert min(waiting_time(*command) for _ in range(3)) < 0.5
