"""What models made by a builder, a function from parameters to a system, have in common."""

import inspect
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from dalembert.errors import DalembertError, InputError, ModelError, shown, told, users_place

Built = TypeVar("Built")


def check_function(owner: str, function: Any, names: Sequence[str]) -> None:
    """Raise unless a model's function can be called with these parameters by name."""
    if not callable(function):
        raise InputError(f"{owner}: {shown(function)} was given as the model's function; expected a function")
    error = call_error(function, **dict.fromkeys(names))
    if error is not None:
        raise InputError(
            f"{owner}: {named(function)} cannot be called with {', '.join(names) or 'no parameters'}: {error}. "
            "Name its arguments as the parameters"
        )


def call_error(function: Callable[..., Any], *positions: Any, **names: Any) -> TypeError | None:
    """Why a function cannot be called with these arguments; None if it can, or does not say what it takes."""
    try:
        inspect.signature(function).bind(*positions, **names)
    except TypeError as error:
        return error
    except ValueError:
        return None
    return None


def built(builder: Callable[..., Any], arguments: Mapping[str, Any], kind: type[Built]) -> Built:
    """The system that a builder makes of arguments by name."""
    try:
        system = builder(**arguments)
    except DalembertError:
        raise
    except (Exception, SystemExit) as error:
        raise ModelError(told(error) if users_place(error) else f"{named(builder)} raised {told(error)}") from error
    if not isinstance(system, kind):
        expected = getattr(kind, "IN_WORDS", kind.__name__)
        advice = "end it with 'return'" if system is None else getattr(system, "INSTEAD", f"return the {expected}")
        raise InputError(f"{named(builder)} returned {shown(system)}; expected a {expected}: {advice}")
    return system


def named(function: Any) -> str:
    """A model's function in a sentence, with its file and line."""
    code = getattr(inspect.unwrap(function) if callable(function) else function, "__code__", None)
    if code is None:
        return "the model's function"
    return f"the model's function ({Path(code.co_filename).name}, line {code.co_firstlineno})"


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def inexact(parameter: str, error: Exception) -> InputError:
    """The error of a builder that cannot run in complex numbers."""
    return InputError(
        f"the model's function cannot run in complex numbers, as exact derivatives by {parameter!r} need ({error}); "
        "use NumPy's functions instead of those of math, dalembert's absolute, norm, hypot and atan2, and no float() "
        "or comparison on parameters; or give derivative='central-differences'"
    )


def restructured() -> InputError:
    """The error of a builder whose systems differ in more than numbers."""
    return InputError(
        "the model's function returned systems of different structure for different parameters; "
        "parameters may change numbers, not the number or the kinds of components"
    )
