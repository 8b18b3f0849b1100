"""Conclusions on a curve: causes of points that are not converged, motions that nothing holds."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.newton import VERIFIED, Solution
from dalembert.vibration.interface.condensed_structure import norm
from dalembert.vibration.interface.free_motions import MOVING, NAMED

LEFT = 0.1
"""Part of the residual, along a motion that no stiffness holds, from which this motion is the cause."""


@dataclass(frozen=True)
class Unconverged:
    """A point that is not converged. ``frequency``: Hz; ``residual``: norm of the residual divided by that of the
    forces; ``cause``: None if the cause is not known.
    """

    frequency: float
    residual: float
    cause: Finding | None = None


def unconverged(problem: Equations, solution: Solution) -> Unconverged | None:
    """Return the cause if a point is not converged."""
    if solution.converged:
        return None
    return Unconverged(problem.hertz(solution.omega), solution.error, _cause(problem, solution))


def _cause(problem: Equations, solution: Solution) -> Finding | None:
    # The part of the residual along motions that nothing resists: a mean force that no position balances.
    motions, along = solution.tangent.unresisted, solution.tangent.unbalanced(solution.evaluation.residual)
    force = float(np.linalg.norm(along))
    if force > max(LEFT * solution.left, VERIFIED * solution.acting):
        balance = problem.balance(solution.samples)
        # By receptances the motions are those of the rows.
        mean = (motions @ along)[:, None]
        moved = np.abs(mean if problem.by_receptances else balance.displacements(mean))[:, 0]
        rows = np.flatnonzero(moved > MOVING * moved.max())[:NAMED]
        motion = listed([repr(balance.lowered.row_names[row]) for row in rows])
        message = (
            f"no contact balances a mean force of {force:.3g} N along {motion}, where the structure has no stiffness."
        )
        advice = (
            "The static forces exceed the limit of friction, or no static force presses the contact. Change them or "
            "the preload, or hold the structure by a spring."
        )
        return Finding("unbalanced-mean", "error", {"motion": motion, "force": force}, message, advice)
    if element := _not_finite(problem, solution):
        message = f"the function of {element!r} returns forces that are not finite."
        advice = "Let it return finite forces at all displacements."
        return Finding("force-not-finite", "error", {"element": element}, message, advice)
    if solution.point.resonates:
        message = "the structure resonates without damping, and no element limits its motion."
        return Finding("undamped-resonance", "error", {}, message, "Give it damping, or choose another frequency.")
    return None


def _not_finite(problem: Equations, solution: Solution) -> str:
    """Name of the user's element whose force is not finite here or after Newton's next step; empty if there is none."""
    balance = problem.balance(solution.samples)
    try:
        step = solution.tangent.solve(solution.evaluation.residual[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError:
        step = np.zeros_like(solution.unknowns)
    for part in (0.0, 1.0):
        motion = balance.displacements(solution.unknowns - part * step) @ balance.series.synthesis.T
        for rows, element in balance.lowered.functions:
            if not np.all(np.isfinite(element.law(motion[rows])[0])):
                return element.name
    return ""


def unconverged_findings(points: int, lost: Iterable[Unconverged]) -> tuple[Finding, ...]:
    """Return the finding on the points of a curve that are not converged."""
    lost = list(lost)
    if not lost:
        return ()
    count = f"{len(lost)} of {points} points were not found."
    known = [(entry.frequency, entry.cause) for entry in lost if entry.cause is not None]
    for frequency, cause in sorted(known, key=lambda entry: entry[1].code != "unbalanced-mean")[:1]:
        values = {"points": len(lost), "frequency": frequency, **cause.values}
        return (replace(cause, values=values, message=f"{count} At {frequency:.6g} Hz {cause.message}"),)
    worst = max(lost, key=lambda entry: entry.residual)
    values = {"points": len(lost), "frequency": worst.frequency, "residual": worst.residual}
    message = f"{count} The largest relative residual is {worst.residual:.1e}, at {worst.frequency:.6g} Hz."
    advice = "Follow the curve by arc length, or with smaller steps of frequency, more harmonics or more samples."
    return (Finding("points-not-found", "warning", values, message, advice),)


def free_findings(problem: Equations) -> tuple[Finding, ...]:
    """Return the finding on motions of the structure that nothing holds."""
    # By receptances, the reference holds all motions.
    names = "" if problem.by_receptances else problem.condensation.free_names
    if not names:
        return ()
    message = f"No spring and no contact holds the mean position along {names}; the smallest one was chosen."
    advice = "Look at changes of these displacements, or hold the structure by a spring."
    return (Finding("free-mean-position", "note", {"motion": names}, message, advice),)


def largest(best: Solution | None, solution: Solution) -> Solution | None:
    """The solution with the larger motion; None before one was found."""
    if not solution.converged or (best is not None and norm(best.unknowns) >= norm(solution.unknowns)):
        return best
    return solution
