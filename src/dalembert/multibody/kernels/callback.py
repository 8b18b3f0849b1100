"""Calls from a kernel into a C function by its address: a function of the user's.

The address is data, so that a new function needs no new compilation and compiled kernels can be kept on disk.
"""

from typing import cast

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic


@intrinsic
def call(typingctx, address, *arrays):
    """Call the C function at ``address`` with the addresses of the first elements of contiguous arrays."""
    signature = types.void(types.int64, cast(types.Type, types.StarArgTuple.from_types(arrays)))

    def generate(context, builder, signature, arguments):
        import llvmlite.ir as ir

        pointers = [
            cgutils.create_struct_proxy(kind)(context, builder, value=value).data
            for kind, value in zip(signature.args[1], cgutils.unpack_tuple(builder, arguments[1]), strict=True)
        ]
        byte = ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [byte] * len(pointers))
        function = builder.inttoptr(arguments[0], kind.as_pointer())
        builder.call(function, [builder.bitcast(pointer, byte) for pointer in pointers])
        return context.get_dummy_value()

    return signature, generate
