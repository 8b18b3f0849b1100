"""The process that computes for a study: its answers, and that it alone ends with what ends in it."""

import asyncio
import os
import signal
import sys
import threading
import time
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import TypeVar

import pytest

from dalembert.studio.processes import context, prepare
from dalembert.studio.worker import Limits, Worker, WorkerError
from worker_functions import (
    built,
    crashing,
    divided,
    double,
    filling,
    hanging,
    leaving,
    priority,
    process,
    refused,
    unsendable,
)

T = TypeVar("T")
GB = 1_000_000_000


@pytest.fixture(scope="module")
def worker() -> Iterator[Worker]:
    worker = Worker(Limits(seconds=20.0, bytes=GB))
    worker.start()
    yield worker
    worker.stop()


def run(work: Callable[[], Awaitable[T]]) -> T:
    async def main() -> T:
        return await work()

    return asyncio.run(main())


def wait_until(condition: Callable[[], bool]) -> None:
    until = time.monotonic() + 10
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.05)


def descriptors() -> int:
    return len(list(Path("/proc/self/fd").iterdir()))


def exists(number: int) -> bool:
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    return True


def sentence(worker: Worker, function: Callable) -> str:
    """What the worker says of a function that fails; afterwards it answers again."""
    with pytest.raises(WorkerError) as caught:
        run(lambda: worker.ask("model", function))
    assert run(lambda: worker.ask("model", double, 2.0)) == 4.0
    return str(caught.value)


def test_another_process_answers_and_keeps_what_it_made(worker):
    first, second = (run(lambda: worker.ask("process", process)) for _ in range(2))
    assert first == second != os.getpid()
    one, same, other = (run(lambda name=name: worker.ask("made", built, name)) for name in ("a", "a", "b"))
    assert one == same
    assert run(lambda: worker.ask("made", built, "b")) == other


def test_the_newest_request_of_each_subject_wins(worker):
    async def ask_all():
        first = asyncio.create_task(worker.ask("slow", double, 0.0, wait=0.3))
        await asyncio.sleep(0.1)
        others = [asyncio.create_task(worker.ask("moved", double, float(n))) for n in range(5)]
        drawn = asyncio.create_task(worker.ask("drawn", double, 7.0))
        return await asyncio.gather(first, *others, drawn)

    assert run(ask_all) == [0.0, None, None, None, None, 8.0, 14.0]


def test_a_request_is_held_up_by_others_alone(worker):
    async def ask_all():
        held = [worker.holds_up("read")]
        first = asyncio.create_task(worker.ask("read", double, 0.0, wait=1.0))
        await asyncio.sleep(0.1)
        held.append(worker.holds_up("read"))  # it is the newest one
        second = asyncio.create_task(worker.ask("read", double, 1.0, wait=1.0))
        await asyncio.sleep(0.1)
        held.append(worker.holds_up("read"))
        await first
        await asyncio.sleep(0.1)
        held += [worker.holds_up("read"), worker.holds_up("drawn")]
        return await second, held

    assert run(ask_all) == (2.0, [False, False, True, False, True])


def test_a_request_that_waits_can_be_dropped(worker):
    async def ask_all():
        first = asyncio.create_task(worker.ask("slow", double, 1.0, wait=0.3))
        waiting = asyncio.create_task(worker.ask("moved", double, 2.0))
        await asyncio.sleep(0.1)
        worker.drop("moved")
        return await asyncio.gather(first, waiting)

    assert run(ask_all) == [2.0, None]


def test_errors_are_sentences_and_the_process_goes_on(worker):
    before = run(lambda: worker.ask("process", process))
    assert sentence(worker, refused) == "mass is -1; expected a positive number"
    assert sentence(worker, divided) == "ZeroDivisionError: division by zero (worker_functions.py, line 33)"
    assert "pickle" in sentence(worker, unsendable)
    assert run(lambda: worker.ask("process", process)) == before


def test_a_model_that_hangs_is_stopped(monkeypatch, worker):
    monkeypatch.setattr(worker, "limits", Limits(seconds=0.5, bytes=GB))
    with pytest.raises(WorkerError, match=r"more than 0\.5 s and was stopped"):
        run(lambda: worker.ask("model", hanging))
    monkeypatch.undo()
    assert run(lambda: worker.ask("model", double, 2.0)) == 4.0


def test_a_user_stops_what_takes_long(worker):
    async def interrupted():
        asked = asyncio.create_task(worker.ask("model", hanging))
        await asyncio.sleep(0.3)
        worker.interrupt()
        await asked

    with pytest.raises(WorkerError, match=r"^The computation was stopped\."):
        run(interrupted)
    assert run(lambda: worker.ask("model", double, 2.0)) == 4.0


class Slow:
    """A process that starts slowly, and says when it begins to."""

    def __init__(self, process, starting: threading.Event) -> None:
        self._process, self._starting = process, starting

    def start(self) -> None:
        self._starting.set()
        time.sleep(0.3)
        self._process.start()

    def __getattr__(self, name: str):
        return getattr(self._process, name)


@pytest.mark.parametrize("before", [False, True], ids=["of the request", "before the request"])
def test_a_user_stops_a_process_that_starts(monkeypatch, before):
    """The stop is not lost, whether the process starts for the request or before it; later requests go on."""
    usual, starting = context(), threading.Event()
    slow = SimpleNamespace(Pipe=usual.Pipe, Process=lambda **options: Slow(usual.Process(**options), starting))
    monkeypatch.setattr("dalembert.studio.worker.context", lambda: slow)
    worker = Worker(Limits(seconds=5.0, bytes=GB))

    async def interrupted():
        if before:
            worker.start()
        asked = asyncio.create_task(worker.ask("model", hanging))
        while not starting.is_set():
            await asyncio.sleep(0.01)
        worker.interrupt()
        later = asyncio.create_task(worker.ask("other", double, 2.0))
        with pytest.raises(WorkerError, match=r"^The computation was stopped\."):
            await asked
        return await later

    try:
        assert run(interrupted) == 4.0
    finally:
        worker.stop()


def test_a_crash_ends_the_process_alone(worker):
    assert "ended by the signal SIGSEGV. Check the Python functions" in sentence(worker, crashing)
    assert "ended with code 3. Check" in sentence(worker, leaving)


def test_a_killed_process_is_replaced(worker):
    number = run(lambda: worker.ask("process", process))
    os.kill(number, signal.SIGKILL)
    time.sleep(0.2)
    assert run(lambda: worker.ask("process", process)) != number


@pytest.mark.skipif(sys.platform != "linux", reason="Linux alone limits the memory of a process.")
def test_a_model_that_fills_the_memory_is_stopped(worker):
    assert sentence(worker, filling).startswith("The computation needs more than 1 GB of memory and was stopped.")


def test_a_closed_study_has_no_process():
    worker = Worker()
    number = run(lambda: worker.ask("process", process))
    assert number is not None
    worker.stop()
    wait_until(lambda: not exists(number))


@pytest.mark.skipif(sys.platform != "linux", reason="descriptors are counted in /proc")
def test_a_closed_study_has_no_pipes():
    prepare()  # the process that others are forked from has pipes, too
    before = descriptors()
    worker = Worker()
    for _ in range(2):  # a process that is replaced has none either
        assert run(lambda: worker.ask("double", double, 1.0)) == 2.0
        worker.interrupt()
    worker.stop()  # it is still in memory, as a page that was left may be
    wait_until(lambda: descriptors() <= before)


def test_a_closed_study_drops_what_it_was_asked_for():
    worker = Worker()

    async def ask_and_stop():
        at_work = asyncio.create_task(worker.ask("slow", double, 1.0, wait=20.0))
        waiting = asyncio.create_task(worker.ask("next", double, 2.0))
        await asyncio.sleep(0.5)
        worker.stop()
        return await asyncio.wait_for(asyncio.gather(at_work, waiting, worker.ask("late", double, 3.0)), 15.0)

    assert run(ask_and_stop) == [None, None, None]


@pytest.mark.skipif(not hasattr(os, "nice"), reason="the system has no priorities of this kind")
def test_a_process_beside_a_run_leaves_the_processors_to_it():
    sparing = Worker(spares=True)
    try:
        assert run(lambda: sparing.ask("priority", priority)) > os.nice(0)
    finally:
        sparing.stop()
