"""What the process of a study is asked for in tests: to answer, and to end in each way that there is."""

import ctypes
import os
import sys
import time

import numpy as np

from dalembert.errors import InputError
from dalembert.studio.worker import Kept


def process(kept: Kept) -> int:
    return os.getpid()


def double(kept: Kept, number: float, *, wait: float = 0.0) -> float:
    time.sleep(wait)
    return 2 * number


def built(kept: Kept, source: str) -> int:
    """Number of an object that is made anew for each source alone."""
    return id(kept.newest("thing", source, lambda: [source]))


def refused(kept: Kept) -> None:
    raise InputError("mass is -1; expected a positive number")


def divided(kept: Kept) -> float:
    return 1 / 0


def hanging(kept: Kept) -> None:
    while True:
        pass


def crashing(kept: Kept) -> None:
    ctypes.string_at(0)


def leaving(kept: Kept) -> None:
    sys.exit(3)


def filling(kept: Kept) -> float:
    held = []
    while True:
        held.append(np.ones(20_000_000))


def unsendable(kept: Kept) -> object:
    return lambda: None


def loaded(kept: Kept, names: list[str]) -> bool:
    """Whether modules are imported already."""
    return set(names) <= set(sys.modules)


def priority(kept: Kept) -> int:
    """How far the process stands back."""
    return os.nice(0)
