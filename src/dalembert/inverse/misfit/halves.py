"""Whether the first and the second half of the records have the same parameters."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Annotated

import numpy as np
from scipy.special import ndtr

from dalembert.inverse.least_squares.descent import End, refine
from dalembert.inverse.least_squares.estimate import UNSEEN
from dalembert.inverse.misfit.residuals import Residuals
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.optimize import LeastSquares
from dalembert.stored_fields import Over

LEVEL = 0.001
"""Probability with which equal parameters are taken for different ones, over all parameters of a fit."""

LEAST = 10
"""Fewest values of a half, beyond the parameters."""

WEAK = 1e-3
"""Singular value of a half, as a part of the whole record's, below which it does not determine a combination."""

REFITTED = LeastSquares(trials=30)


@dataclass(frozen=True, eq=False)
class Halves:
    """Parameters of the first and of the second half of each record."""

    # values, deviations: (2, parameters): naN where a half does not determine the parameter, and for parameters on a
    # bound
    values: Annotated[np.ndarray, Over("half", "parameter", name="half_values")]
    deviations: Annotated[np.ndarray, Over("half", "parameter", name="half_deviations")]
    # differences: (parameters,): second less first value in standard deviations of that difference; NaN where a half
    # does not determine it
    differences: Annotated[np.ndarray, Over("parameter", name="half_differences")]
    # refitted: whether each half was fitted; if not, the values are those of one Gauss–Newton step from the whole fit,
    # as far as the bounds allow
    refitted: bool

    @property
    def drifting(self) -> np.ndarray:
        """Whether each parameter differs significantly, (parameters,)."""
        size = np.nan_to_num(np.abs(self.differences))
        return 2 * ndtr(-size) < LEVEL / max(1, np.count_nonzero(np.isfinite(self.differences)))


def halves(residuals: Residuals) -> Halves | None:
    """Return the parameters of the halves of the records; None where a half has too few values, or a parameter a prior.
    One Gauss–Newton step of each half from the whole fit needs no simulation. Where it finds different parameters, both
    halves are fitted, from the values of the whole fit on.

    With the rows S_h of S = W^½ ∂R/∂p that belong to a half, its step is −S_h⁺ r. The residuals of the whole fit are
    (I − UUᵀ) e, with the noise e and the left singular vectors U of S. So the difference of the steps has the
    covariance G Σ Gᵀ, G = (S_1⁺ − S_2⁺)(I − UUᵀ). Σ is the covariance of the noise: of its process where a channel is
    correlated. Where residuals are systematic, and so no noise, it is that of independent noise that neighbouring
    residuals show.
    """
    problem, at = residuals.problem, residuals.at
    first, second = _masks(residuals)
    free, parameters = residuals.free, problem.model.parameters
    scale = parameters.scale[free]
    if problem.priors or min(np.count_nonzero(first), np.count_nonzero(second)) < len(scale) + LEAST:
        return None
    slopes = problem.slopes(at, parameters.scale)[: len(first), free]
    largest = float(np.linalg.svd(slopes, compute_uv=False)[0])
    maps, known = zip(*(_step(slopes * mask[:, None], largest, scale) for mask in (first, second)), strict=True)
    sizes = np.array([np.sqrt(np.diag(_spread(residuals, columns))) for columns in maps])
    apart = maps[1] - maps[0]
    apart = apart - residuals.basis @ (residuals.basis.T @ apart)
    deviation = np.sqrt(np.diag(_spread(residuals, apart)))
    guess = (parameters.upper - parameters.lower)[free] / np.sqrt(12)
    estimate = partial(_halves, free, sizes, deviation, np.array(known) & (sizes < guess))
    stepped = at.vector[free] + np.array([-residuals.values @ columns for columns in maps])
    if np.any(estimate(stepped, refitted=False).drifting):
        again = [_refitted(problem, mask, at.vector) for mask in (first, second)]
        if all(values is not None for values in again):
            return estimate(np.array(again)[:, free], refitted=True)
    return estimate(np.clip(stepped, parameters.lower[free], parameters.upper[free]), refitted=False)


def _masks(residuals: Residuals) -> tuple[np.ndarray, np.ndarray]:
    """Masks (values,) of the values in the first and in the second half of each record."""
    first, second = (np.zeros(len(residuals.values), dtype=bool) for _ in range(2))
    for signal in residuals.series:
        early = signal.along <= (signal.along[0] + signal.along[-1]) / 2
        first[signal.rows[early]], second[signal.rows[~early]] = True, True
    return first, second


def _step(slopes: np.ndarray, largest: float, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Map (values, parameters) from weighted residuals to a step of the parameters, and which are determined."""
    left, singular, directions = np.linalg.svd(slopes, full_matrices=False)
    seen = singular > max(WEAK * WEAK * largest, UNSEEN)
    pinv = left[:, seen] / singular[seen] @ directions[seen] * scale
    return pinv, ~np.any(np.abs(directions[~seen]) > WEAK, axis=0)


def _spread(residuals: Residuals, columns: np.ndarray) -> np.ndarray:
    """Covariance (columns, columns) of columnsᵀ · noise, for columns (values, columns)."""
    total, fitted = np.zeros((columns.shape[1], columns.shape[1])), dict(residuals.fitted)
    for signal in residuals.series:
        rows, process = columns[signal.rows], fitted.get(signal)
        if process is None:
            total += residuals.variances[signal.rows] * rows.T @ rows
        elif residuals.processes[signal.name].systematic:
            total += residuals.noise(signal) ** 2 * rows.T @ rows
        else:
            total += process.product(signal, rows)
    return total


def _halves(
    free: np.ndarray, sizes: np.ndarray, deviation: np.ndarray, known: np.ndarray, values: np.ndarray, *, refitted: bool
) -> Halves:
    """Halves from values and deviations (2, free parameters), where ``known``; NaN for the others (parameters,)."""
    both = known.all(axis=0) & (deviation > 0)
    differences = np.full(len(deviation), np.nan)
    differences[both] = (values[1] - values[0])[both] / deviation[both]
    rows = np.full((5, len(free)), np.nan)
    rows[:, free] = [*np.where(known, values, np.nan), *np.where(known, sizes, np.nan), differences]
    return Halves(rows[:2], rows[2:4], rows[4], refitted)


def _refitted(problem: MisfitProblem, mask: np.ndarray, vector: np.ndarray) -> np.ndarray | None:
    """Values (parameters,) of a half, by least squares from those of the whole; None if it does not converge."""
    journal = Journal(problem.samples)
    weights = np.where(mask.reshape(problem.weights.shape), problem.weights, 0.0)
    part = replace(problem, weights=weights, journal=journal)
    end = refine(part, REFITTED, End(problem.search.points(vector), np.inf, False, ""))
    problem.journal.simulations += journal.simulations
    return problem.search.vectors(end.point) if end.success else None
