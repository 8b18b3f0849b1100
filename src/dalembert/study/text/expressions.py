"""Arithmetic that a study file may write where a number stands: ``"0.5*L"``, ``"-theta1"``, ``"pi/4"``."""

import ast
import cmath
import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.elementary import absolute, atan2, hypot
from dalembert.errors import InputError, unknown


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
    """Arithmetic in named numbers, which may be complex: ``+ - * / **``, brackets, functions and pi.

    The functions are sin, cos, tan, asin, acos, sqrt, exp, log, abs, and of two numbers atan2 (y, then x) and hypot. In
    complex numbers they decide by real parts and carry the complex step.

    Examples
    --------
    >>> half = Expression.of("0.5*L*cos(angle)")
    >>> sorted(half.names)
    ['L', 'angle']
    >>> half({"L": 2.0, "angle": 0.0})
    1.0
    >>> Expression.of("x**2")({"x": 3 + 1e-30j}).imag / 1e-30
    6.0
    """

    text: str
    names: frozenset[str]
    tree: ast.expr = field(repr=False, compare=False)

    def __str__(self) -> str:
        return self.text

    @classmethod
    def of(cls, text: str) -> "Expression":
        """Expression read from text.

        Raises
        ------
        InputError
            If it is not arithmetic, or uses something that is not offered.
        """
        text = text.strip()
        if len(text) > _LONGEST:
            raise InputError(f"an expression of {len(text)} characters was given; expected at most {_LONGEST}")
        try:
            tree = ast.parse(text, mode="eval").body
            return cls(text, frozenset(_names(tree)), tree)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise InputError(f"{text!r} is no arithmetic expression") from None

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
