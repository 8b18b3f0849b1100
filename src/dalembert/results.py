"""What the results of this package have in common: they can be kept, drawn and reported."""

import json
from dataclasses import replace
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any, ClassVar, Self

from dalembert.contents import Contents
from dalembert.errors import DataError
from dalembert.files import read_dataset, write_contents
from dalembert.findings import Finding
from dalembert.notebook_display import Displayed
from dalembert.parameter import Parameter
from dalembert.stored_fields import Source, Store, restore, store
from dalembert.tables import Table, labelled, shown

if TYPE_CHECKING:
    from xarray import Dataset


class Summarised(Displayed):
    """A result with facts and tables, which the summary, reports, notebooks and pages show.

    A class of results defines :meth:`facts` and :meth:`tables`.
    """

    TITLE: ClassVar[str] = ""
    """Heading of its report."""
    VERDICTS: ClassVar[tuple[str, str]] = ("computed", "incomplete")
    """A word for success, and one for the opposite."""
    findings: tuple[Finding, ...] = ()
    """What the method concludes about the result."""

    @property
    def conclusions(self) -> tuple[Finding, ...]:
        """All findings: how the method ended, if it says that, and what it concludes."""
        return self.findings

    @property
    def doubts(self) -> tuple[Finding, ...]:
        """Reasons to doubt the result: its findings that are more than notes."""
        return tuple(finding for finding in self.conclusions if finding.doubtful)

    @property
    def title(self) -> str:
        """Heading of its report."""
        return self.TITLE

    @property
    def verdict(self) -> str:
        """Whether the result is a success, in a word or two."""
        return self.VERDICTS[0 if getattr(self, "success", True) else 1]

    def key_values(self) -> dict[str, str]:
        """Return the few values that matter most, as texts by what they are; the summary has them in its tables."""
        return {}

    def facts(self) -> dict[str, str]:
        """Return the few numbers that matter, as texts by what they are."""
        return {}

    def tables(self) -> tuple[Table, ...]:
        """Return the tables of the result, the most important first."""
        return ()

    def summary(self) -> str:
        """Return tables, facts, status and findings as text."""
        tables = [table for table in self.tables() if not table.detail]
        facts = {**self.facts(), **fixed_facts(self)}
        lines: list[str] = []
        for table in tables:
            lines += [*([table.caption] if len(tables) > 1 else []), *table.lines(), ""]
        if facts:
            width = max(map(len, facts)) + 1
            lines += [*(f"{name:<{width}} {value}" for name, value in facts.items()), ""]
        status = getattr(self, "status", "")
        findings = [str(finding) for finding in self.conclusions if str(finding) not in status]
        return "\n".join([*lines, *filter(None, (status, *findings))])


class Result(Summarised):
    """A result that can be written to a file, drawn, and reported."""

    FORMAT: ClassVar[str]

    def contents(self) -> Contents:
        """Everything as labelled arrays, with units as attributes, by the types of the fields."""
        to = Store()
        settings = store(self, to)
        scalars = [name for name, value in settings.items() if isinstance(value, str | float | int)]
        facts = {name: settings.pop(name) for name in scalars}
        facts = {name: int(fact) if isinstance(fact, bool) else fact for name, fact in facts.items()}
        attributes = {"format": self.FORMAT, **facts, "settings": json.dumps(settings, sort_keys=True)}
        return Contents(to.variables, to.coordinates, attributes)

    def to_xarray(self) -> "Dataset":
        """Everything as an :class:`xarray.Dataset`, with units as attributes."""
        return self.contents().to_xarray()

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> Self:
        """The result that :meth:`to_xarray` turned into a dataset."""
        settings = {**dataset.attrs, **stored_settings(dataset)}
        source = Source(dataset, {str(name): variable.values for name, variable in dataset.variables.items()})
        return restore(cls, source, settings)

    def save(self, path: str | Path) -> None:
        """Write everything to a NetCDF-4 file, whole or not at all; :meth:`load` gives back the same bits."""
        write_contents(path, self.contents())

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """A result that was saved.

        Raises
        ------
        DataError
            For a file that is not there, holds something else, or was written by another version.
        """
        dataset = read_dataset(path, form=cls.FORMAT, expected=f"a result written by {cls.__name__}.save")
        try:
            return cls.from_xarray(dataset)
        except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:  # fields of other code
            raise DataError(
                f"{path}: this version cannot read the result ({type(error).__name__}: {error}). Run the study again, "
                "or read the file by the version that wrote it"
            ) from error

    def figures(self, *supplements: object, **options: Any) -> dict[str, Any]:
        """Figures by name; arguments as those of :func:`dalembert.report.figures`."""
        return resolve_name("dalembert.report:figures")(self, *supplements, **options)

    def report(self, path: str | Path, *supplements: object, **options: Any) -> Any:
        """Write an HTML report that opens offline; arguments as those of :func:`dalembert.report.report`."""
        return resolve_name("dalembert.report:report")(self, path, *supplements, **options)


class EndedResult(Result):
    """A result of a method that says how it ended, as findings in ``outcome``."""

    outcome: Any

    @property
    def status(self) -> str:
        """How the method ended and what to do, in full sentences: the text of ``outcome``."""
        return " ".join(map(str, self.outcome))

    @property
    def conclusions(self) -> tuple[Finding, ...]:
        return (*self.outcome, *self.findings)

    def contents(self) -> Contents:
        contents = super().contents()
        return replace(contents, attributes={**contents.attributes, "status": self.status})


def fixed_facts(result: Any) -> dict[str, str]:
    """Return values of the parameters that were fixed by equal bounds, as texts by their names.

    >>> from types import SimpleNamespace
    >>> fixed_facts(SimpleNamespace(fixed=(Parameter("mass", 2.0, 2.0, "kg"),)))
    {'mass (kg), fixed': '2'}
    """
    of_parameters = getattr(getattr(result, "parameters", None), "fixed", ())
    fixed: tuple[Parameter, ...] = getattr(result, "fixed", of_parameters)
    return {f"{labelled(item.name, item.unit)}, fixed": shown(float(item.lower)) for item in fixed}


def stored_settings(dataset: "Dataset") -> dict[str, Any]:
    """Return the settings of a stored result."""
    return json.loads(dataset.attrs["settings"])
