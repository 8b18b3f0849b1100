"""Intervals in a study file: two ends, a middle and its radius, or one number that is known exactly."""

from typing import Annotated, Any

from pydantic import BeforeValidator, WithJsonSchema

from dalembert.errors import InputError
from dalembert.intervals import Interval
from dalembert.study.text.numbers import Number
from dalembert.study.text.table import StudyTable, problem

_WAYS = "[lower, upper], { middle, radius }, { middle, relative } or one number"
_FORMS = ({"lower", "upper"}, {"middle", "radius"}, {"middle", "relative"})


class IntervalTable(StudyTable):
    """An interval: its two ends, its middle and radius, or its middle and its radius relative to that."""

    lower: Number | None = None
    upper: Number | None = None
    middle: Number | None = None
    radius: Number | None = None
    relative: Number | None = None

    def _wrong(self) -> list[str]:
        keys = self.model_fields_set
        if keys not in _FORMS:
            raise problem(f"the keys {', '.join(sorted(keys)) or 'none'} were given; expected {_WAYS}")
        try:
            self.interval()
        except InputError as error:
            raise problem(str(error)) from None
        return []

    def interval(self) -> Interval:
        """The interval."""
        if self.middle is not None:
            return Interval.about(self.middle, radius=self.radius, relative=self.relative)
        assert self.lower is not None  # checked above
        assert self.upper is not None
        return Interval(self.lower, self.upper)


def _as_table(value: Any) -> Any:
    match value:
        case [lower, upper]:
            return {"lower": lower, "upper": upper}
        case bool() | list():
            raise problem(f"{value!r} was given; expected {_WAYS}")
        case int() | float() | str():
            return {"lower": value, "upper": value}
    return value


IntervalKey = Annotated[
    IntervalTable,
    BeforeValidator(_as_table),
    WithJsonSchema({"type": ["array", "object", "number", "string"], "description": f"an interval as {_WAYS}"}),
]
