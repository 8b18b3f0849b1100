"""A process that computes for one opened study, so that a model that hangs, crashes or fills the memory ends alone."""

import asyncio
import multiprocessing
import os
import signal
from collections.abc import Callable, Hashable
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import partial
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from queue import SimpleQueue
from threading import Lock, Thread
from typing import Any, Concatenate, Literal, ParamSpec, TypeVar, cast

from dalembert.errors import DalembertError, told
from dalembert.studio.jobs import ending
from dalembert.studio.processes import context

P = ParamSpec("P")
T = TypeVar("T")
ANSWER, WRONG, MEMORY = "answer", "wrong", "memory"
FREE = 0.5
"""Share of the machine's memory that a process may fill."""
STOPPED = "The computation was stopped. Change a value to start it again."
Cause = Literal["failed", "ended", "time", "memory"]


class WorkerError(DalembertError):
    """A computation that failed, or whose process ended."""

    def __init__(self, message: str, cause: Cause = "failed") -> None:
        super().__init__(message)
        self.cause: Cause = cause


@dataclass(frozen=True)
class Limits:
    """What one process may use. ``seconds`` limits one request; kernels that are not compiled yet are compiled within
    it. ``bytes`` limits the memory, except on Windows and macOS.
    """

    seconds: float = 180.0
    bytes: int = field(default_factory=lambda: int(FREE * _memory()))


@dataclass
class Kept:
    """What a process keeps from request to request: the newest thing of each kind."""

    _things: dict[str, tuple[Hashable, Any]] = field(default_factory=dict)

    def drop(self, kind: str) -> None:
        """Keep nothing of a kind."""
        self._things.pop(kind, None)

    def newest(self, kind: str, source: Hashable, make: Callable[[], T]) -> T:
        """Return the thing made of a source, made anew if the last one of its kind was made of another source."""
        if kind not in self._things or self._things[kind][0] != source:
            self._things.pop(kind, None)  # before the new one is made: there may be no room for both
            self._things[kind] = source, make()
        return cast(T, self._things[kind][1])


class Worker:
    """A process that answers requests in their order, and of each subject only the newest. It starts with
    :meth:`start`, and again with the first request after it has ended. With ``spares`` it leaves the processors to
    others that have work.
    """

    def __init__(self, limits: Limits | None = None, *, spares: bool = False) -> None:
        self.limits, self.spares = Limits() if limits is None else limits, spares
        self._newest: dict[str, object] = {}
        self._turns: SimpleQueue[Callable[[], object] | None] = SimpleQueue()
        self._process: BaseProcess | None = None
        self._connection: Connection | None = None
        self._ended = ""
        self._cause: Cause = "ended"
        self._requests = self._interrupted = 0  # number of the last request, and of the last one that must not go on
        self._computed: object | None = None
        self._stopped = False
        self._lock = Lock()  # of the process, which several threads end
        Thread(target=self._take_turns, daemon=True).start()  # the studio ends without waiting for it

    def start(self) -> None:
        """Start the process before anything is asked for."""
        self._turns.put(self._running)

    async def ask(
        self, subject: str, function: Callable[Concatenate[Kept, P], T], *arguments: P.args, **named: P.kwargs
    ) -> T | None:
        """Return ``function(kept, *arguments)``, computed in the process; None if the request was dropped. A request
        that waits is dropped when a newer one of its subject comes, and all are once :meth:`stop` was called. The
        function is one of a module, so that the process finds it. ``kept`` keeps things between requests.
        """
        if self._stopped:
            return None
        mine = self._newest[subject] = object()
        answer: Future[T | None] = Future()
        request = (partial(function, **named) if named else function), arguments
        self._requests += 1
        number = self._requests

        def turn() -> None:
            if not answer.set_running_or_notify_cancel():
                return
            self._computed = mine
            result, failure = None, None
            try:
                result = self._exchange(request, number) if self._newest.get(subject) is mine else None
            except Exception as error:
                failure = None if self._stopped else error
            self._computed = None  # before the answer, so that an answered request holds up no other one
            if failure is None:
                answer.set_result(result)
            else:
                answer.set_exception(failure)

        self._turns.put(turn)
        return await asyncio.wrap_future(answer)

    def holds_up(self, subject: str) -> bool:
        """Return True if another request than the newest one of a subject is computed now."""
        return self._computed not in (None, self._newest.get(subject))

    def drop(self, subject: str) -> None:
        """Drop the request of a subject that waits."""
        self._newest[subject] = object()

    def interrupt(self) -> None:
        """End the process, whatever it computes. The next request starts a new one.

        A process that starts for a request ends as soon as it is there.
        """
        with self._lock:
            if not self._killed(STOPPED):
                self._interrupted = self._requests

    def stop(self) -> None:
        """End the process for good, and drop the requests that have no answer."""
        self._stopped = True
        self._newest.clear()
        self._turns.put(None)
        self._end("")

    def _take_turns(self) -> None:
        while turn := self._turns.get():
            turn()
        self._end("")  # one that started meanwhile
        self._release()

    def _end(self, reason: str, cause: Cause = "ended") -> None:
        with self._lock:
            self._killed(reason, cause)

    def _killed(self, reason: str, cause: Cause = "ended") -> bool:
        """Kill the process, under the lock; return False if there is none."""
        if self._process is None or not self._process.is_alive():
            return False
        self._ended, self._cause = reason, cause
        self._process.kill()
        self._connection = None  # the next request starts another process
        return True

    def _release(self) -> None:
        """Close the pipes of a process that has ended: whoever keeps this object must not keep them."""
        with self._lock:
            process, connection = self._process, self._connection
            self._process = self._connection = None
        if connection is not None:
            connection.close()
        if process is not None:
            process.join(10.0)
            if not process.is_alive():
                process.close()

    def _running(self) -> Connection:
        """Return the connection to the process, which is started if there is none."""
        if self._connection is None or self._process is None or not self._process.is_alive():
            self._release()
            begin = context()
            self._connection, theirs = begin.Pipe()
            self._ended, self._cause = "", "ended"
            process = begin.Process(target=_serve, args=(theirs, self.limits.bytes, self.spares), daemon=True)
            process.start()
            theirs.close()
            with self._lock:
                self._process = process
        return self._connection

    def _exchange(self, request: tuple[Callable[..., Any], tuple[Any, ...]], number: int) -> Any:
        connection = self._running()
        if number <= self._interrupted:  # while the process started
            self._end(STOPPED)
        try:
            connection.send(request)
            if not connection.poll(self.limits.seconds):
                self._end(
                    f"The computation took more than {self.limits.seconds:g} s and was stopped. Simulate a shorter "
                    "time or take larger steps; the next change starts it again.",
                    "time",
                )
            outcome, content = connection.recv()
        except (EOFError, OSError):
            raise WorkerError(self._ending(), self._cause) from None
        if outcome == MEMORY:
            self._end("")
            raise WorkerError(
                f"The computation needs more than {self.limits.bytes / 1e9:.3g} GB of memory and was stopped. Take "
                "fewer samples or larger steps; the next change starts it again.",
                "memory",
            )
        if outcome == WRONG:
            raise WorkerError(content)
        return content

    def _ending(self) -> str:
        assert self._process is not None
        self._process.join(10.0)
        code = self._process.exitcode
        if self._ended:
            return self._ended
        how = "" if code is None else f" {ending(code)}"
        return (
            f"The process that computes this study ended{how}. Check the Python functions and the compiled code that "
            "the study names, and whether the machine has enough memory; the next change starts a new process."
        )


def _memory() -> float:
    """Bytes of the machine's memory; 8 GB where the system does not say it."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return 8e9


def _serve(connection: Connection, most_bytes: int, spares: bool) -> None:
    """Answer requests until the studio or the memory ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in the terminal is the studio's, which ends this process
    Thread(target=_follow_parent, daemon=True).start()
    _limit_memory(most_bytes)
    if spares and hasattr(os, "nice"):
        os.nice(15)
    kept, outcome = Kept(), ANSWER
    while outcome != MEMORY:
        try:
            function, arguments = connection.recv()
        except EOFError:
            return
        outcome = _send(connection, partial(function, kept, *arguments))


def _send(connection: Connection, compute: Callable[[], object]) -> str:
    """Send what is computed, or why there is nothing; return which of them."""
    try:
        connection.send((ANSWER, compute()))
        return ANSWER
    except MemoryError:
        outcome, content = MEMORY, ""
    except Exception as error:  # of the user's model too
        outcome, content = WRONG, told(error)
    connection.send((outcome, content))
    return outcome


def _limit_memory(most_bytes: int) -> None:
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (most_bytes, most_bytes))
    except (ImportError, ValueError, OSError):  # another system, or a limit that is lower already
        return


def _follow_parent() -> None:
    """End this process with the studio, also when that was killed while this one computes."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
