"""Conclusions from the residuals of a fit."""

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.misfit.delays import delay_findings, suspect_delays
from dalembert.inverse.misfit.halves import Halves, halves, halves_findings
from dalembert.inverse.misfit.model_misfit import misfit_findings, model_misfits
from dalembert.inverse.misfit.residuals import Residuals
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem


def misfit_conclusions(
    problem: MisfitProblem, at: Linearisation | None, *, known: bool
) -> tuple[Halves | None, tuple[Finding, ...]]:
    """Return the halves of the records, and findings on delays, on where the model leaves the data, and on the halves.

    Data that a delay explains are not halved: the other parameters make up for the delay.

    Parameters
    ----------
    problem : Problem
    at : Linearisation or None
        At the identified values. Without one, or away from a minimum, there is nothing to conclude.
    known : bool
        Whether the noise of the data is.
    """
    if at is None or problem.compared <= len(at.vector) + 1:
        return None, ()
    residuals = Residuals.of(problem, at, known=known)
    if not np.any(residuals.free) or not np.any(residuals.values) or not residuals.stationary:
        return None, ()
    delays, left = suspect_delays(residuals)
    parts = None if delays else halves(residuals)
    return parts, (
        *delay_findings(delays, problem.data.coordinate.name),
        *misfit_findings(model_misfits(left)),
        *halves_findings(parts, problem),
    )
