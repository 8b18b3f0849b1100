"""What the import of a robot file left out, as data and as findings."""

__all__ = ["Omission"]

from collections.abc import Sequence
from dataclasses import dataclass

from dalembert.findings import Finding

MOST = 8
"""Omissions without effect that a message lists; the others are counted."""


@dataclass(frozen=True)
class Omission:
    """A part of a robot file that has no counterpart in the mechanism. ``text``: what was left out, with its line or
    name; ``moves``: whether the motion changes without it: a spring changes it, a camera does not.
    """

    text: str
    moves: bool = False


def omission_findings(name: str, omissions: Sequence[Omission]) -> tuple[Finding, ...]:
    """Return the findings about what the import of a robot left out: what changes its motion, and all else."""
    findings = []
    for moves in (True, False):
        texts = [omission.text for omission in omissions if omission.moves == moves]
        if not texts:
            continue
        effect = "the motion depends" if moves else "no motion without contact and within limits depends"
        listed = texts if moves or len(texts) <= MOST else [*texts[:MOST], f"and {len(texts) - MOST} more"]
        message = f"Robot {name!r}: the import left out parts of the file on which {effect}: {'; '.join(listed)}."
        values = {"robot": name, "parts": len(texts), "moves": moves}
        advice = "Add to the model what matters." if moves else ""
        findings.append(Finding("not-imported", "warning" if moves else "note", values, message, advice))
    return tuple(findings)
