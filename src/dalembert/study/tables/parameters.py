"""The tables of parameters and constants of a study file."""

import keyword
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from pydantic import Field, ValidationInfo

from dalembert.errors import InputError
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.study.tables.priors import CorrelationTable, PriorTable, prior
from dalembert.study.text.expressions import OF_BOUNDS, RESERVED, Expression, kind_of
from dalembert.study.text.numbers import read_number
from dalembert.study.text.table import Context, StudyTable, problem
from dalembert.units import is_quantity, is_si, symbol

MOST = 10_000
"""Parameters of a series."""


class ParameterTable(StudyTable):
    """A number that a task varies: its bounds, and optionally a first guess, a typical size, a unit, a prior.

    Bounds are numbers in SI units, or have their unit with them: ``lower = "100 MPa"``.
    """

    lower: float | str = Field(description="lower bound, such as 0.1 or '100 MPa'")
    upper: float | str = Field(description="upper bound; the parameter is fixed if both are equal")
    start: float | str | None = Field(None, description="first guess; the middle of the bounds if not given")
    scale: float | str | None = Field(
        None, description="typical size, by which a search divides it; the larger bound in size if not given"
    )
    unit: str | None = Field(None, description="SI unit, for labels; that of the bounds if these have one")
    log: bool | None = Field(
        None,
        description="whether a search uses its logarithm; by default if the bounds are positive and more than a decade "
        "apart",
    )
    deviation: float | str | None = Field(
        None, description="prior: standard deviation of the true value around start, known before the measurement"
    )
    prior: PriorTable | None = Field(
        None, description="distribution of the true value, known before the measurement; uniform if not given"
    )
    count: int | None = Field(
        None,
        ge=2,
        le=MOST,
        description="makes a series of parameters NAME_1, NAME_2 and so on, for a list of numbers that has the name: "
        "coefficients = 'NAME'",
    )

    def _wrong(self) -> list[str]:
        if self.unit is not None and not is_si(self.unit):
            raise problem(
                f"unit {self.unit!r} was given; expected an SI unit such as 'm', 'rad' or 'Pa', in which the numbers "
                "are; a bound may have another unit with it: lower = '100 MPa'"
            )
        try:
            self.parameter("parameter")
        except InputError as error:
            mistake = str(error).removeprefix("parameter 'parameter': ")
        else:
            return []
        wrong = []
        for key in OF_BOUNDS:
            try:
                self.number(key)
            except InputError as error:
                wrong.append(f"{key}: {error}")
        return wrong or [mistake]

    @property
    def symbol(self) -> str | None:
        """SI unit: the one given, or that of the first bound with a unit."""
        if self.unit is not None:
            return self.unit
        texts = [getattr(self, key) for key in OF_BOUNDS]
        return next((symbol(text) for text in texts if isinstance(text, str) and is_quantity(text)), None)

    def number(self, key: str) -> float | None:
        """Value of a key in SI units."""
        entry = getattr(self, key)
        return None if entry is None else self._quantity(entry)

    def _quantity(self, entry: Any) -> float:
        number = read_number(entry, self.symbol)
        assert not isinstance(number, Expression)  # no names are offered to it
        return number

    def parameter(self, name: str) -> Parameter:
        """The parameter."""
        unit = self.symbol
        numbers: dict[str, Any] = {}
        for key in OF_BOUNDS:
            value = getattr(self, key)
            numbers[key] = None if value is None else read_number(value, unit)
        known = self.prior and prior(self.prior, (numbers["lower"], numbers["upper"]), self._quantity)
        return Parameter(name, unit=unit or "", log=self.log, prior=known, **numbers)


def series_in(tables: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    """Names of the parameters of each series, from the tables of a document.

    >>> series_in({"force": {"lower": -9, "upper": 9, "count": 3}, "mass": {"lower": 1, "upper": 2}})
    {'force': ('force_1', 'force_2', 'force_3')}
    """
    counts = {name: table.get("count") for name, table in tables.items() if isinstance(table, dict)}
    return {
        name: tuple(f"{name}_{k + 1}" for k in range(count))
        for name, count in counts.items()
        if isinstance(count, int) and 2 <= count <= MOST
    }


def with_series(tables: dict[str, ParameterTable]) -> dict[str, ParameterTable]:
    """The tables of single parameters, with those of its members in place of a series."""
    result: dict[str, ParameterTable] = {}
    for name, table in tables.items():
        series_names = [name] if table.count is None else [f"{name}_{k + 1}" for k in range(table.count)]
        both = [
            name_here
            for name_here in series_names
            if name_here in result or (name_here != name and name_here in tables)
        ]
        if both:
            raise problem(f"{both[0]!r} is a parameter and one of the series {name!r}; rename one of the two")
        result |= dict.fromkeys(series_names, table.model_copy(update={"count": None}))
    return result


def parameters_of(tables: Mapping[str, ParameterTable], correlations: Sequence[CorrelationTable]) -> Parameters:
    """The parameters of a study file, with the correlations of their priors."""
    items = {name: table.parameter(name) for name, table in tables.items()}
    for correlation in correlations:
        joint = correlation.joined([items[name] for name in correlation.parameters])
        for name in correlation.parameters:
            items[name] = replace(items[name], deviation=None, prior=joint)
    return Parameters(tuple(items.values()))


class LocalParameterTable(StudyTable):
    """What differs of a parameter that one experiment has for itself; the rest is as in [parameters]."""

    lower: float | str | None = Field(None, description="lower bound in this experiment")
    upper: float | str | None = Field(None, description="upper bound in this experiment")
    start: float | str | None = Field(None, description="first guess in this experiment")
    deviation: float | str | None = Field(None, description="prior standard deviation in this experiment")
    prior: PriorTable | None = Field(None, description="prior distribution in this experiment")

    def over(self, shared: ParameterTable) -> ParameterTable:
        """The parameter's table with these keys in place of its."""
        keys = {table: table.model_dump(exclude_none=True) for table in (shared, self)}
        return ParameterTable.model_validate({**keys[shared], **keys[self]})


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


def read_constants(document: Any, info: ValidationInfo) -> dict[str, float | Expression]:
    """Constants in their order: each may use parameters, and constants before it."""
    if not isinstance(document, dict):
        raise problem(f"{document!r} was given; expected a table")
    known = info.context.names if isinstance(info.context, Context) else {}
    parameters = set(known) - set(document)
    wrong, constants = [], {}
    for name, value in document.items():
        try:
            constants[name] = number = read_number(value, None, parameters | set(constants))
            if isinstance(number, Expression):
                kind_of(number, known)
        except InputError as error:
            constants[name] = 0.0
            wrong.append(f"{name}: {error}")
    if wrong:
        raise problem(*wrong)
    return constants
