"""Garbage collection while many kernels are compiled."""

import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_SPAN = 40  # kernels between collections; each leaves about 5 MB


@contextmanager
def rarely_collected() -> Iterator[Callable[[], None]]:
    """Collect garbage in this block only at each 40th call of the yielded function.

    Python would otherwise traverse all objects of the compiler after each kernel: 4 % of the time.
    """
    collects, calls = gc.isenabled(), 0

    def count() -> None:
        nonlocal calls
        calls += 1
        if calls % _SPAN == 0:
            gc.collect()

    # Collections that are forced bound the memory, whatever the thresholds of the collector are.
    gc.disable()
    try:
        yield count
    finally:
        if collects:
            gc.enable()
