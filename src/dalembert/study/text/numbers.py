"""Numbers of a study file: plain, with a unit, or as an expression of parameters and constants."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Annotated, Any

import numpy as np
from pydantic import (
    AfterValidator,
    Field,
    GetJsonSchemaHandler,
    PlainValidator,
    ValidationInfo,
)
from pydantic_core import CoreSchema

from dalembert.errors import InputError, unknown
from dalembert.study.text.expressions import Expression, require_kind
from dalembert.study.text.table import Context, Read, StudyTable, alternative, checked, completed, problem
from dalembert.units import expected, is_quantity, sentence, si

MOST = 1_000_000  # numbers of a range
UNIT = "x-unit"
"""Keyword of a number's unit in the JSON schema; empty where it has none."""


def read_number(value: object, unit: str | None, names: Iterable[str] | None = ()) -> float | Expression:
    """Return a number in SI units, or an expression of names; ``names`` None leaves those unchecked. Names with units,
    as :func:`kinds_of` gives them, must measure what the unit does.
    """
    if isinstance(value, float) and math.isfinite(value):
        return float(value)
    if not isinstance(value, str) or (not value.isidentifier() and is_quantity(value)):
        return si(value, unit)
    try:
        expression = Expression.of(value)
        if not expression.names:
            return si(expression({}), unit)
        for name in sorted(expression.names - set(names if names is not None else expression.names)):
            raise InputError(unknown("name", name, names or ()))
        if unit is not None and isinstance(names, Mapping):
            require_kind(expression, unit, names)
    except InputError as error:
        more = ", or an expression of parameters and constants" if names else ""
        raise InputError(f"{sentence(value, unit, reason=str(error).split('; known: none')[0])}{more}") from None
    return expression


@cache
def number(unit: str | None) -> Any:
    """Type of a key whose number may depend on parameters."""

    def read(value: Any, info: ValidationInfo) -> float | Expression:
        return _validated(value, unit, info.context.names if isinstance(info.context, Context) else None)

    return Annotated[Any, PlainValidator(read), _Described(unit)]


def _validated(value: object, unit: str | None, names: Iterable[str] | None = ()) -> float | Expression:
    try:
        return read_number(value, unit, names)
    except InputError as error:
        raise problem(str(error)) from None


def _read_quantity(value: Any, info: ValidationInfo) -> float | Expression:
    if isinstance(value, str) and is_quantity(value):
        return checked(WithUnit.of, value)
    return _validated(value, None, info.context.names if isinstance(info.context, Context) else None)


@cache
def fixed(unit: str | None) -> Any:
    """Type of a key whose number may not depend on parameters."""
    return Annotated[float, PlainValidator(lambda value: _validated(value, unit)), _Described(unit)]


class WithUnit(float):
    """A number in SI units that was written with its unit, for a key whose quantity is known only by the model."""

    text: str

    @classmethod
    def of(cls, value: object) -> float:
        """The number of a text or a plain number."""
        number = read_number(value, None)
        if not isinstance(value, str) or not is_quantity(value):
            return number  # pyright: ignore[reportReturnType] - no names are offered to it
        result = cls(number)  # pyright: ignore[reportArgumentType]
        result.text = value
        return result


def wrong_units(numbers: Mapping[str, Any], units: Mapping[str, str | None], where: str) -> Iterator[str]:
    """Yield sentences on numbers by name, or tables of them, whose unit is not that of the quantity of the name."""
    for name, value in numbers.items():
        for number in _with_units(value):
            if units.get(name) is not None:
                try:
                    read_number(number.text, units[name])
                except InputError as error:
                    yield f"{where}, {name}: {error}"


def _with_units(value: object) -> Iterator[WithUnit]:
    """Yield the numbers with a unit in a number, a list or a table; those relative to others have none."""
    if isinstance(value, WithUnit):
        yield value
    elif isinstance(value, list | tuple):
        for entry in value:
            yield from _with_units(entry)
    elif isinstance(value, StudyTable):
        yield from _with_units([entry for key, entry in vars(value).items() if key != "relative"])


@dataclass(frozen=True)
class _Described:
    """What editors show of a number: made where a schema is asked for, since its example needs the table of units."""

    unit: str | None

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        of_unit = {} if self.unit is None else {UNIT: self.unit.replace("**", "^")}
        return {"anyOf": [{"type": "number"}, {"type": "string"}], "description": expected(self.unit), **of_unit}


class Grid(StudyTable):
    """Evenly spaced numbers from ``start`` to ``end``, by their count or by their distance."""

    start: float = 0.0
    end: float
    count: int | None = None
    every: float | None = None

    def _wrong(self) -> list[str]:
        if (self.count is None) == (self.every is None):
            raise problem("expected either count or every beside start and end")
        if self.end <= self.start:
            raise problem(f"start is {self.start:g} and end {self.end:g}; expected an end after the start")
        if self.count is not None and self.count < 2:
            raise problem(f"count is {self.count}; expected at least 2")
        if max(self.count or 0, self._steps if self.every else 0) > MOST:
            raise problem(f"there would be {self.count or self._steps:.3g} numbers; expected at most {MOST}")
        if self.every is not None and (self.every <= 0 or abs(self._steps - round(self._steps)) > 1e-9 * self._steps):
            raise problem(
                f"every is {self.every:g}, which does not divide the {self.end - self.start:g} from start to end; "
                "expected a distance that does, or count instead"
            )
        return []

    @property
    def _steps(self) -> float:
        return (self.end - self.start) / (self.every or 1.0)

    @property
    def values(self) -> np.ndarray:
        """The numbers, shape (count,)."""
        return np.linspace(self.start, self.end, self.count or round(self._steps) + 1)


@cache
def samples(unit: str | None) -> Any:
    """Type of a key that takes increasing numbers: a list of them, or a :class:`Grid`; read as a tuple."""
    single = fixed(unit)
    grid = completed(Grid, start=(single, 0.0), end=(single, ...), every=(single | None, None))
    either = alternative(lambda value: isinstance(value, dict | Grid), grid, list[single])
    return Annotated[either, AfterValidator(_increasing)]


def pair(of: Any) -> Any:
    """Type of a key that takes a list of two numbers of a type."""
    return row(of, 2)


def row(of: Any, count: int) -> Any:
    """Type of a key that takes a list of a fixed number of numbers of a type."""
    return Annotated[list[of], Field(min_length=count, max_length=count)]


def _increasing(values: Grid | list[float]) -> tuple[float, ...]:
    numbers = values.values.tolist() if isinstance(values, Grid) else values
    if not numbers:
        raise problem("an empty list was given; expected at least one number")
    for earlier, later in pairwise(numbers):
        if later <= earlier:
            raise problem(f"{later:g} follows {earlier:g}; expected numbers that increase")
    return tuple(numbers)


Number = Annotated[
    float, Read(Annotated[float, PlainValidator(lambda value: checked(WithUnit.of, value)), _Described(None)])
]
Quantity = Annotated[Any, Read(Annotated[Any, PlainValidator(_read_quantity), _Described(None)])]
"""A number that may depend on parameters, and that keeps the unit that is written with it."""
Seconds = Annotated[float, Read(fixed("s"))]
Samples = Annotated[tuple[float, ...], Read(samples(None))]
Times = Annotated[tuple[float, ...], Read(samples("s"))]
Frequencies = Annotated[tuple[float, ...], Read(samples("Hz"))]
FrequencyEnds = Annotated[list[float], Read(pair(fixed("Hz")))]
NumberOfEach = Annotated[
    float | dict[str, float], Read(alternative(lambda value: isinstance(value, dict), dict[str, Number], Number))
]
"""One number for all channels, or one for each."""
