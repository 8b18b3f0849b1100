"""The first lines of a report: what was done, whether it worked, and what came out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from dalembert.findings import Finding
from dalembert.report.section import Section
from dalembert.results import Summarised


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

    @property
    def doubtful(self) -> bool:
        """Return True if a finding is a reason to doubt the result."""
        return any(finding.doubtful for finding in self.findings)

    @property
    def badge(self) -> str:
        """How the verdict is shown: ``"good"``, ``"doubtful"`` or ``"bad"``."""
        return "bad" if not self.success else "doubtful" if self.doubts or self.doubtful else "good"


def headline_of(result: Summarised, facts: Mapping[str, str] | None = None, **changes: Any) -> Headline:
    """Return the headline of a result: its title, verdict, status and facts, with changes."""
    content: dict[str, Any] = {
        "title": result.title,
        "verdict": result.verdict,
        "success": getattr(result, "complete", getattr(result, "success", True)),
        "status": getattr(result, "status", ""),
    }
    known = {**result.key_values(), **(result.facts() if facts is None else facts)}
    return Headline(facts=known, **content | changes)
