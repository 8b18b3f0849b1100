"""Dataclasses as labelled arrays and settings, by the types of their fields.

A field whose type is ``Annotated`` with a form is stored by it, for example as a variable over named dimensions. Any
other field is a setting: a number, a text, or what JSON can hold of it. A dataclass in a field is stored in the same
way.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields, is_dataclass
from types import UnionType
from typing import TYPE_CHECKING, Annotated, Any, Protocol, TypeVar, get_args, get_origin

import numpy as np

from dalembert.intervals import Box
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

if TYPE_CHECKING:
    from xarray import Dataset

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Store:
    """What is written: variables and coordinates as in :class:`~dalembert.contents.Contents`."""

    variables: dict[str, tuple] = field(default_factory=dict)
    coordinates: dict[str, tuple] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Source:
    """What was read: the dataset, and its arrays by name."""

    dataset: "Dataset"
    arrays: dict[str, np.ndarray]


class Form(Protocol):
    """How a field is stored and loaded; what is no array goes to its settings."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Any) -> None: ...
    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Any: ...


class Over:
    """An array or a number as a variable over dimensions, named ``name`` or as the field; None as no variable."""

    def __init__(self, *dimensions: str, name: str = "") -> None:
        self.dimensions, self.name = dimensions, name

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Any) -> None:
        if value is not None:
            to.variables[self.name or name] = (self.dimensions, np.asarray(value))

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Any:
        values = source.arrays.get(self.name or name)
        return values if values is None or self.dimensions else float(values)


class Labels:
    """Names as the coordinate ``name`` of a dimension."""

    def __init__(self, dimension: str, name: str = "") -> None:
        self.dimension, self.name = dimension, name or dimension

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Sequence[str]) -> None:
        to.coordinates[self.name] = (self.dimension, list(value))

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> tuple[str, ...]:
        return tuple(map(str, source.arrays[self.name]))


class _Parameters:
    """Parameters as settings, and the names of the free ones as a coordinate."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Parameters) -> None:
        settings[name] = [encoded(item) for item in value.declared]
        to.coordinates["parameter"] = ("parameter", list(value.names))

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Parameters:
        return Parameters(tuple(Parameter(**item) for item in settings[name]))


class _Box:
    """A box as the variables ``NAME_lower`` and ``NAME_upper`` over the dimension ``parameter``."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Box) -> None:
        to.variables.update({f"{name}_lower": ("parameter", value.lower), f"{name}_upper": ("parameter", value.upper)})
        to.coordinates["parameter"] = ("parameter", list(value.names))

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Box:
        names = tuple(map(str, source.arrays["parameter"]))
        return Box(names, source.arrays[f"{name}_lower"], source.arrays[f"{name}_upper"])


class _Sides:
    """A box as a variable over the dimensions ``side`` and ``parameter``; None as no variable."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Box | None) -> None:
        to.coordinates["side"] = ("side", ["lower", "upper"])
        if value is not None:
            to.variables[name] = (("side", "parameter"), np.stack([value.lower, value.upper]))

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Box | None:
        sides = source.arrays.get(name)
        return None if sides is None else Box(tuple(map(str, source.arrays["parameter"])), *sides)


StoredParameters = Annotated[Parameters, _Parameters()]
StoredBox = Annotated[Box, _Box()]
StoredSides = Annotated[Box | None, _Sides()]
Table = Annotated[np.ndarray, Over("sample", "channel")]
"""An array of shape (samples, channels)."""
OptionalTable = Annotated[np.ndarray | None, Over("sample", "channel")]


def store(item: Any, to: Store) -> dict[str, Any]:
    """Store the arrays of a dataclass, and return its settings."""
    settings: dict[str, Any] = {}
    for part, _, form in _forms(type(item)):
        value = getattr(item, part.name)
        if form is not None:
            form.store(to, settings, part.name, value)
        else:
            settings[part.name] = store(value, to) if is_dataclass(value) else encoded(value)
    return settings


def restore(kind: type[T], source: Source, settings: Mapping[str, Any]) -> T:
    """Return the dataclass whose arrays and settings were stored; a field that is not there gets its default."""
    values = {}
    for part, hint, form in _forms(kind):
        if form is not None:
            value = form.load(source, settings, part.name)
            if value is not None or part.default is MISSING:
                values[part.name] = value
        elif part.name in settings:
            values[part.name] = _decoded(hint, settings[part.name], source)
    return kind(**values)


def encoded(value: Any) -> Any:
    """Return a value as JSON can hold it, each dataclass as a dictionary."""
    if is_dataclass(value):
        return {part.name: encoded(getattr(value, part.name)) for part in fields(value)}
    if isinstance(value, Mapping):
        return {key: encoded(entry) for key, entry in value.items()}
    if isinstance(value, tuple | list):
        return [encoded(entry) for entry in value]
    return value


def _decoded(hint: Any, value: Any, source: Source) -> Any:
    """Return a setting as its type wants it: tuples and dataclasses again."""
    if isinstance(hint, UnionType) and value is not None:
        (hint,) = (member for member in get_args(hint) if member is not type(None))
    if value is None:
        return None
    if get_origin(hint) is tuple:
        kinds = get_args(hint)
        kinds = kinds[:1] * len(value) if kinds[-1] is Ellipsis else kinds
        return tuple(_decoded(kind, member, source) for kind, member in zip(kinds, value, strict=True))
    if is_dataclass(hint) and isinstance(hint, type):
        return restore(hint, source, value)
    return hint(value) if hint in (bool, int, float, str) else value


def _forms(kind: Any) -> Iterator[tuple[Field, Any, Any]]:
    """Yield the fields of a dataclass, each with its type, and its form or None."""
    for part in fields(kind):
        if part.init:
            annotated = get_origin(part.type) is Annotated
            yield (part, *get_args(part.type)[:2]) if annotated else (part, part.type, None)
