"""How an identification went, in full sentences with advice."""

import numpy as np

from dalembert.inverse.fit.doubts import EXCESSIVE
from dalembert.inverse.least_squares.descent import End
from dalembert.inverse.least_squares.too_few import lacking
from dalembert.inverse.problem.noise import NoiseFloor, signal
from dalembert.inverse.problem.problem import Problem

_MEDIAN = 0.6745  # of the size of a standard normal variable
_AS_GIVEN = 1.2  # deviations of the residuals, in those given, up to which they are as large


def status(problem: Problem, best: End, response: np.ndarray, floor: NoiseFloor, correlated: bool) -> str:
    """Whether it converged, how the misfit compares with the known noise, and whether the residuals look like noise.

    Findings say what ``correlated`` residuals mean.
    """
    few = lacking(problem)
    ended_well = "Converged to one of many solutions." if few else "Converged."
    parts = [ended_well if best.success else f"Not converged: {best.message}."]
    ended = [start.fitness for start in problem.journal.starts]
    if len(ended) > 1:
        there = sum(fitness <= best.fitness * (1 + 1e-3) + floor.fitness * 1e-3 for fitness in ended)
        parts.append(f"{there} of {len(ended)} starts ended with the best fitness.")
    if best.nodes is not None:
        parts.append(str(best.nodes))
    failed = len(problem.journal.failures)
    if failed:
        parts.append(f"{failed} simulations failed and were passed over, the first: {problem.journal.failures[0]}.")
    if problem.loss is not None:
        plain = (np.sqrt(problem.weights) * problem.misfit(response)).ravel()
        beyond = int(np.count_nonzero(np.abs(plain) > problem.loss.scale))
        parts.append(
            f"{beyond} of {problem.compared} weighted residuals exceed {problem.loss.scale:.4g} and pull less than "
            "their squares would."
        )
    elif best.fitness > floor.fitness:
        parts.append(_explains(best.fitness, signal(problem)))
    if few:  # a misfit near zero proves nothing
        return " ".join(parts)
    if best.fitness <= floor.fitness:
        parts.append(f"The misfit is at the floor that the noise of the data allows (known from {floor.source}).")
    elif problem.loss is not None and floor.source == "given deviations" and _usual(problem, response) < _AS_GIVEN:
        parts.append("Without the outliers the residuals are as large as the given deviations.")
    elif floor.source == "given deviations":
        parts.append(
            f"The misfit is {np.sqrt(best.fitness / floor.fitness):.2g} times {EXCESSIVE}; look "
            "whether they are too small, the model lacks something, or more starts find a better minimum."
        )
    elif not correlated:
        parts.append("What remains looks like noise; give the data's deviations to have it checked against them.")
    return " ".join(parts)


def _usual(problem: Problem, response: np.ndarray) -> float:
    """Standard deviation of the weighted residuals by their median size, which outliers hardly change."""
    counted = problem.weights > 0
    return float(np.median(np.sqrt(problem.weights[counted]) * np.abs(problem.misfit(response)[counted]))) / _MEDIAN


def _explains(misfit: float, variation: float) -> str:
    """Share of the data's variation that a response explains.

    >>> _explains(1.0, 4.0)
    "The response explains 75 % of the data's variation."
    """
    if not variation > 0:
        return "The data do not vary, so that no share of their variation can be explained."
    if misfit > variation:
        return "The response explains nothing of the data's variation: the misfit is larger than that variation."
    return f"The response explains {100 * (1 - misfit / variation):.4g} % of the data's variation."
