"""Eight real numbers side by side, as one number of a kernel: a vector register, or two or four of a smaller processor.

`+ - * /` and the square root are single instructions, with the bits of real numbers in each lane. Eight is the width on
every processor, so that one layout serves all: twelve spill registers on AVX-512, and four gain less there.

A comparison gives a mask, one truth value a lane. A branch cannot depend on it: a select does (`where`). Branches on
integers, and on which numbers are zero (`is_zero`), are common to all samples of a group.
"""

import math
import operator
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typeconv.castgraph import Conversion
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global
from numba.extending import lower_builtin, lower_cast, lower_getattr, models, overload, register_model

from dalembert.kernels.views import intrinsic, vector_of, view

WIDTH = 8
REAL, VECTOR = ir.DoubleType(), ir.VectorType(ir.DoubleType(), WIDTH)
_STORED = ir.LiteralStructType([VECTOR], packed=True)
ARITHMETIC = {
    "fadd": (operator.add, operator.iadd),
    "fsub": (operator.sub, operator.isub),
    "fmul": (operator.mul, operator.imul),
    "fdiv": (operator.truediv, operator.itruediv),
}
"""Operators by the instruction that carries them out."""


class LanesType(types.Type):
    """Numba's type of eight real numbers; a plain number stands for eight equal ones."""

    alignment = 8 * WIDTH  # of arrays on the stack, bytes

    def __init__(self) -> None:
        super().__init__("Lanes")

    def can_convert_from(self, typingctx: Any, other: Any) -> Conversion | None:
        return Conversion.promote if isinstance(other, types.Float | types.Integer) else None

    def unify(self, typingctx: Any, other: Any) -> Any:
        return self if isinstance(other, types.Float | types.Integer) else None


LANES = LanesType()


class MaskType(types.Type):
    """Numba's type of eight truth values. It has no truth value, so that no branch can depend on it."""

    def __init__(self) -> None:
        super().__init__("Mask")


MASK = MaskType()


class Lanes:
    """Stands for eight real numbers side by side where NumPy's types stand for other numbers."""

    numba = LANES


def lane_zeros(*shape: int) -> np.ndarray:
    """Return zeros (*shape, 8) whose vectors are at multiples of their size, so that none is on two cache lines."""
    count = int(np.prod(shape)) * WIDTH
    room = np.zeros(count + WIDTH - 1)
    first = -(room.ctypes.data // 8) % WIDTH
    return room[first : first + count].reshape(*shape, WIDTH)


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    """In registers a vector. In memory it has the alignment of one double, so that rows of numbers need no gaps."""

    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, VECTOR)

    def get_data_type(self) -> Any:
        return _STORED

    # Numba loads arrays with the alignment of their entries: a packed structure makes these loads unaligned ones, which
    # are as fast on every processor with vectors of this width.
    def as_data(self, builder: Any, value: Any) -> Any:
        return builder.insert_value(ir.Constant(_STORED, ir.Undefined), value, 0)

    def from_data(self, builder: Any, value: Any) -> Any:
        return builder.extract_value(value, 0)


@register_model(MaskType)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, ir.VectorType(ir.IntType(1), WIDTH))


def spread(builder: Any, value: Any) -> Any:
    """Generate a vector of equal entries."""
    first = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
    places = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH)
    return builder.shuffle_vector(first, ir.Constant(VECTOR, ir.Undefined), places)


@lower_cast(types.Float, LanesType)
@lower_cast(types.Integer, LanesType)
def _of_plain(context: Any, builder: Any, source: Any, target: Any, value: Any) -> Any:
    return spread(builder, context.cast(builder, value, source, types.float64))


def _elementwise(instruction: str, symbols: tuple[Any, ...]) -> None:
    class Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            plain = all(isinstance(kind, LanesType | types.Float | types.Integer) for kind in args)
            return LANES(LANES, LANES) if plain and LANES in args and len(args) == 2 else None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return getattr(builder, instruction)(*arguments)

    for symbol in symbols:
        declare: Any = infer_global(symbol)
        declare(type(f"Lanes_{symbol.__name__}", (Template,), {}))
        lower_builtin(symbol, LanesType, LanesType)(generate)


for _instruction, _symbols in ARITHMETIC.items():
    _elementwise(_instruction, _symbols)


@lower_builtin(operator.neg, LanesType)
def _negate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.fneg(arguments[0])


class _Negation(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return LANES(LANES) if args == (LANES,) else None


_declare: Any = infer_global(operator.neg)
_declare(_Negation)


def _comparison(symbol: Any, sign: str) -> None:
    class Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            plain = all(isinstance(kind, LanesType | types.Float | types.Integer) for kind in args)
            return MASK(LANES, LANES) if plain and LANES in args and len(args) == 2 else None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return (builder.fcmp_unordered if sign == "!=" else builder.fcmp_ordered)(sign, *arguments)

    declare: Any = infer_global(symbol)
    declare(type(f"Lanes_{symbol.__name__}", (Template,), {}))
    lower_builtin(symbol, LanesType, LanesType)(generate)


for _symbol, _sign in (
    (operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">="), (operator.eq, "=="),
    (operator.ne, "!="),
):  # fmt: skip
    _comparison(_symbol, _sign)


class _Real(AttributeTemplate):
    key = LanesType

    def resolve_real(self, kind: Any) -> Any:
        return LANES


infer_getattr(_Real)


@lower_getattr(LanesType, "real")
def _real(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    return value


def without_python(*arguments: Any) -> Any:
    """Stand for an intrinsic in Python, where lanes and dual numbers do not exist."""
    raise NotImplementedError("Lanes and dual numbers exist in compiled functions alone.")


@intrinsic(without_python)
def entry(typingctx, x, lane):
    """Return the number of a lane."""
    return types.float64(x, types.int64), lambda context, builder, signature, arguments: builder.extract_element(
        *arguments
    )


@intrinsic(without_python)
def with_entry(typingctx, x, lane, value):
    """Return lanes with another number in one of them."""

    def generate(context, builder, signature, arguments):
        vector, place, number = arguments
        return builder.insert_element(vector, number, place)

    return LANES(x, types.int64, types.float64), generate


def _by_entries(builder: Any, name: str, arguments: Any) -> Any:
    """Generate a function of the processor, entry by entry."""
    kind = ir.FunctionType(VECTOR, [VECTOR] * len(arguments))
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, name), arguments)


@intrinsic(without_python)
def vector_root(typingctx, x):
    """Return the square roots, correctly rounded as those of real numbers."""

    def generate(context, builder, signature, arguments):
        return _by_entries(builder, "llvm.sqrt.v8f64", arguments)

    return LANES(x), generate


@intrinsic(without_python)
def sizes(typingctx, x):
    """Return the absolute values."""

    def generate(context, builder, signature, arguments):
        return _by_entries(builder, "llvm.fabs.v8f64", arguments)

    return LANES(x), generate


@intrinsic(without_python)
def select(typingctx, mask, x, y):
    """Return, lane by lane, x where the mask is true, else y."""

    def generate(context, builder, signature, arguments):
        return builder.select(*arguments)

    return LANES(MASK, LANES, LANES), generate


@intrinsic(without_python)
def any_lane(typingctx, mask):
    """Return whether the mask is true in a lane."""

    def generate(context, builder, signature, arguments):
        bits = ir.IntType(WIDTH)
        return builder.icmp_unsigned("!=", builder.bitcast(arguments[0], bits), ir.Constant(bits, 0))

    return types.boolean(MASK), generate


@intrinsic(without_python)
def first_is_zero(typingctx, x):
    """Return whether the number of the first lane is zero, which speaks for all: a group shares its zero numbers."""

    def generate(context, builder, signature, arguments):
        first = builder.extract_element(arguments[0], ir.Constant(ir.IntType(32), 0))
        return builder.fcmp_ordered("==", first, REAL(0.0))

    return types.boolean(LANES), generate


@intrinsic(without_python)
def larger(typingctx, x, y):
    """Return, lane by lane, y where it is not at most x, which holds for values that are no numbers, else x.

    A value of x that is no number stays.
    """

    def generate(context, builder, signature, arguments):
        # "not b <= a" holds for a b that is no number, too: a failed lane shows in the largest value.
        a, b = arguments
        known, above = builder.fcmp_ordered("==", a, a), builder.fcmp_unordered(">", b, a)
        return builder.select(builder.and_(known, above), b, a)

    return LANES(x, y), generate


@intrinsic(without_python)
def chosen(typingctx, mask, x):
    """Return x in the lanes where the mask is not zero, and zero in the others."""

    def generate(context, builder, signature, arguments):
        zero = ir.Constant(VECTOR, [0.0] * WIDTH)
        return builder.select(builder.fcmp_ordered("!=", arguments[0], zero), arguments[1], zero)

    return LANES(mask, x), generate


def _place(context: Any, builder: Any, kind: Any, array: Any, at: Any) -> Any:
    """Generate the address of an entry, without a check of its number."""
    data = cgutils.create_struct_proxy(kind)(context, builder, value=array).data
    place = builder.gep(data, [at])
    return builder.bitcast(place, VECTOR.as_pointer()) if kind.dtype is LANES else place


def _loaded(builder: Any, place: Any) -> Any:
    """Generate the load of lanes, or of a real number that stands for eight equal ones."""
    entry = builder.load(place, align=8)
    return spread(builder, entry) if entry.type == REAL else entry


def _add_columns(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    """Generate x[at + i] += factor a[begin + i] + weight a[other + i] for i < count, or without the second product.

    Products are contracted where the processor can, as `vector.add_multiple` does for real numbers: one rounding each.
    """
    x = _place(context, builder, signature.args[0], arguments[0], arguments[1])
    columns = [
        (_place(context, builder, signature.args[2], arguments[2], arguments[k]), arguments[k + 1])
        for k in range(3, len(arguments) - 1, 2)
    ]
    with cgutils.for_range(builder, arguments[-1]) as loop:
        place = builder.gep(x, [loop.index])
        total = builder.load(place, align=8)
        for column, factor in columns:
            entry = _loaded(builder, builder.gep(column, [loop.index]))
            total = builder.fadd(total, builder.fmul(factor, entry, flags=("contract",)), flags=("contract",))
        builder.store(total, place, align=8)
    return context.get_dummy_value()


@intrinsic(without_python)
def add_column(typingctx, x, at, a, begin, factor, count):
    """Add ``factor`` times ``count`` entries of ``a`` from ``begin`` on to those of ``x`` from ``at`` on.

    Entries of ``a`` are lanes, or real numbers.
    """
    word = types.int64
    return types.void(x, word, a, word, factor, word), _add_columns


@intrinsic(without_python)
def add_columns(typingctx, x, at, a, begin, factor, other, weight, count):
    """The same for two parts of ``a``, from ``begin`` and from ``other``, by ``factor`` and by ``weight``."""
    word = types.int64
    return types.void(x, word, a, word, factor, word, weight, word), _add_columns


@intrinsic(without_python)
def sum_products(typingctx, row, given, count):
    """Return the sum of row[j] given[j] for j below a multiple of four, by four products at a time.

    Its loop has neither checks of indices nor room for another order of the sums.
    """

    def generate(context, builder, signature, arguments):
        word = arguments[2].type
        starts = [_place(context, builder, signature.args[k], arguments[k], word(0)) for k in range(2)]
        total = cgutils.alloca_once_value(builder, ir.Constant(VECTOR, [0.0] * WIDTH))

        def product(j):
            return builder.fmul(*(builder.load(builder.gep(start, [j]), align=8) for start in starts))

        with cgutils.for_range_slice(builder, word(0), arguments[2], word(4)) as (j, _):
            first, second, third, fourth = (product(builder.add(j, word(k))) for k in range(4))
            # ((first + second) + third) + fourth, as the product of one sample is compiled.
            sums = builder.fadd(builder.fadd(builder.fadd(first, second), third), fourth)
            builder.store(builder.fadd(builder.load(total), sums), total)
        return builder.load(total)

    return LANES(row, given, types.int64), generate


@intrinsic(without_python)
def _floors(typingctx, x):
    def generate(context, builder, signature, arguments):
        return _by_entries(builder, "llvm.floor.v8f64", arguments)

    return LANES(x), generate


@overload(math.floor)
def _floor(x):
    return (lambda x: _floors(x)) if isinstance(x, LanesType) else None  # noqa: PLW0108 - Numba's form


lanes, lanes2 = view(Lanes, 1), view(Lanes, 2)
lane_vector = vector_of(Lanes)
