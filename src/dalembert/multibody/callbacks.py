"""Functions of the user's, made callable from kernels by address, in real and in complex arithmetic."""

import ctypes
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple, cast

import numpy as np
from numba import cfunc, complex128, float64, njit, types
from numba.core.errors import NumbaError
from numba.core.registry import CPUDispatcher
from numba.np.numpy_support import carray

_C_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
_RATE_STEP = 1e-5  # s, of the differences that stand in for a rate that is not given


class Sizes(NamedTuple):
    """Numbers of the state of a marker that the function of a user force is given, and that it returns."""

    state: int
    answer: int

    @property
    def given(self) -> int:
        """Time, and the states of both markers."""
        return 1 + 2 * self.state


@dataclass
class Failures:
    """Exceptions that functions of the user's raised, with the component's name; the answer was NaN there.

    Those ``inexact`` were raised for complex numbers only: the motion does not need them, its derivatives do.
    """

    errors: list[Exception] = field(default_factory=list)
    inexact: list[Exception] = field(default_factory=list)


@dataclass(frozen=True)
class Callback:
    """Addresses for real and for complex numbers, and what keeps them alive."""

    real: int
    complex: int
    alive: tuple[Any, ...] = field(repr=False)


@contextmanager
def in_complex_numbers(strict: bool) -> Iterator[None]:
    """Whether functions of the user's that drop an imaginary part have failed; without it the tangent is less exact."""
    with warnings.catch_warnings():
        warnings.simplefilter("error" if strict else "ignore", np.exceptions.ComplexWarning)
        yield


def force_callback(function: Callable[..., Any], owner: str, failures: Failures, sizes: Sizes) -> Callback:
    """Callback of ``function(t, at, against)``, which returns a force and a torque."""
    first, last = 1 + sizes.state, sizes.given

    def plain(*functions: Callable[..., Any]) -> Callback:
        called = [lambda given, own=own: own(given[0].real, given[1:first], given[first:last]) for own in functions]
        return _plain(called[0], called[-1], sizes.given, sizes.answer, owner, failures)

    if not isinstance(function, CPUDispatcher):
        return plain(function)
    real = _compiled_force(function, float64, sizes)
    try:
        complex_state = _compiled_force(function, complex128, sizes)
        return Callback(real.address, complex_state.address, (real, complex_state))
    except NumbaError as error:
        reason = error

    def refuse(*_: Any) -> Any:
        raise TypeError("Numba cannot compile it for complex numbers") from reason

    inexact = plain(refuse, function)
    return Callback(real.address, inexact.complex, (real, inexact))


def signal_callback(
    function: Callable, rate: Callable | None, second: Callable | None, owner: str, failures: Failures
) -> Callback:
    """Callback of a function of time: value, rate and second rate."""
    h = _RATE_STEP

    def answer(given: np.ndarray) -> tuple[Any, Any, Any]:
        t = given[0].real
        value = function(t)
        if rate is not None:
            first = rate(t)
            last = second(t) if second is not None else (rate(t + h) - rate(t - h)) / (2 * h)
        else:
            ahead, behind = function(t + h), function(t - h)
            first = (ahead - behind) / (2 * h)
            last = second(t) if second is not None else (ahead - 2 * value + behind) / h**2
        return value, first, last

    return _plain(answer, answer, 1, 3, owner, failures)


def _plain(
    function: Callable[[np.ndarray], Any],
    in_real: Callable[[np.ndarray], Any],
    given: int,
    answer: int,
    owner: str,
    failures: Failures,
) -> Callback:
    def trampoline(dtype: type) -> Any:
        def call(source: int, target: int) -> None:
            values, into = _view(source, given, dtype), _view(target, answer, dtype)
            try:
                into[:] = function(values)
            except Exception as error:  # must not cross the compiled code
                error.args = (f"{error}, in the function of {owner!r}",)
                (failures.inexact if dtype is complex else failures.errors).append(error)
                into[:] = np.nan
                if dtype is complex:  # a motion needs the value only, which makes the tangent less exact
                    with suppress(Exception):
                        into[:] = in_real(np.real(values))

        return _C_FUNCTION(call)

    pair = trampoline(float), trampoline(complex)
    own, complex_model = (ctypes.cast(entry, ctypes.c_void_p).value or 0 for entry in pair)
    return Callback(own, complex_model, pair)


def _view(address: int, count: int, dtype: type) -> np.ndarray:
    buffer = (ctypes.c_double * (count * (2 if dtype is complex else 1))).from_address(address)
    return np.frombuffer(cast(Any, buffer), dtype=dtype)  # NumPy's stubs do not know ctypes' arrays


@lru_cache(maxsize=128)
def _compiled_force(function: CPUDispatcher, kind: Any, sizes: Sizes) -> Any:
    # A function that closes over a parameter may answer in complex numbers even to real ones.
    part = njit(lambda x: x.real) if kind is float64 else njit(lambda x: x)
    first, count, answers = 1 + sizes.state, sizes.given, sizes.answer

    @cfunc(types.void(types.CPointer(kind), types.CPointer(kind)))
    def call(source: Any, target: Any) -> None:
        given, into = carray(source, count), carray(target, answers)
        answer = function(given[0].real, given[1:first], given[first:count])
        into[0], into[1], into[2] = part(answer[0]), part(answer[1]), part(answer[2])
        if answers == 6:
            into[3], into[4], into[5] = part(answer[3]), part(answer[4]), part(answer[5])

    return call
