"""Processes that compile kernels for this one: a copy of this process where that is safe, else a new one."""

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING

from dalembert.kernels.garbage import rarely_collected

if TYPE_CHECKING:
    from dalembert.kernels.kernel import Compiled

IN_WORKER = "DALEMBERT_WORKER"  # set in a worker process, which must not start workers


class Worker:
    """Another process, which compiles one kernel after the other into files."""

    def __init__(self) -> None:
        start = _forked if can_fork() else _started
        self.process, self._requests, self._answers, self._wait = start()

    def compile(self, kernel: "Compiled", path: Path) -> bool:
        """Whether the process wrote the object of this kernel; it cannot if it has ended, for example."""
        try:
            self._requests.write(json.dumps([kernel.origin, kernel.digest, str(path)]) + "\n")
            self._requests.flush()
            return self._answers.readline().strip() == "done"
        except OSError:
            return False

    def close(self) -> None:
        for stream in (self._requests, self._answers):
            with suppress(OSError):  # a request may be left that the process did not read
                stream.close()
        self._wait()


def work(requests: Iterable[str], answers: IO[str]) -> None:
    """Compile the kernel of each request, a line of JSON with origin, digest and file, and answer with a line."""
    with rarely_collected() as compiled:
        from dalembert.kernels.kernel import find
        from dalembert.kernels.objects import write_object

        for line in requests:
            origin, digest, path = json.loads(line)
            try:
                kernel = find(origin)
                # An object is stored by its digest, and must be that of the source of this process.
                assert kernel.digest == digest, "the source has changed since the other process read it"
                write_object(Path(path), kernel.object_code())
                answer = "done"
            except Exception:  # whatever it is: the process that asked compiles it itself, and reports the reason
                answer = "failed"
            answers.write(answer + "\n")
            answers.flush()
            compiled()


# Its number, its input, its output, a function that waits for its end.
_Process = tuple[int, IO[str], IO[str], Callable[[], object]]


def can_fork() -> bool:
    """Whether a copy of this process is safe: it has one thread only, and lacks what others were about to finish."""
    return sys.platform == "linux" and threading.active_count() == 1


def _forked() -> _Process:
    """A copy of this process: it has imported the compiler already, which takes a new one a second."""
    (requests, ours), (theirs, answers) = os.pipe(), os.pipe()
    process = os.fork()
    if process == 0:
        try:
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, signal.SIG_DFL)
            os.environ[IN_WORKER] = "1"
            _close_all_but(requests, answers)
            work(os.fdopen(requests), os.fdopen(answers, "w"))
        finally:
            os._exit(0)  # without what this process has registered for its end
    os.close(requests)
    os.close(answers)
    return process, os.fdopen(ours, "w"), os.fdopen(theirs), lambda: os.waitpid(process, 0)


def _close_all_but(*kept: int) -> None:
    """Close the files that this process has inherited: a lock on one of them lasts until all have closed it."""
    for number in [int(path.name) for path in Path("/proc/self/fd").iterdir()]:
        if number > 2 and number not in kept:
            with suppress(OSError):  # that of the listing
                os.close(number)


def _started() -> _Process:
    code = "import sys; from dalembert.kernels.workers import work; work(sys.stdin, sys.stdout)"
    environment = {**os.environ, IN_WORKER: "1", "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env=environment,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    return process.pid, process.stdin, process.stdout, process.wait
