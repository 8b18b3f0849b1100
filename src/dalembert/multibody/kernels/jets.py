"""Automatic differentiation in kernels: numbers with their first and second derivative along one variable.

A jet (u, u', u'') obeys (u v)' = u' v + u v', (u v)'' = u'' v + 2 u' v' + u v'', f(u)' = f' u' and
f(u)'' = f'' u'^2 + f' u''. Along time it gives the rates of a constraint from the constraint itself; along a coordinate
it gives a column of the constraint's Jacobian. Its numbers are real, or complex with the complex step in them.
"""

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from numba import types
from numba.core import cgutils
from numba.core.typeconv.castgraph import Conversion
from numba.core.typing.templates import AbstractTemplate
from numba.core.typing.templates import infer_global as _infer_global
from numba.extending import lower_builtin, lower_cast, models, overload, register_model

from dalembert.kernels.duals import DualType
from dalembert.kernels.lanes import LanesType
from dalembert.kernels.views import intrinsic
from dalembert.multibody.kernels import elementary

infer_global: Any = _infer_global  # a decorator, unlike its type stub says
_FIELDS = ("value", "first", "second")


class Jet:
    """A number and two derivatives, in Python: for debugging, and as a reference in tests."""

    def __init__(self, value: Any, first: Any = 0.0, second: Any = 0.0) -> None:
        self.value, self.first, self.second = value, first, second

    def __add__(self, other: Any) -> "Jet":
        v = _jet(other)
        return Jet(self.value + v.value, self.first + v.first, self.second + v.second)

    def __neg__(self) -> "Jet":
        return Jet(-self.value, -self.first, -self.second)

    def __sub__(self, other: Any) -> "Jet":
        return self + -_jet(other)

    def __rsub__(self, other: Any) -> "Jet":
        return _jet(other) + -self

    def __mul__(self, other: Any) -> "Jet":
        u, v = self, _jet(other)
        second = u.second * v.value + 2.0 * u.first * v.first + u.value * v.second
        return Jet(u.value * v.value, u.first * v.value + u.value * v.first, second)

    def __truediv__(self, other: Any) -> "Jet":
        return self * elementary.reciprocal(_jet(other))

    def __rtruediv__(self, other: Any) -> "Jet":
        return _jet(other) * elementary.reciprocal(self)

    @staticmethod
    def of_jets(function: Callable, *given: Any) -> Any:
        """An elementary function of jets."""
        return _RULES[function](*given)

    @property
    def real(self) -> Any:
        """Real part of the number, for decisions."""
        return elementary.real(self.value)

    __radd__, __rmul__ = __add__, __mul__


class JetVector:
    """Three vectors: numbers and two derivatives of each, in Python."""

    def __init__(self, *vectors: np.ndarray) -> None:
        self.vectors = vectors

    def __getitem__(self, i: int) -> Jet:
        return Jet(*(vector[i] for vector in self.vectors))

    def __setitem__(self, i: int, u: Any) -> None:
        own = _jet(u)
        for vector, part in zip(self.vectors, (own.value, own.first, own.second), strict=True):
            vector[i] = part


def _jet(value: Any) -> Jet:
    return value if isinstance(value, Jet) else Jet(value)


class JetType(types.Type):
    """A number and two derivatives."""

    def __init__(self, base: types.Type) -> None:
        self.base = base
        super().__init__(f"Jet({base})")

    def unify(self, typingctx: Any, other: types.Type) -> types.Type | None:
        return self if isinstance(other, types.Number | DualType | LanesType) else None

    def can_convert_from(self, typingctx: Any, other: types.Type) -> Conversion | None:
        return Conversion.safe if isinstance(other, types.Number | DualType | LanesType) else None


class JetVectorType(types.Type):
    """Three vectors: numbers and two derivatives of each."""

    def __init__(self, array: types.Array) -> None:
        self.array, self.jet = array, JetType(array.dtype)
        super().__init__(f"JetVector({array})")


@register_model(JetType)
class _JetModel(models.StructModel):
    def __init__(self, manager: Any, kind: JetType) -> None:
        super().__init__(manager, kind, [(name, kind.base) for name in _FIELDS])


@register_model(JetVectorType)
class _JetVectorModel(models.StructModel):
    def __init__(self, manager: Any, kind: JetVectorType) -> None:
        super().__init__(manager, kind, [(name, kind.array) for name in _FIELDS])


def _struct(context: Any, builder: Any, kind: types.Type, values: Any) -> Any:
    own = cgutils.create_struct_proxy(kind)(context, builder)
    for name, value in zip(_FIELDS, values, strict=True):
        setattr(own, name, value)
    return own._getvalue()


def _parts(context: Any, builder: Any, kind: types.Type, value: Any) -> list[Any]:
    own = cgutils.create_struct_proxy(kind)(context, builder, value=value)
    return [getattr(own, name) for name in _FIELDS]


@intrinsic(JetVector)
def jets(typingctx, value, first, second):
    """A vector of jets, from three vectors."""
    kind = JetVectorType(value)
    return kind(value, value, value), lambda context, builder, signature, parts: _struct(context, builder, kind, parts)


@intrinsic(Jet)
def jet(typingctx, value, first, second):
    """A jet, from three numbers."""
    kind = JetType(value)
    return kind(value, value, value), lambda context, builder, signature, parts: _struct(context, builder, kind, parts)


@intrinsic(lambda u: (u.value, u.first, u.second))
def parts(typingctx, u):
    """Number, first and second derivative of a jet."""
    answer = types.UniTuple(u.base, 3)

    def generate(context, builder, signature, arguments):
        return context.make_tuple(builder, answer, _parts(context, builder, u, arguments[0]))

    return answer(u), generate


@lower_cast(types.Number, JetType)
@lower_cast(DualType, JetType)
@lower_cast(LanesType, JetType)
def _constant(context: Any, builder: Any, source: Any, target: Any, value: Any) -> Any:
    zero = context.get_constant_null(target.base)
    return _struct(context, builder, target, [context.cast(builder, value, source, target.base), zero, zero])


# -- entries of vectors ----------------------------------------------------------------------------------------------


@overload(operator.getitem)
def _getitem(vector, i):
    if isinstance(vector, JetVectorType):
        return lambda vector, i: _entry(vector, i)
    return None


@intrinsic(lambda vector, i: vector[i])
def _entry(typingctx, vector, i):
    def generate(context, builder, signature, arguments):
        read = context.get_function(operator.getitem, vector.array.dtype(vector.array, i))
        arrays = _parts(context, builder, vector, arguments[0])
        return _struct(context, builder, vector.jet, [read(builder, [array, arguments[1]]) for array in arrays])

    return vector.jet(vector, i), generate


@overload(operator.setitem)
def _setitem(vector, i, u):
    if isinstance(vector, JetVectorType):
        return lambda vector, i, u: _put(vector, i, u)
    return None


@intrinsic(JetVector.__setitem__)
def _put(typingctx, vector, i, u):
    def generate(context, builder, signature, arguments):
        write = context.get_function(operator.setitem, types.none(vector.array, i, vector.array.dtype))
        arrays = _parts(context, builder, vector, arguments[0])
        for array, value in zip(arrays, _parts(context, builder, vector.jet, arguments[2]), strict=True):
            write(builder, [array, arguments[1], value])
        return context.get_dummy_value()

    return types.none(vector, i, vector.jet), generate


# -- arithmetic ------------------------------------------------------------------------------------------------------


def _binary(symbol: Any, rules: dict[str, Any]) -> None:
    """Let an operator take jets: ``rules`` for two jets, a jet and a number, a number and a jet.

    A rule gets the operations on numbers and the parts of both, and returns the parts of the result.
    """

    @infer_global(symbol)
    class Template(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            found = [kind for kind in args if isinstance(kind, JetType)]
            if len(args) != 2 or not found:
                return None
            own = [kind if isinstance(kind, JetType) else found[0].base for kind in args]
            return found[0](*own)

    def lower(rule: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            base = signature.return_type.base
            given = [
                _parts(context, builder, kind, value) if isinstance(kind, JetType) else value
                for kind, value in zip(signature.args, arguments, strict=True)
            ]
            numbers = _Numbers(context, builder, base)
            return _struct(context, builder, signature.return_type, rule(numbers, *given))

        return generate

    lower_builtin(symbol, JetType, JetType)(lower(rules["jets"]))
    # A plain number beside a jet of dual numbers is cast to a dual one.
    for number in (types.Number, DualType, LanesType):
        lower_builtin(symbol, JetType, number)(lower(rules["jet, number"]))
        lower_builtin(symbol, number, JetType)(lower(rules["number, jet"]))


class _Numbers:
    """Operations on the numbers of jets, generated."""

    def __init__(self, context: Any, builder: Any, base: types.Type) -> None:
        self._context, self._builder, self._base = context, builder, base

    def __call__(self, symbol: Any, *values: Any) -> Any:
        function = self._context.get_function(symbol, self._base(*[self._base] * len(values)))
        return function(self._builder, list(values))


def _by_parts(symbol: Any) -> Any:
    return lambda n, u, v: [n(symbol, a, b) for a, b in zip(u, v, strict=True)]


def _multiply(n: _Numbers, u: list, v: list) -> list:
    across = n(operator.mul, u[1], v[1])
    ends = n(operator.add, n(operator.mul, u[2], v[0]), n(operator.mul, u[0], v[2]))
    first = n(operator.add, n(operator.mul, u[1], v[0]), n(operator.mul, u[0], v[1]))
    return [n(operator.mul, u[0], v[0]), first, n(operator.add, ends, n(operator.add, across, across))]


_binary(
    operator.add,
    {
        "jets": _by_parts(operator.add),
        "jet, number": lambda n, u, s: [n(operator.add, u[0], s), *u[1:]],
        "number, jet": lambda n, s, u: [n(operator.add, s, u[0]), *u[1:]],
    },
)
_binary(
    operator.sub,
    {
        "jets": _by_parts(operator.sub),
        "jet, number": lambda n, u, s: [n(operator.sub, u[0], s), *u[1:]],
        "number, jet": lambda n, s, u: [n(operator.sub, s, u[0]), *(n(operator.neg, part) for part in u[1:])],
    },
)
_binary(
    operator.mul,
    {
        "jets": _multiply,
        "jet, number": lambda n, u, s: [n(operator.mul, part, s) for part in u],
        "number, jet": lambda n, s, u: [n(operator.mul, s, part) for part in u],
    },
)


@infer_global(operator.neg)
class _NegTemplate(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return args[0](args[0]) if isinstance(args[0], JetType) else None


@lower_builtin(operator.neg, JetType)
def _negate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    kind = signature.return_type
    numbers = _Numbers(context, builder, kind.base)
    values = [numbers(operator.neg, part) for part in _parts(context, builder, kind, arguments[0])]
    return _struct(context, builder, kind, values)


@overload(operator.truediv)
def _divide(u, v):
    if isinstance(u, JetType) or isinstance(v, JetType):
        return lambda u, v: u * elementary.reciprocal(v)
    return None


# -- functions -------------------------------------------------------------------------------------------------------


@overload(elementary.real)
def _real(x):
    return (lambda x: elementary.real(parts(x)[0])) if isinstance(x, JetType) else None


_RULES: dict[Callable, Callable] = {}


def _rule_of(function: Callable) -> Callable[[Callable], Callable]:
    """Let an elementary function take jets: by the decorated function, in kernels and in Python."""

    def declared(rule: Callable) -> Callable:
        _RULES[function] = rule
        overload(function, strict=False)(lambda *given: rule if isinstance(given[0], JetType) else None)
        return rule

    return declared


@_rule_of(elementary.reciprocal)
def _reciprocal(x):
    u, first, second = parts(x)
    r = elementary.reciprocal(u)
    square = r * r
    return jet(r, -first * square, (2.0 * first * first * r - second) * square)


@_rule_of(elementary.sin_cos)
def _sin_cos(x):
    u, first, second = parts(x)
    s, c = elementary.sin_cos(u)
    square = first * first
    return jet(s, c * first, c * second - s * square), jet(c, -s * first, -s * second - c * square)


@_rule_of(elementary.root)
def _root(x):
    u, first, second = parts(x)
    r = elementary.root(u)
    half = 0.5 * elementary.reciprocal(r)
    rate = first * half
    return jet(r, rate, (second - 2.0 * rate * rate) * half)


@_rule_of(elementary.tanh)
def _tanh(x):
    u, first, second = parts(x)
    t = elementary.tanh(u)
    slope = 1.0 - t * t
    return jet(t, slope * first, slope * (second - 2.0 * t * first * first))


@_rule_of(elementary.angle_of)
def _angle_of(x, y):
    u, du, ddu = parts(x)
    w, dw, ddw = parts(y)
    inverse = elementary.reciprocal(u * u + w * w)
    rate = (u * dw - w * du) * inverse
    second = (u * ddw - w * ddu - 2.0 * rate * (u * du + w * dw)) * inverse
    return jet(elementary.angle_of(u, w), rate, second)
