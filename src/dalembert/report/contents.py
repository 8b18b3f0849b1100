"""Sections of a report in reading order."""

from dataclasses import replace

from dalembert.report.asked import Asked
from dalembert.report.needs import TrajectoryLike
from dalembert.report.needs_frequency import BackboneLike, DeformationLike, ReductionErrorsLike, TimeComparisonLike
from dalembert.report.needs_telling import PredictionLike, ProfilesLike
from dalembert.report.registry import registered_sections
from dalembert.report.results import bounds, frequency, identification, motion
from dalembert.report.sections import Provenance, Section
from dalembert.report.sections.headline import Headline, fixed_facts

__all__ = ["bounds", "contents", "frequency", "identification", "motion"]
BESIDE = (
    TrajectoryLike, ProfilesLike, PredictionLike, TimeComparisonLike, BackboneLike, DeformationLike,
    ReductionErrorsLike,
)  # fmt: skip
"""Kinds of results that have a section in the report of another result."""


def contents(result: object, asked: Asked) -> list[Section]:
    """Sections of a report in reading order; the first is the headline.

    Raises
    ------
    InputError
        For a result that no sections are registered for, and for what no section shows.
    """
    asked.require(BESIDE)
    first, *others = registered_sections(result, asked)
    if not isinstance(first, Headline):
        title = asked.title or type(result).__name__
        first, others = Headline(title, "", True, "", (), asked.notes), [first, *others]
    first = replace(first, findings=tuple(getattr(result, "findings", ())), facts=[*first.facts, *fixed_facts(result)])
    facts = getattr(result, "provenance", {})
    after = [Provenance(facts, asked.study)] if facts or asked.study else []
    return [first, *others, *asked.sections, *after]
