"""What an identification from bands concludes beyond the box."""

from dalembert.findings import Finding
from dalembert.inverse.bands.band_problem import BandProblem
from dalembert.inverse.bands.found import Found
from dalembert.inverse.bands.status import inconsistency

CLEAR = 5e-2
"""Rms difference of reproduced and given bands, as part of their mean width, from which the box is not to be used."""


def conclusions(problem: BandProblem, found: Found) -> tuple[Finding, ...]:
    """Return the findings: bands that no box has, and a best end that only one of the descents reached."""
    findings = []
    share = inconsistency(problem, found)
    if share:
        findings.append(
            Finding(
                "inconsistent-bands",
                "error" if share > CLEAR else "warning",
                {"share": share},
                "The bands are inconsistent: no box of the parameters has them. The best box differs by "
                f"{100 * share:.2g} % of their mean width.",
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
