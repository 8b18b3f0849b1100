"""Elementary functions that carry a complex step, for functions that build models and for forces.

Derivatives by a parameter come from a complex step: the parameter gets an imaginary part of 1e-30, and the derivative
is the imaginary part of the result. NumPy's ``abs``, ``norm`` and ``angle`` drop it, and ``hypot`` and ``arctan2``
refuse complex numbers. The functions here take real and complex numbers or arrays and decide by real parts. They are
exact in the real part and in the first order of the imaginary one.
"""

from typing import Any

import numpy as np


def absolute(x: Any) -> Any:
    """Absolute value of a number or an array; its derivative at 0 is 1.

    Examples
    --------
    >>> absolute(-2.0)
    2.0
    >>> absolute(-2.0 + 1e-30j).imag
    -1e-30
    """
    return np.where(np.real(x) < 0, -np.asarray(x), x)[()] if np.ndim(x) else (-x if np.real(x) < 0 else x)


def hypot(x: Any, y: Any) -> Any:
    """Length (x² + y²)^½ of the vector (x, y); numbers or arrays.

    Examples
    --------
    >>> hypot(3.0, 4.0)
    5.0
    >>> print(f"{hypot(3.0 + 1e-30j, 4.0).imag:.3g}")
    6e-31
    """
    value = np.hypot(np.real(x), np.real(y))
    if not (np.iscomplexobj(x) or np.iscomplexobj(y)):
        return value if np.ndim(value) else float(value)
    slope = np.real(x) * np.imag(x) + np.real(y) * np.imag(y)
    return value + 1j * np.divide(slope, value, out=np.zeros_like(slope * 1.0), where=value != 0)


def norm(x: Any) -> Any:
    """Euclidean length of a vector.

    Examples
    --------
    >>> norm([1.0, 2.0, 2.0])
    3.0
    >>> print(f"{norm([1.0, 2.0, 2.0 + 3e-30j]).imag:.3g}")
    2e-30
    """
    x = np.asarray(x)
    value = float(np.linalg.norm(np.real(x)))
    if not np.iscomplexobj(x):
        return value
    return complex(value, float(np.real(x) @ np.imag(x)) / value if value else 0.0)


def atan2(y: Any, x: Any) -> Any:
    """Angle of the vector (x, y) in (-π, π], rad; numbers or arrays.

    Examples
    --------
    >>> round(atan2(1.0, -1.0), 6)
    2.356194
    >>> print(f"{atan2(1e-30j, 2.0).imag:.3g}")
    5e-31
    """
    value = np.arctan2(np.real(y), np.real(x))
    if not (np.iscomplexobj(x) or np.iscomplexobj(y)):
        return value if np.ndim(value) else float(value)
    square = np.real(x) ** 2 + np.real(y) ** 2
    slope = np.real(x) * np.imag(y) - np.real(y) * np.imag(x)
    return value + 1j * np.divide(slope, square, out=np.zeros_like(slope * 1.0), where=square != 0)
