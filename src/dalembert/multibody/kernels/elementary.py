"""Elementary functions for the complex step and for dual numbers.

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

#: Size of the imaginary step. Second-order terms vanish below the rounding of the first.
STEP = 1e-30


def real(x):
    """Real part, for decisions: a branch must not see the direction of differentiation."""
    return x.real


@overload(real, inline="always")
def _real(x):
    if not isinstance(x, types.Number | DualType):
        return None
    return (lambda x: x.real) if isinstance(x, types.Complex | DualType) else (lambda x: x)


def chained(x, value, slope):
    """Return f(x) for its value and its slope f' at the value of ``x``: the chain rule."""
    return complex(value, slope * x.imag)


@overload(chained, inline="always")
def _chained(x, value, slope):
    if isinstance(x, DualType):
        return lambda x, value, slope: chained_dual(x, value, slope)
    return lambda x, value, slope: complex(value, slope * x.imag)


def _elementary(of_reals: Callable) -> Callable[[Callable], Callable]:
    """Declare a function by its formula for real numbers, and by the decorated one, for complex and dual numbers.

    Kernels and Python use both. Of jets (:mod:`jets`) the function is what their module declares.
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
            return of_reals if isinstance(given[0], types.Number) else None

        return function

    return declared


@_elementary(lambda x: (math.sin(x), math.cos(x)))
def sin_cos(x):
    """Sine and cosine."""
    s, c = math.sin(x.real), math.cos(x.real)
    return chained(x, s, c), chained(x, c, -s)


@_elementary(lambda x: math.sqrt(x))
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


@_elementary(lambda x, y: math.atan2(y, x))
def angle_of(x, y):
    """Angle of the vector (x, y) in (-pi, pi]."""
    # d atan2(y, x) = (x dy - y dx) / (x^2 + y^2)
    inverse = 1.0 / (x.real * x.real + y.real * y.real)
    return chained(y, math.atan2(y.real, x.real), x.real * inverse) + chained(x, 0.0, -y.real * inverse)


@_elementary(lambda x: 1.0 / x)
def reciprocal(x):
    """1/x, without the scaling that a general complex division does."""
    inverse = 1.0 / x.real
    return chained(x, inverse, -inverse * inverse)


@inner
def wrapped(angle):
    """The angle moved by whole turns into (-pi, pi]."""
    turns = math.floor(real(angle) / (2.0 * math.pi) + 0.5)
    return angle - 2.0 * math.pi * turns
