"""One thread for linear algebra: the systems of a curve are small and many, and its samples run beside each other."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from threadpoolctl import ThreadpoolController


@cache
def _controller() -> ThreadpoolController:
    """The libraries of linear algebra that are loaded; to look for them takes milliseconds."""
    return ThreadpoolController()


@contextmanager
def one_thread() -> Iterator[None]:
    """A block, or as a decorator a function, in which linear algebra takes one thread.

    Threads that wait for each other cost up to thirty times the time on a busy machine, and the order of their sums is
    not the same everywhere.
    """
    with _controller().limit(limits=1, user_api="blas"):
        yield
