"""What the data tell about the parameters: standard deviations, correlation, and combinations."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.inverse.combinations import listed, members, moved, separated
from dalembert.inverse.prior import told_by_priors
from dalembert.parameters import Parameters

INDISTINGUISHABLE = 0.99
"""Correlation from which two parameters are said to be hard to tell apart."""

UNSEEN = 1e-10
"""Singular values below this fraction of the largest are zero to the accuracy of a simulation."""


@dataclass(frozen=True, eq=False)
class Estimate:
    """Standard deviations (parameters,) and correlation (parameters, parameters) of identified parameters.

    ``singular_values`` (parameters,), largest first, are those of W^½ ∂R/∂p · scale; the rows of ``directions``
    (parameters, parameters) are the combinations of p/scale that they belong to.
    """

    deviations: np.ndarray
    correlation: np.ndarray
    singular_values: np.ndarray
    directions: np.ndarray


def estimate(slopes: np.ndarray, scale: np.ndarray, variance: float) -> Estimate:
    """Estimate from the linearised least squares problem, covariance s² (JᵀWJ)⁻¹.

    Parameters
    ----------
    slopes : array, shape (values, parameters)
        W^½ ∂R/∂p · scale, from the singular values of which everything follows.
    scale : array, shape (parameters,)
    variance : float
        s², the variance of a weighted residual.

    Notes
    -----
    A combination that the response does not see leaves the deviations of its parameters infinite, and correlates them
    fully.

    Examples
    --------
    The mean of four values with variance 0.04 has the deviation 0.2/√4.

    >>> estimate(np.ones((4, 1)), np.ones(1), variance=0.04).deviations
    array([0.1])
    """
    short = max(0, len(scale) - len(slopes))
    _, singular, directions = np.linalg.svd(np.pad(slopes, ((0, short), (0, 0))), full_matrices=False)
    least = UNSEEN * (singular[0] or 1.0)
    unseen = singular <= least
    inverse = 1 / np.maximum(singular, least)
    spread = directions.T * inverse  # (parameters, combinations): spread @ spread.T is (JᵀWJ)⁻¹
    size = np.linalg.norm(spread, axis=1)
    correlation = (spread / size[:, None]) @ (spread / size[:, None]).T
    correlation = np.clip((correlation + correlation.T) / 2, -1, 1)
    np.fill_diagonal(correlation, 1.0)
    lost = np.any(np.abs(directions[unseen]) > 1e-6, axis=0)
    return Estimate(np.where(lost, np.inf, np.sqrt(variance) * size * scale), correlation, singular, directions)


@dataclass(frozen=True, eq=False)
class Identifiability:
    """What the data can tell, in numbers as in :class:`Estimate` and in plain sentences."""

    singular_values: np.ndarray
    directions: np.ndarray
    sentences: tuple[str, ...]
    deviations: np.ndarray | None = None
    correlation: np.ndarray | None = None

    def __str__(self) -> str:
        return "\n".join(self.sentences) or "The data tell every parameter, and tell them apart."


def sentences(parameters: Parameters, values: np.ndarray, told: Estimate) -> tuple[str, ...]:
    """Plain sentences on parameters at a bound, unseen by the response, known badly, or hard to tell apart."""
    width = parameters.upper - parameters.lower
    found = []
    for k, item in enumerate(parameters):
        side = "lower" if values[k] - item.lower < 1e-6 * width[k] else "upper"
        bound = getattr(item, side)
        seen = not np.isinf(told.deviations[k])  # an unseen one may lie anywhere: its bound is no hint
        if seen and abs(values[k] - bound) < 1e-6 * width[k]:
            found.append(
                f"{item.name!r} sits on its {side} bound {bound:.6g}; widen the bound if the true value may lie beyond."
            )
    found += told_by_priors(parameters, told.deviations, told.correlation)
    return untold(parameters.names, width, told, found, parameters.scale)


def foreseen(parameters: Parameters, told: Estimate, known: bool) -> tuple[str, ...]:
    """Sentences before anything is solved; ``known`` is whether the noise of the data is."""
    found = list(told_by_priors(parameters, told.deviations, told.correlation))
    if not known:
        found.append(
            "How exact the data are is not given, so only what no data of these channels would tell is named; "
            "give their deviations."
        )
    return untold(parameters.names, parameters.upper - parameters.lower, told, found, parameters.scale)


def untold(
    names: tuple[str, ...],
    widths: np.ndarray,
    told: Estimate,
    known: Sequence[str] = (),
    scale: np.ndarray | None = None,
) -> tuple[str, ...]:
    """Sentences on unknowns between bounds of these widths that are unseen, known badly, or hard to tell apart.

    They come after those that are ``known`` already; without sensitivities there is but one sentence. Combinations of
    three unknowns and more are named where ``scale`` (unknowns,) is given.
    """
    if not np.all(np.isfinite(told.singular_values)):
        return ("What the data tell could not be computed: the model gave no sensitivities at the identified values.",)
    found = list(known)
    for name, guess, deviation in zip(names, widths / np.sqrt(12), told.deviations, strict=True):
        if np.isinf(deviation):
            found.append(
                f"{name!r} is not told by the data: it, or a combination that it is part of, leaves the response "
                "as it is; fix it, or measure another channel."
            )
        elif deviation > guess:
            found.append(
                f"{name!r} is hardly told by the data: its deviation {deviation:.3g} exceeds the "
                f"{guess:.3g} of a mere guess between its bounds; fix it, or measure more."
            )
    together = [] if scale is None else _together(widths, told, scale)
    for move, unseen in together:
        parts = listed([repr(names[k]) for k in members(move, widths)])
        leaves = "leaves the response as it is" if unseen else "changes the response by less than its noise"
        found.append(
            f"{parts} can only be told in combination: moving {moved(names, move, widths)} together {leaves}; fix one "
            "of them, or measure what tells them apart."
        )
    for i, j in zip(*np.triu_indices(len(names), 1), strict=True):
        if any({i, j} <= set(members(move, widths)) for move, _ in together):
            continue
        if abs(told.correlation[i, j]) > INDISTINGUISHABLE:
            found.append(
                f"{names[i]!r} and {names[j]!r} can hardly be told apart (correlation "
                f"{told.correlation[i, j]:.4f}); fix one of them, or measure what tells them apart."
            )
    return tuple(found)


def _together(widths: np.ndarray, told: Estimate, scale: np.ndarray) -> list[tuple[np.ndarray, bool]]:
    """Moves (unknowns,) of three unknowns and more that the data do not tell, and whether they leave the response."""
    singular, directions = told.singular_values, told.directions
    unseen = singular <= UNSEEN * (singular[0] or 1.0)
    noise = _noise(told, scale)
    moves = [(row * scale, True) for row in separated(directions[unseen])]
    for value, row in zip(singular[~unseen], directions[~unseen], strict=True):
        if np.any(noise / value * np.abs(row) * scale > widths / np.sqrt(12)):
            moves.append((row * scale, False))
    return [(move, lost) for move, lost in moves if len(members(move, widths)) > 2]


def _noise(told: Estimate, scale: np.ndarray) -> float:
    """Standard deviation of a weighted residual that an estimate was made with; NaN where it cannot be told."""
    seen = told.singular_values > UNSEEN * (told.singular_values[0] or 1.0)
    size = np.linalg.norm(told.directions[seen].T / told.singular_values[seen], axis=1)
    finite = np.isfinite(told.deviations)
    return float(np.median(told.deviations[finite] / (size * scale)[finite])) if finite.any() else np.nan
