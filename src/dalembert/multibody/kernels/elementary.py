"""Elementary functions for the complex step.

In kernels an imaginary part is a direction of differentiation, as small as 1e-30, never a physical quantity. So each
function here is exact in the real part and first order in the imaginary one. That is all that a complex step needs,
it is faster than the general complex function, and it has no branch cuts in the way.
"""

import math
from typing import Any

from numba import types
from numba.extending import overload

from dalembert.kernels.kernel import inner

#: Size of the imaginary step. Second-order terms vanish below the rounding of the first.
STEP = 1e-30


def _is_complex(kind: types.Type) -> bool:
    return isinstance(kind, types.Complex)


def _is_number(kind: types.Type) -> bool:
    """Other types have functions of their own, see :mod:`jets`."""
    return isinstance(kind, types.Number)


# In Python they take real numbers, complex ones, and jets (:mod:`jets`), which know their chain rule by ``function``.


def real(x):
    """Real part, for decisions: a branch must not see the direction of differentiation."""
    return x.real


def sin_cos(x):
    """Sine and cosine."""
    if hasattr(x, "function"):
        s, c = sin_cos(x.value)
        return x.function(s, c, -s), x.function(c, -s, -c)
    s, c = math.sin(x.real), math.cos(x.real)
    return _first_order(x, s, c), _first_order(x, c, -s)


def root(x):
    """Square root of a quantity with a positive real part."""
    if hasattr(x, "function"):
        r = root(x.value)
        return x.function(r, 0.5 / r, -0.25 / (r * r * r))
    r = math.sqrt(x.real)
    return _first_order(x, r, 0.5 / r)


def tanh(x):
    """Hyperbolic tangent."""
    if hasattr(x, "function"):
        t = tanh(x.value)
        return x.function(t, 1.0 - t * t, -2.0 * t * (1.0 - t * t))
    t = math.tanh(x.real)
    return _first_order(x, t, 1.0 - t * t)


def exponential(x):
    """Exponential function; not of jets, so not for constraints."""
    e = math.exp(x.real)
    return _first_order(x, e, e)


def logarithm(x):
    """Natural logarithm of a quantity with a positive real part; not of jets, so not for constraints."""
    return _first_order(x, math.log(x.real), 1.0 / x.real)


def angle_of(x, y):
    """Angle of the vector (x, y) in (-pi, pi]."""
    if hasattr(x, "function"):
        square = x * x + y * y
        rate = (x.value * y.first - y.value * x.first) / square.value
        second = (x.value * y.second - y.value * x.second - rate * square.first) / square.value
        return type(x)(angle_of(x.value, y.value), rate, second)
    angle = math.atan2(y.real, x.real)
    if not isinstance(x, complex):
        return angle
    square = x.real * x.real + y.real * y.real
    return complex(angle, (x.real * y.imag - y.real * x.imag) / square)


def reciprocal(x):
    """1/x, without the scaling that a general complex division does."""
    if hasattr(x, "function"):
        r = reciprocal(x.value)
        return x.function(r, -r * r, 2.0 * r * r * r)
    return _first_order(x, 1.0 / x.real, -1.0 / (x.real * x.real))


def _first_order(x: Any, value: float, slope: float) -> Any:
    """A function of x from its value and slope at the real part: exact there, first order in the imaginary one."""
    return complex(value, slope * x.imag) if isinstance(x, complex) else value


@overload(real, inline="always")
def _real(x):
    if not _is_number(x):
        return None
    return (lambda x: x.real) if _is_complex(x) else (lambda x: x)


@overload(sin_cos)
def _sin_cos(x):
    if not _is_number(x):
        return None
    if not _is_complex(x):
        return lambda x: (math.sin(x), math.cos(x))

    def complex_function(x):
        s, c = math.sin(x.real), math.cos(x.real)
        return complex(s, c * x.imag), complex(c, -s * x.imag)

    return complex_function


@overload(root)
def _root(x):
    if not _is_number(x):
        return None
    if not _is_complex(x):
        return lambda x: math.sqrt(x)

    def complex_function(x):
        s = math.sqrt(x.real)
        return complex(s, 0.5 * x.imag / s)

    return complex_function


@overload(tanh)
def _tanh(x):
    if not _is_number(x):
        return None
    if not _is_complex(x):
        return lambda x: math.tanh(x)

    def complex_function(x):
        s = math.tanh(x.real)
        return complex(s, (1.0 - s * s) * x.imag)

    return complex_function


@overload(exponential)
def _exponential(x):
    if not _is_number(x):
        return None
    if not _is_complex(x):
        return lambda x: math.exp(x)

    def complex_function(x):
        e = math.exp(x.real)
        return complex(e, e * x.imag)

    return complex_function


@overload(logarithm)
def _logarithm(x):
    if not _is_number(x):
        return None
    if not _is_complex(x):
        return lambda x: math.log(x)

    def complex_function(x):
        return complex(math.log(x.real), x.imag / x.real)

    return complex_function


@overload(angle_of)
def _angle_of(x, y):
    if not _is_number(x):
        return None
    if not _is_complex(x):
        return lambda x, y: math.atan2(y, x)

    def complex_function(x, y):
        square = x.real * x.real + y.real * y.real
        return complex(math.atan2(y.real, x.real), (x.real * y.imag - y.real * x.imag) / square)

    return complex_function


@overload(reciprocal)
def _reciprocal(x):
    if not _is_number(x):
        return None
    if not _is_complex(x):
        return lambda x: 1.0 / x

    def complex_function(x):
        inverse = 1.0 / x.real
        return complex(inverse, -x.imag * inverse * inverse)

    return complex_function


@inner
def wrapped(angle):
    """The angle moved by whole turns into (-pi, pi]."""
    turns = math.floor(real(angle) / (2.0 * math.pi) + 0.5)
    return angle - 2.0 * math.pi * turns
