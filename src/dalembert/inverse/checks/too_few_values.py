"""Whether the data have enough values for the parameters."""

from collections.abc import Iterator

from dalembert.errors import counted
from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.problem.problem import MisfitProblem

_MORE = (
    "Measure more samples or channels, fix parameters by equal bounds, or give priors: the start and the deviation of "
    "parameters."
)


def lacks_values(problem: MisfitProblem) -> bool:
    """Whether there are fewer values than parameters."""
    return problem.compared < len(problem.model.parameters)


def too_few_values(optimum: Optimum) -> Iterator[Finding]:
    """Return a finding where values are fewer than parameters, or leave no residual to estimate the noise from."""
    problem = optimum.problem
    values, parameters = problem.compared, len(problem.model.parameters)
    counts = {"values": values, "parameters": parameters}
    if lacks_values(problem):
        message = (
            f"{counted(values, 'value')} cannot determine {counted(parameters, 'parameter')}: other parameters "
            "explain the data as well."
        )
        yield Finding("too-few-data", "warning", counts, message, _MORE)
    elif values == parameters and not optimum.noise_is_known:
        message = (
            f"There are as many parameters as values ({values}), so no residuals are left to estimate the standard "
            "deviations or to test the model."
        )
        yield Finding("too-few-data", "warning", counts, message, _MORE)
