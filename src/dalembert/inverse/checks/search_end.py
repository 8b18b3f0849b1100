"""How a search ended, and how its residuals compare with the noise of the data."""

from collections.abc import Iterator

import numpy as np

from dalembert.errors import counted
from dalembert.findings import Finding
from dalembert.inverse.checks.too_few_values import lacks_values
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.least_squares.descent import End
from dalembert.inverse.noise.noise_floor import signal
from dalembert.inverse.problem.combinations import members, moved, separated
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.problem.search_findings import converged, failed_simulations

_MEDIAN = 0.6745  # of the size of a standard normal variable
_AS_GIVEN = 1.2  # standard deviation of the residuals, relative to the given one, up to which they agree
_SOURCES = {
    "given": "from the given standard deviations",
    "smoothed": "estimated by local polynomials",
    "rounded": "estimated from their rounding",
    "arithmetic": "rounding errors of the arithmetic",
}


def search_end(optimum: Optimum) -> Iterator[Finding]:
    """Yield whether the search converged, and how the residuals compare with the noise of the data."""
    problem, best, floor, response = optimum.problem, optimum.end, optimum.floor, optimum.response
    few = lacks_values(problem)
    many = "Converged to one of many solutions: the data have fewer values than there are parameters."
    if best.success and best.left_out is not None and not few:
        yield _partly_converged(problem, best, best.left_out)
    else:
        yield converged(best.success, best.message, many if few else "Converged.")
    misfits = [start.misfit for start in problem.journal.starts]
    if len(misfits) > 1:
        limit = optimum.search.end.misfit * (1 + 1e-3) + floor.misfit * 1e-3
        at_best = sum(misfit <= limit for misfit in misfits)
        message = f"{at_best} of {len(misfits)} starts converged to the smallest misfit."
        yield Finding("starts-at-best", "note", {"at_best": at_best, "starts": len(misfits)}, message)
    if (nodes := best.nodes) is not None:
        values = {"segments": nodes.segments, "gap": nodes.gap, "growth": nodes.growth}
        if nodes.segments == 1:
            yield Finding("segments-merged", "note", values, str(nodes))
        else:
            yield Finding("segments-separate", "note", values, str(nodes))
    yield from failed_simulations(problem.journal.failures)
    if problem.loss is not None:
        plain = (np.sqrt(problem.weights) * problem.unweighted_residual(response)).ravel()
        beyond = int(np.count_nonzero(np.abs(plain) > problem.loss.scale))
        message = (
            f"{beyond} of {problem.compared} weighted residuals exceed {problem.loss.scale:.4g} and count less than "
            "their squares."
        )
        values = {"residuals": beyond, "of": problem.compared, "scale": problem.loss.scale}
        yield Finding("outlying-residuals", "note", values, message)
    elif best.misfit > floor.misfit:
        yield _explained(best.misfit, signal(problem))
    if not few:  # with fewer values than parameters, a misfit near zero proves nothing
        yield from _compared(optimum)


def _partly_converged(problem: MisfitProblem, best: End, left_out: np.ndarray) -> Finding:
    parameters = problem.model.parameters
    names, widths = parameters.names, parameters.upper - parameters.lower
    moves = [row * problem.search.slope(problem.search.vectors(best.point)) for row in separated(left_out)]
    values = {
        "directions": len(moves),
        "parameters": ", ".join(name for k, name in enumerate(names) if any(k in members(m, widths) for m in moves)),
        "reason": best.message,
    }
    changes = "; ".join(f"change {moved(names, move, widths)}" for move in moves)
    message = (
        f"Converged, except along {counted(len(moves), 'direction')} that the data do not identify ({changes}): the "
        "search left the parameters there."
    )
    advice = "Fix one of them, or measure a quantity that separates them."
    return Finding("partly-converged", "warning", values, message, advice)


def _compared(optimum: Optimum) -> Iterator[Finding]:
    """Yield how the residuals compare with the noise of the data."""
    problem, best, floor = optimum.problem, optimum.end, optimum.floor
    if best.misfit <= floor.misfit:
        message = f"The misfit equals the noise level of the data ({_SOURCES[floor.source]})."
        yield Finding("misfit-at-noise", "note", {"source": floor.source}, message)
    elif problem.loss is not None and floor.known and _usual(problem, optimum.response) < _AS_GIVEN:
        message = "Without the outliers, the residuals agree with the given standard deviations."
        yield Finding("residuals-as-given", "note", {}, message)
    elif floor.known:
        ratio = float(np.sqrt(best.misfit / floor.misfit))
        message = (
            f"The root mean square of the residuals is {ratio:.2g} times as large as the given standard deviations "
            "allow."
        )
        advice = "Check the standard deviations and the model structure, or increase starts."
        yield Finding("misfit-above-noise", "warning", {"ratio": ratio}, message, advice)
    elif not optimum.correlation_is_detected and optimum.minimum.noise is None:
        advice = "Give the standard deviations of the data to compare the residuals with them."
        yield Finding("uncorrelated-residuals", "note", {}, "The residuals are not correlated.", advice)


def _usual(problem: MisfitProblem, response: np.ndarray) -> float:
    """Return the standard deviation of the weighted residuals from their median size, which outliers hardly change."""
    counted = problem.weights > 0
    return (
        float(np.median(np.sqrt(problem.weights[counted]) * np.abs(problem.unweighted_residual(response)[counted])))
        / _MEDIAN
    )


def _explained(misfit: float, variation: float) -> Finding:
    """Return the finding on the share of the data's variation that a response explains."""
    share = 1 - misfit / variation if variation > 0 else np.nan
    if np.isnan(share):
        message = "The data are constant: the explained share of their variation is not defined."
    elif share < 0:
        message = "The response explains nothing of the data's variation: the misfit is larger than that variation."
    else:
        message = f"The response explains {100 * share:.4g} % of the data's variation."
    return Finding("explained-variation", "note", {"share": share}, message)
