"""The base of every table of a study file: unknown keys are refused, and the known ones kept for that error."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Annotated, Any, Self, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    ValidationInfo,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError

from dalembert.errors import DalembertError, InputError
from dalembert.study.context import Context

T = TypeVar("T")
_NAME = r"^[^\W\d][\w-]*$"


class StudyTable(BaseModel):
    """A table of a study file."""

    model_config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True, strict=True)

    @model_validator(mode="before")
    @classmethod
    def _remember_keys(cls, data: Any, info: ValidationInfo) -> Any:
        if isinstance(info.context, Context):
            info.context.remember(data, cls.model_fields)
        return data

    def _wrong(self) -> list[str]:
        """Sentences about keys that do not fit together."""
        return []

    @model_validator(mode="after")
    def _check(self) -> Self:
        if wrong := self._wrong():
            raise problem(*wrong)
        return self


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


Name = Annotated[str, BeforeValidator(_name), Field(pattern=_NAME)]
