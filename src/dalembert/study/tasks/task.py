"""What a task of a study file is, and what it hands back."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from dalembert.findings import Finding
from dalembert.study.table import StudyTable

if TYPE_CHECKING:
    from dalembert.study.duration import Effort
    from dalembert.study.events import Emit
    from dalembert.study.study import Study


def silent(kind: str, **details: Any) -> None:
    """Take an event and do nothing: for parts of a run that nobody follows."""


def concluded(result: Any) -> tuple[Finding, ...]:
    """Findings of a result, and what else it is doubted for."""
    findings = tuple(getattr(result, "findings", ()))
    return (*findings, *(doubt for doubt in getattr(result, "doubts", ()) if doubt not in findings))


class Outcome(Protocol):
    """What a task found."""

    @property
    def success(self) -> bool: ...

    @property
    def status(self) -> str:
        """What came out, or what could not, in a sentence."""
        ...

    @property
    def summary(self) -> str:
        """What came out, in a few lines for a terminal."""
        ...

    @property
    def best(self) -> dict[str, Any]:
        """Few numbers for the list of runs."""
        ...

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What is concluded about the result."""
        return ()

    def save(self, path: Path) -> None:
        """Write the result as NetCDF, whole or not at all."""
        ...

    def report(self, path: Path) -> None:
        """Write the HTML report, whole or not at all."""
        ...


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
    """

    name: ClassVar[str]
    rank: ClassVar[int] = 100
    of_structures: ClassVar[bool] = False

    @abstractmethod
    def table(self) -> type[StudyTable]:
        """Schema of the task's table."""

    @abstractmethod
    def wrong(self, file: Any) -> list[str]:
        """Sentences about what the task misses elsewhere in the file."""

    @abstractmethod
    def plan(self, study: "Study") -> str:
        """What would run, and about how many simulations, in a sentence; nothing is simulated for it."""

    def parts(self, study: "Study") -> Iterable[Callable[[], object]]:
        """Parts of the run, each of which checks its settings before its first simulation."""
        return (partial(self.run, study, silent),)

    @abstractmethod
    def effort(self, study: "Study") -> "Effort":
        """What the study spends its time with."""

    def unknowns(self, study: "Study") -> tuple[str, ...]:
        """Names of the values that the events of a run tell."""
        return study.parameters.names

    def foresight(self, study: "Study") -> int:
        """About how many simulations :meth:`foreseen` takes the time of; none if it has nothing to say."""
        return 0

    def foreseen(self, study: "Study") -> tuple[str, ...]:
        """Sentences on what would come out, from a look that costs little."""
        return ()

    def trials(self, study: "Study") -> int:
        """Number of simulations that the run checks the study by, before those that it computes its result from."""
        return 0

    @abstractmethod
    def run(self, study: "Study", emit: "Emit") -> Outcome:
        """Do it."""

    @abstractmethod
    def load(self, study: "Study", path: Path) -> Outcome:
        """What a run found, from its result file."""
