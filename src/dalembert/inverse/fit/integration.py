"""How far the steps of the simulation move the identified values."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from dalembert.forward import refined
from dalembert.inverse.least_squares.estimate import UNSEEN
from dalembert.inverse.problem.integration_error import as_residuals, integration_error
from dalembert.inverse.problem.nodes import Nodes
from dalembert.inverse.problem.prior import prior_residual
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem
from dalembert.stored_fields import Over

CHAOTIC = 1e3
"""Growth of a small change of the state from which on the bias is not linear in the error of the response."""


@dataclass(frozen=True, eq=False)
class IntegrationBias:
    """What one more exact simulation at the identified values says about the error of the integrator. With the
    responses ŷ_h and ŷ_{h/2} at the identified values and a method of order q, the error of ŷ_h is d = (ŷ_h − ŷ_{h/2})
    2^q/(2^q − 1), and values − bias are corrected by δp = (JᵀWJ)⁻¹ JᵀW d. For methods that choose their steps ŷ_{h/2}
    is the response at a tolerance 100 times tighter, and d the difference.
    """

    how: str  # what the more exact simulation was, such as ``"at half the step"``; why there is none if it failed
    # bias: (parameters,): error of the identified values that the steps cause, to first order: values − bias are the
    # corrected ones. NaN without the simulation.
    bias: Annotated[np.ndarray, Over("parameter", name="integration_bias")]
    misfit: Annotated[float, Over(name="integration_misfit")]  # of the same values with converged steps
    # corrected: misfit of the corrected values with converged steps
    corrected: Annotated[float, Over(name="integration_corrected")]
    # remainder: weighted sum of squares of that part of the response's error which no change of the parameters makes up
    # for
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
    error = integration_error(problem, at, finer)
    return _unknown(at, error.how) if error.error is None else _estimated(problem, at, error.error, error.how)


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
