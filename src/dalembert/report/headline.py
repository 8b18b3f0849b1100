"""The first lines of a report: what was done, whether it worked, and what came out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from dalembert.findings import Finding
from dalembert.report.section import Section
from dalembert.results import Result


@dataclass(frozen=True, kw_only=True)
class Headline(Section):
    """Title, verdict with advice and reasons to doubt it, and the few numbers that matter."""

    template: ClassVar[str] = "headline.html"
    heading: str = "Result"
    title: str
    verdict: str = ""
    success: bool = True
    status: str = ""
    facts: Mapping[str, str] = field(default_factory=dict)
    notes: Sequence[str] = ()
    doubts: Sequence[str] = ()
    findings: Sequence[Finding] = ()

    @classmethod
    def of(
        cls, title: str, success: bool, verdicts: tuple[str, str], status: str, facts: Mapping[str, str]
    ) -> "Headline":
        """Headline of a result whose verdict is the first of two where it is a success, else the second."""
        verdict = verdicts[0] if success else verdicts[1]
        return cls(title=title, verdict=verdict, success=success, status=status, facts=facts)

    @property
    def doubtful(self) -> bool:
        """Return True if a finding is a reason to doubt the result."""
        return any(finding.doubtful for finding in self.findings)

    @property
    def badge(self) -> str:
        """How the verdict is shown: ``"good"``, ``"doubtful"`` or ``"bad"``."""
        return "bad" if not self.success else "doubtful" if self.doubts or self.doubtful else "good"


def headline_of(result: Result, **changes: Any) -> Headline:
    """Return the headline of a result: its title, verdict, status and facts, with changes."""
    content: dict[str, Any] = {"title": result.TITLE, "verdict": result.verdict, "facts": result.facts()}
    content |= {"success": getattr(result, "success", True), "status": getattr(result, "status", "")}
    return Headline(**content | changes)
