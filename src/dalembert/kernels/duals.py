"""Dual numbers in kernels: a value with its derivatives along eight directions, a double and eight lanes.

(u, u')(v, v') = (uv, uv' + vu'), (u, u')/(v, v') = (q, (u' - q v')/v) with q = u/v. A number without derivatives stays
plain: it costs no more than it has to. Inequalities are of values, and so is `real`; equality is of derivatives, too.
"""

import operator
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typeconv.castgraph import Conversion
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global
from numba.extending import (
    lower_builtin,
    lower_cast,
    lower_getattr,
    models,
    overload,
    register_model,
)

from dalembert.kernels.lanes import LANES, REAL, VECTOR, WIDTH, spread, without_python
from dalembert.kernels.views import intrinsic, vector_of, view

DIRECTIONS = WIDTH
ENTRIES = 1 + WIDTH  # doubles of a dual number in memory
_PLAIN = types.Float | types.Integer


class DualType(types.Type):
    """Numba's type of a value with eight derivatives. It is no ``Number``, which Numba unifies by NumPy's rules."""

    def __init__(self) -> None:
        super().__init__("Dual")

    def can_convert_from(self, typingctx: Any, other: Any) -> Conversion | None:
        return Conversion.promote if isinstance(other, _PLAIN) else None

    def unify(self, typingctx: Any, other: Any) -> Any:
        return self if isinstance(other, _PLAIN) else None


DUAL = DualType()


class Dual:
    """Stands for dual numbers where ``float`` and ``complex`` stand for real and complex ones."""

    numba = DUAL


@register_model(DualType)
class _DualModel(models.StructModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, [("value", types.float64), ("slopes", LANES)])


def _dual(context: Any, builder: Any, value: Any, slopes: Any) -> Any:
    number = cgutils.create_struct_proxy(DUAL)(context, builder)
    number.value, number.slopes = value, slopes
    return number._getvalue()


def _parts(context: Any, builder: Any, number: Any) -> tuple[Any, Any]:
    parts = cgutils.create_struct_proxy(DUAL)(context, builder, value=number)
    return parts.value, parts.slopes


@lower_cast(types.Float, DualType)
@lower_cast(types.Integer, DualType)
def _constant(context: Any, builder: Any, source: Any, target: Any, value: Any) -> Any:
    zero = ir.Constant(VECTOR, [0.0] * WIDTH)
    return _dual(context, builder, context.cast(builder, value, source, types.float64), zero)


# -- arithmetic ------------------------------------------------------------------------------------------------------


def _add(b: Any, u: tuple, v: tuple) -> tuple:
    return b.fadd(u[0], v[0]), b.fadd(u[1], v[1])


def _subtract(b: Any, u: tuple, v: tuple) -> tuple:
    return b.fsub(u[0], v[0]), b.fsub(u[1], v[1])


def _multiply(b: Any, u: tuple, v: tuple) -> tuple:
    # (u, u')(v, v') = (uv, uv' + vu'); products and sums are not contracted, as in real numbers.
    return b.fmul(u[0], v[0]), b.fadd(b.fmul(spread(b, u[0]), v[1]), b.fmul(spread(b, v[0]), u[1]))


def _divide(b: Any, u: tuple, v: tuple) -> tuple:
    # The quotient is a division, as in real numbers, so that values have their bits.
    quotient, inverse = b.fdiv(u[0], v[0]), spread(b, b.fdiv(REAL(1.0), v[0]))
    return quotient, b.fmul(inverse, b.fsub(u[1], b.fmul(spread(b, quotient), v[1])))


def _scale(b: Any, u: tuple, s: Any) -> tuple:
    return b.fmul(u[0], s), b.fmul(u[1], spread(b, s))


def _scaled_inverse(b: Any, s: Any, v: tuple) -> tuple:
    # (s / v)' = -(s / v) / v v'
    quotient = b.fdiv(s, v[0])
    return quotient, b.fmul(spread(b, b.fneg(b.fdiv(quotient, v[0]))), v[1])


_RULES: dict[Any, tuple[Any, Any, Any]] = {
    (operator.add, operator.iadd): (
        _add, lambda b, u, s: (b.fadd(u[0], s), u[1]), lambda b, s, v: (b.fadd(s, v[0]), v[1]),
    ),
    (operator.sub, operator.isub): (
        _subtract, lambda b, u, s: (b.fsub(u[0], s), u[1]), lambda b, s, v: (b.fsub(s, v[0]), b.fneg(v[1])),
    ),
    (operator.mul, operator.imul): (_multiply, _scale, lambda b, s, v: _scale(b, v, s)),
    (operator.truediv, operator.itruediv): (
        _divide,
        lambda b, u, s: (b.fdiv(u[0], s), b.fmul(u[1], spread(b, b.fdiv(REAL(1.0), s)))),
        _scaled_inverse,
    ),
}  # fmt: skip
"""Rules of operators: for two dual numbers, a dual and a plain one, a plain and a dual one."""


def _binary(symbol: Any, rules: tuple[Any, Any, Any]) -> None:
    class Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            if len(args) != 2 or DUAL not in args or not all(isinstance(kind, DualType | _PLAIN) for kind in args):
                return None
            return DUAL(*(kind if kind is DUAL else types.float64 for kind in args))

    def lower(rule: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            operands = [
                _parts(context, builder, value) if kind is DUAL else value
                for kind, value in zip(signature.args, arguments, strict=True)
            ]
            return _dual(context, builder, *rule(builder, *operands))

        return generate

    declare: Any = infer_global(symbol)
    declare(type(f"Dual_{symbol.__name__}", (Template,), {}))
    lower_builtin(symbol, DualType, DualType)(lower(rules[0]))
    lower_builtin(symbol, DualType, types.float64)(lower(rules[1]))
    lower_builtin(symbol, types.float64, DualType)(lower(rules[2]))


for _symbols, _rules in _RULES.items():
    for _symbol in _symbols:
        _binary(_symbol, _rules)


def _negate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    value, slopes = _parts(context, builder, arguments[0])
    return _dual(context, builder, builder.fneg(value), builder.fneg(slopes))


class _Negation(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return DUAL(DUAL) if args == (DUAL,) else None


_declare: Any = infer_global(operator.neg)
_declare(_Negation)
lower_builtin(operator.neg, DualType)(_negate)


def _comparison(symbol: Any, sign: str) -> None:
    class Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            plain = all(isinstance(kind, DualType | _PLAIN) for kind in args)
            return types.boolean(DUAL, DUAL) if plain and DUAL in args and len(args) == 2 else None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        values, slopes = zip(*(_parts(context, builder, value) for value in arguments), strict=True)
        if sign not in ("==", "!="):
            # Branches depend on values alone: a derivative is that of the branch that is taken.
            return builder.fcmp_ordered(sign, *values)
        # A number differs from zero if a derivative does, as in complex numbers: `if damping != 0.0` must not drop the
        # derivative by a damping that is zero.
        apart = builder.bitcast(builder.fcmp_unordered("!=", *slopes), ir.IntType(WIDTH))
        differ = builder.or_(
            builder.fcmp_unordered("!=", *values), builder.icmp_unsigned("!=", apart, ir.Constant(ir.IntType(WIDTH), 0))
        )
        return differ if sign == "!=" else builder.not_(differ)

    declare: Any = infer_global(symbol)
    declare(type(f"Dual_{symbol.__name__}", (Template,), {}))
    lower_builtin(symbol, DualType, DualType)(generate)


for _symbol, _sign in (
    (operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">="), (operator.eq, "=="),
    (operator.ne, "!="),
):  # fmt: skip
    _comparison(_symbol, _sign)


@overload(abs)
def _absolute(x):
    if isinstance(x, DualType):
        return lambda x: -x if x.real < 0.0 else x
    return None


# -- parts -----------------------------------------------------------------------------------------------------------


class _Real(AttributeTemplate):
    key = DualType

    def resolve_real(self, kind: Any) -> Any:
        return types.float64


infer_getattr(_Real)


@lower_getattr(DualType, "real")
def _real(context: Any, builder: Any, kind: Any, number: Any) -> Any:
    return _parts(context, builder, number)[0]


@intrinsic(without_python)
def chained(typingctx, x, value, slope):
    """Return f(x) for a value f and a slope f' at the value of ``x``: the chain rule."""

    def generate(context, builder, signature, arguments):
        slopes = _parts(context, builder, arguments[0])[1]
        return _dual(context, builder, arguments[1], builder.fmul(spread(builder, arguments[2]), slopes))

    return DUAL(x, types.float64, types.float64), generate


@intrinsic(without_python)
def with_slopes(typingctx, value, slopes):
    """Return the dual number of a value and eight derivatives."""

    def generate(context, builder, signature, arguments):
        return _dual(context, builder, *arguments)

    return DUAL(types.float64, LANES), generate


@intrinsic(without_python)
def dual_zero(typingctx):
    """Return zero."""
    return DUAL(), lambda context, builder, signature, arguments: context.get_constant_null(DUAL)


@intrinsic(without_python)
def slopes_of(typingctx, x):
    """Return the eight derivatives of a dual number, as lanes."""
    return LANES(x), lambda context, builder, signature, arguments: _parts(context, builder, arguments[0])[1]


# -- memory ----------------------------------------------------------------------------------------------------------

duals, duals2 = view(Dual, 1), view(Dual, 2)

dual_vector = vector_of(Dual)


def as_duals(value: np.ndarray, slopes: Any) -> np.ndarray:
    """Return dual numbers in memory, (..., 9): values (...) with up to eight slopes of that shape, the others zero."""
    numbers = np.zeros((*value.shape, ENTRIES))
    numbers[..., 0] = value
    for direction, slope in enumerate(slopes, start=1):
        numbers[..., direction] = slope
    return numbers
