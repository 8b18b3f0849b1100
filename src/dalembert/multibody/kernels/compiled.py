"""How kernels are compiled: once for a machine, kept on disk, without the interpreter's lock."""

from numba import njit

# No fast-math: results must be the same bits on every run, and NaN must stay visible.
_OPTIONS = {"cache": True, "nogil": True, "error_model": "numpy"}

#: For functions that make arrays.
compiled = njit(**_OPTIONS)
#: For functions that make none: without the counting of references to their arguments, which would take more time than
#: the mechanics of a small model (measured: 1.1 against 0.2 microseconds a residual of two bodies and two joints).
kernel = njit(**_OPTIONS, _nrt=False)
#: The same for small functions that stand inside others: written into their callers.
inlined = njit(**_OPTIONS, _nrt=False, forceinline=True)
