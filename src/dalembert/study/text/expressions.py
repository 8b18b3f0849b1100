"""Arithmetic where a study file expects a number, ``"0.5*L"``, ``"pi/4"``: its value and the unit of its value."""

import ast
import cmath
import math
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.elementary import absolute, atan2, hypot
from dalembert.errors import InputError, unknown
from dalembert.unit_table import Unit, readings
from dalembert.units import difference, is_quantity, si_unit, symbol


class _Domain(ValueError):
    """An argument for which a function has no value."""


def _asin(x: Any) -> Any:
    if abs(np.real(x)) > 1:
        raise _Domain(f"an arc sine or cosine takes numbers from -1 to 1, and got {np.real(x):g}")
    value = np.arcsin(np.real(x))
    return value + 1j * np.imag(x) / np.sqrt(1 - np.real(x) ** 2) if np.iscomplexobj(x) else value


def _log(x: Any) -> Any:
    if not np.real(x) > 0:
        raise _Domain(f"a logarithm takes positive numbers, and got {np.real(x):g}")
    return np.log(x)


FUNCTIONS: dict[str, Callable] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": _asin,
    "acos": lambda x: np.pi / 2 - _asin(x),
    "sqrt": np.sqrt,
    "exp": np.exp,
    "log": _log,
    "abs": absolute,
}
OF_TWO: dict[str, Callable] = {"atan2": atan2, "hypot": hypot}
"""Functions of two numbers; ``atan2(y, x)`` is the angle of the vector (x, y)."""
CONSTANTS = {"pi": math.pi}
RESERVED = frozenset(FUNCTIONS) | frozenset(OF_TWO) | frozenset(CONSTANTS)
_BINARY: dict[type, Callable] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
_UNARY: dict[type, Callable] = {ast.UAdd: operator.pos, ast.USub: operator.neg}
_LONGEST = 500


@dataclass(frozen=True)
class Expression:
    """Arithmetic in named numbers, which may be complex: ``+ - * / **``, brackets, functions and pi. The functions are
    sin, cos, tan, asin, acos, sqrt, exp, log, abs, and of two numbers atan2 (y, then x) and hypot. In complex numbers
    they decide by real parts and carry the complex step.
    """

    text: str
    names: frozenset[str]
    tree: ast.expr = field(repr=False, compare=False)

    def __str__(self) -> str:
        return self.text

    @classmethod
    def of(cls, text: str) -> "Expression":
        """Expression read from text."""
        text = text.strip()
        if len(text) > _LONGEST:
            raise InputError(f"an expression of {len(text)} characters was given; expected at most {_LONGEST}")
        try:
            tree = ast.parse(text, mode="eval").body
            return cls(text, frozenset(_names(tree)), tree)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise InputError(f"{text!r} is no arithmetic expression; expected for example '2*pi/3*sqrt(k/m)'") from None

    def __call__(self, values: Mapping[str, complex]) -> complex:
        """Value for named numbers; a float where all of them are real."""
        try:
            with np.errstate(all="ignore"):
                value = _value(self.tree, values)
        except (ZeroDivisionError, OverflowError) as error:
            raise InputError(f"{self.text!r} has no value: {error}") from None
        except _Domain as error:
            raise InputError(f"{self.text!r} has no value{_at(self.names, values)}: {error}") from None
        real = not any(np.iscomplexobj(values[name]) for name in self.names)
        if not cmath.isfinite(value) or (real and np.iscomplexobj(value)):
            raise InputError(f"{self.text!r} is not a finite real number{_at(self.names, values)}")
        return float(value.real) if real else complex(value)


def resolved(number: float | Expression, values: Mapping[str, Any], where: str) -> complex:
    """Return a number; that of an expression at values of its names."""
    try:
        return number(values) if isinstance(number, Expression) else number
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _names(node: ast.expr) -> set[str]:
    match node:
        case ast.Constant(value=bool()):
            pass
        case ast.Constant(value=int() | float()):
            return set()
        case ast.Name(id=name) if name not in FUNCTIONS and name not in OF_TWO:
            return set() if name in CONSTANTS else {name}
        case ast.UnaryOp(op=op, operand=operand) if type(op) in _UNARY:
            return _names(operand)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            return _names(left) | _names(right)
        case ast.Call(func=ast.Name(id=name), args=[_] | [_, _] as arguments, keywords=[]):
            if name not in FUNCTIONS and name not in OF_TWO:
                raise InputError(unknown("function", name, [*FUNCTIONS, *OF_TWO]))
            if (len(arguments) == 2) == (name in OF_TWO):
                return set[str]().union(*map(_names, arguments))
    raise InputError(
        f"{ast.unparse(node)!r} is not offered in an expression; expected names and numbers with "
        f"+ - * / ** and brackets, {', '.join(FUNCTIONS)}, {' and '.join(OF_TWO)} of two numbers, and pi"
    )


def _value(node: ast.expr, values: Mapping[str, complex]) -> complex:
    match node:
        case ast.Constant(value=int() | float() as number):
            return float(number)  # no integers, so that no power of theirs grows without bound
        case ast.Name(id=name):
            return CONSTANTS[name] if name in CONSTANTS else values[name]
        case ast.UnaryOp(op=op, operand=operand):
            return _UNARY[type(op)](_value(operand, values))
        case ast.BinOp(left=left, op=op, right=right):
            return _BINARY[type(op)](_value(left, values), _value(right, values))
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return (FUNCTIONS | OF_TWO)[name](*(_value(argument, values) for argument in arguments))
    raise AssertionError(f"{ast.dump(node)} passed the check of names")


def _at(names: frozenset[str], values: Mapping[str, complex]) -> str:
    return " for " + ", ".join(f"{name} = {values[name]}" for name in sorted(names)) if names else ""


Kinds = Mapping[str, Unit | None]
"""Units of named numbers; None where a number has none."""

OF_BOUNDS = ("lower", "upper", "start", "scale", "deviation")
"""Keys of a parameter whose numbers may have its unit with them."""


def kinds_of(document: Mapping[str, Any], names: Iterable[str], series: Mapping[str, Iterable[str]]) -> Kinds:
    """Return the units of the parameters and constants of a document; ``series`` are those that share a table."""
    units: dict[str, Unit | None] = dict.fromkeys(names)
    for name, table in _tables(document, "parameters"):
        for member in series.get(name, (name,)):
            units[member] = _of_parameter(table) if isinstance(table, Mapping) else None
    for name, value in _tables(document, "constants"):
        units[name] = _of_constant(value, units)
    return units


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
    >>> known = {"L": readings("m")[0], "F": readings("N")[0]}
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
            first, second = _kind(left, known), _kind(right, known)
            if first is not None and second is not None and difference(first, second) is not None:
                raise InputError(f"{ast.unparse(node)!r} adds quantities of different kinds")
            return first or second
        case ast.BinOp(left=left, op=ast.Mult() | ast.Div() as operation, right=right):
            first, second = _kind(left, known), _kind(right, known)
            if first is None or second is None:
                return None
            return first * second ** (1 if isinstance(operation, ast.Mult) else -1)
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
    """Refuse an expression that measures something else than a unit does."""
    unit_here, wanted = kind_of(expression, known), _unit(unit)
    if unit_here is None or wanted is None or unit_here == wanted:
        return
    reason = difference(unit_here, wanted)
    if reason is not None:
        raise InputError(reason or f"it measures something else, in {si_unit(unit_here)}")
