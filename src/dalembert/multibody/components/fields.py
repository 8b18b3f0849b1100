"""Fields of components: numbers with a unit, and checks of their values."""

from dataclasses import MISSING, Field, field
from typing import Any

from dalembert.arguments import limited, of_class

#: A number of a model; complex while a derivative is taken.
Number = float | complex


def number(unit: str, default: Any = MISSING, **limits: float) -> Any:
    """A numeric field with its limits; the schema of study files and labels read its SI unit from the metadata."""
    return limited(default, unit, **limits)


def pair(unit: str, default: Any = (0.0, 0.0)) -> Any:
    """A field of two numbers of the same unit, or a point."""
    return field(default=default, metadata={"unit": unit, "shape": (2,)})


def arguments(component: type) -> tuple[Field, ...]:
    """The constructor's arguments of a component, as fields with their metadata, in order.

    Unlike ``dataclasses.fields`` it includes those that are not kept under the same name, such as the ``start`` of a
    bar, where the attribute is the point and not its place.
    """
    entries = component.__dataclass_fields__.values()
    return tuple(entry for entry in entries if entry.init and not of_class(entry.type))
