"""Directions of the parameters that the data do not identify, and steps that creep along them."""

from dataclasses import dataclass

import numpy as np

from dalembert.optimize.stopping import PROGRESS, SMOOTH
from dalembert.optimize.sum_of_squares import SumOfSquares
from dalembert.optimize.tikhonov import UNSEEN

UNIFORM = 1 / np.sqrt(12)  # standard deviation of a uniform distribution, relative to its width
CREEPING = 0.1  # part of the foreseen fall of the sum of squares below which a step creeps
# Falls of the sum of squares, relative to the square of an error, to the variance of white residuals, and to that of
# others, which is too large where they are no noise, up to which these explain the falls.
BIASED, WHITE, OTHER = 4.0, 4.0, 1.0


@dataclass(frozen=True, eq=False)
class IdentifiablePart:
    """Slopes without their changes along directions that are not identifiable."""

    slopes: np.ndarray  # (values, parameters)
    left_out: np.ndarray  # (directions, parameters): directions that are not identifiable, in units of the parameters
    # Foreseen fall of the sum of squares along the identifiable directions, relative to the variance of a residual.
    offset: float

    @property
    def final(self) -> bool:
        """Whether directions are left out, and the others have come within the noise of their minimum."""
        return len(self.left_out) > 0 and self.offset < 1


def identifiable_part(
    problem: SumOfSquares, x: np.ndarray, residual: np.ndarray, slopes: np.ndarray, fall: float = 0.0
) -> IdentifiablePart:
    """Return slopes without the directions that the data do not identify; with all of them if the disturbance of the
    ``problem`` is not known. ``x`` (parameters,); ``residual`` (values,); ``slopes`` (values, parameters): relative to
    one unit a parameter; ``fall``: last fall of the sum of squares.

    With u s vᵀ a part of the singular value decomposition of slopes · widths, noise of variance
    σ² = ‖r‖²/(values − parameters) moves the minimum along v by σ/s widths, and an error e by uᵀe/s. A direction is not
    identifiable if the root of the sum of both squares exceeds the standard deviation of a uniform distribution between
    the bounds. It is left out if noise and error explain both ``fall`` and the foreseen fall (uᵀr)² along it, which are
    then below 4 σ² + 4 (uᵀe)², or σ² + 4 (uᵀe)² if the residuals are not white: the point is as likely as the minimum.
    Directions along which the bounds are farther than the standard deviation are kept, whatever their singular values.
    """
    freedom = int(np.count_nonzero(residual)) - len(x)
    if problem.disturbance is None or freedom <= 0:
        return IdentifiablePart(slopes, np.empty((0, len(x))), np.inf)
    # In widths of the bounds: a singular value compares a whole interval with the noise.
    left, singular, directions = np.linalg.svd(slopes * problem.widths, full_matrices=False)
    falls, reach = (left.T @ residual) ** 2, np.max(np.abs(directions), axis=1)
    variance = float(residual @ residual) / freedom
    explained = (WHITE if problem.disturbance.white(x) else OTHER) * variance

    def lost(bias: np.ndarray) -> np.ndarray:
        wide = (np.sqrt(variance + bias) * reach > UNIFORM * singular) | (singular <= UNSEEN * singular[0])
        return wide & (np.maximum(falls, fall) < explained + BIASED * bias)

    # By the noise alone first. The error of the residuals, such as an integrator's, costs a simulation: only where
    # noise decides nothing.
    out = lost(np.zeros(len(singular)))
    if not out.any() and (error := problem.disturbance.error(x)) is not None:
        out = lost((left.T @ error) ** 2)
    offset = float(np.sum(falls[~out])) / max(variance, np.finfo(float).tiny)
    left_out = directions[out] * problem.widths
    if not out.any():
        return IdentifiablePart(slopes, left_out, offset)
    return IdentifiablePart((left[:, ~out] * singular[~out]) @ directions[~out] / problem.widths, left_out, offset)


def creeps(before: float, now: float, foreseen: float) -> bool:
    """Return True if a step from one sum of squares to the next reached little of the ``foreseen`` relative fall."""
    return foreseen > SMOOTH and before - now < min(CREEPING * foreseen, PROGRESS) * before
