"""Which parameters the data identify, as findings, each fact once."""

from collections.abc import Iterable, Iterator

import numpy as np

from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.inverse.least_squares.estimate import UNSEEN, Estimate
from dalembert.inverse.problem.combinations import members, moved, separated
from dalembert.inverse.problem.prior import prior_findings
from dalembert.inverse.problem.prior_conflicts import conflicts_of_minimum
from dalembert.parameters import Parameters

INDISTINGUISHABLE = 0.99
"""Correlation from which two parameters are hardly distinguishable."""

UNCHANGED, NOISE, INTEGRATOR = "rounding", "noise", "integrator"
EFFECTS = {
    UNCHANGED: "does not change the response",
    NOISE: "changes the response by less than its noise",
    INTEGRATOR: "changes the response by less than the error of the integrator",
}
"""Effects of moves that the data do not see, by what they are below."""

SEPARATE = "Fix one of them, or measure a quantity that separates them."


def identifiability_findings(
    parameters: Parameters,
    values: np.ndarray,
    known: Estimate,
    plain: Estimate | None = None,
    bias: np.ndarray | None = None,
) -> Iterator[Finding]:
    """Yield findings on parameters at a bound, not identifiable, or hardly distinguishable. ``values`` (parameters,):
    identified values. ``known``: of these values. ``plain``: for independent residuals; ``known`` if not given. A prior
    that contradicts the data leaves correlated ones, whose larger standard deviations would hide the conflict. ``bias``
    (parameters,): error of the values that the integrator causes; NaN where it is not known.
    """
    width = parameters.upper - parameters.lower
    for k, item in enumerate(parameters):
        side = "lower" if values[k] - item.lower < 1e-6 * width[k] else "upper"
        bound = getattr(item, side)
        seen = not np.isinf(known.deviations[k])  # one that the response does not see may lie anywhere
        if seen and abs(values[k] - bound) < 1e-6 * width[k]:
            yield Finding(
                "parameter-at-bound",
                "warning",
                {"parameter": item.name, "side": side, "bound": float(bound)},
                f"{item.name!r} is at its {side} bound {bound:.6g}.",
                "Widen the bound if the true value may lie beyond it.",
            )
    plain = known if plain is None else plain
    yield from conflicts_of_minimum(parameters, values, plain.deviations, plain.correlation)
    yield from prior_findings(parameters, known.deviations, known.correlation)
    yield from unidentifiable(parameters.names, width, parameters.scale, known, bias)


def foreseen(parameters: Parameters, expected: Estimate, *, noise_known: bool) -> Iterator[Finding]:
    """Yield findings before anything is identified; ``expected`` is the estimate from sensitivities alone."""
    yield from prior_findings(parameters, expected.deviations, expected.correlation)
    if not noise_known:
        message = (
            "The noise of the data is not given: only parameters that exact data of these channels cannot identify "
            "are listed."
        )
        advice = "Give the standard deviations of the data."
        yield Finding("unknown-noise", "note", {}, message, advice)
    yield from unidentifiable(parameters.names, parameters.upper - parameters.lower, parameters.scale, expected)


def unidentifiable(
    names: tuple[str, ...], widths: np.ndarray, scale: np.ndarray, known: Estimate, bias: np.ndarray | None = None
) -> Iterator[Finding]:
    """Yield findings on unknowns that are not or hardly identifiable, alone, in combination, or in pairs. Unknowns of a
    combination are named with it, and not again alone or in pairs. Without sensitivities there is one finding, which
    says so. ``widths`` (unknowns,): distances between the bounds. ``scale`` (unknowns,). ``bias`` (unknowns,): error of
    the values that the integrator causes; NaN where it is not known.
    """
    if not np.all(np.isfinite(known.singular_values)):
        message = "Identifiability is not known: the model has no sensitivities at the identified values."
        yield Finding("no-sensitivities", "note", {}, message)
        return
    guesses = widths / np.sqrt(12)  # standard deviations of uniform distributions between the bounds
    systematic = np.zeros(len(names)) if bias is None else np.nan_to_num(bias)
    together = list(_together(widths, scale, known, systematic))
    combined = {k for move, _ in together for k in members(move, widths)}
    for k, (name, guess, deviation) in enumerate(zip(names, guesses, known.deviations, strict=True)):
        if k in combined:
            continue
        if np.isinf(deviation):
            yield Finding(
                "unidentifiable-parameter",
                "warning",
                {"parameter": name},
                f"{name!r} is not identifiable: it, or a combination with it, does not change the response.",
                "Fix it, or measure another channel.",
            )
        elif deviation > guess:
            yield Finding(
                "weakly-identifiable-parameter",
                "warning",
                {"parameter": name, "deviation": float(deviation), "uniform": float(guess)},
                f"{name!r} is hardly identifiable: its standard deviation {deviation:.3g} exceeds {guess:.3g}, that of "
                "a uniform distribution between its bounds.",
                "Fix it, or measure more.",
            )
    for move, below in together:
        parts = [names[k] for k in members(move, widths)]
        yield Finding(
            "unidentifiable-combination",
            "warning",
            {"parameters": ", ".join(parts), "unseen": below == UNCHANGED, "below": below},
            f"Only a combination of {listed(list(map(repr, parts)))} is identifiable: changing "
            f"{moved(names, move, widths)} together {EFFECTS[below]}.",
            SEPARATE,
        )
    for i, j in zip(*np.triu_indices(len(names), 1), strict=True):
        if any({i, j} <= set(members(move, widths)) for move, _ in together):
            continue
        if abs(known.correlation[i, j]) > INDISTINGUISHABLE:
            yield Finding(
                "indistinguishable-parameters",
                "warning",
                {"parameters": f"{names[i]}, {names[j]}", "correlation": float(known.correlation[i, j])},
                f"{names[i]!r} and {names[j]!r} are hardly distinguishable (correlation "
                f"{known.correlation[i, j]:.4f}).",
                SEPARATE,
            )


def _together(
    widths: np.ndarray, scale: np.ndarray, known: Estimate, bias: np.ndarray
) -> Iterable[tuple[np.ndarray, str]]:
    """Yield moves (unknowns,) of several unknowns that the data do not see, and what their effect is below. A move that
    changes the response counts where neither it nor any unknown that moves is known better than by a uniform
    distribution: by the noise, or by the noise and the ``bias`` (unknowns,) of the integrator.
    """
    singular, directions = known.singular_values, known.directions
    unseen = singular <= UNSEEN * (singular[0] or 1.0)
    for row in separated(directions[unseen]):
        if len(members(row * scale, widths)) > 1:
            yield row * scale, UNCHANGED
    noise, guesses = _noise(known, scale), widths / np.sqrt(12)
    for value, row in zip(singular[~unseen], directions[~unseen], strict=True):
        parts = members(row * scale, widths)
        if len(parts) < 2:
            continue
        for below, error in ((NOISE, 0.0 * bias), (INTEGRATOR, bias)):
            far = np.any(np.hypot(noise / value, row @ (error / scale)) * np.abs(row) * scale > guesses)
            if far and np.all(np.hypot(known.deviations, error)[parts] > guesses[parts]):
                yield row * scale, below
                break


def _noise(known: Estimate, scale: np.ndarray) -> float:
    """Return the standard deviation of a weighted residual that an estimate was made with; NaN if it is not known."""
    seen = known.singular_values > UNSEEN * (known.singular_values[0] or 1.0)
    size = np.linalg.norm(known.directions[seen].T / known.singular_values[seen], axis=1)
    finite = np.isfinite(known.deviations)
    return float(np.median(known.deviations[finite] / (size * scale)[finite])) if finite.any() else np.nan
