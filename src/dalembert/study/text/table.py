"""The base of every table of a study file, and what its validators know of the rest of the file."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from traceback import walk_tb
from typing import Annotated, Any, Self, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    Tag,
    ValidationInfo,
    create_model,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError

from dalembert.errors import DalembertError, InputError
from dalembert.unit_table import Unit

T = TypeVar("T")
_NAME = r"^[^\W\d][\w-]*$"
_READERS = __name__.rsplit(".", 2)[0]  # the package that reads studies


@dataclass
class Context:
    """Surroundings of a study file while it is read. ``folder``: files named in the study are relative to it;
    ``names``: parameters and constants, which an expression may use, with their units; ``series``: names of the
    parameters of each series, which a list of numbers may name as a whole; ``files``: where a file named in the study
    lies if not relative to the folder, as a run folder keeps copies; ``used``: files that were asked for.
    """

    folder: Path = field(default_factory=Path)
    names: Mapping[str, Unit | None] = field(default_factory=dict)
    series: dict[str, tuple[str, ...]] = field(default_factory=dict)
    files: dict[str, Path] = field(default_factory=dict)
    used: dict[str, Path] = field(default_factory=dict)
    _keys: dict[int, tuple[str, ...]] = field(default_factory=dict)

    def file(self, name: str) -> Path:
        """Path of a file named in the study."""
        path = self.files.get(name, self.folder / name)
        self.used[name] = path
        return path

    def remember(self, table: Any, keys: Iterable[str]) -> None:
        """Keep the keys that a table of the document may have, for the error about one that it may not."""
        self._keys[id(table)] = tuple(keys)

    def known_keys(self, table: Any) -> tuple[str, ...]:
        """Keys that a table of the document may have; none if it was never read as a table."""
        return self._keys.get(id(table), ())


class StudyTable(BaseModel):
    """A table of a study file."""

    model_config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True, strict=True)

    @model_validator(mode="before")
    @classmethod
    def _remember_keys(cls, data: Any, info: ValidationInfo) -> Any:
        if isinstance(info.context, Context):
            info.context.remember(data, cls.model_fields)  # for the error about an unknown key
        return data

    def picked(self, *keys: str) -> dict[str, Any]:
        """Return some keys with their values."""
        return {key: getattr(self, key) for key in keys}

    def _wrong(self) -> list[str]:
        """Sentences about keys that do not fit together."""
        return []

    @model_validator(mode="after")
    def _check(self) -> Self:
        if wrong := self._wrong():
            raise problem(*wrong)
        return self


Table = TypeVar("Table", bound=StudyTable)


def problem(*sentences: str) -> PydanticCustomError:
    """Error of a validator, in our own sentences."""
    return PydanticCustomError("dalembert", "{sentences}", {"sentences": "\n".join(sentences)})


def checked(function: Callable[..., T], *arguments: Any) -> T:
    """Result of a function, its :class:`InputError` turned into one that pydantic collects with the others."""
    try:
        return function(*arguments)
    except InputError as error:
        raise problem(str(error)) from None


@contextmanager
def placed(where: str, kind: type[DalembertError] = InputError) -> Iterator[None]:
    """A block whose errors of a kind are about a place in the file; the place is put in front."""
    try:
        yield
    except kind as error:
        raise kind(f"{where}: {error}") from None


@contextmanager
def naming(table: str) -> Iterator[None]:
    """A block whose refused arguments are placed in a table, unless the study's code refused them, which says where."""
    try:
        yield
    except InputError as error:
        frames = [frame for frame, _ in walk_tb(error.__traceback__)]
        if frames[-1].f_globals["__name__"].startswith(_READERS):
            raise
        raise InputError(f"[{table}]: {error}") from error.__cause__


def _name(value: Any) -> str:
    if isinstance(value, str) and re.fullmatch(_NAME, value):
        return value
    raise problem(f"{value!r} was given; expected a name of letters, digits, _ and -, a letter first, such as 'OA'")


@dataclass(frozen=True)
class Read:
    """Mark of a key that is read as another type says: ``Annotated[float, Read(fixed("m"))]``."""

    type: Any

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return handler.generate_schema(self.type)


def completed(table: type[Table], **keys: Any) -> type[Table]:
    """Return a table with further keys, or other types of its keys: those that depend on the kinds that there are.
    ``keys``: (type, default), as `pydantic.create_model` takes them.
    """
    return create_model(table.__name__, __base__=table, __doc__=table.__doc__, __module__=table.__module__, **keys)


def alternative(is_first: Callable[[Any], bool], first: Any, other: Any) -> Any:
    """Type of a key that takes one of two types, selected by a test of the value."""
    return Annotated[
        Annotated[first, Tag("#1")] | Annotated[other, Tag("#2")],
        Discriminator(lambda value: "#1" if is_first(value) else "#2"),
    ]


Name = Annotated[str, BeforeValidator(_name), Field(pattern=_NAME)]
