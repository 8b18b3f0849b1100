"""Products of matrices inside kernels, by the BLAS of SciPy, which receive their addresses as arguments."""

import ctypes
from functools import cache
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

from dalembert.kernels.views import intrinsic


def gemm() -> int:
    """Address of the BLAS's product of two real matrices."""
    return _address("dgemm")


def gemv() -> int:
    """Address of the BLAS's product of a real matrix and a vector."""
    return _address("dgemv")


@cache
def _address(routine: str) -> int:
    from scipy.linalg import cython_blas  # type: ignore[attr-defined] - a compiled module

    capsule = cython_blas.__pyx_capi__[routine]
    name, pointer = ctypes.pythonapi.PyCapsule_GetName, ctypes.pythonapi.PyCapsule_GetPointer
    name.restype, name.argtypes = ctypes.c_char_p, [ctypes.py_object]
    pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    return pointer(capsule, name(capsule))


def _product(gemm: int, a: Any, b: Any, former: float, c: Any) -> None:
    c[:] = a @ b + former * c


@intrinsic(_product)
def product(typingctx, gemm, a, b, former, c):
    """Set the matrix c to a b + former c; all are contiguous by rows, and ``gemm`` is the BLAS's address."""
    signature = types.void(types.int64, a, b, types.float64, c)

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        (a, m, k), (b, _, n), (c, _, _) = (_matrix(context, builder, signature, values, at) for at in (1, 2, 4))
        # By columns, as the BLAS has matrices, it is the transposed product.
        # The BLAS takes all arguments by address, so that each scalar has a cell on the stack.
        no, one, scale = _letter(builder, "N"), _number(builder, 1.0), cgutils.alloca_once_value(builder, values[3])
        _call(builder, values[0], [no, no, n, m, k, one, b, n, a, k, scale, c, n])
        return context.get_dummy_value()

    return signature, generate


def _applied(gemv: int, a: Any, x: Any, y: Any) -> None:
    y[:] = a @ x


@intrinsic(_applied)
def applied(typingctx, gemv, a, x, y):
    """Set the vector y to a x; all are contiguous, the matrix by rows, and ``gemv`` is the BLAS's address."""
    signature = types.void(types.int64, a, x, y)

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        a, m, n = _matrix(context, builder, signature, values, 1)
        x, y = (cgutils.create_struct_proxy(signature.args[k])(context, builder, value=values[k]).data for k in (2, 3))
        # The rows of a are the columns of the BLAS's matrix, so that a x is its transposed product.
        yes, one, none, step = _letter(builder, "T"), _number(builder, 1.0), _number(builder, 0.0), _length(builder, 1)
        _call(builder, values[0], [yes, n, m, one, a, n, x, step, none, y, step])
        return context.get_dummy_value()

    return signature, generate


def _matrix(context: Any, builder: Any, signature: Any, values: Any, k: int) -> tuple[Any, Any, Any]:
    """Pointers to the entries, the rows and the columns of an argument."""
    array = cgutils.create_struct_proxy(signature.args[k])(context, builder, value=values[k])
    rows, columns = cgutils.unpack_tuple(builder, array.shape, 2)
    return array.data, _length(builder, rows), _length(builder, columns)


def _length(builder: Any, value: Any) -> Any:
    # SciPy's BLAS counts in 32 bits.
    short = ir.IntType(32)
    return cgutils.alloca_once_value(builder, short(value) if isinstance(value, int) else builder.trunc(value, short))


def _number(builder: Any, value: float) -> Any:
    return cgutils.alloca_once_value(builder, ir.DoubleType()(value))


def _letter(builder: Any, letter: str) -> Any:
    return cgutils.alloca_once_value(builder, ir.IntType(8)(ord(letter)))


def _call(builder: Any, address: Any, arguments: list[Any]) -> None:
    kind = ir.FunctionType(ir.VoidType(), [argument.type for argument in arguments])
    builder.call(builder.inttoptr(address, kind.as_pointer()), arguments)
