"""How closely a rough misfit determines the identified values."""

from collections.abc import Iterator

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.least_squares.estimate import UNSEEN
from dalembert.inverse.problem.combinations import amounts

LARGE = 0.5
"""Distance to the minimum that the sensitivities foresee, in deviations, from which roughness is a warning."""

SMALL = 0.01
"""Distance below which roughness does not matter."""


def rough_misfit(optimum: Optimum) -> Iterator[Finding]:
    """Yield how far the foreseen minimum is from the values, where a rough misfit ended the search. The distance is
    δp = −(JᵀWJ)⁻¹ JᵀW r, inside the bounds. A smooth misfit would have led there.
    """
    at = optimum.linearisation
    if not optimum.end.rough or at is None or optimum.minimum.explained_by == "arithmetic":
        return
    problem, deviations = optimum.problem, optimum.estimate.deviations
    parameters = problem.model.parameters
    residual, slopes = problem.residuals(at.vector, at.response), problem.slopes(at, parameters.scale)
    left, singular, directions = np.linalg.svd(slopes, full_matrices=False)
    seen = singular > UNSEEN * (singular[0] or 1.0)
    along = left[:, seen].T @ residual
    step = parameters.clip(at.vector - parameters.scale * (directions[seen].T @ (along / singular[seen]))) - at.vector
    foreseen = float(along @ along / (residual @ residual))
    known = np.isfinite(deviations) & (deviations > 0)
    ratios = np.divide(np.abs(step), deviations, out=np.zeros(len(step)), where=known)
    worst = int(np.argmax(ratios))
    if ratios[worst] < SMALL:
        return
    values = {"foreseen": foreseen, "deviations": float(ratios[worst])}
    values |= {name: float(abs(change)) for name, change in zip(parameters.names, step, strict=True)}
    message = (
        f"The misfit is rough below {100 * foreseen:.2g} % of its value. The identified values are determined to about "
        f"{amounts(parameters, np.abs(step))}, at most {ratios[worst]:.2g} standard deviations."
    )
    advice = "Use smaller steps or a tighter tolerance of the solver, and smoother laws, such as a larger slip_rate."
    yield Finding("rough-misfit", "warning" if ratios[worst] > LARGE else "note", values, message, advice)
