"""Memory by its address: arrays, records, calls of C functions; inside kernels, and in Python for debugging."""

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import from_dtype, types
from numba.core import cgutils
from numba.extending import intrinsic as _typed_intrinsic

WORD = ir.IntType(64)


def intrinsic(plain: Callable[..., Any], **options: Any) -> Callable[[Callable], Any]:
    """Declare a function whose code is generated; from Python ``plain`` is called instead."""

    def declared(definition: Callable) -> Any:
        handle: Any = _typed_intrinsic(**options)(definition) if options else _typed_intrinsic(definition)
        # The handle stays Numba's, so that compiled code sees the intrinsic; only the call from Python differs.
        handle.__class__ = type("Intrinsic", (type(handle),), {"__call__": lambda self, *given: plain(*given)})
        return handle

    return declared


def array_at(context: Any, builder: Any, kind: types.Array, address: Any, shape: list) -> Any:
    """Generate an array structure over memory that the caller keeps alive."""
    item = context.get_data_type(kind.dtype)
    size = WORD(context.get_abi_sizeof(item))
    # Row-major strides from the last axis on: each is the next one times the length of its axis.
    strides, step = [size], size
    for length in reversed(shape[1:]):
        step = builder.mul(step, length)
        strides.insert(0, step)
    entries = shape[0]
    for length in shape[1:]:
        entries = builder.mul(entries, length)
    parts = {"nitems": entries, "itemsize": size, "data": builder.inttoptr(address, item.as_pointer())}
    parts |= {"shape": cgutils.pack_array(builder, shape), "strides": cgutils.pack_array(builder, strides)}
    # the fields in Numba's order; the others, of the memory's owner, are null
    model = context.data_model_manager[kind]
    array = ir.Constant(context.get_value_type(kind), None)
    for k, name in enumerate(model._fields):
        if name in parts:
            array = builder.insert_value(array, parts[name], k)
    return array


def memory(dtype: Any, address: int, *shape: int) -> np.ndarray:
    """The array at an address, in Python."""
    dtype = np.dtype(dtype)
    size = int(np.prod(shape)) * dtype.itemsize
    return np.frombuffer((ctypes.c_char * size).from_address(int(address)), dtype).reshape(shape)


def _item(dtype: Any) -> Any:
    """Numba's type of numbers of a NumPy type, or of a class that stands for numbers of the kernels alone."""
    return getattr(dtype, "numba", None) or from_dtype(np.dtype(dtype))


def view(dtype: Any, axes: int) -> Any:
    """An intrinsic: the vector, the matrix by rows or the stack of matrices at an address."""
    kind: Any = types.Array(_item(dtype), axes, "C")

    def plain(address: int, *shape: int) -> np.ndarray:
        array = memory(dtype, address, *shape)
        return array.view(np.recarray) if array.dtype.names else array

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return array_at(context, builder, kind, arguments[0], list(arguments[1:]))

    answer = kind(*[types.int64] * (1 + axes)), generate
    definitions: dict[int, Callable] = {
        1: lambda typingctx, address, length: answer,
        2: lambda typingctx, address, rows, columns: answer,
        3: lambda typingctx, address, blocks, rows, columns: answer,
    }
    return intrinsic(plain)(definitions[axes])


integers, integers2 = view("i8", 1), view("i8", 2)
reals, reals2, reals3 = view("f8", 1), view("f8", 2), view("f8", 3)
complexes, complexes2 = view("c16", 1), view("c16", 2)


def records(dtype: np.dtype) -> Any:
    """An intrinsic: the vector of records of this type at an address."""
    return view(dtype, 1)


def record(dtype: np.dtype) -> Any:
    """An intrinsic: the record of this type at an address; its fields are read and written by name."""
    kind: Any = from_dtype(dtype)

    @intrinsic(lambda address: memory(dtype, address, 1).view(np.recarray)[0])
    def at(typingctx, address):
        """The record at an address."""

        def generate(context, builder, signature, arguments):
            return builder.inttoptr(arguments[0], context.get_value_type(kind))

        return kind(types.int64), generate

    return at


@intrinsic(lambda array: array.ctypes.data)
def address_of(typingctx, array):
    """Address of an array's first entry."""

    def generate(context, builder, signature, arguments):
        data = cgutils.create_struct_proxy(signature.args[0])(context, builder, value=arguments[0]).data
        return builder.ptrtoint(data, WORD)

    return types.int64(array), generate


def _call(address: int, first: int, second: int) -> None:
    ctypes.CFUNCTYPE(None, ctypes.c_int64, ctypes.c_int64)(int(address))(int(first), int(second))


@intrinsic(_call)
def call(typingctx, address, first, second):
    """Call the C function at ``address`` with two addresses."""
    signature = types.void(types.int64, types.int64, types.int64)

    def generate(context, builder, signature, arguments):
        kind = ir.FunctionType(ir.VoidType(), [WORD, WORD])
        builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), arguments[1:])
        return context.get_dummy_value()

    return signature, generate


def _call_with(address: int, *arrays: np.ndarray) -> None:
    pointers = [array.ctypes.data for array in arrays]
    ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * len(pointers))(int(address))(*pointers)


@intrinsic(_call_with)
def call_with(typingctx, address, *arrays):
    """Call the C function at ``address`` with the addresses of contiguous arrays, each as a pointer."""
    given: Any = types.StarArgTuple.from_types(arrays)
    signature = types.void(types.int64, given)

    def generate(context, builder, signature, arguments):
        byte, pointers = ir.IntType(8).as_pointer(), []
        values = cgutils.unpack_tuple(builder, arguments[1])
        for kind, value in zip(signature.args[1], values, strict=True):
            data = cgutils.create_struct_proxy(kind)(context, builder, value=value).data
            # Untyped pointers, as the C function takes arrays of real and of complex numbers alike.
            pointers.append(builder.bitcast(data, byte))
        kind = ir.FunctionType(ir.VoidType(), [byte] * len(pointers))
        builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), pointers)
        return context.get_dummy_value()

    return signature, generate


def vector_of(item: type) -> Any:
    """An intrinsic: a contiguous array (n, -) of real numbers as a vector of lanes or of dual numbers, one a row."""
    kind: Any = types.Array(_item(item), 1, "C")

    @intrinsic(lambda rows: rows)
    def vector(typingctx, rows):
        """The rows as a vector."""

        def generate(context, builder, signature, arguments):
            array = cgutils.create_struct_proxy(signature.args[0])(context, builder, value=arguments[0])
            length = cgutils.unpack_tuple(builder, array.shape, 2)[0]
            return array_at(context, builder, kind, builder.ptrtoint(array.data, WORD), [length])

        return kind(rows), generate

    return vector


def _on_stack(context: Any, builder: Any, kind: types.Array, shape: tuple[int, ...]) -> Any:
    """Generate an array on the stack of the function, the same one at each call from one place."""
    with builder.goto_entry_block():
        # In the entry block, else a loop around the call would use more stack at each turn.
        cells = builder.alloca(context.get_data_type(kind.dtype), size=int(np.prod(shape)))
        # Vectors of lanes fill a cache line each: at other addresses each load would touch two of them.
        cells.align = getattr(kind.dtype, "alignment", None)
    return array_at(context, builder, kind, builder.ptrtoint(cells, WORD), [WORD(length) for length in shape])


def local(dtype: type, *shape: int) -> Any:
    """An intrinsic: a small array on the stack; its entries are not set."""
    kind: Any = types.Array(_item(dtype), len(shape), "C")

    @intrinsic(lambda: np.zeros(shape, dtype))
    def array(typingctx):
        """An array on the stack; its entries are not set."""
        return kind(), lambda context, builder, signature, arguments: _on_stack(context, builder, kind, shape)

    return array


@intrinsic(lambda array, count: np.zeros(count, array.dtype), prefer_literal=True)
def stack(typingctx, array, count):
    """A vector on the stack, of the type of an array's entries and of a literal length; its entries are not set."""
    kind = types.Array(array.dtype, 1, "C")

    def generate(context, builder, signature, arguments):
        return _on_stack(context, builder, kind, (count.literal_value,))

    return kind(array, count), generate
