"""The outcome of a task whose result can summarise, save and report itself."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dalembert.findings import Finding
from dalembert.study.tasks.task import Outcome, concluded

if TYPE_CHECKING:
    from dalembert.study.study import Study


@dataclass(frozen=True)
class ResultOutcome(Outcome):
    """A result with ``success``, ``status``, ``summary()`` and ``save(path)``.

    Parameters
    ----------
    study : Study
    result : any
    numbers : mapping
        Those that the list of runs tells.
    options : mapping
        Of :func:`dalembert.report.report`, beside title, notes and study.
    """

    study: "Study" = field(repr=False)
    result: Any
    numbers: dict[str, Any]
    options: Mapping[str, Any] = field(default_factory=dict)

    @property
    def success(self) -> bool:
        return self.result.success

    @property
    def status(self) -> str:
        return self.result.status

    @property
    def summary(self) -> str:
        return self.result.summary()

    @property
    def best(self) -> dict[str, Any]:
        return self.numbers

    @property
    def findings(self) -> tuple[Finding, ...]:
        return concluded(self.result)

    def save(self, path: Path) -> None:
        self.result.save(path)

    def report(self, path: Path) -> None:
        from dalembert.report import report

        about = self.study.file.study
        text = self.study.content.decode()
        report(self.result, path, title=self.study.title, notes=about.description, study=text, **self.options)
