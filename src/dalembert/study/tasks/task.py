"""What a task of a study file is, and what it hands back."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from pkgutil import resolve_name
from typing import Any, ClassVar

from dalembert.findings import Finding
from dalembert.study.run.duration import Effort
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.text.table import StudyTable, completed


def silent(kind: str, **details: Any) -> None:
    """Take an event and do nothing: for parts of a run that nobody follows."""


@dataclass(frozen=True)
class Outcome:
    """What a task found: a result with ``success``, ``status``, ``summary()`` and ``save(path)``.

    Parameters
    ----------
    study : Study
    result : any
    best : mapping
        Few numbers for the list of runs.
    options : mapping
        Of :func:`dalembert.report.report`, beside title, notes and study.
    further_results : mapping
        Further results, by the names of their files beside that of the result, without ending.
    of_run : tuple of Finding
        Findings about the run, which do not depend on the result.
    """

    study: Study = field(repr=False)
    result: Any
    best: Mapping[str, Any] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    further_results: Mapping[str, Any] = field(default_factory=dict)
    of_run: tuple[Finding, ...] = ()

    @property
    def success(self) -> bool:
        return self.result.success

    @property
    def status(self) -> str:
        """The result, or why there is none, in a sentence."""
        return self.result.status

    @property
    def summary(self) -> str:
        """The result in a few lines for a terminal."""
        return self.result.summary()

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Findings about the run, findings of the result, and what else it is doubted for."""
        findings = tuple(getattr(self.result, "findings", ()))
        return (
            *self.of_run,
            *findings,
            *(doubt for doubt in getattr(self.result, "doubts", ()) if doubt not in findings),
        )

    @property
    def supplements(self) -> Iterable[Any]:
        """What the report shows beside the result."""
        return self.further_results.values()

    def save(self, path: Path) -> None:
        """Write the result and what is beside it as NetCDF, each whole or not at all."""
        self.result.save(path)
        for name, result in self.further_results.items():
            result.save(path.with_name(f"{name}.nc"))

    def report(self, path: Path) -> None:
        """Write the HTML report; if that fails, no partial file is left."""
        from dalembert.report import report

        notes, text = self.study.file.study.description, self.study.content.decode()
        report(
            self.result,
            path,
            *self.supplements,
            title=self.study.title,
            notes=notes,
            study=text,
            findings=self.of_run,
            **self.options,
        )


def load_further_results(result: Path, kinds: Mapping[str, Any]) -> dict[str, Any]:
    """What was written beside a result, by the names of files and of their kinds' classes."""
    paths = {name: result.with_name(f"{name}.nc") for name in kinds}
    return {name: kind.load(paths[name]) for name, kind in kinds.items() if paths[name].is_file()}


class Task(ABC):
    """One thing that a study file can ask for: a table, its meaning, its run and its result.

    Attributes
    ----------
    name : str
        Of the table. A class with a name is a task of study files.
    rank : int
        Place in lists of tasks.
    of_structures : bool
        Whether it is for structures over frequency alone.
    keeps_responses : bool
        Whether the checkpoint of a run keeps responses of a forward model, whose size :meth:`effort` says.
    schema : type
        Of the table.
    needs : tuple of callable
        What it needs elsewhere in the file: each returns sentences from the file and the name of the task.
    """

    name: ClassVar[str]
    rank: ClassVar[int] = 100
    of_structures: ClassVar[bool] = False
    keeps_responses: ClassVar[bool] = False
    schema: ClassVar[type[StudyTable]]
    needs: ClassVar[tuple[Callable[[Any, str], list[str]], ...]] = ()

    def table(self) -> type[StudyTable]:
        """Schema of the task's table."""
        keys = self.keys()
        return completed(self.schema, **keys) if keys else self.schema

    def keys(self) -> dict[str, Any]:
        """Keys of the table that depend on the kinds that there are, as :func:`completed` takes them."""
        return {}

    def wrong(self, file: Any) -> list[str]:
        """Sentences about what the task misses elsewhere in the file."""
        return [sentence for need in self.needs for sentence in need(file, self.name)]

    @abstractmethod
    def plan(self, study: Study) -> str:
        """What would run, and about how many simulations, in a sentence; nothing is simulated for it."""

    def parts(self, study: Study) -> Iterable[Callable[[], object]]:
        """Parts of the run, each of which checks its settings before its first simulation."""
        return (partial(self.run, study, silent),)

    @abstractmethod
    def effort(self, study: Study) -> Effort:
        """What the study spends its time with."""

    def planned(self, study: Study) -> int | None:
        """Simulations that the search takes, where they are settled beforehand; None where it stops by itself."""
        return None

    def unknowns(self, study: Study) -> tuple[str, ...]:
        """Names of the values in the events of a run."""
        return study.parameters.names

    def foresight(self, study: Study) -> int:
        """About how many simulations :meth:`foreseen` takes the time of; none if it has nothing to say."""
        return 0

    def foreseen(self, study: Study) -> tuple[str, ...]:
        """Sentences on what would come out, from a look that costs little."""
        return ()

    def trials(self, study: Study) -> int:
        """Number of simulations that the run checks the study by, before those that it computes its result from."""
        return 0

    @abstractmethod
    def run(self, study: Study, emit: Emit) -> Outcome:
        """Do it."""

    @abstractmethod
    def load(self, study: Study, path: Path) -> Outcome:
        """What a run found, from its result file."""


class ResultTask(Task):
    """A task that makes one result, which one class reads again.

    Attributes
    ----------
    kind : str
        Where that class is, ``"package.module:Class"``; it has a class method ``load(path)``.
    """

    kind: ClassVar[str]

    @abstractmethod
    def result(self, study: Study, emit: Emit) -> Any:
        """Do it."""

    def outcome(self, study: Study, result: Any) -> Outcome:
        """What a run hands back of its result."""
        return Outcome(study, result)

    def run(self, study: Study, emit: Emit) -> Outcome:
        return self.outcome(study, self.result(study, emit))

    def load(self, study: Study, path: Path) -> Outcome:
        return self.outcome(study, resolve_name(self.kind).load(path))
