"""Integer powers as products: Numba's power of complex numbers has rounding errors in the imaginary part.

For a negative x, ``(x + 1e-30j)**3`` would have an imaginary part of 1e-17 where the derivative asks for 3e-30 x².
"""

import operator
from collections.abc import Iterator
from typing import Any

from numba.core import ir
from numba.core.compiler_machinery import FunctionPass, register_pass
from numba.core.ir_utils import find_const, guard

LARGEST = 64
"""Exponents that become products."""


@register_pass(mutates_CFG=False, analysis_only=False)
class IntegerPowers(FunctionPass):
    """Replace ``x**n`` with a constant whole n by products, by repeated squaring."""

    _name = "integer_powers"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """Rewrite all statements; whether anything changed."""
        changed = False
        for block in state.func_ir.blocks.values():
            body = []
            for statement in block.body:
                exponent = _exponent(state.func_ir, statement)
                if exponent is None:
                    body.append(statement)
                else:
                    body += _products(state.func_ir, block.scope, statement, exponent)
                    changed = True
            block.body = body
        return changed


def _exponent(code: Any, statement: Any) -> int | None:
    """The exponent of a statement ``y = x**n`` with a constant whole n from 2 on."""
    value = statement.value if isinstance(statement, ir.Assign) else None
    if not (isinstance(value, ir.Expr) and value.op in ("binop", "inplace_binop")):
        return None
    if value.fn not in (operator.pow, operator.ipow):
        return None
    exponent = guard(find_const, code, value.rhs)
    # Exponents 0 and 1 need no product.
    if isinstance(exponent, int | float) and float(exponent).is_integer() and 2 <= exponent <= LARGEST:
        return int(exponent)
    return None


def _products(code: Any, scope: Any, statement: Any, exponent: int) -> Iterator[Any]:
    """Statements that compute the power."""
    where = statement.loc

    def assigned(value: Any, target: Any) -> Any:
        # Later passes look definitions up by name, so that each new variable needs its entry.
        code._definitions[target.name] = [value]
        return ir.Assign(value, target, where)

    # Exponent in binary, from its lowest bit: square is x^(2^k), and bits that are set multiply the result by it.
    result, square = None, statement.value.lhs
    while True:
        if exponent & 1 and result is None:
            result = square
        elif exponent & 1:
            made = assigned(ir.Expr.binop(operator.mul, result, square, where), scope.redefine("power", where))
            yield made
            result = made.target
        exponent >>= 1
        if not exponent:
            break
        made = assigned(ir.Expr.binop(operator.mul, square, square, where), scope.redefine("power", where))
        yield made
        square = made.target
    yield ir.Assign(result, statement.target, where)
