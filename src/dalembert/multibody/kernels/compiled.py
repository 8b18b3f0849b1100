"""How kernels are compiled: once for a machine, kept on disk, without the interpreter's lock."""

from numba import njit

#: No fast-math: results must be the same bits on every run, and NaN must stay visible.
compiled = njit(cache=True, nogil=True, error_model="numpy")
