"""What a report is asked to show with a result."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

from dalembert.errors import InputError, shown, unknown
from dalembert.findings import Finding
from dalembert.report.section import Section

Kind = TypeVar("Kind")


@dataclass(frozen=True)
class Asked:
    """What a report is asked to show with a result.

    Parameters
    ----------
    beside : tuple
        Other results, mappings of str to results (one for each experiment), and sections.
    title : str, optional
    notes : sequence of str
        Paragraphs.
    study : str, optional
        Text of the study file.
    points, channels, dofs : tuple of str
    truth : mapping
    amplitude : str
    findings : sequence of Finding
        About the run, before those of the result.
    """

    beside: tuple[Any, ...] = ()
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
        """Results of a kind by the names of their experiments; by no name where there is only one.

        >>> Asked((3, {"warm": 1.0, "cold": 2.0})).each(int), Asked((3, {"warm": 1.0, "cold": 2.0})).each(float)
        ({'': 3}, {'warm': 1.0, 'cold': 2.0})
        """
        found: dict[str, Kind] = {}
        for one in self.beside:
            given = one if isinstance(one, Mapping) else {"": one}
            found.update({name: value for name, value in given.items() if isinstance(value, kind)})
        self.taken.extend(found.values())
        return found

    def one(self, kind: type[Kind]) -> Kind | None:
        """The first result of a kind; None if there is none."""
        return next(iter(self.each(kind).values()), None)

    @property
    def sections(self) -> list[Section]:
        """Sections of the user's."""
        return [one for one in self.beside if isinstance(one, Section)]

    def refuse_others(self) -> None:
        """Refuse what no section has taken.

        Raises
        ------
        InputError
            For anything else than results that a section has taken, and sections.
        """
        for one in self.beside:
            for value in one.values() if isinstance(one, Mapping) else [one]:
                if not isinstance(value, Section) and not any(value is other for other in self.taken):
                    raise InputError(
                        f"report: {shown(one)} was given beside the result; expected a trajectory, profiles, a "
                        "population, a prediction, a comparison in time, a backbone, a deformation, reduction errors, "
                        "or a section"
                    )


def asked(beside: tuple[Any, ...], **options: Any) -> Asked:
    """What is asked for, from the arguments of :func:`dalembert.report.report`.

    Raises
    ------
    InputError
        For an unknown option.
    """
    known = {one.name for one in fields(Asked) if one.init} - {"beside"}
    for name in options:
        if name not in known:
            raise InputError(unknown("option", name, sorted(known), "report"))
    lists = {name: tuple(options[name]) for name in ("points", "channels", "dofs") if name in options}
    given = tuple(one for one in beside if one is not None)
    return Asked(given, **{**options, **lists, "truth": options.get("truth") or {}})
