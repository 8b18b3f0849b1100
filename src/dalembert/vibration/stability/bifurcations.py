"""Bifurcations: points at which the stability of periodic motions changes."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from dalembert.errors import counted
from dalembert.findings import Finding
from dalembert.vibration.balance.arc_length import PathPoint, zero_between
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.newton import CrossingPlane, Solution
from dalembert.vibration.stability.modal_map import MOST_ROWS
from dalembert.vibration.stability.stability import REAL, Exponents, exponents, remembers

FOLD, TORUS, DOUBLING, BRANCH = "fold", "torus", "period doubling", "branch point"
STABLE, UNSTABLE, NOT_ASKED = 1, 0, -1
AT_FOLD = 1e-5
"""Distance from a fold, as part of the frequency, that is none."""
PLACED = 1e-4
"""Part of the way between two points to which a change is found."""


def judged(problem: Equations, path: Iterable[PathPoint], located: bool) -> Iterator[PathPoint]:
    """Yield points with their stability, and the points at which it changes.

    ``located``: whether changes become separate points; else the first point behind one is marked.
    """
    before: tuple[Solution, Exponents] | None = None
    folded, adjacent = False, True
    for point in path:
        if point.returned:
            before = None
        if not point.solution.converged:
            yield point
            before = None
        elif point.fold:
            # An exponent is zero here, up to rounding of either sign.
            stable = _said(before[1] if before else exponents(problem, point.solution))
            yield replace(point, stable=stable, marker=FOLD)
            folded = True
        else:
            current = exponents(problem, point.solution)
            # Between two judged points this one says nothing, and a bifurcation between them cannot be placed.
            if not current.judged and np.isfinite(current.error):
                # A change of sign within the error is no bifurcation: points further on show whether there is one.
                yield replace(point, unjudged=current.unjudged)
                adjacent = False
                continue
            kind = ""
            if before is not None and before[1].unstable != current.unstable and not folded:
                kind = _kind(before[1], current)
                # Without a fold the balance changes its sign where an exponent passes zero. The steps of a time map
                # shift a fold a little, so that its exponents may pass zero next to it.
                if kind == BRANCH and remembers(problem):
                    kind = kind if before[0].tangent.sign * point.solution.tangent.sign < 0 else ""
                place = _located(problem, before, (point.solution, current)) if located and adjacent and kind else None
                if place is not None:
                    # Where an exponent is zero, rounding decides whether it grows.
                    stable = _said(before[1]) if replace(place[1], unjudged="").judged else NOT_ASKED
                    marker = _kind(place[1], place[1], _rank(before[1], current))
                    yield PathPoint(place[0], stable=stable, marker=marker)
                    kind = ""
            yield replace(point, stable=_said(current), marker=kind)
            before, folded, adjacent = (point.solution, current), False, True


def fold_findings(frequencies: Sequence[float], folds: np.ndarray, harmonics: int) -> tuple[Finding, ...]:
    """Return the finding on points whose stability is not known because a fold lies between motion and perturbations.
    ``frequencies``: of these points, Hz; ``folds`` (folds,): frequencies of the folds, Hz. The steps of a time map move
    a fold a little, which is no finding; ``harmonics``: of the curve.
    """
    apart = [frequency for frequency in frequencies if not np.any(np.abs(folds - frequency) <= AT_FOLD * frequency)]
    if not apart:
        return ()
    cause = f"a fold lies at another frequency with {counted(harmonics, 'harmonic')} than with more"
    values, message = _unknown(apart, cause)
    return (
        Finding("stability-near-fold", "warning", {**values, "harmonics": harmonics}, message, "Keep more harmonics."),
    )


def rows_findings(frequencies: Sequence[float]) -> tuple[Finding, ...]:
    """Return the finding on points whose stability was not computed. ``frequencies``: of these points, Hz."""
    if not frequencies:
        return ()
    values, message = _unknown(frequencies, f"more than {MOST_ROWS} displacements of contacts slip or open there")
    advice = "Use fewer contacts, or compare these motions with integration in time."
    return (Finding("stability-many-contacts", "warning", {**values, "rows": MOST_ROWS}, message, advice),)


def _unknown(frequencies: Sequence[float], cause: str) -> tuple[dict[str, float], str]:
    """Values and message of a finding on points whose stability is not known."""
    low, high = float(min(frequencies)), float(max(frequencies))
    count = counted(len(frequencies), "point")
    message = f"The stability of {count} between {low:.6g} and {high:.6g} Hz is not known: {cause}."
    return {"points": len(frequencies), "lowest": low, "highest": high}, message


def _said(result: Exponents) -> int:
    if not result.judged:
        return NOT_ASKED
    return UNSTABLE if result.unstable else STABLE


def _rank(before: Exponents, after: Exponents) -> int:
    """Return the number of the exponent whose real part changes its sign, in the order of growth."""
    return max(before.unstable, after.unstable) - 1


def _kind(before: Exponents, after: Exponents, rank: int | None = None) -> str:
    """From the side on which the exponent grows."""
    rank = _rank(before, after) if rank is None else rank
    grows = before if before.unstable > after.unstable else after
    # A multiplier crosses the unit circle at +1, at -1 or elsewhere: an imaginary part of none, of a half or of another
    # part of ω.
    turn, none = abs(grows.values[rank].imag) % 1.0, max(REAL, grows.error if np.isfinite(grows.error) else 0.0)
    if min(turn, 1 - turn) < none:
        return BRANCH
    return DOUBLING if abs(turn - 0.5) < none else TORUS


def _located(
    problem: Equations, before: tuple[Solution, Exponents], after: tuple[Solution, Exponents]
) -> tuple[Solution, Exponents] | None:
    """The point between two at which the exponent that changes sides neither grows nor falls."""
    (first, first_exponents), (last, other) = before, after
    rank = _rank(first_exponents, other)
    if len(first_exponents.values) <= rank or len(other.values) <= rank:
        return None
    size = float(np.linalg.norm(last.unknowns - first.unknowns)) or 1.0
    width = abs(last.omega - first.omega) or 1.0
    # A plane across the chord between both points, not a frequency: near a fold two motions have the same one.
    chord = np.append((last.unknowns - first.unknowns).ravel() / size, (last.omega - first.omega) / width)

    def growth(part: float) -> tuple[tuple[Solution, Exponents], float]:
        guess = first.unknowns + part * (last.unknowns - first.unknowns)
        omega = first.omega + part * (last.omega - first.omega)
        plane = CrossingPlane(chord / np.linalg.norm(chord), guess, omega, size, width)
        solution = problem.solve(guess, omega, max(first.samples, last.samples), plane)
        current = exponents(problem, solution) if solution.converged else Exponents(np.zeros(0))
        return (solution, current), float(current.values[rank].real) if len(current.values) > rank else float("nan")

    ends = {part: (entry, float(entry[1].values[rank].real)) for part, entry in ((0.0, before), (1.0, after))}
    return zero_between(growth, 1.0, ends, PLACED)
