"""How functions are compiled: once for a machine, kept on disk, without the interpreter's lock."""

from pathlib import Path
from typing import Any

from numba import njit

from dalembert.stale import forget_stale

forget_stale(Path(__file__).parent, Path(__file__))

# No fast-math, so that results are the same bits on every run.
_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
compiled: Any = njit(**_OPTIONS)
