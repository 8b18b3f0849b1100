"""Interrupts that Python would lose."""

import _thread
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Timer
from typing import Any

DELAY = 0.05
"""Seconds until the interrupt is sent again: this hook is a callback too, and must have ended."""


@contextmanager
def kept_interrupts() -> Iterator[None]:
    """Block in which no Ctrl-C is lost that arrives inside a callback. Python drops what a callback of the garbage
    collector, a destructor or a callback of a C library raises, a KeyboardInterrupt too. It is sent to the main thread
    again, until it arrives outside a callback.
    """
    former = sys.unraisablehook

    def hook(unraisable: Any) -> None:
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            again = Timer(DELAY, _thread.interrupt_main)
            again.daemon = True
            again.start()
        else:
            former(unraisable)

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = former
