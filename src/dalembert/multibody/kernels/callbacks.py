"""Functions of the user's, made callable from kernels by address, in real and in complex arithmetic.

What they return is checked: None, another count of numbers, or a number that is not finite for finite arguments is an
error with the name of the component.
"""

import ctypes
import warnings
from cmath import isfinite
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numba import cfunc, complex128, float64, njit, types
from numba.core.errors import NumbaError
from numba.core.registry import CPUDispatcher
from numba.np.numpy_support import carray

from dalembert.arguments import is_number
from dalembert.errors import InputError, SolveError, shown
from dalembert.kernels.views import reals

_NO_TIME = -np.inf  # of a compiled function that returned finite numbers so far
_C_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
_RATE_STEP = 1e-5  # s, of the differences that stand in for a rate that is not given


class AnswerError(InputError):
    """A function of the user's returned something other than finite numbers."""


class Sizes(NamedTuple):
    """Numbers of the state of a marker that the function of a user force is given, and that it returns, and which."""

    state: int
    answer: int
    words: str

    @property
    def given(self) -> int:
        """Time, and the states of both markers."""
        return 1 + 2 * self.state


@dataclass
class Failures:
    """Exceptions that functions of the user's raised, with the component's name; the answer was NaN there. Those
    ``inexact`` were raised for complex numbers only: the motion does not need them, its derivatives do. Compiled
    functions have the time at which they last returned numbers that are not finite, an array (1,).
    """

    errors: list[Exception] = field(default_factory=list)
    inexact: list[Exception] = field(default_factory=list)
    compiled: list[tuple[str, np.ndarray]] = field(default_factory=list)

    def after(self, time: float) -> SolveError | None:
        """The first error; else that of a compiled function that returned NaN after a time of the signals, in s."""
        for error in self.errors:
            if isinstance(error, AnswerError):
                return SolveError(str(error))
            return SolveError(f"a function of the user's failed near t = {time:.6g} s: {type(error).__name__}: {error}")
        for owner, (last,) in self.compiled:
            if last >= time - 1e-9 * abs(time):
                return SolveError(str(_wrong_answer(owner, np.nan, "finite numbers", last)))
        return None


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
        return _plain(called[0], called[-1], sizes.given, sizes.answer, sizes.words, owner, failures)

    if not isinstance(function, CPUDispatcher):
        return plain(function)
    try:
        real, wrong_at = _compiled_force(function, float64, sizes)
    except NumbaError as error:
        raise InputError(
            f"UserForce {owner!r}: its compiled function does not return {sizes.words}, or Numba cannot compile it. "
            "Run it without numba.njit to see which"
        ) from error
    # Compiled functions cannot raise: they note the time of a first wrong answer, which the run reads at its end.
    failures.compiled.append((owner, wrong_at))
    try:
        complex_state, _ = _compiled_force(function, complex128, sizes)
        return Callback(real.address, complex_state.address, (real, complex_state))
    except NumbaError as error:
        # For real numbers it runs compiled; in complex numbers a plain Python call takes its place, or refuses.
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
        if not is_number(value):
            raise _wrong_answer(owner, value, "a finite number", t)
        if rate is not None:
            first = rate(t)
            last = second(t) if second is not None else (rate(t + h) - rate(t - h)) / (2 * h)
        else:
            ahead, behind = function(t + h), function(t - h)
            # Central differences of second order: of the user's function, in complex numbers too, so that their
            # derivatives by parameters are exact.
            first = (ahead - behind) / (2 * h)
            last = second(t) if second is not None else (ahead - 2 * value + behind) / h**2
        return value, first, last

    return _plain(answer, answer, 1, 3, "three finite numbers", owner, failures)


def _plain(
    function: Callable[[np.ndarray], Any],
    in_real: Callable[[np.ndarray], Any],
    given: int,
    answer: int,
    words: str,
    owner: str,
    failures: Failures,
) -> Callback:
    def check(numbers: Any, values: np.ndarray) -> None:
        """Raise unless a function returned finite numbers; cheap, as it runs at every iteration."""
        try:
            right = len(numbers) == answer and (isfinite(sum(numbers)) or not np.isfinite(values).all())
        except (TypeError, ValueError):  # None, a number alone, or something that has no sum
            right = False
        if not right:
            raise _wrong_answer(owner, numbers, words, values[0].real)

    def trampoline(dtype: type) -> Any:
        view_given, view_answer = _view(given, dtype), _view(answer, dtype)

        def call(source: int, target: int) -> None:
            values, into = view_given(source), view_answer(target)
            try:
                numbers = function(values)
                check(numbers, values)
                into[:] = numbers
            except Exception as error:  # must not cross the compiled code
                if not isinstance(error, AnswerError):
                    error.args = (f"{error}, in the function of {owner!r}",)
                (failures.inexact if dtype is complex else failures.errors).append(error)
                into[:] = np.nan
                if dtype is complex:  # a motion needs the value only, which makes the tangent less exact
                    with suppress(Exception):
                        into[:] = in_real(np.real(values))

        return _C_FUNCTION(call)

    pair = trampoline(float), trampoline(complex)
    real_address, complex_address = (ctypes.cast(entry, ctypes.c_void_p).value or 0 for entry in pair)
    return Callback(real_address, complex_address, pair)


def _wrong_answer(owner: str, numbers: Any, expected: str, time: float) -> AnswerError:
    return AnswerError(f"the function of {owner!r} returned {shown(numbers)} at t = {time:.6g} s; expected {expected}")


def _view(count: int, dtype: type) -> Callable[[int], np.ndarray]:
    """A function from an address to the array there."""
    buffer: Any = ctypes.c_double * (count * (2 if dtype is complex else 1))  # NumPy's stubs do not know ctypes' arrays
    item = np.dtype(dtype)
    return lambda address: np.frombuffer(buffer.from_address(address), item)


@lru_cache(maxsize=128)
def _compiled_force(function: CPUDispatcher, kind: Any, sizes: Sizes) -> tuple[Any, np.ndarray]:
    """A C function of given and answer, and the time at which it last returned numbers that are not finite, (1,)."""
    wrong_at = np.array([_NO_TIME])
    address = wrong_at.ctypes.data
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
        of_answer, of_given = 0.0, 0.0  # NaN, if a number is not finite
        for number in into:
            of_answer += 0.0 * number.real
        for number in given:
            of_given += 0.0 * number.real
        if of_answer != 0.0 and of_given == 0.0:
            reals(address, 1)[0] = given[0].real

    return call, wrong_at
