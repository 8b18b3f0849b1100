"""Threads of linear algebra: the order of sums depends on their number, and so do the last digits of a result."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from threadpoolctl import ThreadpoolController

THREADS = 1
"""Number in runs of studies, on every machine. The cores simulate side by side; each simulation has small systems."""


@cache
def _controller() -> ThreadpoolController:
    """The libraries of linear algebra that are loaded; to look for them takes milliseconds."""
    import scipy.linalg  # noqa: F401 (SciPy has a separate library, which is loaded only now)

    return ThreadpoolController()


def threads() -> int:
    """Return the number of threads that linear algebra takes in this process now."""
    return max((library["num_threads"] for library in _controller().select(user_api="blas").info()), default=1)


@contextmanager
def with_threads(number: int) -> Iterator[None]:
    """A block in which linear algebra takes a number of threads."""
    with _controller().limit(limits=number, user_api="blas"):
        yield


@contextmanager
def single_thread() -> Iterator[None]:
    """A block, or as a decorator a function, in which linear algebra takes one thread.

    Threads that wait for each other cost up to thirty times the time on a busy machine.
    """
    with with_threads(THREADS):
        yield
