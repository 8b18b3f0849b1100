"""Causes of residuals: delays of sensors, and parameters that differ between the halves of the records."""

from dataclasses import dataclass

import numpy as np

from dalembert.inverse.misfit.delays import SuspectDelay, suspect_delays
from dalembert.inverse.misfit.halves import Halves, halves
from dalembert.inverse.misfit.residuals import Residuals
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem


@dataclass(frozen=True, eq=False)
class ResidualCauses:
    """Suspected delays, the residuals without them, and the parameters of the halves, each if it is known."""

    delays: tuple[SuspectDelay, ...] = ()
    residuals: Residuals | None = None
    halves: Halves | None = None


def residual_causes(problem: MisfitProblem, at: Linearisation | None, *, known: bool) -> ResidualCauses:
    """Return causes of the residuals at identified values; none away from a minimum. Data that a delay explains are not
    halved: the other parameters make up for the delay. ``known``: whether the noise is.
    """
    if at is None or problem.compared <= len(at.vector) + 1:
        return ResidualCauses()
    residuals = Residuals.of(problem, at, known=known)
    if not np.any(residuals.free) or not np.any(residuals.values) or not residuals.stationary:
        return ResidualCauses()
    delays, left = suspect_delays(residuals)
    return ResidualCauses(delays, left, None if delays else halves(residuals))
