"""How kernels are compiled: once for a machine, kept on disk, without the interpreter's lock."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import njit

from dalembert.stale import forget_stale

_Function = TypeVar("_Function", bound=Callable)

forget_stale(Path(__file__).parent.parent, Path(__file__))

# Of fast-math only the fusing of a product with a sum, which saves a seventh of a residual: results must be the same
# bits on every run, and NaN must stay visible.
_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "fastmath": {"contract"}}


def _decorator(**options: Any) -> Callable[[_Function], _Function]:
    """Numba's decorator with options that its type stubs do not know; a kernel is called as the function it is from."""
    return cast(Any, njit(**_OPTIONS, **options))


#: For functions that make arrays, or return them or views of them.
compiled = _decorator(_nrt=True)
#: For functions that do neither: without the counting of references to their arguments, which would take more time than
#: the mechanics of a small model (measured: 1.1 against 0.2 microseconds a residual of two bodies and two joints).
kernel = _decorator(_nrt=False)
#: The same for small functions that stand inside others, and for those that the loop over the steps calls: written into
#: their callers. A call would copy the hundreds of words that describe a model's arrays (measured: a fifth of a step).
#: Of one function there must not be two decorated forms: they would share a place in the cache.
inlined = _decorator(_nrt=False, forceinline=True)
#: The same for loops over components, which are specialised by a kernel: written out before types are inferred, which
#: saves a compilation each.
template = _decorator(_nrt=False, inline="always")
