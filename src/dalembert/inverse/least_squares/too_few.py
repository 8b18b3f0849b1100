"""Whether there are enough values to determine the parameters and to test the model."""

from collections.abc import Iterator

from dalembert.findings import Finding
from dalembert.inverse.problem.problem import Problem

ADVICE = (
    "Measure more samples or channels, fix parameters by equal bounds, or give the deviation of what is known before "
    "the data."
)


def lacking(problem: Problem) -> bool:
    """Whether there are fewer values than parameters."""
    return problem.compared < len(problem.model.parameters)


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" + ("" if number == 1 else "s")


def too_few_findings(problem: Problem, *, known: bool) -> Iterator[Finding]:
    """Return a finding where values are fewer than parameters, or leave no residual to estimate the noise from.

    Parameters
    ----------
    problem : Problem
    known : bool
        Whether the noise of the data is.
    """
    values, parameters = problem.compared, len(problem.model.parameters)
    counts = {"values": values, "parameters": parameters}
    if lacking(problem):
        message = (
            f"{_counted(values, 'value')} cannot determine {_counted(parameters, 'parameter')}: other parameters "
            "explain the data as well."
        )
        yield Finding("too-few-data", "warning", counts, message, ADVICE)
    elif values == parameters and not known:
        message = (
            f"There are as many parameters as values ({values}), so no residuals are left to estimate the standard "
            "deviations or to test the model."
        )
        yield Finding("too-few-data", "warning", counts, message, ADVICE)
