"""Fields of components: numbers with a unit, and checks of their values."""

from dataclasses import MISSING, Field, field
from typing import Any

import numpy as np

from dalembert.errors import InputError

#: A number of a model; complex while a derivative is taken.
Number = float | complex


def number(unit: str, default: Any = MISSING) -> Any:
    """A numeric field whose SI unit the schema of study files and the labels read from its metadata."""
    return field(metadata={"unit": unit}) if default is MISSING else field(default=default, metadata={"unit": unit})


def pair(unit: str, default: Any = (0.0, 0.0)) -> Any:
    """A field of two numbers of the same unit, or a point."""
    return field(default=default, metadata={"unit": unit, "shape": (2,)})


def arguments(component: type) -> tuple[Field, ...]:
    """The constructor's arguments of a component, as fields with their metadata, in order.

    Unlike ``dataclasses.fields`` it includes those that are not kept under the same name, such as the ``start`` of a
    bar, where the attribute is the point and not its place.
    """
    return tuple(entry for entry in component.__dataclass_fields__.values() if entry.init)


def require(owner: str, **values: Number) -> None:
    """Refuse numbers that are not positive."""
    for name, value in values.items():
        if not np.real(value) > 0:
            raise InputError(f"{owner}: {name} is {np.real(value):g}; expected a positive number")


def require_not_negative(owner: str, **values: Number) -> None:
    """Refuse numbers that are negative."""
    for name, value in values.items():
        if not np.real(value) >= 0:
            raise InputError(f"{owner}: {name} is {np.real(value):g}; expected zero or a positive number")
