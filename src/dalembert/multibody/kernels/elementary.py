"""Elementary functions for the complex step, for dual numbers and for lanes.

In kernels an imaginary part is a direction of differentiation, as small as 1e-30, never a physical quantity. So each
function here is exact in the real part and first order in the imaginary one. That is all that a complex step needs,
it is faster than the general complex function, and it has no branch cuts in the way.
"""

import math
from collections.abc import Callable
from functools import wraps
from typing import Any

from numba import types
from numba.extending import overload

from dalembert.kernels.duals import DualType
from dalembert.kernels.duals import chained as chained_dual
from dalembert.kernels.kernel import inner
from dalembert.kernels.lanes import (
    WIDTH,
    LanesType,
    MaskType,
    any_lane,
    entry,
    first_is_zero,
    select,
    sizes,
    vector_root,
    with_entry,
)

#: Size of the imaginary step. Second-order terms vanish below the rounding of the first.
STEP = 1e-30


def real(x):
    """Real part, for decisions: a branch must not see the direction of differentiation."""
    return x.real


@overload(real, inline="always")
def _real(x):
    if not isinstance(x, types.Number | DualType | LanesType):
        return None
    return (lambda x: x.real) if isinstance(x, types.Complex | DualType) else (lambda x: x)


def where(condition, a, b):
    """Return a where the condition holds, else b: in place of a branch on the state, which lanes cannot take.

    Both are evaluated; what is not a number in the other one does not matter.
    """
    return a if condition else b


@overload(where, inline="always")
def _where(condition, a, b):
    if isinstance(condition, MaskType):
        return lambda condition, a, b: select(condition, a, b)
    return lambda condition, a, b: a if condition else b


def is_any(condition):
    """Return whether a condition holds; of lanes, whether it does in one of them."""
    return condition


@overload(is_any, inline="always")
def _is_any(condition):
    return (lambda condition: any_lane(condition)) if isinstance(condition, MaskType) else lambda condition: condition


def is_zero(number):
    """Return whether a number of a component is zero, with its derivatives.

    A branch may depend on this, in lanes too: samples side by side share their zero numbers.
    """
    return number == 0.0


@overload(is_zero, inline="always")
def _is_zero(number):
    if isinstance(number, LanesType):
        return lambda number: first_is_zero(number)
    return lambda number: number == 0.0


def size_of(x):
    """Return the absolute value of the real part, for decisions."""
    return abs(x.real)


@overload(size_of, inline="always")
def _size(x):
    return (lambda x: sizes(x)) if isinstance(x, LanesType) else lambda x: abs(x.real)


def chained(x, value, slope):
    """Return f(x) for its value and its slope f' at the value of ``x``: the chain rule."""
    return complex(value, slope * x.imag)


@overload(chained, inline="always")
def _chained(x, value, slope):
    if isinstance(x, DualType):
        return lambda x, value, slope: chained_dual(x, value, slope)
    return lambda x, value, slope: complex(value, slope * x.imag)


def lane_by_lane(function: Any) -> Callable:
    """A function of lanes: that of real numbers in each lane, so that its bits are the same."""

    def mapped(x):
        y = x
        for lane in range(WIDTH):
            y = with_entry(y, lane, function(entry(x, lane)))
        return y

    return mapped


def _sin_cos_of_lanes(x):
    # The library's vector functions have other roundings than the scalar ones: each lane takes the scalar function.
    s, c = x, x
    for lane in range(WIDTH):
        sine, cosine = sin_cos(entry(x, lane))
        s, c = with_entry(s, lane, sine), with_entry(c, lane, cosine)
    return s, c


def _angle_of_lanes(x, y):
    angle = x
    for lane in range(WIDTH):
        angle = with_entry(angle, lane, angle_of(entry(x, lane), entry(y, lane)))
    return angle


def _elementary(of_reals: Callable, of_lanes: Callable | None = None) -> Callable[[Callable], Callable]:
    """Declare a function by its formula for real numbers, and by the decorated one, for complex and dual numbers.

    Kernels and Python use both. In lanes it is that of real numbers lane by lane, or ``of_lanes``. Of jets
    (:mod:`jets`) the function is what their module declares.
    """

    def declared(with_slopes: Callable) -> Callable:
        @wraps(with_slopes)
        def function(*given: Any) -> Any:
            if hasattr(given[0], "of_jets"):
                return given[0].of_jets(function, *given)
            return with_slopes(*given) if isinstance(given[0], complex) else of_reals(*given)

        @overload(function, strict=False)
        def compiled(*given):
            if isinstance(given[0], types.Complex | DualType):
                return with_slopes
            if isinstance(given[0], LanesType):
                return of_lanes or lane_by_lane(function)
            return of_reals if isinstance(given[0], types.Number) else None

        return function

    return declared


@_elementary(lambda x: (math.sin(x), math.cos(x)), _sin_cos_of_lanes)
def sin_cos(x):
    """Sine and cosine."""
    s, c = math.sin(x.real), math.cos(x.real)
    return chained(x, s, c), chained(x, c, -s)


@_elementary(lambda x: math.sqrt(x), lambda x: vector_root(x))
def root(x):
    """Square root of a quantity with a positive real part."""
    s = math.sqrt(x.real)
    return chained(x, s, 0.5 / s)


@_elementary(lambda x: math.tanh(x))
def tanh(x):
    """Hyperbolic tangent."""
    s = math.tanh(x.real)
    # tanh' = 1 - tanh^2
    return chained(x, s, 1.0 - s * s)


@_elementary(lambda x: math.exp(x))
def exponential(x):
    """Exponential function; not of jets, so not for constraints."""
    e = math.exp(x.real)
    return chained(x, e, e)


@_elementary(lambda x: math.log(x))
def logarithm(x):
    """Natural logarithm of a quantity with a positive real part; not of jets, so not for constraints."""
    return chained(x, math.log(x.real), 1.0 / x.real)


@_elementary(lambda x, y: math.atan2(y, x), _angle_of_lanes)
def angle_of(x, y):
    """Angle of the vector (x, y) in (-pi, pi]."""
    # d atan2(y, x) = (x dy - y dx) / (x^2 + y^2)
    inverse = 1.0 / (x.real * x.real + y.real * y.real)
    return chained(y, math.atan2(y.real, x.real), x.real * inverse) + chained(x, 0.0, -y.real * inverse)


@_elementary(lambda x: 1.0 / x, lambda x: 1.0 / x)
def reciprocal(x):
    """1/x, without the scaling that a general complex division does."""
    inverse = 1.0 / x.real
    return chained(x, inverse, -inverse * inverse)


@inner
def wrapped(angle):
    """The angle moved by whole turns into (-pi, pi]."""
    turns = math.floor(real(angle) / (2.0 * math.pi) + 0.5)
    return angle - 2.0 * math.pi * turns
