"""The first lines of a report: what was done, whether it worked, and what came out."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from dalembert.findings import Finding
from dalembert.parameters import Parameter
from dalembert.report.digits import shown
from dalembert.report.quantities import labelled
from dalembert.report.section import Section
from dalembert.results import fixed_of

MOST_VALUES = 4


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


def fixed_facts(result: object) -> dict[str, str]:
    """Values of the parameters that were fixed by equal bounds."""
    return {f"{labelled(item.name, item.unit)}, fixed": shown(float(item.lower)) for item in fixed_of(result)}


def few(parameters: Iterable[Parameter], texts: Iterable[str]) -> dict[str, str]:
    """The values of parameters as facts, unless there are many."""
    facts = {labelled(item.name, item.unit): text for item, text in zip(parameters, texts, strict=True)}
    return facts if len(facts) <= MOST_VALUES else {}
