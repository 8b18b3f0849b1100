"""Whether a path came to its end, and why it did not."""

import numpy as np

from dalembert.findings import Finding

ADVICE = {
    "fold": "The response beyond is on another branch. Give single values there in place of two ends.",
    "stopped": "Use more harmonics or smaller steps, or start behind this place.",
    "closed": "The path is an isolated branch. Other branches of the range are not on it.",
    "joined": "Behind this place it is the same branch again, or the curve.",
    "no-progress": "Use more harmonics or samples, or events=True, so that the path has no sharp turns.",
}
"""What to do, by the reason."""


def end_findings(
    places: np.ndarray,
    converged: np.ndarray,
    ends: tuple[float, float],
    what: str,
    unit: str,
    end_inside: str = "",
    left: bool = False,
) -> tuple[Finding, ...]:
    """Return the findings on a path that left its range, or did not reach its end.

    ``places`` (points,): values of what the path leads over, in its order; ``converged`` (points,); ``what``, ``unit``:
    of the values; ``end_inside``: the reason of an end inside the range, if it has one; ``left``: whether the path
    leaves the range at its first value and comes back.
    """
    (begin, end), last = ends, float(places[-1])
    outside: tuple[Finding, ...] = ()
    if left:
        message = (
            f"The path leaves the range at {begin:.6g} {unit} ({what}) and comes back. Its part outside is missing."
        )
        outside = (Finding("left-range", "warning", {"begin": begin}, message, "Begin the range farther outside."),)
    if np.isclose(last, end, rtol=1e-12, atol=0.0):  # a point that was not found there has its finding
        return outside
    where = f"{last:.6g} {unit} ({what})"
    if end_inside == "closed":
        reason, how = end_inside, f"The path is closed: it comes back to its first point at {where}."
    elif end_inside:
        reason, how = end_inside, f"The branch comes back to the curve at {where}."
    elif (last - begin) * np.sign(end - begin) <= 0 and len(places) > 1:
        reason, how = "fold", f"The path passes a fold and leaves the range at {where}."
    elif not converged[-1]:
        reason, how = "stopped", f"The path stops at {where}: no further point was found."
    else:
        reason, how = "no-progress", f"The path stops at {where}: its steps became too short."
    reached = places[converged]
    farthest = float(reached[np.argmax(reached * np.sign(end - begin))]) if reached.size else begin
    values = {"reason": reason, "last": last, "farthest": farthest, "end": end}
    message = f"{how} It does not reach {end:.6g} {unit}."
    return (*outside, Finding("end-not-reached", "warning", values, message, ADVICE[reason]))
