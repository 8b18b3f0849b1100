"""Products of matrices inside kernels, by the BLAS of SciPy, whose address they are given."""

import ctypes
from functools import cache
from typing import Any

from numba import types
from numba.core import cgutils

from dalembert.kernels.views import intrinsic


@cache
def gemm() -> int:
    """Address of the BLAS's product of two real matrices."""
    from scipy.linalg import cython_blas  # type: ignore[attr-defined] - a compiled module

    capsule = cython_blas.__pyx_capi__["dgemm"]
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
        import llvmlite.ir as ir

        size, number, byte = ir.IntType(32), ir.DoubleType(), ir.IntType(8)

        def matrix(k: int) -> tuple[Any, Any, Any]:
            array = cgutils.create_struct_proxy(signature.args[k])(context, builder, value=values[k])
            rows, columns = cgutils.unpack_tuple(builder, array.shape, 2)
            return array.data, builder.trunc(rows, size), builder.trunc(columns, size)

        def given(value: Any) -> Any:
            return cgutils.alloca_once_value(builder, value)

        (a_data, m, k), (b_data, _, n), (c_data, _, _) = matrix(1), matrix(2), matrix(4)
        # By columns, as the BLAS has matrices, it is the transposed product.
        no, one = given(byte(ord("N"))), given(number(1.0))
        m, n, k, scale = given(m), given(n), given(k), given(values[3])
        arguments = [no, no, n, m, k, one, b_data, n, a_data, k, scale, c_data, n]
        kind = ir.FunctionType(ir.VoidType(), [argument.type for argument in arguments])
        builder.call(builder.inttoptr(values[0], kind.as_pointer()), arguments)
        return context.get_dummy_value()

    return signature, generate
