"""What is said where compilation takes a while."""

import sys
from functools import cache
from pathlib import Path
from typing import Any


@cache
def announce_compilation(function: Any, what: str, time: str) -> None:
    """Say, once, that a compiled function is not on disk yet, what takes its time now, and about how long."""
    kept, name = Path(function._cache.cache_path), function.py_func
    if not any(kept.glob(f"{name.__module__.rpartition('.')[2]}.{name.__qualname__}-*.nbi")):
        sys.stderr.write(f"dalembert: compiling {what}, once on this machine; this takes {time}\n")
