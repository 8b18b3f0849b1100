"""Memory by its address, inside kernels: arrays, records, calls of C functions."""

from typing import Any

import numpy as np
from numba import from_dtype, types
from numba.core import cgutils
from numba.extending import intrinsic as _typed_intrinsic
from numba.np.arrayobj import make_array, populate_array

intrinsic: Any = _typed_intrinsic  # whose type stubs count the typing context among the arguments


def array_at(context: Any, builder: Any, kind: types.Array, address: Any, shape: list) -> Any:
    """Generate an array structure over memory that others keep alive."""
    import llvmlite.ir as ir

    word = ir.IntType(64)
    array = make_array(kind)(context, builder)
    item = context.get_data_type(kind.dtype)
    size = word(context.get_abi_sizeof(item))
    strides, step = [], size
    for length in reversed(shape):
        strides.insert(0, step)
        step = builder.mul(step, length)
    pointer = builder.inttoptr(address, item.as_pointer())
    populate_array(array, data=pointer, shape=shape, strides=strides, itemsize=size, meminfo=None)
    return array._getvalue()


def _view(dtype: types.Type, axes: int) -> Any:
    kind = types.Array(dtype, axes, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return array_at(context, builder, kind, arguments[0], list(arguments[1:]))

    if axes == 1:

        @intrinsic
        def view(typingctx, address, length):
            """The vector at an address."""
            return kind(types.int64, types.int64), generate
    else:

        @intrinsic
        def view(typingctx, address, rows, columns):
            """The matrix at an address, by rows."""
            return kind(types.int64, types.int64, types.int64), generate

    return view


integers, integers2 = _view(types.int64, 1), _view(types.int64, 2)
reals, reals2 = _view(types.float64, 1), _view(types.float64, 2)
complexes, complexes2 = _view(types.complex128, 1), _view(types.complex128, 2)


def record(dtype: np.dtype) -> Any:
    """An intrinsic: the record of this type at an address; its fields are read and written by name."""
    kind = from_dtype(dtype)

    @intrinsic
    def view(typingctx, address):
        """The record at an address."""

        def generate(context, builder, signature, arguments):
            return builder.inttoptr(arguments[0], context.get_value_type(kind))

        return kind(types.int64), generate

    return view


def records(dtype: np.dtype) -> Any:
    """An intrinsic: the vector of records of this type at an address."""
    return _view(from_dtype(dtype), 1)


@intrinsic
def address_of(typingctx, array):
    """Address of an array's first entry."""

    def generate(context, builder, signature, arguments):
        import llvmlite.ir as ir

        data = cgutils.create_struct_proxy(signature.args[0])(context, builder, value=arguments[0]).data
        return builder.ptrtoint(data, ir.IntType(64))

    return types.int64(array), generate


@intrinsic
def call(typingctx, address, first, second):
    """Call the C function at ``address`` with two addresses."""
    signature = types.void(types.int64, types.int64, types.int64)

    def generate(context, builder, signature, arguments):
        import llvmlite.ir as ir

        word = ir.IntType(64)
        kind = ir.FunctionType(ir.VoidType(), [word, word])
        builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), arguments[1:])
        return context.get_dummy_value()

    return signature, generate


@intrinsic
def call_with(typingctx, address, *arrays):
    """Call the C function at ``address`` with the addresses of contiguous arrays, each as a pointer."""
    signature = types.void(types.int64, types.StarArgTuple.from_types(arrays))

    def generate(context, builder, signature, arguments):
        import llvmlite.ir as ir

        byte, pointers = ir.IntType(8).as_pointer(), []
        values = cgutils.unpack_tuple(builder, arguments[1])
        for kind, value in zip(signature.args[1], values, strict=True):
            data = cgutils.create_struct_proxy(kind)(context, builder, value=value).data
            pointers.append(builder.bitcast(data, byte))
        kind = ir.FunctionType(ir.VoidType(), [byte] * len(pointers))
        builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), pointers)
        return context.get_dummy_value()

    return signature, generate


def local(dtype: types.Type, *shape: int) -> Any:
    """An intrinsic: a small array on the stack, the same one at each call from one place."""
    kind = types.Array(dtype, len(shape), "C")

    @intrinsic
    def array(typingctx):
        """An array on the stack; its entries are not set."""

        def generate(context, builder, signature, arguments):
            import llvmlite.ir as ir

            word = ir.IntType(64)
            with builder.goto_entry_block():
                memory = builder.alloca(context.get_data_type(dtype), size=int(np.prod(shape)))
            return array_at(context, builder, kind, builder.ptrtoint(memory, word), [word(n) for n in shape])

        return kind(), generate

    return array


@_typed_intrinsic(prefer_literal=True)
def stack(typingctx, array, count):
    """A vector on the stack, of the type of an array's entries and of a literal length."""
    kind = types.Array(array.dtype, 1, "C")

    def generate(context, builder, signature, arguments):
        import llvmlite.ir as ir

        with builder.goto_entry_block():
            memory = builder.alloca(context.get_data_type(array.dtype), size=count.literal_value)
        word = ir.IntType(64)
        return array_at(context, builder, kind, builder.ptrtoint(memory, word), [word(count.literal_value)])

    return kind(array, count), generate
