"""Arguments of kernels as 64-bit words: an annotation defines their number and their content."""

import ctypes
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numpy as np


@dataclass(frozen=True)
class ArrayOf:
    """A contiguous array: its dtype and its number of axes. Its words are its address and its shape."""

    dtype: str
    axes: int


Integers = Annotated[np.ndarray, ArrayOf("i8", 1)]
Integers2 = Annotated[np.ndarray, ArrayOf("i8", 2)]
Reals = Annotated[np.ndarray, ArrayOf("f8", 1)]
Reals2 = Annotated[np.ndarray, ArrayOf("f8", 2)]
Reals3 = Annotated[np.ndarray, ArrayOf("f8", 3)]
Reals4 = Annotated[np.ndarray, ArrayOf("f8", 4)]
Complexes = Annotated[np.ndarray, ArrayOf("c16", 1)]
Complexes2 = Annotated[np.ndarray, ArrayOf("c16", 2)]
Complexes3 = Annotated[np.ndarray, ArrayOf("c16", 3)]
#: Unsigned.
Bytes = Annotated[np.ndarray, ArrayOf("u1", 1)]
Bytes2 = Annotated[np.ndarray, ArrayOf("u1", 2)]
#: Address of a record or of a kernel: one word.
Address = int

_SCALARS: dict[Any, str] = {int: "i8", float: "f8", bool: "i8"}
Words = list[Any]
Pack = Callable[[Any, Words], None]


def leaves(annotation: Any) -> Iterator[Any]:
    """Scalars and arrays of an annotation, those of a NamedTuple in the order of its fields."""
    if annotation in _SCALARS:
        yield annotation
    elif get_origin(annotation) is Annotated:
        yield next(entry for entry in get_args(annotation) if isinstance(entry, ArrayOf))
    elif get_origin(annotation) is tuple:
        for entry in get_args(annotation):
            yield from leaves(entry)
    elif hasattr(annotation, "_fields"):
        for entry in fields(annotation).values():
            yield from leaves(entry)
    else:
        raise TypeError(
            f"{annotation!r} cannot be an argument of a kernel. Use int, float, bool, an array or a NamedTuple"
        )


@cache
def fields(record: type) -> dict[str, Any]:
    """Annotations of a NamedTuple."""
    hints = get_type_hints(record, include_extras=True)
    return {name: hints[name] for name in record._fields}  # type: ignore[attr-defined] - of a NamedTuple


def width(leaf: Any) -> int:
    """Words of a scalar or an array."""
    return 1 + leaf.axes if isinstance(leaf, ArrayOf) else 1


def count(annotation: Any) -> int:
    """Words of an argument."""
    return sum(map(width, leaves(annotation)))


def form(annotation: Any) -> str:
    """Format of an argument's words, for :mod:`struct`."""
    return "".join("d" if leaf is float else "q" * width(leaf) for leaf in leaves(annotation))


def packer(name: str, annotation: Any) -> Pack:
    """A function that appends an argument's words to others; ``name`` is for its messages."""
    if annotation is float:
        return _pack_float
    if annotation in _SCALARS:
        return _pack_integer
    if get_origin(annotation) is Annotated:
        return _array_packer(name, next(leaves(annotation)))
    entries = get_args(annotation) if get_origin(annotation) is tuple else fields(annotation).values()
    # A message names the field, or the number of an entry without a name.
    names = getattr(annotation, "_fields", range(len(entries)))
    parts = [packer(f"{name}.{own}", entry) for own, entry in zip(names, entries, strict=True)]

    def pack(value: Any, words: Words) -> None:
        for own, entry in zip(parts, value, strict=True):
            own(entry, words)

    return pack


def _pack_integer(value: Any, words: Words) -> None:
    words.append(int(value))


def _pack_float(value: Any, words: Words) -> None:
    words.append(value)


def _array_packer(name: str, leaf: ArrayOf) -> Pack:
    dtype, axes = np.dtype(leaf.dtype), leaf.axes

    def pack(value: np.ndarray, words: Words) -> None:
        # The kernel sees an address only. Another dtype or stride would read other memory than meant.
        if value.dtype != dtype or value.ndim != axes or not value.flags.c_contiguous:
            raise TypeError(
                f"{name} is an array of {value.dtype} with shape {value.shape}; "
                f"expected a contiguous one of {dtype} with {axes} axes"
            )
        words.append(address(value))
        words += value.shape

    return pack


def address(memory: Any) -> int:
    """Address of the first entry of a contiguous array, or of another object's memory."""
    try:
        # It takes less than half of the time of `array.ctypes.data`.
        return ctypes.addressof(ctypes.c_char.from_buffer(memory))
    except (TypeError, ValueError):  # it cannot be written to, or is empty
        return memory.ctypes.data  # of an array; slower, since it makes several objects


def unpack(annotation: Any, values: tuple[Any, ...]) -> Any:
    """A result, a scalar or a tuple of scalars, from what its words say in their format."""
    if annotation in _SCALARS:
        return annotation(values[0])
    return tuple([own(value) for own, value in zip(get_args(annotation), values, strict=True)])
