"""Arguments of dataclasses, checked by their annotations before anything is computed with them."""

import inspect
import types
import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, InitVar, field, fields
from functools import cache, wraps
from typing import Any, ClassVar, NamedTuple, TypeVar, Union, cast

import numpy as np

from dalembert.errors import InputError, shown
from dalembert.ranges import Range

LARGEST = 1e100  # of a number of a model; squares of larger ones soon leave the range of floating point
Function = TypeVar("Function", bound=Callable[..., Any])
_PLAIN = (float, int, complex, np.float64, np.complex128)


def limited(default: Any = MISSING, unit: str | None = None, **limits: float) -> Any:
    """Field of a dataclass that derives from :class:`Checked` whose values lie in a :class:`Range`."""
    metadata = {"unit": unit, "range": Range(**limits) if limits else None}
    return field(default=default, metadata={name: value for name, value in metadata.items() if value is not None})


class Checked:
    """Base of dataclasses whose arguments are checked when they are made, those of subclasses included.

    An annotation says what is accepted: ``float | complex`` a finite number of a model, which is complex while a
    derivative is taken; ``float`` a real number; ``int``, ``bool``, ``str``, ``None`` and classes what they name;
    tuples, sequences and mappings of these. Other annotations accept everything, and so do fields with the metadata
    ``checked=False``, which the class checks itself. The metadata ``range`` limits numbers, those of sequences too.

    Raises
    ------
    InputError
        It names the object, the argument, what was given and what is expected.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Rod(Checked):
    ...     name: str
    ...     length: float | complex = limited(unit="m", above=0)
    >>> Rod("AB", "2")
    Traceback (most recent call last):
    dalembert.errors.InputError: Rod 'AB': length is '2'; expected a number in m
    >>> Rod("AB", -2.0)
    Traceback (most recent call last):
    dalembert.errors.InputError: Rod 'AB': length is -2 m; expected a positive number
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        post_init = cls.__dict__.get("__post_init__")
        if post_init is not None:

            @wraps(post_init)
            def first_checked(self: Any, *arguments: Any) -> None:
                _check(self, arguments)
                post_init(self, *arguments)

            cls.__post_init__ = first_checked  # type: ignore[attr-defined]

    def __post_init__(self, *arguments: Any) -> None:
        _check(self, arguments)


class _Argument(NamedTuple):
    """An argument: its name, tests one of which it must pass, and its place among those that are not kept."""

    name: str
    tests: tuple[Callable[[Any], bool], ...]
    place: int | None
    default: Any
    kinds: tuple[Any, ...]
    unit: str
    range: Range | None


def _check(instance: Any, passed_on: tuple[Any, ...]) -> None:
    for argument in _arguments(type(instance)):
        name, tests, place, default, kinds, unit, within = argument
        value = getattr(instance, name) if place is None else passed_on[place]
        if value is default:
            continue
        for test in tests:
            if test(value):
                break
        else:
            raise InputError(refusal(_owner(instance, name), name, value, kinds, unit))
        if within is None or value is None or isinstance(value, str):
            continue
        if isinstance(value, float) and within.above < value < within.below and within.least <= value <= within.most:
            continue
        if value not in within:
            first = next(entry for entry in np.ravel(np.real(value)) if entry not in within)
            number = f"{first:g} {unit}".strip()
            words = str(within).replace("number", "whole number") if int in kinds else str(within)
            raise InputError(f"{_owner(instance, name)}: {name} is {number}; expected {words}")


def _owner(instance: Any, argument: str) -> str:
    """Class and name of an object, for messages about an argument."""
    named = (
        argument != "name"
        and any(entry.name == "name" for entry in fields(instance))
        and isinstance(instance.name, str)
    )
    return type(instance).__name__ + (f" {instance.name!r}" if named else "")


@cache
def _arguments(checked_class: type) -> tuple[_Argument, ...]:
    entries = [
        entry for entry in checked_class.__dataclass_fields__.values() if entry.init and not of_class(entry.type)
    ]  # type: ignore[attr-defined]
    try:
        annotations = typing.get_type_hints(checked_class)
    except Exception:  # a name that only type checkers know
        annotations = {}
    arguments, passed_on = [], 0
    for entry in entries:
        annotation, place = annotations.get(entry.name, entry.type), None
        if isinstance(annotation, InitVar):
            annotation, place, passed_on = annotation.type, passed_on, passed_on + 1
        kinds = kinds_of(annotation if entry.metadata.get("checked", True) else Any)
        unit = entry.metadata.get("unit", "")
        tests, within = tuple(map(_test, kinds)), entry.metadata.get("range")
        if unit and float in kinds:  # a quantity
            tests = tuple(_is_finite if kind is float else _test(kind) for kind in kinds)
        arguments.append(_Argument(entry.name, tests, place, entry.default, kinds, unit, within))
    return tuple(arguments)


def of_class(annotation: Any) -> bool:
    """Whether an annotation is that of a class variable."""
    if isinstance(annotation, str):
        return annotation.startswith(("ClassVar", "typing.ClassVar"))
    return annotation is ClassVar or typing.get_origin(annotation) is ClassVar


def _is_finite(value: Any) -> bool:
    return is_real(value) and is_number(value)


@cache
def kinds_of(annotation: Any) -> tuple[Any, ...]:
    """Alternatives of an annotation; ``complex`` alone for a number of a model.

    >>> kinds_of(float | complex | None)
    (<class 'complex'>, <class 'NoneType'>)
    """
    union = typing.get_origin(annotation) in (Union, types.UnionType)
    kinds = typing.get_args(annotation) if union else (annotation,)
    return tuple(kind for kind in kinds if kind is not float) if complex in kinds else kinds


_TESTS: dict[Any, Callable[[Any], bool]] = {}


@cache
def _test(kind: Any) -> Callable[[Any], bool]:
    """Whether a value is of a kind."""
    if kind in _TESTS:
        return _TESTS[kind]
    origin = typing.get_origin(kind)
    if origin is Callable:
        return callable
    inner = [_any_of(member) for member in typing.get_args(kind)]
    if origin is tuple and Ellipsis not in typing.get_args(kind):
        return lambda value: (
            _is_row(value)
            and len(value) == len(inner)
            and all(test(entry) for test, entry in zip(inner, value, strict=True))
        )
    if origin in (tuple, list, Sequence, Iterable):
        item = typing.get_args(kind)[0]
        many = _finite_floats if {float, complex} & set(kinds_of(item)) else lambda value: False
        return lambda value: (
            (item is str and isinstance(value, str)) or many(value) or (_is_row(value) and all(map(inner[0], value)))
        )
    if origin is Mapping:
        return lambda value: isinstance(value, Mapping) and all(map(inner[1], value.values()))
    if (
        kind is Any
        or not isinstance(kind, type)
        or (getattr(kind, "_is_protocol", False) and not getattr(kind, "_is_runtime_protocol", False))
    ):
        return lambda value: True
    return lambda value: isinstance(value, kind)


def _finite_floats(value: Any) -> bool:
    """Whether a value is an array of numbers that every test of a number accepts; one test for all of them."""
    return (
        isinstance(value, np.ndarray)
        and value.ndim == 1
        and value.dtype in (float, complex)
        and bool(np.all(np.abs(value) <= LARGEST))
    )


def _any_of(annotation: Any) -> Callable[[Any], bool]:
    tests = [_test(kind) for kind in kinds_of(annotation)]
    return lambda value: any(test(value) for test in tests)


def takes_checked(*but: str) -> Callable[[Function], Function]:
    """Return a decorator of functions whose arguments are checked by their annotations, as those of :class:`Checked`
    are. The function itself checks the arguments ``but``, with a more detailed message.
    """

    def checking(function: Function) -> Function:
        signature = inspect.signature(function)
        known = {
            name: (kinds_of(entry.annotation), _any_of(entry.annotation), entry.default)
            for name, entry in signature.parameters.items()
            if entry.annotation is not entry.empty and entry.kind is not entry.VAR_KEYWORD and name not in but
        }

        @wraps(function)
        def with_checks(*args: Any, **options: Any) -> Any:
            for name, value in signature.bind(*args, **options).arguments.items():
                if name in known:
                    kinds, test, default = known[name]
                    if value is not default and not test(value):
                        raise InputError(refusal(function.__name__, name, value, kinds))
            return function(*args, **options)

        return cast(Function, with_checks)

    return checking


def is_number(value: Any) -> bool:
    """Whether a value is a finite number of a model, real or complex, and small enough to compute with.

    >>> [is_number(value) for value in (2, 1 + 1j, np.float32(3), "2", None, True, np.nan, 1e200, np.ones(2))]
    [True, True, True, False, False, False, False, False, False]
    """
    if type(value) not in _PLAIN:
        if not _is_scalar(value):
            return False
        value = np.asarray(value).item()
    return -LARGEST <= value.real <= LARGEST and -LARGEST <= value.imag <= LARGEST


def _is_scalar(value: Any, kinds: str = "iufc") -> bool:
    """Whether something is one number to NumPy."""
    try:
        array = np.asarray(value)
    except Exception:  # whatever an object of the user's raises
        return False
    return array.shape == () and array.dtype.kind in kinds


def array_of(value: Any) -> np.ndarray:
    """Numbers of a model as an array; an empty one for anything else."""
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        return np.zeros(0)
    return array if all(map(is_number, array.ravel().tolist())) else np.zeros(0)


def is_integer(value: Any) -> bool:
    """Whether a value is a whole number, and not just equal to one."""
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def is_real(value: Any) -> bool:
    """Whether a value is one real number; a bool is none."""
    return _is_scalar(value, "iuf")


def _is_row(value: Any) -> bool:
    """Whether a value is a list of something."""
    if isinstance(value, np.ndarray):
        return value.ndim > 0
    return isinstance(value, Sequence) and not isinstance(value, str | bytes)


_TESTS.update(
    {
        complex: is_number,
        float: is_real,
        int: is_integer,
        bool: lambda value: isinstance(value, bool | np.bool_),
        np.ndarray: lambda value: True,
    }
)


def refusal(owner: str, name: str, value: Any, kinds: tuple[Any, ...], unit: str = "") -> str:
    """Sentence for an argument that is of none of these kinds."""
    stated = [kind for kind in kinds if kind is not type(None)]
    return f"{owner}: {name} is {shown(value)}; expected {' or '.join(_words(kind, value, unit) for kind in stated)}"


_COUNTS = {2: "two", 3: "three"}
_WORDS = {float: "a number", int: "a whole number", bool: "True or False", str: "a text"}


def _words(kind: Any, value: Any, unit: str) -> str:
    """What is expected of a kind."""
    of_unit = f" in {unit}" if unit else ""
    if kind is float and _is_scalar(value, "c"):
        return f"a real number{of_unit}, which depends on no parameter"
    if kind is complex:
        if not _is_scalar(value):
            return f"a number{of_unit}"
        return f"a number below {LARGEST:g} in size" if np.isfinite(value) else f"a finite number{of_unit}"
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    if origin is tuple and Ellipsis not in inner:
        count, example = _COUNTS.get(len(inner), len(inner)), ", ".join(["0.0"] * len(inner))
        return f"{count} finite numbers{of_unit}, such as ({example})"
    if origin in (tuple, list, Sequence, Iterable):
        return "a list of texts" if inner[0] is str else f"a list of finite numbers{of_unit}"
    if origin is Mapping:
        return f"a mapping from names to {_words(kinds_of(inner[1])[0], value, unit)}"
    if origin is Callable:
        return "a function"
    return _WORDS.get(kind) or getattr(kind, "IN_WORDS", None) or f"a {kind.__name__}"
