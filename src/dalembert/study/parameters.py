"""The tables of parameters and constants of a study file."""

import keyword
from typing import Any

from pydantic import ValidationInfo

from dalembert.errors import InputError
from dalembert.parameters import Parameter
from dalembert.study.context import Context
from dalembert.study.expressions import RESERVED, Expression
from dalembert.study.numbers import read_number
from dalembert.study.table import StudyTable, problem
from dalembert.units import is_quantity, is_si, symbol

_NUMBERS = ("lower", "upper", "start", "scale", "deviation")


class ParameterTable(StudyTable):
    """A number that a task varies: its bounds, and optionally a first guess, a typical size, a unit, a prior deviation.

    Bounds are numbers in SI units, or have their unit with them: ``lower = "100 MPa"``.
    """

    lower: float | str
    upper: float | str
    start: float | str | None = None
    scale: float | str | None = None
    unit: str | None = None
    log: bool | None = None
    deviation: float | str | None = None

    def _wrong(self) -> list[str]:
        if self.unit is not None and not is_si(self.unit):
            raise problem(
                f"unit {self.unit!r} was given; expected an SI unit such as 'm', 'rad' or 'Pa', in which the numbers "
                "are; a bound may have another unit with it: lower = '100 MPa'"
            )
        wrong = []
        for key in _NUMBERS:
            try:
                self.number(key)
            except InputError as error:
                wrong.append(f"{key}: {error}")
        if not wrong:
            try:
                self.parameter("parameter")
            except InputError as error:
                wrong.append(str(error).removeprefix("parameter 'parameter': "))
        return wrong

    @property
    def symbol(self) -> str | None:
        """SI unit: the one given, or that of the first bound with a unit."""
        if self.unit is not None:
            return self.unit
        texts = [getattr(self, key) for key in _NUMBERS]
        return next((symbol(text) for text in texts if isinstance(text, str) and is_quantity(text)), None)

    def number(self, key: str) -> float | None:
        """Value of a key in SI units."""
        given = getattr(self, key)
        number = None if given is None else read_number(given, self.symbol)
        assert not isinstance(number, Expression)  # no names are offered to it
        return number

    def parameter(self, name: str) -> Parameter:
        """The parameter."""
        return Parameter(name, unit=self.symbol or "", log=self.log, **{key: self.number(key) for key in _NUMBERS})  # type: ignore[arg-type]


class OwnParameterTable(StudyTable):
    """What differs of a parameter that one experiment has for itself; the rest is as in [parameters]."""

    lower: float | str | None = None
    upper: float | str | None = None
    start: float | str | None = None
    deviation: float | str | None = None

    def over(self, shared: ParameterTable) -> ParameterTable:
        """The parameter's table with these keys in place of its."""
        given = {table: table.model_dump(exclude_none=True) for table in (shared, self)}
        return ParameterTable.model_validate({**given[shared], **given[self]})


def check_names(names: Any) -> Any:
    """Names of parameters or constants, which expressions and Python functions must be able to use."""
    wrong = [
        f"{name!r} cannot be the name of a parameter or constant; "
        "expected letters, digits and _, a letter first, and none of " + ", ".join(sorted(RESERVED))
        for name in (names if isinstance(names, dict) else ())
        if not name.isidentifier() or keyword.iskeyword(name) or name in RESERVED
    ]
    if wrong:
        raise problem(*wrong)
    return names


def read_constants(given: Any, info: ValidationInfo) -> dict[str, float | Expression]:
    """Constants in their order: each may use parameters, and constants before it."""
    if not isinstance(given, dict):
        raise problem(f"{given!r} was given; expected a table")
    parameters = set(info.context.names) - set(given) if isinstance(info.context, Context) else set()
    wrong, constants = [], {}
    for name, value in given.items():
        try:
            constants[name] = read_number(value, None, parameters | set(constants))
        except InputError as error:
            constants[name] = 0.0
            wrong.append(f"{name}: {error}")
    if wrong:
        raise problem(*wrong)
    return constants
