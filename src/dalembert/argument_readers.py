"""Readers of single arguments: names, numbers, samples, models and counts, each with its error."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from dalembert.arguments import is_integer
from dalembert.errors import InputError, shown


def names_of(entries: str | Iterable[str], owner: str, what: str) -> tuple[str, ...]:
    """Return names from a sequence of them, or from a single one: ``"x"`` gives ``("x",)``."""
    if isinstance(entries, str):
        return (str(entries),)
    names = tuple(entries) if isinstance(entries, Iterable) else ()
    if not isinstance(entries, Iterable) or not all(isinstance(name, str) for name in names):
        wrong = next((name for name in names if not isinstance(name, str)), entries)
        raise InputError(f"{owner}: {what} is {shown(wrong)}; expected names, such as ['AB.end.x', 'AB.end.y']")
    return tuple(map(str, names))


def numbers_of(numbers: Any, owner: str, what: str) -> np.ndarray:
    """Real numbers as an array of floats."""
    try:
        if numbers is not None and not isinstance(numbers, str | bytes):
            return np.array(numbers, dtype=object).astype(float)
    except (TypeError, ValueError):
        pass
    raise InputError(f"{owner}: {what} is {shown(numbers)}; expected real numbers")


def samples_of(values: Any, owner: str, what: str) -> np.ndarray:
    """Real numbers as an array (samples,) of at least one."""
    numbers = np.zeros(0) if np.ndim(values) != 1 else numbers_of(values, owner, what)
    if not len(numbers):
        raise InputError(f"{owner}: {what} is {shown(values)}; expected a list of real numbers")
    return numbers


def check_model(owner: str, model: Any) -> None:
    """Raise unless something may be a forward model; its channels are not looked at, as they may take long."""
    if not (hasattr(type(model), "evaluate") and hasattr(model, "parameters")):
        raise InputError(
            f"{owner}: model is {shown(model)}; expected a forward model, such as TimeResponse or PythonModel"
        )


def check_integer(owner: str, name: str, value: Any, least: int) -> None:
    """Raise unless a value is a whole number of at least ``least``."""
    if not is_integer(value) or value < least:
        raise InputError(f"{owner}: {name} is {shown(value)}; expected a whole number, at least {least}")
