"""Findings on beams and cables in space whose line turns far within an element."""

import numpy as np

from dalembert.findings import Finding


def turn_findings(
    owner: str, name: str, elements: int, times: np.ndarray, cosines: np.ndarray, limit: str
) -> tuple[Finding, ...]:
    """Return a finding on a body of which a node turns by more than 90 degrees against another of its element.

    ``times`` (samples,): s; ``cosines`` (samples,): of the largest angle; ``limit``: words on where the element fails.
    """
    sample = int(np.argmin(cosines))
    angle = float(np.degrees(np.arccos(np.clip(cosines[sample], -1.0, 1.0))))
    if angle <= 90.0:
        return ()
    values = {"body": name, "angle": angle, "time": float(times[sample]), "elements": elements}
    message = (
        f"A node of {owner} turns by {angle:.3g} degrees against another node of its element at "
        f"{times[sample]:.4g} s. The element is not accurate there{limit}."
    )
    return (Finding("beam-turn", "warning", values, message, "Use more elements."),)
