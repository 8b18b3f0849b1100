"""Why points of a curve were not found, and what is free in those that were."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.vibration.condensation import MOVING, NAMED
from dalembert.vibration.equations import Equations
from dalembert.vibration.newton import VERIFIED, Solution

LEFT = 0.1
"""Part of the residual, along a motion that no stiffness holds, from which this motion is the cause."""


@dataclass(frozen=True)
class Unfound:
    """A point that was not found.

    Parameters
    ----------
    frequency : float
        Hz.
    residual : float
        As part of the forces.
    motion : str
        Coordinates that move where no contact balances their mean force and the structure has no stiffness; empty for
        other causes.
    force : float
        This mean force, N.
    """

    frequency: float
    residual: float
    motion: str = ""
    force: float = 0.0


def unfound(problem: Equations, solution: Solution) -> Unfound | None:
    """Return the cause if a point was not found."""
    if solution.converged:
        return None
    frequency, residual = float(solution.omega) / (2 * np.pi), solution.evaluation.residual
    motions = solution.point.free_motions
    along = motions.T @ residual[:, 0]
    largest = max(LEFT * float(np.linalg.norm(residual)), VERIFIED * solution.point.load)
    if not np.linalg.norm(along) > largest:
        return Unfound(frequency, solution.error)
    balance = problem.balance(solution.samples)
    moved = np.abs(balance.displacements((motions @ along)[:, None])[:, 0])
    names = [repr(balance.lowered.row_names[row]) for row in np.flatnonzero(moved > MOVING * moved.max())]
    return Unfound(frequency, solution.error, listed(names[:NAMED]), float(np.linalg.norm(along)))


def unfound_findings(points: int, lost: Iterable[Unfound]) -> tuple[Finding, ...]:
    """Return the finding on the points of a curve, of so many, that were not found."""
    lost = list(lost)
    if not lost:
        return ()
    count = f"{len(lost)} of {points} points were not found."
    for one in lost:
        if one.motion:
            values = {"points": len(lost), "frequency": one.frequency, "motion": one.motion, "force": one.force}
            message = (
                f"{count} At {one.frequency:.6g} Hz no contact balances a mean force of {one.force:.3g} N along "
                f"{one.motion}, where the structure has no stiffness."
            )
            advice = (
                "The static forces exceed the limit of friction, or no static force presses the contact. Change "
                "them or the preload, or hold the structure by a spring."
            )
            return (Finding("unbalanced-mean", "error", values, message, advice),)
    worst = max(lost, key=lambda one: one.residual)
    values = {"points": len(lost), "frequency": worst.frequency, "residual": worst.residual}
    message = f"{count} The largest residual is {worst.residual:.1e} of the forces, at {worst.frequency:.6g} Hz."
    advice = "Follow the curve by arc length, or with smaller steps of frequency, more harmonics or more samples."
    return (Finding("points-not-found", "warning", values, message, advice),)


def free_findings(problem: Equations) -> tuple[Finding, ...]:
    """Return the finding on motions of the structure that nothing holds."""
    names = problem.condensation.free_names
    if not names:
        return ()
    message = f"No spring and no contact holds the mean position along {names}; the smallest one was chosen."
    advice = "Look at changes of these displacements, or hold the structure by a spring."
    return (Finding("free-mean-position", "note", {"motion": names}, message, advice),)
