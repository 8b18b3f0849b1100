"""What parameters, constants and expressions of them measure, as far as their units say it."""

import ast
from collections.abc import Iterable, Mapping
from typing import Any

from dalembert.errors import InputError
from dalembert.study.text.expressions import Expression
from dalembert.unit_table import Unit, readings
from dalembert.units import difference, is_quantity, si_unit, symbol

Kinds = Mapping[str, Unit | None]
"""Units of named numbers; None where a number has none."""

OF_BOUNDS = ("lower", "upper", "start", "scale", "deviation")
"""Keys of a parameter whose numbers may have its unit with them."""


def kinds_of(document: Mapping[str, Any], names: Iterable[str], series: Mapping[str, Iterable[str]]) -> Kinds:
    """Return the units of the parameters and constants of a document; ``series`` are those that share a table."""
    found: dict[str, Unit | None] = dict.fromkeys(names)
    for name, table in _tables(document, "parameters"):
        for one in series.get(name, (name,)):
            found[one] = _of_parameter(table) if isinstance(table, Mapping) else None
    for name, value in _tables(document, "constants"):
        found[name] = _of_constant(value, found)
    return found


def _tables(document: Mapping[str, Any], name: str) -> Iterable[tuple[str, Any]]:
    table = document.get(name)
    return table.items() if isinstance(table, Mapping) else ()


def _of_parameter(table: Mapping[str, Any]) -> Unit | None:
    if table.get("unit"):
        return _unit(table["unit"])
    texts = (table.get(key) for key in OF_BOUNDS)
    return next((_of_quantity(text) for text in texts if isinstance(text, str) and is_quantity(text)), None)


def _of_constant(value: Any, known: Kinds) -> Unit | None:
    if not isinstance(value, str):
        return None
    if is_quantity(value):
        return _of_quantity(value)
    try:
        return kind_of(Expression.of(value), known)
    except InputError:  # refused where the constant is read
        return None


def _of_quantity(text: str) -> Unit | None:
    try:
        return _unit(symbol(text))
    except InputError:
        return None


def _unit(text: object) -> Unit | None:
    return next(iter(readings(text)), None) if isinstance(text, str) else None


def kind_of(expression: Expression, known: Kinds) -> Unit | None:
    """Return the unit of an expression; None where a factor without a unit leaves it open.

    Raises
    ------
    InputError
        For a sum of quantities of different kinds.

    Examples
    --------
    >>> known = {"L": readings("m")[0], "F": readings("N")[0], "k": None}
    >>> kind_of(Expression.of("F*L"), known) == readings("N*m")[0], kind_of(Expression.of("0.5*L"), known)
    (True, None)
    """
    return _kind(expression.tree, known)


def _kind(node: ast.expr, known: Kinds) -> Unit | None:
    match node:
        case ast.Name(id=name):
            return known.get(name)
        case ast.UnaryOp(operand=operand) | ast.Call(func=ast.Name(id="abs"), args=[operand]):
            return _kind(operand, known)
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub(), right=right):
            one, other = _kind(left, known), _kind(right, known)
            if one is not None and other is not None and difference(one, other) is not None:
                raise InputError(f"{ast.unparse(node)!r} adds quantities of different kinds")
            return one or other
        case ast.BinOp(left=left, op=ast.Mult() | ast.Div() as operation, right=right):
            one, other = _kind(left, known), _kind(right, known)
            if one is None or other is None:
                return None
            return one * other ** (1 if isinstance(operation, ast.Mult) else -1)
        case ast.BinOp(left=left, op=ast.Pow(), right=ast.Constant(value=int() as power)) if abs(power) < 10:
            base = _kind(left, known)
            return None if base is None else base**power
    return None


def kind_of_number(value: object, known: Kinds) -> Unit | None:
    """Return the unit of a number that was written with one, or of an expression; None where it is not known."""
    if isinstance(value, Expression):
        return kind_of(value, known)
    text = getattr(value, "text", None)
    return _of_quantity(text) if isinstance(text, str) else None


def require_kind(expression: Expression, unit: str, known: Kinds) -> None:
    """Refuse an expression that measures something else than a unit does.

    Raises
    ------
    InputError
    """
    given, wanted = kind_of(expression, known), _unit(unit)
    if given is None or wanted is None:
        return
    reason = difference(given, wanted)
    if reason is not None:
        raise InputError(reason or f"it measures something else, in {si_unit(given)}")
