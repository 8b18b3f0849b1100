"""The tables of prior distributions of a study file."""

from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

import numpy as np
from pydantic import Field

from dalembert.errors import unknown
from dalembert.parameter import Parameter
from dalembert.priors import CorrelatedNormal, HalfNormal, LogNormal, LogUniform, Normal, Prior, Uniform
from dalembert.study.text.table import StudyTable

Quantity: TypeAlias = float | str


class NormalTable(StudyTable):
    """Normal distribution."""

    target: ClassVar[type[Prior]] = Normal

    kind: Literal["normal"]
    mean: Quantity
    deviation: Quantity = Field(description="standard deviation")


class LogNormalTable(StudyTable):
    """Normal distribution of the logarithm, of a positive parameter."""

    target: ClassVar[type[Prior]] = LogNormal

    kind: Literal["log-normal"]
    median: Quantity
    log_deviation: float = Field(description="standard deviation of the natural logarithm; 0.1 is about 10 %")


class HalfNormalTable(StudyTable):
    """Distribution of the size of a normal number with mean 0."""

    target: ClassVar[type[Prior]] = HalfNormal

    kind: Literal["half-normal"]
    deviation: Quantity = Field(description="standard deviation of the normal number")


class UniformTable(StudyTable):
    """Uniform distribution within the bounds."""

    target: ClassVar[type[Prior]] = Uniform

    kind: Literal["uniform"]


class LogUniformTable(StudyTable):
    """Uniform distribution of the logarithm within positive bounds."""

    target: ClassVar[type[Prior]] = LogUniform

    kind: Literal["log-uniform"]


PriorTable = Annotated[
    NormalTable | LogNormalTable | HalfNormalTable | UniformTable | LogUniformTable, Field(discriminator="kind")
]


def prior(table: Any, bounds: tuple[float, float], number: Callable[[Any], float]) -> Prior:
    """Prior of a table; ``number`` reads a quantity in the unit of the parameter with these bounds."""
    if table.target in (Uniform, LogUniform):
        return table.target(*bounds)
    keys = [name for name in type(table).model_fields if name != "kind"]
    return table.target(**{k: getattr(table, k) if k == "log_deviation" else number(getattr(table, k)) for k in keys})


class CorrelationTable(StudyTable):
    """Correlation of the normal priors of several parameters."""

    parameters: list[str] = Field(min_length=2)
    correlation: float | list[list[float]] = Field(
        description="of two parameters or all pairs: a number; else a matrix with one row for each parameter"
    )

    def joined(self, items: Sequence[Parameter]) -> CorrelatedNormal:
        """The prior of these parameters together, from the prior of each."""
        known = [item.distribution for item in items]
        mean = [prior.mean for prior in known if isinstance(prior, Normal)]
        deviations = np.array([prior.deviation for prior in known if isinstance(prior, Normal)])
        correlation = np.array(self.correlation)
        if correlation.ndim == 0:
            correlation = np.where(np.eye(len(deviations)), 1.0, correlation)
        covariance = deviations[:, None] * correlation * deviations
        return CorrelatedNormal(tuple(self.parameters), tuple(mean), tuple(map(tuple, covariance.tolist())))

    def wrong(self, tables: Mapping[str, Any]) -> list[str]:
        """Sentences about what does not fit to the parameters of the file."""
        where, count = "[[prior_correlations]]", len(self.parameters)
        wrong = [unknown("parameter", name, tables, where) for name in self.parameters if name not in tables]
        if wrong:
            return wrong
        if np.shape(self.correlation) not in ((), (count, count)):
            return [f"{where}: correlation is no number and no matrix of {count} rows and columns"]
        return [
            f"{where}: parameter {name!r} has no normal prior; give it prior = {{kind = 'normal', ...}}, or a start "
            "and a deviation"
            for name in self.parameters
            if not isinstance(tables[name].parameter(name).distribution, Normal)
        ]
