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
from dalembert.kernels.kernel import inlined, inner
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


@overload(real)
def _real(x):
    if not isinstance(x, types.Number | DualType | LanesType):
        return None
    return (lambda x: x.real) if isinstance(x, types.Complex | DualType) else (lambda x: x)


def where(condition, a, b):
    """Return a where the condition holds, else b: in place of a branch on the state, which lanes cannot take.

    Both are evaluated; what is not a number in the other one does not matter.
    """
    return a if condition else b


@overload(where, strict=False)
def _where(condition, a, b):
    if isinstance(condition, MaskType):
        return lambda condition, a, b: select(condition, a, b)
    return where


def is_any(condition):
    """Return whether a condition holds; of lanes, whether it does in one of them."""
    return condition


@overload(is_any)
def _is_any(condition):
    return (lambda condition: any_lane(condition)) if isinstance(condition, MaskType) else lambda condition: condition


def is_zero(number):
    """Return whether a number of a component is zero, with its derivatives.

    A branch may depend on this, in lanes too: samples side by side share their zero numbers.
    """
    return number == 0.0


@overload(is_zero)
def _is_zero(number):
    if isinstance(number, LanesType):
        return lambda number: first_is_zero(number)
    return lambda number: number == 0.0


def size_of(x):
    """Return the absolute value of the real part, for decisions."""
    return abs(x.real)


@overload(size_of)
def _size(x):
    return (lambda x: sizes(x)) if isinstance(x, LanesType) else lambda x: abs(x.real)


def chained(x, value, slope):
    """Return f(x) for its value and its slope f' at the value of ``x``: the chain rule."""
    return complex(value, slope * x.imag)


@overload(chained)
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


@inlined
def _sine_and_cosine(x):
    """Sine and cosine below `_LARGE`, of a real number or of lanes, by the same operations in the same order.

    x = k pi/2 + r + tail with |r| <= pi/4, pi/2 in three parts, so that the products with k are exact (Cody and Waite
    1980); then polynomials in r^2 (`_SINE`, `_COSINE`). Errors are below one unit in the last place. In contrast to the
    system's functions, the bits are the same on every processor.
    """
    k = 1.0 * math.floor(x * _TWO_OVER_PI + 0.5)
    first = x - k * _HALF_PI[0]
    second = k * _HALF_PI[1]
    near = first - second
    # What rounding took off the difference goes to the tail.
    rest = k * _HALF_PI[2] - ((first - near) - second)
    r = near - rest
    tail = (near - r) - rest
    z = r * r
    cube = z * r
    polynomial = _SINE[1] + z * (_SINE[2] + z * (_SINE[3] + z * (_SINE[4] + z * _SINE[5])))
    s = r - ((z * (0.5 * tail - cube * polynomial) - tail) - cube * _SINE[0])
    polynomial = _COSINE[1] + z * (_COSINE[2] + z * (_COSINE[3] + z * (_COSINE[4] + z * _COSINE[5])))
    half = 0.5 * z
    c = 1.0 - half
    c = c + (((1.0 - c) - half) + (z * (z * (_COSINE[0] + z * polynomial)) - r * tail))
    # The quadrant exchanges sine and cosine, and turns their signs.
    quadrant = k - 4.0 * math.floor(0.25 * k)
    is_odd = quadrant - 2.0 * math.floor(0.5 * quadrant) == 1.0
    sine, cosine = where(is_odd, c, s), where(is_odd, s, c)
    return where(quadrant >= 2.0, -sine, sine), where(size_of(quadrant - 1.5) < 1.0, -cosine, cosine)


_LARGE = 1e6  # rad, above which the products with k are no more exact
_TWO_OVER_PI = 2.0 / math.pi
_HALF_PI = 1.57079632673412561417, 6.07710050630396597660e-11, 2.02226624879595063154e-21
#: Minimax polynomials on [-pi/4, pi/4]: coefficients of Sun Microsystems' fdlibm (1993), k_sin.c and k_cos.c.
_SINE = (
    -1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04,
    2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10,
)  # fmt: skip
_COSINE = (
    4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05,
    -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11,
)  # fmt: skip


@inner
def _sin_cos_of_reals(x):
    if abs(x) < _LARGE:
        return _sine_and_cosine(x)
    return math.sin(x), math.cos(x)


def _sin_cos_of_lanes(x):
    s, c = _sine_and_cosine(x)
    if is_any(sizes(x) >= _LARGE):
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


@_elementary(lambda x: _sin_cos_of_reals(x), _sin_cos_of_lanes)
def sin_cos(x):
    """Sine and cosine, with the same bits on every processor."""
    s, c = _sin_cos_of_reals(x.real)
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
