"""What an identification from bands concludes about the bands and its own search, as findings."""

from dalembert.findings import Finding
from dalembert.inverse.bands.found import Found
from dalembert.inverse.doubts import NO_BOX


def conclusions(found: Found, status: str) -> tuple[Finding, ...]:
    """Return the findings: bands that no box has, and a best end that only one of the descents reached."""
    findings = []
    if NO_BOX in status:
        findings.append(
            Finding(
                "inconsistent-bands",
                "error",
                {},
                "The bands are inconsistent: no box of the parameters has them.",
                "Check the bands, the model and the bounds of the parameters.",
            )
        )
    if found.reached == 1:
        findings.append(
            Finding(
                "minimum-reached-once",
                "warning",
                {"reached": 1},
                "Only one of the descents reached the best fitness: another minimum may be better.",
                "Increase starts.",
            )
        )
    return tuple(findings)
