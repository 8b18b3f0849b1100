"""What the data tell about the parameters, in plain sentences, each fact once."""

from collections.abc import Iterable, Sequence

import numpy as np

from dalembert.errors import listed
from dalembert.inverse.least_squares.estimate import UNSEEN, Estimate
from dalembert.inverse.problem.combinations import members, moved, separated
from dalembert.inverse.problem.prior import told_by_priors
from dalembert.parameters import Parameters

INDISTINGUISHABLE = 0.99
"""Correlation from which two parameters are said to be hard to tell apart."""


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
    return untold(parameters.names, width, parameters.scale, told, found)


def foreseen(parameters: Parameters, told: Estimate, known: bool) -> tuple[str, ...]:
    """Sentences before anything is solved; ``known`` is whether the noise of the data is."""
    found = list(told_by_priors(parameters, told.deviations, told.correlation))
    if not known:
        found.append(
            "How exact the data are is not given, so only what no data of these channels would tell is named; "
            "give their deviations."
        )
    return untold(parameters.names, parameters.upper - parameters.lower, parameters.scale, told, found)


def untold(
    names: tuple[str, ...], widths: np.ndarray, scale: np.ndarray, told: Estimate, known: Sequence[str] = ()
) -> tuple[str, ...]:
    """Sentences on unknowns between bounds of these widths that are unseen, known badly, or hard to tell apart.

    They come after those that are ``known`` already; without sensitivities there is but one sentence. Unknowns that
    belong to a combination are named with it, and no more by themselves or in pairs.
    """
    if not np.all(np.isfinite(told.singular_values)):
        return ("What the data tell could not be computed: the model gave no sensitivities at the identified values.",)
    guesses = widths / np.sqrt(12)
    together = list(_together(widths, scale, told, told.deviations > guesses))
    combined = {k for move, _ in together for k in members(move, widths)}
    found = list(known)
    for k, (name, guess, deviation) in enumerate(zip(names, guesses, told.deviations, strict=True)):
        if k in combined:
            continue
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


def _together(
    widths: np.ndarray, scale: np.ndarray, told: Estimate, weak: np.ndarray
) -> Iterable[tuple[np.ndarray, bool]]:
    """Moves (unknowns,) of several unknowns that the data do not tell, and whether they leave the response as it is.

    Those that change it by less than its noise count where every unknown that moves is ``weak`` (unknowns,), known no
    better than by a guess.
    """
    singular, directions = told.singular_values, told.directions
    unseen = singular <= UNSEEN * (singular[0] or 1.0)
    for row in separated(directions[unseen]):
        if len(members(row * scale, widths)) > 1:
            yield row * scale, True
    noise = _noise(told, scale)
    for value, row in zip(singular[~unseen], directions[~unseen], strict=True):
        parts = members(row * scale, widths)
        far = np.any(noise / value * np.abs(row) * scale > widths / np.sqrt(12))
        if far and len(parts) > 1 and np.all(weak[parts]):
            yield row * scale, False


def _noise(told: Estimate, scale: np.ndarray) -> float:
    """Standard deviation of a weighted residual that an estimate was made with; NaN where it cannot be told."""
    seen = told.singular_values > UNSEEN * (told.singular_values[0] or 1.0)
    size = np.linalg.norm(told.directions[seen].T / told.singular_values[seen], axis=1)
    finite = np.isfinite(told.deviations)
    return float(np.median(told.deviations[finite] / (size * scale)[finite])) if finite.any() else np.nan
