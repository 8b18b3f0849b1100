"""How kernels are compiled: once for a machine, kept on disk, without the interpreter's lock."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import njit
from numba.core.registry import CPUDispatcher

from dalembert.stale import forget_stale

_Function = TypeVar("_Function", bound=Callable)

forget_stale(Path(__file__).parent.parent, Path(__file__))

# No fast-math, not even the fusing of a product with a sum (a thirtieth of a simulation's time): what is fused depends
# on what stands inside what, so that a process that has just compiled would round otherwise than one that finds its
# code on disk. Without it the bits are those of IEEE arithmetic, in every process. Nothing is called by its address, so
# nothing needs C's wrapper.
_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}


class _Inner(CPUDispatcher):
    """A function that only compiled ones may call: without Python's wrapper, a sixth of the time that compiling takes.

    Called from Python it would end the process, so that it refuses.
    """

    def __call__(self, *_args: Any, **_kwargs: Any) -> Any:
        raise TypeError(f"{self.py_func.__name__} has no wrapper for Python: call it from a compiled function")


def _decorator(inner: bool = True, **options: Any) -> Callable[[_Function], _Function]:
    """Numba's decorator with options that its type stubs do not know; a kernel is called as the function it is from."""
    decorate = cast(Any, njit)(**_OPTIONS, no_cpython_wrapper=inner, **options)

    def decorated(function: _Function) -> _Function:
        dispatcher = decorate(function)
        if inner:
            dispatcher.__class__ = _Inner
        return dispatcher

    return decorated


#: For functions that make arrays, or return them or views of them, and for those that Python calls.
compiled = _decorator(inner=False, _nrt=True)
#: For functions that do neither: without the counting of references to their arguments, which would take more time than
#: the mechanics of a small model (measured: 1.1 against 0.2 microseconds a residual of two bodies and two joints).
kernel = _decorator(_nrt=False)
#: The same for small functions that stand inside others, and for those that the loop over the steps calls: written into
#: their callers. A call would copy the hundreds of words that describe a model's arrays (measured: a fifth of a step).
#: Of one function there must not be two decorated forms: they would share a place in the cache.
inlined = _decorator(_nrt=False, forceinline=True)
#: For functions of either sort that have one caller, and for loops over components, which are specialised by a kernel:
#: written into it before types are inferred, which saves a compilation each (a third of all that compiling takes).
template = _decorator(inner=False, _nrt=True, inline="always")
