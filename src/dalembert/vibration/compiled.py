"""How functions are compiled: once for a machine, kept on disk, without the interpreter's lock."""

import sys
from functools import cache
from pathlib import Path
from typing import Any

from numba import njit

from dalembert.stale import forget_stale

forget_stale(Path(__file__).parent, Path(__file__))

# No fast-math, so that results are the same bits on every run.
_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
compiled: Any = njit(**_OPTIONS)


@cache
def announce_compilation(function: Any, what: str) -> None:
    """Say, once, that a compiled function is not on disk yet, and what takes its time now."""
    kept, name = Path(function._cache.cache_path), function.py_func
    if not any(kept.glob(f"{name.__module__.rpartition('.')[2]}.{name.__qualname__}-*.nbi")):
        sys.stderr.write(f"dalembert: compiling {what}, once on this machine; this takes about half a minute\n")
