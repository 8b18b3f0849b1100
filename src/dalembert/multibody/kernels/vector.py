"""Vector instructions by name, for loops too short for the compiler to find them."""

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils

from dalembert.kernels.views import intrinsic

LANES = 4  # numbers treated at a time; lengths are multiples of it


def _add(target: Any, at: int, source: Any, *rest: Any) -> None:
    count = rest[-1]
    for begin, factor in zip(rest[:-1:2], rest[1:-1:2], strict=True):
        target[at : at + count] += factor * source[begin : begin + count]


@intrinsic(_add)
def add_multiple(typingctx, target, at, source, begin, factor, count):
    """target[at : at + count] += factor * source[begin : begin + count], for contiguous vectors of real numbers."""
    return types.void(target, types.int64, source, types.int64, types.float64, types.int64), _sum_multiples


@intrinsic(_add)
def add_two_multiples(typingctx, target, at, source, begin, factor, other, weight, count):
    """The same for two parts of ``source``, from ``begin`` and from ``other``, by ``factor`` and by ``weight``."""
    signature = types.void(
        target, types.int64, source, types.int64, types.float64, types.int64, types.float64, types.int64
    )
    return signature, _sum_multiples


def _sum_multiples(context, builder, signature, arguments):
    def start(number, offset):
        data = cgutils.create_struct_proxy(signature.args[number])(context, builder, value=arguments[number]).data
        return builder.gep(data, [offset])

    def spread(factor):
        undefined = ir.Constant(lanes, ir.Undefined)
        one = builder.insert_element(undefined, factor, ir.Constant(ir.IntType(32), 0))
        return builder.shuffle_vector(one, undefined, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))

    word, lanes = ir.IntType(64), ir.VectorType(ir.DoubleType(), LANES)
    to = start(0, arguments[1])
    parts = [(start(2, arguments[k]), spread(arguments[k + 1])) for k in range(3, len(arguments) - 1, 2)]
    with cgutils.for_range_slice(builder, word(0), arguments[-1], word(LANES)) as (i, _):
        place = builder.bitcast(builder.gep(to, [i]), lanes.as_pointer())
        total = builder.load(place, align=8)
        for part, factor in parts:
            given = builder.load(builder.bitcast(builder.gep(part, [i]), lanes.as_pointer()), align=8)
            total = builder.fadd(total, builder.fmul(factor, given, flags=("contract",)), flags=("contract",))
        builder.store(total, place, align=8)
    return context.get_dummy_value()


@intrinsic(lambda a, at, b, begin, count: float(np.dot(a[at : at + count], b[begin : begin + count])))
def dot(typingctx, a, at, b, begin, count):
    """Sum of a[at : at + count] * b[begin : begin + count], of contiguous vectors of real numbers; by lanes."""
    return types.float64(a, types.int64, b, types.int64, types.int64), _sum_products


def _sum_products(context, builder, signature, arguments):
    def start(number, offset):
        data = cgutils.create_struct_proxy(signature.args[number])(context, builder, value=arguments[number]).data
        return builder.gep(data, [offset])

    word, lanes = ir.IntType(64), ir.VectorType(ir.DoubleType(), LANES)
    parts = start(0, arguments[1]), start(2, arguments[3])
    with builder.goto_entry_block():
        total = builder.alloca(lanes)
    builder.store(ir.Constant(lanes, [0.0] * LANES), total)
    with cgutils.for_range_slice(builder, word(0), arguments[-1], word(LANES)) as (i, _):
        first, second = (
            builder.load(builder.bitcast(builder.gep(part, [i]), lanes.as_pointer()), align=8) for part in parts
        )
        product = builder.fmul(first, second, flags=("contract",))
        builder.store(builder.fadd(builder.load(total), product, flags=("contract",)), total)
    sums = builder.load(total)
    own = [builder.extract_element(sums, ir.Constant(ir.IntType(32), lane)) for lane in range(LANES)]
    return builder.fadd(builder.fadd(own[0], own[1]), builder.fadd(own[2], own[3]))
