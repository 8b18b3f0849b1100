"""The options of a report: what it shows with a result."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

from dalembert.errors import InputError, shown, unknown
from dalembert.findings import Finding
from dalembert.report.section import Section

Kind = TypeVar("Kind")


@dataclass(frozen=True)
class ReportOptions:
    """What a report shows with a result. ``supplements``: other results, mappings of str to results (one for each
    experiment), and sections; ``notes``: paragraphs; ``study``: text of the study file; ``findings``: about the run,
    before those of the result.
    """

    supplements: tuple[Any, ...] = ()
    title: str | None = None
    notes: Sequence[str] = ()
    study: str | None = None
    points: tuple[str, ...] = ()
    channels: tuple[str, ...] = ()
    truth: Mapping[str, Any] = field(default_factory=dict)
    dofs: tuple[str, ...] = ()
    amplitude: str = "peak"
    findings: Sequence[Finding] = ()
    taken: list[Any] = field(default_factory=list, init=False, repr=False)
    """Results beside that a section shows."""

    def each(self, kind: type[Kind]) -> dict[str, Kind]:
        """Return results of a kind by the names of their experiments; by no name where there is only one.
        >>> options = ReportOptions((3, {"warm": 1.0, "cold": 2.0}))
        >>> options.each(int), options.each(float)
        ({'': 3}, {'warm': 1.0, 'cold': 2.0})
        """
        results = {
            name: value
            for item in self.supplements
            for name, value in (item if isinstance(item, Mapping) else {"": item}).items()
            if isinstance(value, kind)
        }
        self.taken.extend(results.values())
        return results

    def first(self, kind: type[Kind]) -> Kind | None:
        """The first result of a kind; None if there is none."""
        return next(iter(self.each(kind).values()), None)

    @property
    def sections(self) -> list[Section]:
        """The user's sections."""
        return [item for item in self.supplements if isinstance(item, Section)]

    def refuse_others(self) -> None:
        """Refuse what no section has taken."""
        for item in self.supplements:
            for value in item.values() if isinstance(item, Mapping) else [item]:
                if not isinstance(value, Section) and not any(value is shown_result for shown_result in self.taken):
                    raise InputError(
                        f"report: {shown(item)} was given beside the result; expected a trajectory, profiles, a "
                        "population, a prediction, a comparison in time, a backbone, a deformation, reduction errors, "
                        "or a section"
                    )


def report_options(supplements: tuple[Any, ...], **options: Any) -> ReportOptions:
    """Return the options from the arguments of :func:`dalembert.report.report`."""
    known = {item.name for item in fields(ReportOptions) if item.init} - {"supplements"}
    for name in options:
        if name not in known:
            raise InputError(unknown("option", name, sorted(known), "report"))
    lists = {name: tuple(options[name]) for name in ("points", "channels", "dofs") if name in options}
    results = tuple(item for item in supplements if item is not None)
    return ReportOptions(results, **{**options, **lists, "truth": options.get("truth") or {}})
