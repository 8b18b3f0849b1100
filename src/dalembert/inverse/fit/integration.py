"""How far the steps of the simulation move the identified values."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from dalembert.findings import Finding
from dalembert.forward import refined
from dalembert.inverse.least_squares.estimate import UNSEEN
from dalembert.inverse.problem.integration_error import as_residuals, integration_error
from dalembert.inverse.problem.prior import prior_residual
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.inverse.shooting.nodes import Nodes
from dalembert.stored_fields import Over

CHAOTIC = 1e3
"""Growth of a small change of the state from which on the bias is not linear in the error of the response."""

LARGE = 0.5
"""Bias, in deviations of the parameter or of the misfit, from which it is a finding."""


@dataclass(frozen=True, eq=False)
class IntegrationBias:
    """What one more exact simulation at the identified values says about the error of the integrator.

    Parameters
    ----------
    how : str
        What the more exact simulation was, such as ``"at half the step"``; why there is none if it failed.
    bias : array, shape (parameters,)
        Error of the identified values that the steps cause, to first order: values − bias are the corrected ones. NaN
        without the simulation.
    misfit : float
        Of the same values with converged steps.
    corrected : float
        Misfit of the corrected values with converged steps.
    remainder : float
        Weighted sum of squares of that part of the response's error which no change of the parameters makes up for.

    Notes
    -----
    With the responses ŷ_h and ŷ_{h/2} at the identified values and a method of order q, the error of ŷ_h is
    d = (ŷ_h − ŷ_{h/2}) 2^q/(2^q − 1), and values − bias are corrected by δp = (JᵀWJ)⁻¹ JᵀW d. For methods that choose
    their steps ŷ_{h/2} is the response at a tolerance 100 times tighter, and d the difference.
    """

    how: str
    bias: Annotated[np.ndarray, Over("parameter", name="integration_bias")]
    misfit: Annotated[float, Over(name="integration_misfit")]
    corrected: Annotated[float, Over(name="integration_corrected")]
    remainder: Annotated[float, Over(name="integration_remainder")]

    @property
    def failed(self) -> bool:
        """Whether the more exact simulation failed."""
        return bool(np.isnan(self.misfit))


def integration_bias(problem: MisfitProblem, at: Linearisation | None, nodes: Nodes | None) -> IntegrationBias | None:
    """Return the bias by the integrator at a minimum; None for a model that cannot be simulated more exactly.

    ``nodes`` are those of multiple shooting. Where errors grow much, the bias is not linear in that of the response.
    """
    finer = None if at is None else refined(problem.model)
    if at is None or finer is None:
        return None
    if nodes is not None and nodes.segments > 1:
        return _unknown(at, f"the response is that of {nodes.segments} segments, which one simulation does not follow")
    if nodes is not None and nodes.growth > CHAOTIC:
        return _unknown(at, f"a small change of the initial state grows {nodes.growth:.2g} times")
    found = integration_error(problem, at, finer)
    return _unknown(at, found.how) if found.error is None else _estimated(problem, at, found.error, found.how)


def _estimated(problem: MisfitProblem, at: Linearisation, error: np.ndarray, how: str) -> IntegrationBias:
    """The bias that an error (samples, channels) of the response causes."""
    scale = problem.model.parameters.scale
    slopes = problem.slopes(at, scale)
    weighted = as_residuals(problem, at, error)
    left, singular, directions = np.linalg.svd(slopes, full_matrices=False)
    seen = singular > UNSEEN * (singular[0] or 1.0)
    step = directions[seen].T @ (left[:, seen].T @ weighted / singular[seen])
    correction = step * scale
    linear = at.response - error + at.jacobian @ correction
    remainder = weighted - slopes @ step
    return IntegrationBias(
        how=how,
        bias=-correction,
        misfit=_misfit(problem, at.response - error, at.vector),
        corrected=_misfit(problem, linear, at.vector + correction),
        remainder=float(remainder @ remainder),
    )


def _misfit(problem: MisfitProblem, response: np.ndarray, vector: np.ndarray) -> float:
    return float(np.sum(problem.squares(response)) + np.sum(prior_residual(problem.model.parameters, vector) ** 2))


def _unknown(at: Linearisation, why: str) -> IntegrationBias:
    return IntegrationBias(why, np.full(len(at.vector), np.nan), np.nan, np.nan, np.nan)


def integration_findings(
    found: IntegrationBias | None,
    problem: MisfitProblem,
    deviations: np.ndarray,
    misfit: float,
    *,
    known: bool,
    white: bool,
) -> Iterator[Finding]:
    """Yield findings on the error of the integrator.

    Parameters
    ----------
    found : IntegrationBias or None
    problem : Problem
    deviations : array, shape (parameters,)
    misfit : float
    known : bool
        Whether the deviations of the data are.
    white : bool
        Whether the residuals are white noise.

    Notes
    -----
    Data that contain the same error were simulated with the same steps. They agree better with the response of these
    steps than with the converged one, beyond the noise, and leave white residuals; then the bias is only a note.
    """
    if found is None:
        return
    if found.failed:
        message = f"The error of the integrator was not estimated: {found.how}."
        yield Finding("integration-bias-unknown", "note", {}, message, "Compare with a fit at finer steps.")
        return
    freedom = max(1, problem.compared - len(deviations))
    variance = 1.0 if known else misfit / freedom
    ratios = np.zeros(len(deviations))
    some = np.isfinite(deviations) & (deviations > 0)
    ratios[some] = np.abs(found.bias[some]) / deviations[some]
    worst = int(np.argmax(ratios))
    change = (found.corrected - misfit) / max(variance * np.sqrt(2 * freedom), np.finfo(float).tiny)
    if ratios[worst] <= LARGE and abs(change) <= LARGE:
        return
    name, unit = problem.model.parameters.names[worst], problem.model.parameters.items[worst].unit
    values = {
        "parameter": name,
        "bias": float(found.bias[worst]),
        "deviations": float(ratios[worst]),
        "misfit": found.misfit,
        "corrected_misfit": found.corrected,
    }
    size = (
        f"The integrator biases {name!r} by {f'{found.bias[worst]:.2g} {unit}'.rstrip()}, {ratios[worst]:.2g} times "
        f"its standard deviation (estimated by one simulation {found.how})."
    )
    if white and found.corrected > misfit and found.remainder > 9 * variance:
        yield Finding(
            "integration-bias", "note", values,
            f"{size} The data contain the same error, as data simulated with the same steps do.",
        )  # fmt: skip
        return
    if ratios[worst] <= LARGE:
        values["change"] = float(change)
        yield Finding(
            "integration-bias", "note", values,
            f"The integrator biases no parameter by more than {LARGE:g} standard deviations. With converged steps the "
            f"misfit changes by {change:.2g} of its standard deviations.",
            "Use a smaller step or a tighter tolerance for the best misfit.",
        )  # fmt: skip
        return
    ratio = np.sqrt(found.misfit / max(misfit, np.finfo(float).tiny))
    worse = f" With converged steps the same values leave residuals {ratio:.3g} times as large." if ratio > 1.05 else ""
    advice = "Identify again with a smaller step or a tighter tolerance."
    yield Finding("integration-bias", "warning", values, size + worse, advice)
