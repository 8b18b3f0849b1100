"""Kernels that a computation needs, compiled beforehand: those that are missing on all cores, with progress."""

import os
import queue
import sys
import tempfile
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing, contextmanager
from itertools import chain, groupby
from pathlib import Path
from typing import TYPE_CHECKING

from dalembert.kernels.garbage import rarely_collected
from dalembert.kernels.objects import OBJECTS, cached_path, is_writable
from dalembert.kernels.workers import IN_WORKER, Worker, can_fork

if TYPE_CHECKING:
    from dalembert.kernels.kernel import Compiled

Progress = Callable[[int, int, str], None]


def prepare(kernels: Iterable["Compiled"]) -> None:
    """Load kernels and those that they call; compile the missing ones on all cores, and keep them.

    Several processes may do so at once: each object appears whole or not at all, and is the same from all of them.
    """
    missing = OBJECTS.missing(kernels)
    if not missing:
        return
    with _shown(len(missing)) as progress:
        _compile(missing, progress)


def _compile(missing: list["Compiled"], progress: Progress) -> None:
    own = [kernel for kernel in missing if kernel.origin is None]
    others = [kernel for kernel in missing if kernel.origin is not None]
    tasks: queue.SimpleQueue[list[Compiled]] = queue.SimpleQueue()
    # A family goes to one process: its kernels share inner functions, which are then compiled once.
    for _, group in groupby(sorted(others, key=lambda kernel: kernel.family), key=lambda kernel: kernel.family):
        tasks.put(list(group))
    done = _Counter(len(missing), progress)
    # Kernels of scripts have no origin, so that no other process could find them: they come first, here.
    kernels = chain(own, _taken(tasks))
    with tempfile.TemporaryDirectory() as spare, rarely_collected() as compiled:

        def make(kernel: "Compiled") -> None:
            OBJECTS.make(kernel)
            done(kernel)
            compiled()

        make(next(kernels))  # a copy of this process then has a compiler that is ready
        workers = list(_workers(min(_cores() - 1, len(others) // _few())))  # before there are threads
        folder = None if is_writable() else Path(spare)
        threads = [threading.Thread(target=_serve, args=(worker, tasks, folder, done)) for worker in workers]
        for thread in threads:
            thread.start()
        try:
            for kernel in kernels:
                make(kernel)
        finally:
            while _next(tasks) is not None:
                pass  # after an interruption nobody needs the others
            for thread in threads:
                thread.join()


class _Counter:
    """Counts kernels that are ready."""

    def __init__(self, total: int, progress: Progress) -> None:
        self._total, self._progress, self._count, self._lock = total, progress, 0, threading.Lock()

    def __call__(self, kernel: "Compiled") -> None:
        with self._lock:
            self._count += 1
            self._progress(self._count, self._total, kernel.symbol)


def _taken(tasks: "queue.SimpleQueue[list[Compiled]]") -> "Iterator[Compiled]":
    while (group := _next(tasks)) is not None:
        yield from group


def _next(tasks: "queue.SimpleQueue[list[Compiled]]") -> "list[Compiled] | None":
    try:
        return tasks.get_nowait()
    except queue.Empty:
        return None


def _serve(worker: Worker, tasks: "queue.SimpleQueue[list[Compiled]]", folder: Path | None, done: _Counter) -> None:
    """Send kernels to a worker, one after the other. This process compiles what the worker cannot."""
    with closing(worker):
        for kernel in _taken(tasks):
            path = cached_path(kernel) if folder is None else folder / f"{kernel.symbol}.o"
            if worker.compile(kernel, path):
                OBJECTS.add(kernel, path.read_bytes())
            else:
                OBJECTS.make(kernel)
            done(kernel)


def _workers(count: int) -> Iterator[Worker]:
    for _ in range(count):
        try:
            yield Worker()
        except OSError:  # no process can be started: this one compiles alone
            return


def _few() -> int:
    """Fewest kernels for which another process is worth its start: a new one takes as long as ten kernels."""
    return 7 if can_fork() else 14


def _cores() -> int:
    if IN_WORKER in os.environ:
        return 1
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


_OBSERVERS: list[Progress] = []


@contextmanager
def observed(progress: Progress) -> Iterator[None]:
    """Report compilation in this block to a function (count, total, symbol) instead of to the terminal."""
    _OBSERVERS.append(progress)
    try:
        yield
    finally:
        _OBSERVERS.remove(progress)


@contextmanager
def _shown(total: int) -> Iterator[Progress]:
    """Progress on the terminal: a line that is updated, elsewhere one line."""
    if _OBSERVERS:
        yield _OBSERVERS[-1]
        return
    live = sys.stderr.isatty()
    what = f"dalembert: compiling {total} kernels, once on this machine"

    def progress(count: int, total: int, symbol: str) -> None:
        if live:
            sys.stderr.write(f"\r{what}: {count}/{total}")
            sys.stderr.flush()

    if total > 1:
        sys.stderr.write(what if live else what + "\n")
        sys.stderr.flush()
    yield progress
    if live and total > 1:
        sys.stderr.write("\n")
