"""Fields of components: numbers with a unit, and checks of their values."""

from collections.abc import Callable
from dataclasses import MISSING, Field, field
from inspect import cleandoc
from typing import Any, TypeVar

from dalembert.arguments import limited, of_class

#: A number of a model; complex while a derivative is taken.
Number = float | complex
_Component = TypeVar("_Component", bound=type)


def number(unit: str, default: Any = MISSING, **limits: float) -> Any:
    """A numeric field with its limits; the schema of study files and labels read its SI unit from the metadata."""
    return limited(default, unit, **limits)


def pair(unit: str, default: Any = (0.0, 0.0)) -> Any:
    """A field of two numbers of the same unit, or a point."""
    return field(default=default, metadata={"unit": unit, "shape": (2,)})


def parameters_of(law: type) -> Callable[[_Component], _Component]:
    """Decorator: the line ``{law}`` of a component's docstring becomes the parameters in that of its law."""
    entries = cleandoc(law.__doc__ or "").rpartition("Parameters\n----------\n")[2]

    def documented(component: _Component) -> _Component:
        component.__doc__ = cleandoc(component.__doc__ or "").replace("{law}", entries)
        return component

    return documented


def arguments(component: type) -> tuple[Field, ...]:
    """The constructor's arguments of a component, as fields with their metadata, in order.

    Unlike ``dataclasses.fields`` it includes those that are not kept under the same name, such as the ``start`` of a
    bar, where the attribute is the point and not its place.
    """
    entries = component.__dataclass_fields__.values()
    return tuple(entry for entry in entries if entry.init and not of_class(entry.type))
