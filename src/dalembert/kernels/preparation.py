"""Kernels that a computation needs, compiled beforehand: those that are missing on all cores, with progress."""

import json
import os
import queue
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import chain, groupby
from pathlib import Path
from typing import TYPE_CHECKING

from dalembert.kernels.garbage import rarely_collected
from dalembert.kernels.objects import OBJECTS, cached_path, is_writable

if TYPE_CHECKING:
    from dalembert.kernels.kernel import Compiled

_FEW = 14  # kernels for each other process, which takes as long to begin as ten of them to compile
_WORKER = "DALEMBERT_WORKER"  # set in a worker process, which must not start workers
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
    workers = min(_cores() - 1, len(others) // _FEW)
    tasks: queue.SimpleQueue[list[Compiled]] = queue.SimpleQueue()
    for _, group in groupby(sorted(others, key=lambda kernel: kernel.family), key=lambda kernel: kernel.family):
        tasks.put(list(group))
    done = _Counter(len(missing), progress)
    with tempfile.TemporaryDirectory() as spare:
        folder = None if is_writable() else Path(spare)
        threads = [threading.Thread(target=_serve, args=(tasks, folder, done)) for _ in range(workers)]
        for thread in threads:
            thread.start()
        with rarely_collected() as compiled:
            for kernel in chain(own, _taken(tasks)):
                OBJECTS.make(kernel)
                done(kernel)
                compiled()
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


def _serve(tasks: "queue.SimpleQueue[list[Compiled]]", folder: Path | None, done: _Counter) -> None:
    """Send kernels to a worker process, one after the other. This process compiles what the worker cannot."""
    command = [sys.executable, "-c", "from dalembert.kernels.preparation import work; work()"]
    environment = {**os.environ, _WORKER: "1", "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    try:
        worker = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env=environment,
        )
    except OSError:
        return
    with worker:
        assert worker.stdin is not None
        assert worker.stdout is not None
        while (group := _next(tasks)) is not None:
            for kernel in group:
                path = cached_path(kernel) if folder is None else folder / f"{kernel.symbol}.o"
                try:
                    worker.stdin.write(json.dumps([kernel.origin, kernel.digest, str(path)]) + "\n")
                    worker.stdin.flush()
                    answer = worker.stdout.readline()
                except OSError:
                    answer = ""
                if answer.strip() == "done":
                    OBJECTS.add(kernel, path.read_bytes())
                else:
                    OBJECTS.make(kernel)
                done(kernel)
        worker.stdin.close()


def work() -> None:
    """Read kernels and files from the standard input, a pair a line, and compile each kernel into its file."""
    with rarely_collected() as compiled:
        from dalembert.kernels.kernel import find
        from dalembert.kernels.objects import write_object

        for line in sys.stdin:
            origin, digest, path = json.loads(line)
            try:
                kernel = find(origin)
                assert kernel.digest == digest, "the source has changed since the other process read it"
                write_object(Path(path), kernel.object_code())
                answer = "done"
            except Exception:  # whatever it is: the process that asked compiles it itself, and reports the reason
                answer = "failed"
            sys.stdout.write(answer + "\n")
            sys.stdout.flush()
            compiled()


def _cores() -> int:
    if _WORKER in os.environ:
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
