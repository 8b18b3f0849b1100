"""Eight real numbers side by side, as one number of a kernel: a vector register, or two or four of a smaller processor.

`+ - * /` are single instructions. Eight is the width on every processor, so that one layout serves all: twelve spill
registers on AVX-512, and four gain less there.
"""

import operator
from typing import Any

from llvmlite import ir
from numba import types
from numba.core.typeconv.castgraph import Conversion
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import lower_builtin, lower_cast, models, register_model

from dalembert.kernels.views import vector_of

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

    def __init__(self) -> None:
        super().__init__("Lanes")

    def can_convert_from(self, typingctx: Any, other: Any) -> Conversion | None:
        return Conversion.promote if isinstance(other, types.Float | types.Integer) else None

    def unify(self, typingctx: Any, other: Any) -> Any:
        return self if isinstance(other, types.Float | types.Integer) else None


LANES = LanesType()


class Lanes:
    """Stands for eight real numbers side by side where NumPy's types stand for other numbers."""

    numba = LANES


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


lane_vector = vector_of(Lanes)
