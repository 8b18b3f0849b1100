"""Arguments of kernels in generated code: words in memory, from which a function loads what it uses.

A NamedTuple stays in memory. Functions that pass it on pass its address, where Numba's own tuples would become hundreds
of arguments: half of the compiler's time.
"""

from typing import Annotated, Any, get_args, get_origin

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import lower_cast, lower_getattr_generic, register_model

from dalembert.kernels.views import WORD, array_at
from dalembert.kernels.words import count, fields, leaves

_SCALARS = {int: types.int64, float: types.float64, bool: types.boolean}
_ITEMS = {"u1": types.uint8, "i8": types.int64, "f8": types.float64, "c16": types.complex128}


class Stored(types.Type):
    """A NamedTuple in memory, by its address; its words do not change while a function runs."""

    def __init__(self, record: type) -> None:
        self.record = record
        # Numba compares types by their names: two records of one name in two modules have to differ.
        super().__init__(f"Stored({record.__module__}.{record.__qualname__})")

    @property
    def tuple(self) -> Any:
        """The same as a tuple of values."""
        return types.BaseTuple.from_types(list(map(_value_type, fields(self.record).values())), self.record)

    def can_convert_to(self, typingctx: Any, other: Any) -> Any:
        return typingctx.can_convert(self.tuple, other)


@register_model(Stored)
class _StoredModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, WORD.as_pointer())


@infer_getattr
class _StoredFields(AttributeTemplate):
    key = Stored

    def generic_resolve(self, kind: Stored, name: str) -> Any:
        annotation = fields(kind.record).get(name)
        # None tells Numba that the record has no such field; it then reports the name and the line.
        return None if annotation is None else numba_type(annotation)


@lower_getattr_generic(Stored)
def _field(context: Any, builder: Any, kind: Stored, words: Any, name: str) -> Any:
    at = 0
    # The address of a field is a constant offset, as each annotation has a known number of words.
    for other, annotation in fields(kind.record).items():
        if other == name:
            return load_words(context, builder, annotation, words, at)
        at += count(annotation)
    raise AttributeError(name)


@lower_cast(Stored, types.BaseTuple)
def _as_tuple(context: Any, builder: Any, given: Stored, wanted: Any, words: Any) -> Any:
    values, at = [], 0
    for annotation, kind in zip(fields(given.record).values(), wanted.types, strict=True):
        value = load_words(context, builder, annotation, words, at)
        # A field that is a record itself is stored, but is part of a tuple by its values: the cast loads these.
        values.append(context.cast(builder, value, numba_type(annotation), kind))
        at += count(annotation)
    return context.make_tuple(builder, wanted, values)


def numba_type(annotation: Any) -> Any:
    """Numba's type of an argument."""
    if annotation in _SCALARS:
        return _SCALARS[annotation]
    if get_origin(annotation) is Annotated:
        leaf = next(leaves(annotation))
        return types.Array(_ITEMS[leaf.dtype], leaf.axes, "C")
    if get_origin(annotation) is tuple:
        return types.Tuple([numba_type(entry) for entry in get_args(annotation)])
    return Stored(annotation)


def _value_type(annotation: Any) -> Any:
    kind = numba_type(annotation)
    return kind.tuple if isinstance(kind, Stored) else kind


def accepted(annotation: Any, given: Any) -> Any:
    """The type in which a kernel takes an argument of a type: a NamedTuple in memory, or its values, as it is."""
    kind = numba_type(annotation)
    if isinstance(kind, Stored) and getattr(given, "instance_class", None) is kind.record:
        # A kernel called with a tuple made in compiled code takes its values, so that nothing has to be stored first.
        entries = map(accepted, fields(kind.record).values(), given.types)
        return types.BaseTuple.from_types(list(entries), kind.record)
    return kind


def load_words(context: Any, builder: Any, annotation: Any, words: Any, at: int) -> Any:
    """Generate an argument from its words, which do not change: LLVM may load them once."""
    # The metadata `invariant.load` needs an empty node. It lets LLVM load a word once and keep it in a register.
    constant = builder.module.add_metadata([])

    def word(k: int, kind: Any = WORD) -> Any:
        loaded = builder.load(builder.bitcast(_place(builder, words, k), kind.as_pointer()))
        loaded.set_metadata("invariant.load", constant)
        return loaded

    if annotation is float:
        return word(at, ir.DoubleType())
    if annotation is bool:
        # A bool has a whole word; Numba's booleans are one bit.
        return builder.icmp_unsigned("!=", word(at), WORD(0))
    if annotation is int:
        return word(at)
    if get_origin(annotation) is Annotated:
        kind = numba_type(annotation)
        return array_at(context, builder, kind, word(at), [word(at + 1 + axis) for axis in range(kind.ndim)])
    return _place(builder, words, at)


def read_words(context: Any, builder: Any, result: Any, words: Any, at: int) -> Any:
    """Generate a result, a scalar or a tuple of scalars, from words that were just written."""
    if get_origin(result) is tuple:
        values = [read_words(context, builder, entry, words, at + k) for k, entry in enumerate(get_args(result))]
        return context.make_tuple(builder, numba_type(result), values)
    # Without the metadata of `load_words`: the kernel wrote these words after the caller had stored the arguments.
    place = _place(builder, words, at)
    if result is float:
        return builder.load(builder.bitcast(place, ir.DoubleType().as_pointer()))
    value = builder.load(place)
    return builder.icmp_unsigned("!=", value, WORD(0)) if result is bool else value


def store_words(context: Any, builder: Any, annotation: Any, kind: Any, value: Any, words: Any, at: int) -> None:
    """Generate the words of an argument of a type."""

    def put(entry: Any, k: int) -> None:
        builder.store(entry, builder.bitcast(_place(builder, words, k), entry.type.as_pointer()))

    if annotation is bool:
        put(builder.zext(value, WORD), at)
    elif annotation in _SCALARS:
        put(value, at)
    elif isinstance(kind, types.Array):
        array = cgutils.create_struct_proxy(kind)(context, builder, value=value)
        put(builder.ptrtoint(array.data, WORD), at)
        for axis, length in enumerate(cgutils.unpack_tuple(builder, array.shape, kind.ndim)):
            put(length, at + 1 + axis)
    elif isinstance(kind, Stored):
        # A record that is passed on is copied, as the words of all arguments stand one after the other.
        cgutils.raw_memcpy(builder, _place(builder, words, at), value, WORD(count(annotation)), 8)
    else:
        entries = get_args(annotation) if get_origin(annotation) is tuple else fields(annotation).values()
        for k, (entry, part) in enumerate(zip(entries, kind.types, strict=True)):
            store_words(context, builder, entry, part, builder.extract_value(value, k), words, at)
            at += count(entry)


def _place(builder: Any, words: Any, at: int) -> Any:
    return builder.gep(words, [WORD(at)]) if at else words
